// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/step.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/integrators/implicit_forces.hpp"
#include "softgauss/engine/step/integrators/implicit_midpoint.hpp"
#include "softgauss/engine/step/integrators/runge_kutta.hpp"
#include "softgauss/engine/step/integrators/single_solve.hpp"
#include "softgauss/engine/step/integrators/stages.hpp"
#include "softgauss/engine/step/integrators/step_doubling.hpp"
#include "softgauss/engine/step/integrators/tunnelling.hpp"
#include "softgauss/engine/step/integrators/velocity_derivative.hpp"
#include "softgauss/engine/step/realised.hpp"
#include "softgauss/engine/step/sleep.hpp"
#include "softgauss/engine/step/step_clock.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {
namespace {

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

/// What a step is given besides the state.
struct Given {
  const Input& input;
  ContactSource* contacts;
  StepControl* control;
  Sleepers* sleepers = nullptr;
};

/// Smooth forces and rows, of the velocity of turning that the state predicts.
void computeForces(const Model& model, const Input& input, const State& state, Data& data,
                   StepClock& clock) {
  if (data.plan.drifts) predictMidstepVelocity(model, state, data);
  computeSmoothForces(model, data.plan, state, input, data.kinematics, data.inertia, data.active,
                      data.forces);
  if (data.plan.inSolve) addImplicitForces(model, state, data);
  data.stats.times.kinematics += clock.lap();
}

/// When M and J are matrices: for goals, where the solve is not on bodies, or M is differentiated.
Columns columnsOf(const Model& model, const StepControl* control, const Data& data) {
  if (model.options.exactDiagonal || data.derivative) return Columns::now;
  if (!control) return Columns::never;
  return control->addsColumns() ? Columns::later : Columns::now;
}

void assembleRows(const Model& model, const Input& input, const State& state, Data& data,
                  StepClock& clock, Columns columns) {
  if (kBuiltRows.empty() || data.plan.rows.empty()) return;
  Assembly assembly{
      model, state, data.kinematics, data.contacts, data.weights, data.inertia.sparsity, &input};
  assembly.columns = columns;
  assembly.trees = &data.active;
  if (data.plan.drifts && predictsMidstepVelocity(model, state))
    assembly.midstepVelocity = &data.midstepVelocity;
  data.constraints.assemble(assembly);
  // What cannot be factored is found by the solve.
  if (model.options.exactDiagonal && !data.constraints.active().empty())
    data.exactDiagonal.apply(data.inertia.M, data.constraints);
  data.stats.rows = data.constraints.rowCount();
  data.stats.stabilisedBodies = data.constraints.geometricStiffness.heldBodies();
  data.stats.times.rows += clock.lap();
}

/// computeStages(); the clock's last lap ended with the last stage.
SolveStatus computeStages(const Model& model, const Input& input, const State& state, Data& data,
                          ContactSource* contacts, StepClock& clock,
                          Columns columns = Columns::now) noexcept {
  SOFTGAUSS_ASSERT(data.plan.fits(model));
  data.stats = {};
  data.bodies.tied.clear();
  if (data.parts) data.parts->begin();
  if (!isFinite(input, state, data.active)) {
    data.stats.status = SolveStatus::notFinite;
    data.stats.badDof = firstBadDof(model, input, state);
    return data.stats.status;
  }
  clock.lap();
  const TreeSelection& active = data.active;
  computeKinematics(model, state, active.bodies(), data.kinematics);
  computeMassMatrix(model, data.kinematics, active.bodies(), active.dofs(), data.inertia,
                    columns != Columns::never);
  if (data.plan.inSolve) addImplicitInertia(model, data);
  data.bodies.massFactored = false;
  computeForces(model, input, state, data, clock);

  if (looksForContacts(data, contacts)) {
    ++data.contacts.detections;
    if (active.all())
      contacts->detect(model, data.kinematics, data.contacts);
    else
      contacts->detectAmong(model, data.kinematics, active, data.contacts);
    data.stats.contacts = data.contacts.size();
    data.stats.pairsSkipped = data.contacts.pairsSkipped;
    for (const Contact& c : data.contacts.contacts)
      data.stats.maxPenetration = std::max(data.stats.maxPenetration, -c.distance);
    data.stats.times.collision = clock.lap();
  } else {
    data.contacts.clear();
  }
  assembleRows(model, input, state, data, clock, columns);
  return SolveStatus::converged;
}

/// (8) where goals choose the control, then (13): what moves under it. `aim`: the acceleration that
/// goals ask for.
SolveStatus solve(const Model& model, const Given& given, const State& state, Data& data,
                  const VectorX*& aim, StepClock& clock) noexcept {
  StepStats& stats = data.stats;
  const VectorX* guess = state.warmstart.valid ? &state.warmstart.a : nullptr;
  if (given.control) {  // (8)
    aim = guess = given.control->apply(model, state, data);
    if (!guess) return stats.status;
    clock.lap();
  }
  // (13), but for islands that take parts of their own
  stats.status =
      forwardDynamics(model, guess, data, given.control ? given.control->known() : KnownTrees{});
  stats.iterations += data.forward.report.iterations;
  stats.factorizations += data.forward.report.factorizations;
  stats.residual = std::max(stats.residual, data.forward.report.residual);
  stats.times.solve += clock.lap();
  if (isRefused(stats.status)) stats.badDof = worstDof(model, data, state);
  return stats.status;
}

/// (23), v and q of the step's end, by the integrator that is chosen. Converged where the state has
/// moved on. `start`: where the step began.
SolveStatus integrate(const Model& model, const Given& given, const State& start, Data& data,
                      State& state) noexcept {
  const auto moved = [](bool finite) {
    return finite ? SolveStatus::converged : SolveStatus::notFinite;
  };
  switch (model.options.integrator) {
    case Integrator::semiImplicitEuler:
    case Integrator::leapfrog:
    case Integrator::implicit:
      if (model.options.stepDoubling)
        return moved(stepDoubling(model, given.input, given.contacts, start, data, state));
      return moved(moveOnce(model, data, state));
    case Integrator::implicitMidpoint:
      return implicitMidpoint(model, given.input, given.contacts, data, state);
    case Integrator::rungeKutta4:
      return moved(rungeKutta(kRungeKutta4, model, given.input, given.contacts, data, state));
    case Integrator::dormandPrince:
      return moved(rungeKutta(kDormandPrince, model, given.input, given.contacts, data, state));
  }
  return SolveStatus::notFinite;
}

/// How often each mechanism has acted in what is now a step, or a part of one.
void countMechanisms(const Model& model, const State& start, Data& data) {
  MechanismCounts& acted = data.stats.acted;
  acted = data.constraints.acted();
  acted[Mechanism::midpointVelocity] = data.plan.drifts && predictsMidstepVelocity(model, start);
  acted[Mechanism::treeSubstepping] = data.stats.substeppedTrees;
  acted[Mechanism::geometricStiffness] = data.stats.stabilisedBodies;
}

/// The next solve starts from the last one's end.
void keepAcceleration(const Data& data, WarmStart& warmstart) {
  if (warmstart.a.size() != data.forward.a.size()) warmstart.a.setZero(data.forward.a.size());
  copy(data.active.dofs(), data.forward.a, warmstart.a);
  warmstart.valid = true;
}

/// `woken`: what is awake touches who sleeps; the step begins anew with them.
enum class Tried : std::uint8_t { taken, refused, unresolved, woken };

/// Whether the islands that need parts are left to them, in a step that is not a part itself.
bool leavesIslands(const Model& model, const Given& given, const State& state, Data& data) {
  SubstepWorkspace& p = *data.parts;
  const bool isPart = model.options.outerTimestep != 0.0;
  if (isPart || !p.islands || !p.islands->divide(model, given.control != nullptr, data))
    return false;
  copy(data.active.dofs(), state.a, p.predicted);
  p.predictedForces = state.connectionForces;
  return true;
}

/// A step, or a part of one, from `start`, which is the state: drift, stages, (8), (13), (23).
/// Where motion needs more than `most` parts of it (6.3) it ends before the solve.
Tried tryStep(const Model& model, const Given& given, const State& start, int most, State& state,
              Data& data) noexcept {
  StepClock clock(data);
  StepStats& stats = data.stats;
  const bool drifts = data.plan.drifts, resolves = drifts && !model.options.stepDoubling;
  const Segments dofs = data.active.dofs();
  if (drifts) driftBefore(model, data, state);
  const Columns columns = columnsOf(model, given.control, data);
  if (isRefused(computeStages(model, given.input, state, data, given.contacts, clock, columns)))
    return Tried::refused;
  if (given.sleepers && given.sleepers->touches(model, data.contacts)) return Tried::woken;
  const VectorX* aim = nullptr;
  for (bool again = false;; again = true) {
    if (resolves) {
      data.parts->substepSelection.find(model, state, given.control && given.control->acts(), data);
      if (data.parts->substepSelection.parts > most && !leavesIslands(model, given, state, data))
        return Tried::unresolved;
    }
    if (isRefused(solve(model, given, state, data, aim, clock))) {
      const bool wakes =
          given.sleepers && given.control && given.sleepers->mark(given.control->wanted());
      return wakes ? Tried::woken : Tried::refused;
    }
    if (!drifts || again || !predictionFailed(model, data, state)) break;
    ++stats.repeats;
    data.parts->repeats = true;
    stats.residual = 0.0;  // what was predicted by it does not move
    stats.roundingLimitedSolves = 0;
    keepAcceleration(data, state.warmstart);  // nearer than the last step's
    computeForces(model, given.input, state, data, clock);
    assembleRows(model, given.input, state, data, clock, columns);
  }
  SolveStatus moved = integrate(model, given, start, data, state);
  if (!isRefused(moved) && resolves && data.parts->substepSelection.anyFree) {
    SubstepWorkspace& p = *data.parts;
    const bool finite =
        p.treeSubstepping.integrate(model, p.substepSelection, start, data, state) &&
        allFinite(dofs, state.v) && allFinite(data.active.coordinates(), state.q);
    if (!finite) moved = SolveStatus::notFinite;
  }
  if (isRefused(moved)) {
    stats.status = moved;
    stats.badDof = worstDof(model, data, state);
    return Tried::refused;
  }
  for (const Segment s : drifts ? dofs : Segments{})
    part(data.parts->moved, s) = (part(state.v, s) - part(start.v, s)) / model.options.timestep;
  stats.realised = deviation(model, data, resolves, given.control,
                             drifts ? data.parts->moved : data.acceleration, aim);
  countMechanisms(model, start, data);
  stats.unconvergedSolves += stats.status != SolveStatus::converged;
  keepAcceleration(data, state.warmstart);
  if (given.control) given.control->keep(state.warmstart, data.active);
  stats.times.integrate = clock.lap();
  return Tried::taken;
}

/// The step in `parts` steps, each with its own control. A part that comes to need more than two
/// parts itself ends it, but for the shortest.
Tried stepInParts(const Model& model, const Given& given, int parts, State& state,
                  Data& data) noexcept {
  SubstepWorkspace& p = *data.parts;
  p.model.options = model.options;
  p.model.options.timestep = model.options.timestep / parts;
  p.model.options.outerTimestep = model.options.timestep;
  const int most = parts < SubstepSelection::kMaxDivisions ? 2 : SubstepSelection::kMaxDivisions;
  copyState(data.active, p.before, p.start);
  copy(data.active.dofs(), p.predicted, p.start.a);
  p.start.connectionForces = p.predictedForces;
  p.start.hasAcceleration = true;
  StepStats total;
  Tried tried = Tried::taken;
  for (int k = 0; k < parts && tried == Tried::taken; ++k) {
    copyState(data.active, p.start, state);
    p.model.options.nextTimestep = k + 1 == parts ? model.options.timestep : 0.0;
    tried = tryStep(p.model, given, p.start, most, state, data);
    total.add(data.stats);
    copyState(data.active, state, p.start);
  }
  total.contacts = data.stats.contacts;
  total.rows = data.stats.rows;
  data.stats = total;
  data.stats.parts = parts;
  data.stats.acted[Mechanism::substepping] = parts;
  data.stats.substeps += parts;
  for (const Segment s : data.active.dofs())
    part(data.acceleration, s) = (part(state.v, s) - part(p.before.v, s)) / model.options.timestep;
  state.time = p.before.time + model.options.timestep;
  return tried;
}

/// The step in as few parts as resolve it, at least those that the selection has found.
Tried stepInParts(const Model& model, const Given& given, State& state, Data& data) noexcept {
  Tried tried = Tried::unresolved;
  for (int parts = 1; tried == Tried::unresolved;) {
    parts = std::min(SubstepSelection::kMaxDivisions, parts * data.parts->substepSelection.parts);
    tried = stepInParts(model, given, parts, state, data);
  }
  return tried;
}

/// The step of every island that the others have left to its own parts.
Tried stepIslands(const Model& model, const Given& given, State& state, Data& data) noexcept {
  SubstepWorkspace& p = *data.parts;
  IslandSubsteps& islands = *p.islands;
  const Given alone{given.input, given.contacts, nullptr, given.sleepers};
  for (int island = 0; island < islands.islands(); ++island) {
    if (islands.parts(island) == 1) continue;
    islands.begin(model, island, data, p.before, p.predicted, p.predictedForces);
    const Tried tried = stepInParts(model, alone, islands.state, islands.data);
    islands.data.stats.contacts = islands.data.stats.rows = 0;  // the whole step's count
    data.stats.add(islands.data.stats);
    if (tried != Tried::taken) return tried;
    islands.finish(model, island, data, state);
  }
  return Tried::taken;
}

/// A step of the trees that are awake. Where it is not taken, the state has its start.
Tried takeStep(const Model& model, const Given& given, State& state, Data& data) noexcept {
  constexpr int kAny = SubstepSelection::kMaxDivisions;
  if (!data.plan.drifts) return tryStep(model, given, state, kAny, state, data);
  SubstepWorkspace& p = *data.parts;
  copyState(data.active, state, p.before);
  if (state.a.size() != model.nv) state.a.setZero(model.nv);  // somebody has put it together
  const int most = model.options.stepDoubling ? kAny : 1;
  Tried tried = tryStep(model, given, p.before, most, state, data);
  if (tried == Tried::unresolved) {
    copy(data.active.dofs(), state.a, p.predicted);
    p.predictedForces = state.connectionForces;
    tried = stepInParts(model, given, state, data);
  } else if (tried == Tried::taken && p.leavesAny()) {
    tried = stepIslands(model, given, state, data);
  }
  if (tried != Tried::taken) copyState(data.active, p.before, state);
  return tried;
}

/// Stages of all trees, whoever sleeps. False where they are refused.
bool beginStages(const Model& model, const Input& input, const State& state, Data& data) noexcept {
  if (data.sleepers) data.sleepers->forget(model, data);
  return !data.stats.refuse(model, findBadInput(model, input, state));
}

}  // namespace

SolveStatus computeStages(const Model& model, const Input& input, const State& state, Data& data,
                          ContactSource* contacts) noexcept {
  StepClock clock(data);
  if (!beginStages(model, input, state, data)) return data.stats.status;
  return computeStages(model, input, state, data, contacts, clock);
}

SolveStatus computeBodyStages(const Model& model, const Input& input, const State& state,
                              Data& data, ContactSource* contacts) noexcept {
  StepClock clock(data);
  if (!beginStages(model, input, state, data)) return data.stats.status;
  return computeStages(model, input, state, data, contacts, clock, columnsOf(model, nullptr, data));
}

SolveStatus step(const Model& model, const Input& input, State& state, Data& data,
                 ContactSource* contacts, StepControl* control) noexcept {
  Sleepers* const sleepers = data.sleepers.get();
  if (sleepers) sleepers->select(model, state, data);
  const auto refuse = [&](const BadInput& bad) { return data.stats.refuse(model, bad); };
  if (refuse(findBadInput(model, input, state, data.active.bodies()))) return data.stats.status;
  if (!sleepers) {
    takeStep(model, {input, contacts, control}, state, data);
    return data.stats.status;
  }
  const double began = state.time;
  bool refused = refuse(sleepers->begin(model, input, control, state, data, contacts));
  Tried tried = Tried::woken;
  while (!refused && tried == Tried::woken) {
    const bool chooses = !data.active.none();
    tried = takeStep(model, {input, contacts, chooses ? control : nullptr, sleepers}, state, data);
    if (tried == Tried::woken) refused = refuse(sleepers->wakeMarked(model, state, data, contacts));
  }
  if (tried == Tried::taken)
    sleepers->finish(model, input, control, began, state, data);
  else
    sleepers->undo(state);
  return data.stats.status;
}

}  // namespace softgauss
