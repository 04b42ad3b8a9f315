// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/swing_damping.hpp"

#include <algorithm>
#include <cmath>

#include "engine/constraints/connection.hpp"
#include "engine/core/rotation.hpp"

namespace softgauss {
namespace {

/// 1 − â âᵀ.
Matrix3 across(const Vector3& a) {
  return Matrix3::Identity() - a * a.transpose() / a.squaredNorm();
}

/// A point as seen from what the body turns about: its centre of mass where it floats, or its
/// joint; nothing where neither turns it.
Vector3 leverOn(const Assembly& in, int body, const Vector3& p_BP) {
  const Body& b = in.model.bodies[body];
  const Matrix3& R = in.kinematics.X_WB[body].R;
  if (b.joint == JointKind::floating) return R * (p_BP - b.com);
  return b.joint == JointKind::revolute ? Vector3(R * p_BP) : Vector3::Zero();
}

}  // namespace

int SwingDamping::hold(const Assembly& in, const ConnectionRows& connections, const VectorX& rows) {
  constexpr double kFollowed = 0.5;  // h ω [rad]
  constexpr double kThrough = 0.2;   // of the forces: what counts as all
  constexpr double kTouched = 1e-6;  // of the forces: less is rounding
  constexpr double kStringDrag = 0.1;
  const Model& model = in.model;
  clearBlocks();
  findPulls(in, connections);
  swings_.assign(model.trees.size(), {});
  for (const Pull& p : pulls_) {
    Swing* swing = swingOf(model, p);
    if (!swing) continue;
    if (p.moment > 0.0) swing->K += p.moment * across(p.a_W);
    swing->force += p.f_W.norm();
    swing->sum += p.f_W;
  }
  int held = 0;
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    Swing& swing = swings_[t];
    if (swing.K.isZero(0.0)) continue;
    const int root = model.trees[t].rootBody;
    const Body& body = model.bodies[root];
    const Vector3 all = rows.segment<3>(body.v);
    const double through = std::min(1.0, (1.0 - all.norm() / swing.force) / kThrough);
    if (!(through > 0.0)) continue;
    const Matrix3& R = in.kinematics.X_WB[root].R;
    const Matrix3 K = through * (R.transpose() * swing.K * R);
    const double turn =
        model.options.timestep * std::sqrt(0.5 * body.I_Bcm.matrix().ldlt().solve(K).trace());
    swing.share = through * (1.0 - kFollowed * kFollowed / (turn * turn));
    // What touches it, or welds it, presses at once and not as a string does.
    swing.drag = (all - swing.sum).norm() > kTouched * swing.force ? 1.0 : kStringDrag;
    held += swing.share > 0.0;
  }
  for (std::size_t i = 0; i < pulls_.size(); ++i)
    if (const Swing* swing = swingOf(model, pulls_[i]);
        swing && swing->share > 0.0 && pulls_[i].moment > 0.0)
      addRows(in, i, *swing);
  resizeRows(reference.size());
  return held;
}

SwingDamping::Swing* SwingDamping::swingOf(const Model& model, const Pull& pull) {
  const Body& body = model.bodies[pull.body];
  return body.joint == JointKind::floating ? &swings_[body.tree] : nullptr;
}

void SwingDamping::findPulls(const Assembly& in, const ConnectionRows& connections) {
  pulls_.clear();
  for (std::size_t i = 0; i < in.model.connections.size(); ++i) {
    const Connection& c = in.model.connections[i];
    const Vector3 f_W = Eigen::Map<const Vector3>(connections.f.data() + 3 * i);
    const auto pull = [&](int body, int other, const Vector3& p_BP, const Vector3& on_W) {
      const Vector3 a_W = leverOn(in, body, p_BP);
      const double moment = 0.5 * (a_W.dot(on_W) + a_W.norm() * on_W.norm());
      pulls_.push_back({body, other, a_W, on_W, moment});
    };
    pull(c.bodyA, c.bodyB, c.p_AP, f_W);
    pull(c.bodyB, c.bodyA, c.p_BP, -f_W);
  }
}

const SwingDamping::Pull* SwingDamping::beyond(const Model& model, std::size_t pull) const {
  const int bead = pulls_[pull].other;
  if (!model.isFree(bead)) return nullptr;
  const Pull* hardest = nullptr;
  for (const Pull& p : pulls_)
    if (p.other == bead && p.body != pulls_[pull].body &&
        (!hardest || p.f_W.squaredNorm() > hardest->f_W.squaredNorm()))
      hardest = &p;
  return hardest;
}

void SwingDamping::addRows(const Assembly& in, std::size_t i, const Swing& swing) {
  const Pull &pull = pulls_[i], &onOther = pulls_[i ^ 1];
  const auto levers = [&](const Pull& p) { return std::min(1.0, p.a_W.norm() / pull.a_W.norm()); };
  const double near = levers(onOther);
  const Pull* far = near < 1.0 ? beyond(in.model, i) : nullptr;
  if (!far) return addRows(in, pull, pull.other, swing.share, near * swing.drag);
  if (near > 0.0) addRows(in, pull, pull.other, near * swing.share, swing.drag);
  addRows(in, pull, far->body, (1.0 - near) * swing.share, levers(*far) * swing.drag);
}

void SwingDamping::addRows(const Assembly& in, const Pull& pull, int other, double share,
                           double drag) {
  const double dt = in.model.options.timestep;
  RelativeMotion motion;
  motion.bodyA = other;
  motion.bodyB = pull.body;
  motion.angularDim = 3;
  motion.angular = frameFromNormal(pull.a_W.normalized());
  jacobian_.add(in.model, in.kinematics, in.tree, motion);
  Offset turns{};
  turns.r = turns.bias = Vector3::Zero();
  turns.rate = motion.angular.transpose() *
               (in.kinematics.V[pull.body].angular - in.kinematics.V[other].angular);
  Softness softness;
  softness.R = 1.0 / (dt * dt * pull.moment * share);
  softness.damping = drag / dt;
  pushRows(motion, turns, softness);
  D[D.size() - 3] = 0.0;  // about the lever
}

}  // namespace softgauss
