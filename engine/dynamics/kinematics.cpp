// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/kinematics.hpp"

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss {

Kinematics::Kinematics(const Model& model)
    : X_WB(model.bodies.size()),
      p_WO(model.trees.size(), Vector3::Zero()),
      S(model.dofs.size()),
      V(model.bodies.size()),
      A_bias(model.bodies.size()) {
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[b].parent == 0) X_WB[b] = model.bodies[b].X_PB;
}

namespace {

/// Free body: S = [translations | rotations about the body's own axes through its origin p = O].
void floatingJoint(const Body& body, const VectorX& q, int b, Kinematics& k) {
  Transform& X = k.X_WB[b];
  X.p = q.segment<3>(body.q);
  const Quaternion r(q[body.q + 3], q[body.q + 4], q[body.q + 5], q[body.q + 6]);
  X.R = r.normalized().toRotationMatrix();
  k.p_WO[body.tree] = X.p;
  for (int i = 0; i < 3; ++i) {
    k.S[body.v + i] = {Vector3::Zero(), Vector3::Unit(i)};
    k.S[body.v + 3 + i] = {X.R.col(i), Vector3::Zero()};
  }
}

/// Pose and axes of one body.
void pose(const Model& model, const VectorX& q, int b, Kinematics& k) {
  const Body& body = model.bodies[b];
  if (body.joint == JointKind::floating) {
    floatingJoint(body, q, b, k);
    return;
  }
  // Pose: the joint moves the body by q along or about its axis.
  const Transform& X_WP = k.X_WB[body.parent];
  Transform& X = k.X_WB[b];
  const double displacement = q[body.q];
  X.p.noalias() = X_WP.R * body.X_PB.p;
  X.p += X_WP.p;
  Matrix3 R_WJ;
  R_WJ.noalias() = X_WP.R * body.X_PB.R;
  Vector3 axis_W;
  axis_W.noalias() = R_WJ * body.axis;
  if (body.parent == 0) k.p_WO[body.tree] = X.p;
  const Vector3 r = X.p - k.p_WO[body.tree];

  Motion& S = k.S[body.v];
  if (body.joint == JointKind::revolute) {
    X.R.noalias() = R_WJ * axisRotation(body.axis, displacement);
    S = {axis_W, r.cross(axis_W)};
  } else {
    X.R = R_WJ;
    X.p += displacement * axis_W;
    S = {Vector3::Zero(), axis_W};
  }
}

}  // namespace

void computePoses(const Model& model, const VectorX& q, Segments bodies, Kinematics& k) {
  for (const Segment s : bodies)
    for (int b = s.begin; b < s.end; ++b) pose(model, q, b, k);
}

void computeKinematics(const Model& model, const State& state, Segments bodies, Kinematics& k) {
  computePoses(model, state.q, bodies, k);
  computeVelocities(model, k, state.v, bodies, k.V, k.A_bias);
  k.hasMidstep = false;
}

void setMidstepVelocity(const Model& model, const VectorX& v, Segments bodies, Kinematics& k) {
  k.V_midstep.resize(model.bodies.size());
  k.hasMidstep = true;
  computeVelocities(model, k, v, bodies, k.V_midstep, k.A_bias);
}

void computeVelocities(const Model& model, const Kinematics& k, const VectorX& v, Segments bodies,
                       std::vector<Motion>& V, std::vector<Motion>& A_bias) {
  for (const Segment s : bodies)
    for (int b = s.begin; b < s.end; ++b) {
      const Body& body = model.bodies[b];
      if (body.joint == JointKind::floating) {
        const Vector3 pdot = v.segment<3>(body.v);
        const Vector3 omega = k.X_WB[b].R * v.segment<3>(body.v + 3);
        V[b] = {omega, pdot};
        // Ṡ v: the rotation axes are carried along with the body's origin.
        A_bias[b] = {Vector3::Zero(), pdot.cross(omega)};
        continue;
      }
      // Ṡ = V_P × S, as S × S = 0.
      const Motion Sv = k.S[body.v] * v[body.v];
      V[b] = V[body.parent] + Sv;
      A_bias[b] = A_bias[body.parent] + cross(V[body.parent], Sv);
    }
}

namespace {

Vector3 pointAt(const Model& model, const Kinematics& k, const std::vector<Motion>& V, int body,
                const Vector3& p_WP) {
  if (body == 0) return Vector3::Zero();
  const Vector3 r = p_WP - k.p_WO[model.bodies[body].tree];
  return V[body].linear + V[body].angular.cross(r);
}

}  // namespace

Vector3 pointVelocity(const Model& model, const Kinematics& k, int body, const Vector3& p_WP) {
  return pointAt(model, k, k.V, body, p_WP);
}

Vector3 pointMidstepVelocity(const Model& model, const Kinematics& k, int body,
                             const Vector3& p_WP) {
  return pointAt(model, k, k.midstepVelocities(), body, p_WP);
}

MidstepPoint midstepPoint(const Model& model, const Kinematics& k, int body, const Vector3& p_WP) {
  if (body == 0) return {Vector3::Zero(), Vector3::Zero()};
  const Vector3 r = p_WP - k.p_WO[model.bodies[body].tree];
  const Motion& A = k.A_bias[body];
  const Motion& V = k.midstepVelocities()[body];
  const Vector3& omega = V.angular;
  const Vector3 v = V.linear + omega.cross(r);
  // Classical from spatial acceleration: a = A_lin + α × r + ω × v.
  return {v, A.linear + A.angular.cross(r) + omega.cross(v)};
}

Vector3 pointBiasAcceleration(const Model& model, const Kinematics& k, int body,
                              const Vector3& p_WP) {
  return midstepPoint(model, k, body, p_WP).bias;
}

}  // namespace softgauss
