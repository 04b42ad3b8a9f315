// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/geometric_stiffness.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss {
namespace {

/// 1 − â âᵀ.
Matrix3 across(const Vector3& a) {
  return Matrix3::Identity() - a * a.transpose() / a.squaredNorm();
}

/// A point as seen from what the body turns about: its centre of mass, or its joint in a tree that
/// does not float; nothing where neither turns it.
Vector3 leverOn(const Assembly& in, int body, const Vector3& p_WP) {
  const Body& b = in.model.bodies[body];
  if (b.tree < 0) return Vector3::Zero();
  const Transform& X_WB = in.kinematics.X_WB[body];
  if (in.model.floats(b.tree)) return p_WP - X_WB * b.com;
  return b.joint == JointKind::revolute ? Vector3(p_WP - X_WB.p) : Vector3::Zero();
}

}  // namespace

void GeometricStiffness::assemble(const Assembly& in) {
  const Model& model = in.model;
  clearBlocks();
  heldBodies_ = 0;
  if (!in.state.connectionForces.isZero(0.0) && model.options.effects.has(Effect::equality)) {
    findConnectionForces(in);
    for (const Tree& tree : model.trees)
      if (in.takesPart(tree.rootBody) && model.floats(model.bodies[tree.rootBody].tree))
        for (int b = tree.rootBody; b < tree.bodyEnd; ++b) findShare(in, b);
    for (std::size_t i = 0; i < connectionForces_.size(); ++i) {
      const double share = bodyStiffness_[connectionForces_[i].body].share;
      if (share > 0.0 && connectionForces_[i].moment > 0.0)
        addRows(in, i, share, otherLoadRatio_[model.bodies[connectionForces_[i].body].tree]);
    }
  }
  resizeRows(reference.size());
}

void GeometricStiffness::findShare(const Assembly& in, int b) {
  constexpr double kFollowed = 0.5;  // h ω [rad]
  constexpr double kThrough = 0.2;   // of the forces: what counts as all
  const Body& body = in.model.bodies[b];
  BodyStiffness& stiffness = bodyStiffness_[b];
  Vector3 all = stiffness.sum;
  if (b == in.model.trees[body.tree].rootBody) {
    all = treeForce_[body.tree];
    // What touches it, or welds it, presses at once and not as a string does.
    if (stiffness.force > 0.0)
      otherLoadRatio_[body.tree] = (all - stiffness.sum).norm() / (kThrough * stiffness.force);
  }
  if (body.massless || stiffness.K.isZero(0.0)) return;
  const double through = std::min(1.0, (1.0 - all.norm() / stiffness.force) / kThrough);
  if (!(through > 0.0)) return;
  const Matrix3& R = in.kinematics.X_WB[b].R;
  const Matrix3 K = through * (R.transpose() * stiffness.K * R);
  const double turn =
      in.model.options.timestep * std::sqrt(0.5 * body.I_Bcm.matrix().ldlt().solve(K).trace());
  stiffness.share = through * (1.0 - kFollowed * kFollowed / (turn * turn));
  heldBodies_ += stiffness.share > 0.0;
}

void GeometricStiffness::findConnectionForces(const Assembly& in) {
  const Model& model = in.model;
  connectionForces_.clear();
  bodyStiffness_.assign(model.bodies.size(), {});
  otherLoadRatio_.assign(model.trees.size(), 0.0);
  treeForce_.assign(model.trees.size(), Vector3::Zero());
  const double* force = in.state.connectionForces.data();
  for (const Connection& c : model.connections) {
    if (!in.takesPart(c.bodyA, c.bodyB)) {
      force += 9;
      continue;
    }
    addConnectionForces(in, c.bodyA, c.bodyB, in.kinematics.X_WB[c.bodyA] * c.p_AP,
                        in.kinematics.X_WB[c.bodyB] * c.p_BP,
                        Vector3(force[0], force[1], force[2]));
    for (const int body : {c.bodyA, c.bodyB}) {
      force += 3;
      if (model.bodies[body].tree >= 0)
        treeForce_[model.bodies[body].tree] << force[0], force[1], force[2];
    }
    force += 3;
  }
  for (const Tree& tree : model.trees)
    if (in.takesPart(tree.rootBody) && model.floats(model.bodies[tree.rootBody].tree))
      addJointForces(in, tree);
}

void GeometricStiffness::addConnectionForces(const Assembly& in, int bodyA, int bodyB,
                                             const Vector3& p_WA, const Vector3& p_WB,
                                             const Vector3& f_W) {
  const auto pull = [&](int body, int other, const Vector3& p_W, const Vector3& on_W) {
    const Vector3 a_W = leverOn(in, body, p_W);
    const double moment = 0.5 * (a_W.dot(on_W) + a_W.norm() * on_W.norm());
    connectionForces_.push_back({body, other, a_W, on_W, moment});
    BodyStiffness& stiffness = bodyStiffness_[body];
    if (moment > 0.0) stiffness.K += moment * across(a_W);
    stiffness.force += on_W.norm();
    stiffness.sum += on_W;
  };
  pull(bodyA, bodyB, p_WA, f_W);
  pull(bodyB, bodyA, p_WB, -f_W);
}

void GeometricStiffness::addJointForces(const Assembly& in, const Tree& tree) {
  for (int b = tree.bodyEnd - 1; b > tree.rootBody; --b) {
    const Vector3 f_W = bodyStiffness_[b].sum;  // with what its children have passed on
    if (f_W.isZero(0.0)) continue;
    const Vector3 p_W = in.kinematics.X_WB[b].p;
    addConnectionForces(in, in.model.bodies[b].parent, b, p_W, p_W, f_W);
  }
}

const GeometricStiffness::ConnectionForce* GeometricStiffness::neighbourAcross(
    const Model& model, std::size_t pull) const {
  const int middle = connectionForces_[pull].other;
  if (!model.isFree(middle)) return nullptr;
  const ConnectionForce* hardest = nullptr;
  for (const ConnectionForce& p : connectionForces_)
    if (p.other == middle && p.body != connectionForces_[pull].body &&
        (!hardest || p.f_W.squaredNorm() > hardest->f_W.squaredNorm()))
      hardest = &p;
  return hardest;
}

void GeometricStiffness::addRows(const Assembly& in, std::size_t i, double share,
                                 double otherLoadRatio) {
  const ConnectionForce &pull = connectionForces_[i], &onOther = connectionForces_[i ^ 1];
  const auto leverRatio = [&](const ConnectionForce& p) {
    return std::min(1.0, p.a_W.norm() / pull.a_W.norm());
  };
  const double near = leverRatio(onOther);
  const ConnectionForce* far = near < 1.0 ? neighbourAcross(in.model, i) : nullptr;
  if (!far) return addRows(in, pull, pull.other, share, near, otherLoadRatio);
  if (near > 0.0) addRows(in, pull, pull.other, near * share, 1.0, otherLoadRatio);
  addRows(in, pull, far->body, (1.0 - near) * share, leverRatio(*far), otherLoadRatio);
}

void GeometricStiffness::addRows(const Assembly& in, const ConnectionForce& pull, int other,
                                 double share, double leverRatio, double otherLoadRatio) {
  constexpr double kStringDrag = 0.1;
  constexpr double kTurnsFar = 0.25;  // of one body against the other in a step [rad]
  const double dt = in.model.options.timestep;
  RelativeMotion motion;
  motion.bodyA = other;
  motion.bodyB = pull.body;
  motion.angularDim = 3;
  motion.angular = frameFromNormal(pull.a_W.normalized());
  jacobian_.add(in.model, in.kinematics, in.tree, motion, in.columns);
  Offset turns{};
  turns.r = turns.bias = Vector3::Zero();
  turns.rate = motion.angular.transpose() *
               (in.kinematics.V[pull.body].angular - in.kinematics.V[other].angular);
  const double turn = dt * turns.rate.tail<2>().norm() / kTurnsFar;
  const double drag = std::min(1.0, kStringDrag + std::pow(turn, 4) + otherLoadRatio);
  Softness softness;
  softness.R = 1.0 / (dt * dt * pull.moment * share);
  softness.damping = leverRatio * drag / dt;
  pushRows(turns, softness);
  D[D.size() - 3] = 0.0;  // about the lever
}

}  // namespace softgauss
