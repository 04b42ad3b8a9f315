// SPDX-License-Identifier: Apache-2.0
#include "engine/step/step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/step/forward.hpp"
#include "engine/step/integrators/implicit_forces.hpp"
#include "engine/step/integrators/implicit_midpoint.hpp"
#include "engine/step/integrators/runge_kutta.hpp"
#include "engine/step/integrators/sight.hpp"
#include "engine/step/integrators/single_solve.hpp"
#include "engine/step/integrators/stages.hpp"
#include "engine/step/integrators/step_doubling.hpp"
#include "engine/step/integrators/velocity_derivative.hpp"

namespace softgauss {
namespace {

using Clock = std::chrono::steady_clock;

/// Seconds since `last`, which becomes now.
double lap(Clock::time_point& last) {
  const Clock::time_point now = Clock::now();
  const double seconds = std::chrono::duration<double>(now - last).count();
  last = now;
  return seconds;
}

bool finite(const Model& model, const Input& input, const State& state) {
  if (state.q.size() != model.nq || state.v.size() != model.nv) return false;
  if (input.tau.size() != 0 && input.tau.size() != model.nv) return false;
  if (!state.q.allFinite() || !state.v.allFinite() || !input.tau.allFinite()) return false;
  return std::all_of(input.wrenches.begin(), input.wrenches.end(), [&](const ExternalWrench& w) {
    return w.body >= 0 && w.body < model.bodyCount() && w.F_Bo_W.force.allFinite() &&
           w.F_Bo_W.moment.allFinite();
  });
}

/// The first dof whose position, velocity or applied force is not finite, −1 if none is.
int firstBadDof(const Model& model, const Input& input, const State& state) {
  for (const Body& body : model.bodies) {
    const int coordinates = body.dofs == 6 ? 7 : body.dofs;
    const bool bad =
        (state.q.size() == model.nq && !state.q.segment(body.q, coordinates).allFinite()) ||
        (state.v.size() == model.nv && !state.v.segment(body.v, body.dofs).allFinite()) ||
        (input.tau.size() == model.nv && !input.tau.segment(body.v, body.dofs).allFinite());
    if (bad) return body.v;
  }
  return -1;
}

/// Where a step that failed went wrong: the dof of the first force that is not finite, or else of
/// what is largest.
int worstDof(const Model& model, const Data& data, const State& state) {
  int worst = -1;
  double largest = 0.0;
  for (int i = 0; i < model.nv; ++i) {
    const double net = data.forces.net[i];
    if (!std::isfinite(net)) return i;
    const double size = std::max(std::abs(state.v[i]), model.options.timestep * std::abs(net));
    if (size > largest) largest = size, worst = i;
  }
  return worst;
}

}  // namespace

Data::~Data() = default;

Data::Data(const Model& model) : Data(model, Evaluation{}) {
  if (model.options.looksWithin()) stages = std::make_unique<IntegratorStages>(model);
}

Data::Data(const Model& model, Evaluation)
    : plan(model),
      weights(model),
      kinematics(model),
      inertia(model),
      forces(model, plan),
      constraints(plan.rows),
      exactDiagonal(model.options.exactDiagonal ? model.nv : 0),
      followed(plan.midpoint ? FollowedTrees(model) : FollowedTrees()),
      midStep(plan.midpoint && !plan.rows.empty() ? MidStep(model) : MidStep()),
      acceleration(VectorX::Zero(model.nv)),
      derivative(isImplicit(model.options.integrator) ? std::make_unique<VelocityDerivative>(model)
                                                      : nullptr) {
  ForwardSolution& s = forward;
  for (VectorX* x : {&s.a, &s.Ma, &s.gradient, &s.direction, &s.Md, &s.scale, &s.start})
    *x = VectorX::Zero(model.nv);
  // Rows exist before the first step, so that stages may be read in any state.
  constraints.assemble({model, State(model), kinematics, contacts, weights, inertia.sparsity});
}

namespace {

/// computeStages(); `clock` is when the last stage ended. A clock is read only after what has run.
SolveStatus computeStages(const Model& model, const Input& input, const State& state, Data& data,
                          ContactSource* contacts, Clock::time_point& clock,
                          bool posed = false) noexcept {
  SOFTGAUSS_ASSERT(data.plan.fits(model));
  data.stats = {};
  if (!finite(model, input, state)) {
    data.stats.status = SolveStatus::notFinite;
    data.stats.badDof = firstBadDof(model, input, state);
    return data.stats.status;
  }
  clock = Clock::now();
  if (!posed) computeKinematics(model, state, data.kinematics);
  computeMassMatrix(model, data.kinematics, data.inertia);
  computeSmoothForces(model, data.plan, state, input, data.kinematics, data.inertia, data.forces);
  if (data.plan.inSolve) putInSolve(model, state, data);
  data.stats.times.kinematics = lap(clock);

  if (looksForContacts(data, contacts)) {
    ++data.contacts.detections;
    contacts->detect(model, data.kinematics, data.contacts);
    data.stats.contacts = data.contacts.size();
    data.stats.pairsSkipped = data.contacts.pairsSkipped;
    for (const Contact& c : data.contacts.contacts)
      data.stats.maxPenetration = std::max(data.stats.maxPenetration, -c.distance);
    data.stats.times.collision = lap(clock);
  } else {
    data.contacts.clear();
  }

  if (!kBuiltRows.empty() && !data.plan.rows.empty()) {
    data.constraints.assemble({model, state, data.kinematics, data.contacts, data.weights,
                               data.inertia.sparsity, input.softFriction});
    // A mass matrix that cannot be factored is found, and reported, by the solve.
    if (model.options.exactDiagonal && !data.constraints.active().empty())
      data.exactDiagonal.apply(data.inertia.M, data.constraints);
    if (model.options.noSlip) data.sticking.clear();
    data.stats.rows = data.constraints.rowCount();
    data.stats.times.rows = lap(clock);
  }
  return SolveStatus::converged;
}

/// What became of the state; converged where it has moved on.
SolveStatus integrate(const Model& model, const Input& held, ContactSource* contacts, Data& data,
                      State& state) noexcept {
  const auto moved = [](bool finite) {
    return finite ? SolveStatus::converged : SolveStatus::notFinite;
  };
  switch (model.options.integrator) {
    case Integrator::semiImplicitEuler:
    case Integrator::implicit:
      if (model.options.stepDoubling)
        return moved(stepDoubling(model, held, contacts, data, state));
      return moved(moveOnce(model, data, state));
    case Integrator::implicitMidpoint:
      return implicitMidpoint(model, held, contacts, data, state);
    case Integrator::rungeKutta4:
      return moved(rungeKutta(kRungeKutta4, model, held, contacts, data, state));
    case Integrator::dormandPrince:
      return moved(rungeKutta(kDormandPrince, model, held, contacts, data, state));
  }
  return SolveStatus::notFinite;
}

SolveStatus advance(const Model& model, const Input& held, ContactSource* contacts,
                    const VectorX* guess, Data& data, State& state,
                    Clock::time_point& clock) noexcept {
  StepStats& stats = data.stats;
  stats.status = forwardDynamics(model, guess, data);
  stats.iterations = data.forward.report.iterations;
  stats.factorizations = data.forward.report.factorizations;
  stats.residual = data.forward.report.residual;
  stats.times.solve = lap(clock);
  if (!isRefused(stats.status)) {
    const SolveStatus moved = integrate(model, held, contacts, data, state);
    if (isRefused(moved)) stats.status = moved;
  }
  if (isRefused(stats.status)) {
    stats.badDof = worstDof(model, data, state);
    return stats.status;
  }
  stats.realised = deviation(data.acceleration, data.forward.a);
  stats.shortSolves += stats.status != SolveStatus::converged;
  state.warmstart.a = data.forward.a;
  state.warmstart.valid = true;
  stats.times.integrate = lap(clock);
  return stats.status;
}

}  // namespace

SolveStatus computeStages(const Model& model, const Input& input, const State& state, Data& data,
                          ContactSource* contacts) noexcept {
  Clock::time_point clock;
  return computeStages(model, input, state, data, contacts, clock);
}

SolveStatus computeStagesAt(const Model& model, const Input& input, const State& state, Data& data,
                            ContactSource* contacts) noexcept {
  Clock::time_point clock;
  return computeStages(model, input, state, data, contacts, clock, true);
}

double deviation(const VectorX& realised, const VectorX& solved) noexcept {
  if (solved.size() == 0) return 0.0;
  return (realised - solved).cwiseAbs().maxCoeff() / std::max(solved.cwiseAbs().maxCoeff(), 1.0);
}

SolveStatus advance(const Model& model, const Input& held, ContactSource* contacts,
                    const VectorX* guess, Data& data, State& state) noexcept {
  Clock::time_point clock = Clock::now();
  return advance(model, held, contacts, guess, data, state, clock);
}

SolveStatus step(const Model& model, const Input& input, State& state, Data& data,
                 ContactSource* contacts) noexcept {
  Clock::time_point clock;
  if (computeStages(model, input, state, data, contacts, clock) == SolveStatus::notFinite)
    return SolveStatus::notFinite;
  return advance(model, input, contacts, state.warmstart.valid ? &state.warmstart.a : nullptr, data,
                 state, clock);
}

}  // namespace softgauss
