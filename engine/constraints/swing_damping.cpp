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

/// From the centre of mass of a body that is free by itself; nothing on others.
Vector3 leverOn(const Assembly& in, int body, const Vector3& p_BP) {
  if (!in.model.isFree(body)) return Vector3::Zero();
  return in.kinematics.X_WB[body].R * (p_BP - in.model.bodies[body].com);
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
    Swing& swing = swings_[model.bodies[p.body].tree];
    if (p.moment > 0.0) swing.K += p.moment * across(p.a_W);
    swing.force += p.f_W.norm();
    swing.sum += p.f_W;
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
  for (const Pull& p : pulls_) {
    const Swing& swing = swings_[model.bodies[p.body].tree];
    if (p.moment > 0.0 && swing.share > 0.0) addRows(in, p, swing);
  }
  resizeRows(reference.size());
  return held;
}

void SwingDamping::findPulls(const Assembly& in, const ConnectionRows& connections) {
  pulls_.clear();
  for (std::size_t i = 0; i < in.model.connections.size(); ++i) {
    const Connection& c = in.model.connections[i];
    const Vector3 f_W = Eigen::Map<const Vector3>(connections.f.data() + 3 * i);
    const Vector3 a_A = leverOn(in, c.bodyA, c.p_AP), a_B = leverOn(in, c.bodyB, c.p_BP);
    const auto pull = [&](int body, int other, const Vector3& a_W, const Vector3& b_W,
                          const Vector3& on_W) {
      if (!in.model.isFree(body)) return;
      const double a = a_W.norm(), moment = 0.5 * (a_W.dot(on_W) + a * on_W.norm());
      pulls_.push_back({body, other, a_W, on_W, moment, std::min(1.0, b_W.norm() / a)});
    };
    pull(c.bodyA, c.bodyB, a_A, a_B, f_W);
    pull(c.bodyB, c.bodyA, a_B, a_A, -f_W);
  }
}

void SwingDamping::addRows(const Assembly& in, const Pull& pull, const Swing& swing) {
  const double dt = in.model.options.timestep;
  RelativeMotion motion;
  motion.bodyA = pull.other;
  motion.bodyB = pull.body;
  motion.angularDim = 3;
  motion.angular = frameFromNormal(pull.a_W.normalized());
  jacobian_.add(in.model, in.kinematics, in.tree, motion);
  Offset turns{};
  turns.r = turns.bias = Vector3::Zero();
  turns.rate = motion.angular.transpose() *
               (in.kinematics.V[pull.body].angular - in.kinematics.V[pull.other].angular);
  Softness softness;
  softness.R = 1.0 / (dt * dt * pull.moment * swing.share);
  softness.damping = swing.drag * pull.levers / dt;
  pushRows(motion, turns, softness);
  D[D.size() - 3] = 0.0;  // about the lever
}

}  // namespace softgauss
