// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/jacobian.hpp"

namespace softgauss {
void pointJacobian(const Model& model, const Kinematics& k, int body, const Vector3& p_WP,
                   Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> J) {
  J.setZero();
  if (body == 0) return;
  const Vector3 r = p_WP - k.p_WO[model.bodies[body].tree];
  for (int i = model.lastDof(body); i >= 0; i = model.dofs[i].parent)
    J.col(i) = dofPointVelocity(k.S[i], r);
}

void rotationJacobian(const Model& model, const Kinematics& k, int body,
                      Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> J) {
  J.setZero();
  for (int i = model.lastDof(body); i >= 0; i = model.dofs[i].parent) J.col(i) = k.S[i].angular;
}

}  // namespace softgauss
