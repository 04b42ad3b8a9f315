// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/pose_error.hpp"

#include <cmath>

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::app {

LinkPoses::LinkPoses(const Model& model) : model_(&model), kinematics_(model) {
  for (int i = 1; i < model.bodyCount(); ++i) {
    const Body& body = model.bodies[i];
    if (!(body.mass > 0.0)) continue;
    bodies_.push_back(i);
    rho_.push_back(std::sqrt(body.I_Bcm.matrix().trace() / (3.0 * body.mass)));
  }
  p_.resize(bodies_.size());
  R_.resize(bodies_.size());
}

void LinkPoses::set(const State& state) {
  computeKinematics(*model_, state, kinematics_);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Transform& X = kinematics_.X_WB[bodies_[i]];
    p_[i] = X * model_->bodies[bodies_[i]].com;
    R_[i] = X.R;
  }
}

PoseError LinkPoses::against(const LinkPoses& other) const {
  PoseError error;
  double total = 0.0, turned = 0.0;
  for (std::size_t i = 0; i < p_.size(); ++i) {
    // |sin| of small angles keeps its digits where the trace has lost them.
    const Matrix3 D = R_[i].transpose() * other.R_[i];
    const Vector3 axis(D(2, 1) - D(1, 2), D(0, 2) - D(2, 0), D(1, 0) - D(0, 1));
    const double angle = std::atan2(0.5 * axis.norm(), 0.5 * (D.trace() - 1.0));
    total += (p_[i] - other.p_[i]).squaredNorm() + std::pow(rho_[i] * angle, 2);
    turned += angle * angle;
  }
  const double count = static_cast<double>(p_.size());
  error.total = std::sqrt(total / count);
  error.orientation = std::sqrt(turned / count);
  return error;
}

}  // namespace softgauss::app
