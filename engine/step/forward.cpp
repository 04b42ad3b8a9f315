// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/forward.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {
namespace {

int firstNotFinite(const VectorX& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i])) return static_cast<int>(i);
  return -1;
}

bool hasRows(const Data& data) { return !kBuiltRows.empty() && !data.constraints.active().empty(); }

/// What islands without rows come to, and where others begin that are not near a guess.
struct SmoothStart {
  bool known = false;

  /// data.forward.start ← M⁻¹(τ − c).
  bool find(const Model& model, Data& data) {
    if (known) return true;
    copy(data.active.dofs(), data.forces.net, data.forward.start);
    return known = solveMass(model, data, nullptr, data.forward.start);
  }
};

/// Whether the solve is repeated, but not for this island: its prediction holds, and the guess is
/// what it has come to.
bool isHeld(const Model& model, const Data& data, int island) {
  if (!data.parts || !data.parts->repeats) return false;
  const auto missed = [&](const Segment& bodies) {
    for (int b = bodies.begin; b < bodies.end; ++b)
      if (data.parts->mispredicted[idx(model.bodies[idx(b)].tree)]) return true;
    return false;
  };
  return std::ranges::none_of(data.bodies.islands.bodies(island), missed);
}

/// One island: Newton's method from `guess` or, where that is far away, from the unconstrained
/// acceleration if it costs less.
NewtonReport solveIsland(const Model& model, const VectorX* guess, int island, SmoothStart& smooth,
                         Data& data) {
  /// A gradient at the guess that is no larger than the forces themselves: it is near.
  constexpr double kNear = 1.0;
  ForwardSolution& s = data.forward;
  BodyObjective objective(model, data, island);
  const int rows = objective.rowCount();
  // Without rows a guess is as good only where goals have found it.
  const bool warm = guess && (rows > 0 || data.inertia.whole);
  double residual = kInfinity, warmCost = kInfinity;
  if (warm) {
    warmCost = objective.moveTo(*guess);
    residual = objective.gradient(s.gradient);
  }
  // Converged already; found anew, its gradient may have gone up by rounding.
  if (warm && isHeld(model, data, island) && residual <= kRoundingFloor * model.options.tolerance)
    return {.residual = residual};
  if (!(residual <= (rows > 0 ? kNear : model.options.tolerance))) {
    if (!smooth.find(model, data)) return {.status = SolveStatus::notFinite};
    const double smoothCost = objective.moveTo(s.start);
    if (rows > 0 && warm && warmCost <= smoothCost) objective.moveTo(*guess);
    residual = objective.gradient(s.gradient);
  }
  return minimize(objective, model.options.tolerance,
                  mostIterations(model.options.maxIterations, rows), residual, s.gradient,
                  s.direction);
}

/// Of this solve, and not left to parts of their own: where goals tie trees to such as are, all of
/// the island are solved.
bool isSolved(const Model& model, const Data& data, int island) {
  const Segments bodies = data.bodies.islands.bodies(island);
  if (!data.active.holds(model, bodies.front().begin)) return false;
  if (!data.parts || !data.parts->leavesAny()) return true;
  for (const Segment s : bodies)
    for (int b = s.begin; b < s.end; ++b)
      if (!data.parts->leaves(b)) return true;
  return false;
}

/// Of the dofs of an island, whose solution is `a`: its rows are evaluated there, and
/// data.forward.gradient is known.
NewtonReport take(Segments dofs, const VectorX& a, Data& data) {
  copy(dofs, a, data.forward.a);
  setForceScale(dofs, data);
  return {.residual = largest(dofs, data.forward.gradient, data.forward.scale)};
}

bool isKnown(KnownTrees known, const Model& model, const Data& data, int island) {
  const int body = data.bodies.islands.bodies(island).front().begin;
  return !known.empty() && known[idx(model.bodies[idx(body)].tree)] != 0;
}

/// Of all trees of the solve.
bool areKnown(KnownTrees known, const Data& data) {
  if (known.empty() || (data.parts && data.parts->leavesAny())) return false;
  return std::ranges::all_of(data.active.trees(), [&](int t) { return known[idx(t)] != 0; });
}

void solveRows(const Model& model, const VectorX* guess, KnownTrees known, Data& data) {
  ForwardSolution& s = data.forward;
  const int selected = data.constraints.selected();
  data.bodies.divide(model, data.inertia, data.active, data.constraints);
  if (guess && !allFinite(data.active.dofs(), *guess)) guess = nullptr;
  SmoothStart smooth;
  for (int i = 0; i < data.bodies.islands.size() && !isRefused(s.report.status); ++i) {
    const Segments dofs = data.bodies.islands.dofs(i);
    if (!isSolved(model, data, i))
      for (const Segment of : dofs) part(s.a, of).setZero();
    else if (guess && isKnown(known, model, data, i))
      s.report.add(take(dofs, *guess, data));
    else
      s.report.add(solveIsland(model, guess, i, smooth, data));
  }
  data.constraints.select(selected);
  data.stats.roundingLimitedSolves += s.report.roundingLimited;
  if (s.report.status == SolveStatus::notFinite && data.stats.badDof < 0)
    data.stats.badDof = firstNotFinite(s.a);
}

/// Whether M̂ a = τ − c as closely as a search would have it.
bool solves(const Model& model, const VectorX& a, Data& data) {
  ForwardSolution& s = data.forward;
  const Segments dofs = data.active.dofs();
  data.inertia.hat().multiply(dofs, a, s.gradient);
  for (const Segment of : dofs) part(s.gradient, of) -= part(data.forces.net, of);
  setForceScale(dofs, data);
  return largest(dofs, s.gradient, s.scale) <= model.options.tolerance;
}

/// Without rows the minimiser is M⁻¹(τ − c): no iteration, no residual. Where M is a matrix, goals
/// have found it.
void solveSmooth(const Model& model, const VectorX* guess, KnownTrees known, Data& data) {
  ForwardSolution& s = data.forward;
  const Segments active = data.active.dofs();
  if (guess && data.inertia.whole && solves(model, *guess, data)) {
    copy(active, *guess, s.a);
    return;
  }
  copy(active, data.forces.net, s.a);
  const bool solved = solveMass(model, data, nullptr, s.a);
  for (const int t : data.active.trees()) {
    const Segment dofs{model.trees[idx(t)].firstDof, model.trees[idx(t)].dofEnd};
    if (guess && !known.empty() && known[idx(t)])
      s.report.add(take({&dofs, 1}, *guess, data));
    else
      part(s.gradient, dofs).setZero();
  }
  if (solved && allFinite(active, s.a)) return;
  s.report.status = SolveStatus::notFinite;
  if (solved) data.stats.badDof = firstNotFinite(s.a);
}

/// Whether there is something to solve for; else, what is wrong with the input is in the report.
bool begin(const Model& model, const VectorX* guess, Data& data) {
  ForwardSolution& s = data.forward;
  s.report = {};
  const Segments active = data.active.dofs();
  data.stats.invalidWarmStarts += guess && guess->size() == model.nv && !allFinite(active, *guess);
  if (model.nv == 0) return false;
  if (guess && guess->size() != model.nv) {
    data.stats.refuse(model, {BadInputKind::warmStart, -1, static_cast<double>(guess->size()),
                              static_cast<double>(model.nv)});
    s.report.status = data.stats.status;
    return false;
  }
  if (allFinite(active, data.forces.net)) return true;
  data.stats.badDof = firstNotFinite(data.forces.net);
  s.report.status = SolveStatus::notFinite;
  return false;
}

}  // namespace

int mostIterations(int option, int rows) {
  constexpr int kRows = 1000;
  return option * std::max(1, rows / kRows);
}

namespace {

/// y ← x over M̂ and `diagonal`, of the trees whose M̂ has nothing else.
bool divide(const Model& model, const VectorX* diagonal, const VectorX& x, VectorX& y, Data& data) {
  const TreeMatrix& M = data.inertia.hat();
  for (const int t : data.active.trees()) {
    if (!data.plan.diagonal[idx(t)]) continue;
    for (int i = model.trees[idx(t)].firstDof; i < model.trees[idx(t)].dofEnd; ++i) {
      const double pivot = M.row(i)[i] + (diagonal ? (*diagonal)[i] : 0.0);
      if (!(pivot > 0.0)) {
        data.stats.badDof = i;
        return false;
      }
      y[i] = x[i] / pivot;
    }
  }
  return true;
}

}  // namespace

bool solveMass(const Model& model, Data& data, const VectorX* diagonal, VectorX& x) {
  if (data.plan.allDiagonal) return divide(model, diagonal, x, x, data);
  BodySolution& s = data.bodies;
  if (data.plan.anyDiagonal && !divide(model, diagonal, x, s.divided, data)) return false;
  if (diagonal || !s.massFactored) {
    if (data.active.all())
      s.massFactor.begin(model, data.inertia);
    else
      s.massFactor.begin(model, data.inertia, data.active.bodies());
    for (int i = 0; diagonal && i < model.nv; ++i) s.massFactor.addJoint(i, (*diagonal)[i]);
    const bool factored = s.massFactor.factor(model, data.kinematics);
    s.massFactored = factored && !diagonal;
    if (!factored) {
      data.stats.badDof = s.massFactor.failedJoint();
      return false;
    }
  }
  s.massFactor.solve(model, data.kinematics, x, s.ray);
  // With the bits of a scene that has no other trees.
  if (data.plan.anyDiagonal)
    for (const int t : data.active.trees())
      if (data.plan.diagonal[idx(t)]) {
        const Segment dofs{model.trees[idx(t)].firstDof, model.trees[idx(t)].dofEnd};
        copy({&dofs, 1}, s.divided, x);
      }
  return true;
}

SolveStatus forwardDynamics(const Model& model, const VectorX* guess, Data& data,
                            KnownTrees known) noexcept {
  if (!begin(model, guess, data)) return data.forward.report.status;
  if (guess && areKnown(known, data)) {
    data.forward.report = take(data.active.dofs(), *guess, data);
  } else if (hasRows(data)) {
    solveRows(model, guess, known, data);
  } else {
    solveSmooth(model, guess, known, data);
  }
  return data.forward.report.status;
}

}  // namespace softgauss
