// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/inverse_derivative.hpp"

#include <functional>

#include "softgauss/engine/forces/external_wrench_derivative.hpp"
#include "softgauss/engine/forces/gravity_compensation.hpp"
#include "softgauss/engine/step/integrators/implicit_forces.hpp"
#include "softgauss/engine/step/integrators/leapfrog.hpp"
#include "softgauss/engine/step/inverse.hpp"

namespace softgauss {

InverseDerivative::InverseDerivative(const Model& model)
    : tree_(model),
      scalars_(model),
      contacts_(model),
      pairs_(model),
      differences_(model, Plan(model).rows),
      q_(MatrixX::Zero(model.nv, model.nv)),
      v_(MatrixX::Zero(model.nv, model.nv)),
      tau_(VectorX::Zero(model.nv)) {}

void InverseDerivative::addSmooth(const Model& model, const Input& input, const VectorX& a,
                                  const Data& data) {
  tree_.addTo(model, data.kinematics, data.inertia, a, q_, v_);
  if (data.plan.hasDamping()) v_.diagonal() += data.plan.damping;
  if (data.plan.hasSprings()) {
    for (const Plan::Spring& s : data.plan.springs) {
      q_(s.dof, s.dof) += s.stiffness;
      if (data.plan.inSolve && isStiffSpring(model, data, s))
        v_(s.dof, s.dof) += model.options.timestep * s.stiffness;
    }
  }
  if (data.plan.bearsWeight) addGravityCompensationDerivative(model, data.kinematics, q_);
  if (data.plan.hasExternalWrench())
    for (const ExternalWrench& wrench : input.wrenches)
      addExternalWrenchDerivative(model, data.kinematics, wrench, q_);
}

SolveStatus InverseDerivative::compute(const Model& model, const Input& input, const State& state,
                                       const VectorX& a, ContactSource* contacts, Data& data) {
  const SolveStatus status = inverseDynamics(model, a, data, tau_);
  if (isRefused(status)) return status;
  inverseDynamicsJacobian(data, P_);
  q_.setZero();
  v_.setZero();
  addSmooth(model, input, a, data);
  if (data.constraints.active().empty()) return status;
  Assembly in{model, state, data.kinematics, data.contacts, data.weights, data.inertia.sparsity,
              &input};
  if (data.plan.drifts && predictsMidstepVelocity(model, state))
    in.midstepVelocity = &data.midstepVelocity;
  if (model.options.uses(Mechanism::supportedMass)) {
    load_.assemble(model, data.kinematics, data.contacts, data.weights);
    in.load = &load_;
  }
  scalars_.addTo(in, data.constraints, data.inertia, q_, v_);
  bool begun = false;
  const auto measure = [&](int contact) -> ContactShift::Measured {
    if (!contacts) return ContactShift::Measured::Zero();
    if (!begun) pairs_.begin(data.kinematics);
    begun = true;
    return pairs_.of(model, data.contacts, contact, *contacts);
  };
  contacts_.addTo(in, data.constraints, a, std::cref(measure), q_, v_);
  differences_.addTo(in, a, q_, v_);
  return status;
}

}  // namespace softgauss
