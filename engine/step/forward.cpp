// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/forward.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/step/gauss_objective.hpp"
#include "softgauss/engine/step/no_slip.hpp"

namespace softgauss {
namespace {

int firstNotFinite(const VectorX& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i])) return static_cast<int>(i);
  return -1;
}

/// Without rows the minimiser is M⁻¹(τ − c): no iteration, no residual. False where M is singular.
bool solveSmooth(Data& data) {
  ForwardSolution& s = data.forward;
  s.Ma = s.a = data.forces.net;
  s.gradient.setZero();
  if (!solveMass(data, nullptr, s.a)) return false;
  if (!s.a.allFinite()) s.report.status = SolveStatus::notFinite;
  return true;
}

}  // namespace

int mostIterations(int option, int rows) {
  constexpr int kRows = 1000;
  return option * std::max(1, rows / kRows);
}

bool solveMass(Data& data, const VectorX* diagonal, VectorX& x) {
  ForwardSolution& s = data.forward;
  const TreeMatrix& M = data.inertia.hat();
  if (data.plan.diagonal) {
    for (int i = 0; i < M.size(); ++i) {
      const double pivot = M.row(i)[i] + (diagonal ? (*diagonal)[i] : 0.0);
      if (!(pivot > 0.0)) {
        data.stats.badDof = i;
        return false;
      }
      x[i] /= pivot;
    }
    return true;
  }
  if (diagonal || !s.massFactored) {
    s.massFactored = !diagonal;
    if (!s.massFactor.compute(M, diagonal ? diagonal->data() : nullptr)) {
      s.massFactored = false;
      data.stats.badDof = s.massFactor.failedRow();
      return false;
    }
  }
  s.massFactor.solve(x);
  return true;
}

SolveStatus minimizeGauss(const Model& model, const VectorX* guess, Data& data) noexcept {
  ForwardSolution& s = data.forward;
  s.report = {};
  s.cellFactored = false;
  data.stats.invalidWarmStarts += guess && !guess->allFinite();
  if (model.nv == 0) return SolveStatus::converged;
  if (guess && guess->size() != model.nv) {
    data.stats.refuse(model, {BadInputKind::warmStart, -1, static_cast<double>(guess->size()),
                              static_cast<double>(model.nv)});
    return s.report.status = data.stats.status;
  }
  const auto notFinite = [&] {
    data.stats.badDof = firstNotFinite(data.forces.net);
    s.report.status = SolveStatus::notFinite;
    return s.report.status;
  };
  const auto notPositive = [&] {  // solveMass() has named the dof
    s.report.status = SolveStatus::notFinite;
    return s.report.status;
  };
  const auto finish = [&] {
    data.stats.roundingLimitedSolves += s.report.roundingLimited;
    if (s.report.status == SolveStatus::notFinite) data.stats.badDof = firstNotFinite(s.a);
    return s.report.status;
  };
  if (!data.forces.net.allFinite()) return notFinite();

  if (kBuiltRows.empty() || data.constraints.active().empty()) {
    if (!solveSmooth(data)) return notPositive();
    return finish();
  }

  GaussObjective objective(data.inertia, data.forces.net, data.constraints, s);
  // A warm start that solves the problem already (after GDD, at rest) ends it here.
  const bool warm = data.constraints.rowCount() > 0 && guess && guess->allFinite();
  double warmCost = kInfinity;
  if (warm) {
    warmCost = objective.moveTo(*guess);
    s.report.residual = objective.gradient(s.gradient);
    if (s.report.residual <= model.options.tolerance) return finish();
  }
  // Without rows the minimiser is M⁻¹(τ − c).
  if (!s.massFactored && !s.massFactor.compute(data.inertia.hat())) {
    data.stats.badDof = s.massFactor.failedRow();
    return notPositive();
  }
  s.massFactored = true;
  s.start = data.forces.net;
  s.massFactor.solve(s.start);
  const double smoothCost = objective.moveTo(s.start);
  if (warm && warmCost <= smoothCost) objective.moveTo(*guess);
  s.report = minimize(objective, model.options.tolerance,
                      mostIterations(model.options.maxIterations, data.constraints.rowCount()),
                      s.gradient, s.direction);
  s.cellFactored = s.report.factorizations > 0 && !objective.cellChanged();
  return finish();
}

SolveStatus forwardDynamics(const Model& model, const VectorX* guess, Data& data) noexcept {
  const SolveStatus status = minimizeGauss(model, guess, data);
  if (!model.options.noSlip || isRefused(status)) return status;
  removeSlip(model, data);
  if (data.forward.report.status == SolveStatus::notFinite)
    data.stats.badDof = firstNotFinite(data.forward.a);
  return data.forward.report.status;
}

}  // namespace softgauss
