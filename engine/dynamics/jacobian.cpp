// SPDX-License-Identifier: Apache-2.0
#include "engine/dynamics/jacobian.hpp"

namespace softgauss {
namespace {

/// Last dof that moves a body, −1 for the world.
int lastDof(const Model& model, int body) {
  const Body& b = model.bodies[body];
  return b.dofs > 0 ? b.v + b.dofs - 1 : -1;
}

}  // namespace

void pointJacobian(const Model& model, const Kinematics& k, int body, const Vector3& p_WP,
                   Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> J) {
  J.setZero();
  if (body == 0) return;
  const Vector3 r = p_WP - k.p_WO[model.bodies[body].tree];
  for (int i = lastDof(model, body); i >= 0; i = model.dofs[i].parent)
    J.col(i) = dofPointVelocity(k.S[i], r);
}

void rotationJacobian(const Model& model, const Kinematics& k, int body,
                      Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> J) {
  J.setZero();
  for (int i = lastDof(model, body); i >= 0; i = model.dofs[i].parent) J.col(i) = k.S[i].angular;
}

}  // namespace softgauss
