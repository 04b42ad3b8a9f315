// SPDX-License-Identifier: Apache-2.0
#include "gdd/goal_directed_step.hpp"

#include <chrono>

namespace softgauss::gdd {

GoalDirectedController::GoalDirectedController(const Model& model)
    : box(model),
      solver(model),
      expansion(model),
      control(VectorX::Zero(model.nv)),
      cost_(model.nv) {}

SolveStatus GoalDirectedController::step(const Model& model, const Input& input, State& state,
                                         Data& data, ContactSource* contacts) noexcept {
  using Clock = std::chrono::steady_clock;
  if (computeStages(model, input, state, data, contacts) == SolveStatus::notFinite)
    return SolveStatus::notFinite;

  // A disturbance is not the control's: it belongs to what the control has to cope with.
  const Clock::time_point start = Clock::now();
  data.forces.c -= data.forces.tau;
  cost_.clear();
  for (const auto& goal : goals)
    if (goal->actsAt(state.time)) goal->addCost({model, state, data}, cost_);
  report = expansion.solve(solver, model, cost_, box, data, state.warmstart);
  solveTime = std::chrono::duration<double>(Clock::now() - start).count();
  if (report.status == GddStatus::notFinite) {
    data.stats.status = SolveStatus::notFinite;
    data.stats.badDof = solver.badDof();
    return data.stats.status;
  }

  control = expansion.force().cwiseMax(box.lower).cwiseMin(box.upper);
  setAppliedForce(control, data.forces);
  const SolveStatus status = advance(model, &expansion.acceleration(), data, state);
  if (status != SolveStatus::notFinite) expansion.keepWarmStart(state.warmstart);
  return status;
}

}  // namespace softgauss::gdd
