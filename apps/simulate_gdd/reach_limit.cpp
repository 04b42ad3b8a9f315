// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/reach_limit.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "softgauss/engine/dynamics/jacobian.hpp"

namespace softgauss::app {
namespace {

constexpr int kStarts = 24;
constexpr int kIterations = 200;
constexpr double kClose = 1e-4;      // [m] there is no more to find
constexpr double kLeastGain = 1e-7;  // [m] an iteration that gains less is the last
constexpr double kFreeRange = M_PI;  // [rad] starts of joints without a range lie within

/// A joint between the base and the link.
struct ChainJoint {
  int q, v;
  bool slides;
  double lower, upper;
};

class Search {
 public:
  Search(const Model& model, int frame, const Vector3& p_FP, const Vector3& p_WTarget)
      : model_(model), frame_(frame), p_FP_(p_FP), target_(p_WTarget), k_(model), J_(3, model.nv) {
    for (int b = model.frames[frame].body; b > 0; b = model.bodies[b].parent) {
      if (model.bodies[b].dofs != 1) continue;
      const Body& body = model.bodies[b];
      ChainJoint joint{body.q, body.v, body.joint == JointKind::prismatic, -kInfinity, kInfinity};
      for (const JointRange& range : model.ranges)
        if (range.body == b) joint.lower = range.lower, joint.upper = range.upper;
      joints_.push_back(joint);
    }
  }

  /// The least distance from starts that are the same in every run.
  double least(const VectorX& q, bool withinRanges) {
    std::mt19937_64 random(1);
    double best = kInfinity;
    for (int start = 0; start < kStarts && best > kClose; ++start) {
      VectorX from = q;
      if (start > 0)
        for (const ChainJoint& j : joints_) {
          const bool bounded = std::isfinite(j.lower) && std::isfinite(j.upper);
          from[j.q] = std::uniform_real_distribution<double>(
              bounded ? j.lower : -kFreeRange, bounded ? j.upper : kFreeRange)(random);
        }
      best = std::min(best, descend(std::move(from), withinRanges));
    }
    return best;
  }

 private:
  Vector3 away(const VectorX& q) {
    computePoses(model_, q, k_);
    point_ = framePose(model_, k_, frame_) * p_FP_;
    return target_ - point_;
  }

  /// Levenberg's method on the distance, joints held to their ranges.
  double descend(VectorX q, bool withinRanges) {
    clamp(q, withinRanges);
    Vector3 e = away(q);
    double damping = 1e-3;
    for (int i = 0; i < kIterations && e.norm() > kClose; ++i) {
      pointJacobian(model_, k_, model_.frames[frame_].body, point_, J_);
      Eigen::Matrix3d A = Eigen::Matrix3d::Identity() * damping;
      for (const ChainJoint& j : joints_)
        if (isFree(j, q, J_.col(j.v).dot(e), withinRanges))
          A += J_.col(j.v) * J_.col(j.v).transpose();
      const Vector3 pull = A.ldlt().solve(e);
      VectorX next = q;
      for (const ChainJoint& j : joints_) {
        const double step = J_.col(j.v).dot(pull);
        if (isFree(j, q, J_.col(j.v).dot(e), withinRanges))
          next[j.q] += std::clamp(step, -0.5, 0.5);
      }
      clamp(next, withinRanges);
      const Vector3 after = away(next);
      const double gain = e.norm() - after.norm();
      if (gain > 0.0) {
        q = std::move(next);
        e = after;
        damping = std::max(0.3 * damping, 1e-9);
        if (gain < kLeastGain) break;
      } else {
        away(q);
        damping *= 10.0;
        if (damping > 1e6) break;
      }
    }
    return e.norm();
  }

  /// A joint at the end of its range does not count where it would go on.
  static bool isFree(const ChainJoint& j, const VectorX& q, double slope, bool withinRanges) {
    if (!withinRanges && !j.slides) return true;
    return slope > 0.0 ? q[j.q] < j.upper : q[j.q] > j.lower;
  }
  void clamp(VectorX& q, bool withinRanges) const {
    for (const ChainJoint& j : joints_)
      if (withinRanges || j.slides) q[j.q] = std::clamp(q[j.q], j.lower, j.upper);
  }

  const Model& model_;
  int frame_;
  Vector3 p_FP_, target_, point_;
  Kinematics k_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> J_;
  std::vector<ChainJoint> joints_;
};

}  // namespace

ReachLimit reachLimit(const Model& model, const VectorX& q, int frame, const Vector3& p_FP,
                      const Vector3& p_WTarget) {
  Search search(model, frame, p_FP, p_WTarget);
  ReachLimit limit;
  limit.withinRanges = search.least(q, true);
  limit.freely = limit.withinRanges > kClose ? search.least(q, false) : limit.withinRanges;
  limit.freely = std::min(limit.freely, limit.withinRanges);
  return limit;
}

}  // namespace softgauss::app
