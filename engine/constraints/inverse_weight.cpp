// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/inverse_weight.hpp"

#include "engine/dynamics/inertia.hpp"
#include "engine/dynamics/jacobian.hpp"

namespace softgauss {

InverseWeights::InverseWeights(const Model& model)
    : translation(model.bodies.size(), 0.0),
      rotation(model.bodies.size(), 0.0),
      dof(model.dofs.size(), 0.0) {
  if (model.nv == 0) return;
  State state(model);
  for (const Body& body : model.bodies)
    if (body.dofs == 1) state.q[body.q] = 0.0;
  Kinematics k(model);
  MassMatrix inertia(model);
  computeKinematics(model, state, k);
  computeMassMatrix(model, k, inertia);
  TreeFactor factor;
  if (!factor.compute(inertia.M))
    throw ModelError({}, "joint '" + model.jointNames[model.dofs[factor.failedRow()].body] + "'",
                     "the mass matrix is singular where all joints are at zero; this joint moves "
                     "nothing that resists it, or its numbers overflow");

  VectorX column(model.nv);
  for (int i = 0; i < model.nv; ++i) {
    column.setZero();
    column[i] = 1.0;
    factor.solve(column);
    dof[i] = column[i];
  }
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, model.nv);
  const auto meanDiagonal = [&] {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const VectorX row = J.row(axis).transpose();
      column = row;
      factor.solve(column);
      sum += row.dot(column);
    }
    return sum / 3.0;
  };
  for (int b = 1; b < model.bodyCount(); ++b) {
    pointJacobian(model, k, b, k.X_WB[b] * model.bodies[b].com, J);
    translation[b] = meanDiagonal();
    rotationJacobian(model, k, b, J);
    rotation[b] = meanDiagonal();
    if (model.bodies[b].joint == JointKind::floating) {
      const int v = model.bodies[b].v;
      for (const int first : {v, v + 3}) {
        const double mean = (dof[first] + dof[first + 1] + dof[first + 2]) / 3.0;
        dof[first] = dof[first + 1] = dof[first + 2] = mean;
      }
    }
  }
}

}  // namespace softgauss
