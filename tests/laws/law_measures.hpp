// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the laws of soft constraints measure, the same for pyramids and elliptic cones.

#include <algorithm>

#include "softgauss/engine/dynamics/jacobian.hpp"
#include "softgauss/engine/step/inverse.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {

inline VectorX inverse(Scene& s, const VectorX& a) {
  VectorX tau(s.model.nv);
  inverseDynamics(s.model, a, *s.data, tau);
  return tau;
}

/// A residual of M a + c = τ + Jᵀf, in units of √M_ii, relative to the forces that cancel in it.
inline double relativeImbalance(const Scene& s, const VectorX& residual) {
  const MatrixX M = s.data->inertia.M.dense();
  const VectorX unit = M.diagonal().cwiseSqrt(), Ma = M * s.data->forward.a;
  const auto size = [&](const VectorX& force) {
    return force.cwiseQuotient(unit).cwiseAbs().maxCoeff();
  };
  return size(residual) / std::max({size(s.data->forces.net), size(Ma), 1.0});
}

/// The scene with M and forces of the bodies alone: damping and springs of now, not of the step's
/// end.
inline Scene inContinuousTime(Scene s) {
  s.model.options.integrator = Integrator::semiImplicitEuler;
  s.model.options.implicitInSolve = false;
  s.stages();
  return s;
}

/// By how much the inverse misses the applied force at the forward solution.
inline double inverseMiss(Scene& s) {
  return relativeImbalance(s, inverse(s, s.data->forward.a) - s.input.tau);
}

/// Sum of the contacts' forces at their points, and of their moments, on both bodies.
template <class ContactEffect>
VectorX forceOfContacts(const Scene& s, const ContactEffect& contact) {
  VectorX force = VectorX::Zero(s.model.nv);
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, s.model.nv);
  for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i) {
    const Contact& c = s.data->contacts.contacts[contact.contactsWithRows()[i].contact];
    pointJacobian(s.model, s.data->kinematics, c.bodyB, c.p_WC, J);
    force += J.transpose() * contact.force(i);
    pointJacobian(s.model, s.data->kinematics, c.bodyA, c.p_WC, J);
    force -= J.transpose() * contact.force(i);
    rotationJacobian(s.model, s.data->kinematics, c.bodyB, J);
    force += J.transpose() * contact.moment(i);
    rotationJacobian(s.model, s.data->kinematics, c.bodyA, J);
    force -= J.transpose() * contact.moment(i);
  }
  return force;
}

}  // namespace softgauss::test
