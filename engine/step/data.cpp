// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/data.hpp"

#include <algorithm>

#include "softgauss/engine/step/integrators/stages.hpp"
#include "softgauss/engine/step/integrators/velocity_derivative.hpp"
#include "softgauss/engine/step/sleep.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {

Data::~Data() = default;

Data::Data(const Model& model) : Data(model, Evaluation{}) {
  if (model.options.sleep.enabled) sleepers = std::make_unique<Sleepers>(model);
  if (model.options.isMultiStage()) stages = std::make_unique<IntegratorStages>(model);
  if (!plan.drifts) return;
  parts = std::make_unique<SubstepWorkspace>(model);
  const Options& options = model.options;
  const bool divides = plan.coriolis && options.uses(Mechanism::substepping) &&
                       !options.stepDoubling && !options.exactDiagonal;
  if (divides && model.trees.size() > 1) parts->islands = std::make_unique<IslandSubsteps>(model);
}

Data::Data(const Model& model, Evaluation)
    : plan(model),
      active(model),
      weights(model),
      kinematics(model),
      inertia(model),
      forces(model, plan),
      constraints(plan.rows),
      exactDiagonal(model.options.exactDiagonal ? model.nv : 0),
      bodies(model),
      midstepVelocity(VectorX::Zero(plan.drifts ? model.nv : 0)),
      acceleration(VectorX::Zero(model.nv)),
      derivative(isImplicit(model.options.integrator) ? std::make_unique<VelocityDerivative>(model)
                                                      : nullptr) {
  ForwardSolution& s = forward;
  for (VectorX* x : {&s.a, &s.gradient, &s.direction, &s.diagonal, &s.scale, &s.start})
    *x = VectorX::Zero(model.nv);
  // Rows exist before the first step, so that stages may be read in any state.
  constraints.assemble({model, State(model), kinematics, contacts, weights, inertia.sparsity});
}

bool StepStats::refuse(const Model& model, const BadInput& bad) {
  if (!bad) return false;
  *this = {};
  status = SolveStatus::badInput;
  badInput = bad;
  if (bad.kind == BadInputKind::quaternion) badDof = model.bodies[bad.index].v;
  if (bad.kind == BadInputKind::controlLimits) badDof = bad.index;
  return true;
}

void StepStats::add(const StepStats& other) {
  status = std::max(status, other.status);
  residual = std::max(residual, other.residual);
  realised = std::max(realised, other.realised);
  maxPenetration = std::max(maxPenetration, other.maxPenetration);
  pairsSkipped += other.pairsSkipped;
  parts = std::max(parts, other.parts);
  for (int StepStats::*count :
       {&StepStats::contacts, &StepStats::rows, &StepStats::iterations, &StepStats::factorizations,
        &StepStats::substeppedTrees, &StepStats::abandonedTrees, &StepStats::stabilisedBodies,
        &StepStats::substeps, &StepStats::repeats, &StepStats::evaluations, &StepStats::rejections,
        &StepStats::minimumStepsAccepted, &StepStats::tunnellingSplits,
        &StepStats::unconvergedSolves, &StepStats::roundingLimitedSolves,
        &StepStats::invalidWarmStarts, &StepStats::possibleTunnelling})
    this->*count += other.*count;
  acted.add(other.acted);
  badDof = std::max(badDof, other.badDof);
  if (other.badInput) badInput = other.badInput;
  for (double StepTimes::*time : {&StepTimes::kinematics, &StepTimes::collision, &StepTimes::rows,
                                  &StepTimes::solve, &StepTimes::integrate})
    times.*time += other.times.*time;
}

}  // namespace softgauss
