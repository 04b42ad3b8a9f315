// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/inverse_weight.hpp"

#include <Eigen/Cholesky>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/dynamics/regular_mass.hpp"

namespace softgauss {
namespace {

using Axes = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;
using OfJoint = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// A body and what hangs from it, in world axes about the body's own centre of mass, angular part
/// first: about one common point, a long chain would lose digits by the square of its length.
struct Articulated {
  Matrix6 X = Matrix6::Identity();  ///< motions about the parent's centre to those about this one
  Matrix6 inertia = Matrix6::Zero();
  Axes S, U;                           ///< axes of the joint, and articulated inertia times them
  OfJoint Dinv;                        ///< (Sᵀ U + armature)⁻¹
  Matrix6 mobility = Matrix6::Zero();  ///< acceleration of the body by a force on it
};

Matrix6 shift(const Vector3& r) {
  Matrix6 X = Matrix6::Identity();
  X.bottomLeftCorner<3, 3>() = -skew(r);
  return X;
}

Matrix6 ownInertia(const Body& body, const Matrix3& R) {
  Matrix6 I = Matrix6::Zero();
  if (body.massless) return I;
  I.topLeftCorner<3, 3>() = rotated(R, body.I_Bcm).matrix();
  I.bottomRightCorner<3, 3>().diagonal().setConstant(body.mass);
  return I;
}

/// From the leaves to the roots: articulated inertias (Featherstone 2008, section 7.3).
std::vector<Articulated> articulate(const Model& model, const Kinematics& k) {
  const bool armature = model.options.effects.has(Effect::armature);
  const auto center = [&](int b) { return Vector3(k.X_WB[b] * model.bodies[b].com); };
  std::vector<Articulated> all(model.bodies.size());
  for (int b = model.bodyCount() - 1; b > 0; --b) {
    const Body& body = model.bodies[b];
    Articulated& own = all[b];
    const Vector3 c = center(b), r = c - k.p_WO[body.tree];
    own.S.resize(6, body.dofs);
    for (int i = 0; i < body.dofs; ++i) {
      const Motion& axis = k.S[body.v + i];
      own.S.col(i) << axis.angular, axis.linear + axis.angular.cross(r);
    }
    own.inertia += ownInertia(body, k.X_WB[b].R);
    own.U = own.inertia * own.S;
    OfJoint D = own.S.transpose() * own.U;
    if (armature)
      for (int i = 0; i < body.dofs; ++i) D(i, i) += model.dofs[body.v + i].armature;
    own.Dinv = D.llt().solve(OfJoint::Identity(body.dofs, body.dofs));
    if (body.parent == 0) continue;
    own.X = shift(c - center(body.parent));
    const Matrix6 left = own.inertia - own.U * own.Dinv * own.U.transpose();
    all[body.parent].inertia += own.X.transpose() * left * own.X;
  }
  return all;
}

/// Mean mobility of a point p of a body over the three translations.
double translationAt(const Body& body, const Matrix3& R_WB, const Matrix6& mobility,
                     const Vector3& p_B) {
  const Matrix6 X = shift(R_WB * (p_B - body.com));
  return (X * mobility * X.transpose()).bottomRightCorner<3, 3>().trace() / 3.0;
}

}  // namespace

InverseWeights::InverseWeights(const Model& model)
    : translation(model.bodies.size(), 0.0),
      rotation(model.bodies.size(), 0.0),
      dof(model.dofs.size(), 0.0),
      connection(model.connections.size(), 0.0),
      weld(model.welds.size(), 0.0) {
  if (model.nv == 0) return;
  State state(model);
  for (const Body& body : model.bodies)
    if (body.dofs == 1) state.q[body.q] = body.reference;
  Kinematics k(model);
  MassMatrix inertia(model);
  computeKinematics(model, state, k);
  computeMassMatrix(model, k, inertia);
  TreeFactor factor;
  if (singularDof(inertia.M, factor) >= 0) {
    if (const std::optional<SingularMass> why = findSingularMass(model, model.q0))
      throw ModelError({}, why->element, why->problem);
    state = State(model);
    computeKinematics(model, state, k);
    computeMassMatrix(model, k, inertia);
    factor.compute(inertia.M);
  }

  // From the roots to the leaves: a force on a body moves its joint, and by what the joint passes
  // on, its parent. Linear in the number of bodies, where J M⁻¹ Jᵀ is cubic.
  std::vector<Articulated> all = articulate(model, k);
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    Articulated& own = all[b];
    const Matrix6 parent = own.X * all[body.parent].mobility * own.X.transpose();
    const Matrix6 passed = Matrix6::Identity() - own.S * own.Dinv * own.U.transpose();
    own.mobility = own.S * own.Dinv * own.S.transpose() + passed * parent * passed.transpose();
    rotation[b] = own.mobility.topLeftCorner<3, 3>().trace() / 3.0;
    translation[b] = own.mobility.bottomRightCorner<3, 3>().trace() / 3.0;

    const Axes onParent = own.U * own.Dinv;
    const OfJoint weights = own.Dinv + onParent.transpose() * parent * onParent;
    for (int i = 0; i < body.dofs; ++i) dof[body.v + i] = weights(i, i);
    if (body.joint != JointKind::floating) continue;
    for (const int first : {0, 3}) {
      const double mean = weights.diagonal().segment<3>(first).mean();
      for (int i = first; i < first + 3; ++i) dof[body.v + i] = mean;
    }
  }
  const auto ofTies = [&](const auto& ties, std::vector<double>& sums) {
    for (std::size_t i = 0; i < ties.size(); ++i)
      for (const auto& [b, p] : {std::pair(ties[i].bodyA, ties[i].centers.inA),
                                 std::pair(ties[i].bodyB, ties[i].centers.inB)})
        if (b != 0) sums[i] += translationAt(model.bodies[b], k.X_WB[b].R, all[b].mobility, p);
  };
  ofTies(model.connections, connection);
  ofTies(model.welds, weld);
}

}  // namespace softgauss
