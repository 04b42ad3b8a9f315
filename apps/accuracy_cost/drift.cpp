// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/drift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "apps/shared/progress.hpp"

namespace softgauss::app {
namespace {

constexpr double kStep = 0.002, kDuration = 10.0;  // [s]

Drift measure(const Problem& problem, const Method& method) {
  Drift drift{problem.name, method, 0.0, 0.0, 0.0};
  const auto tested = makeEngine(problem, method, kStep);
  const Model& model = tested->model();
  State state(model);
  if (problem.start) problem.start(model, state);
  tested->start(state);
  Kinematics k(model);
  const auto look = [&](Momentum& momentum) {
    computeKinematics(model, tested->state(), k);
    momentum = computeMomentum(model, k);
    return computeEnergy(model, k, tested->state().q, tested->state().v);
  };
  Momentum momentum, before;
  const Energy first = look(before);
  double kinetic = first.kinetic;
  // Nothing pushes where there is neither weight nor a base.
  const bool isFree = !model.options.effects.has(Effect::gravity) && model.trees.size() == 1 &&
                      model.bodies[model.trees[0].rootBody].joint == JointKind::floating;
  for (int i = 0; i < static_cast<int>(std::lround(kDuration / kStep)); ++i) {
    if (!tested->advance({}, 1)) {
      drift.energy = kInfinity;
      return drift;
    }
    const Energy now = look(momentum);
    kinetic = std::max(kinetic, now.kinetic);
    drift.last = now.total() - first.total();
    drift.energy = std::max(drift.energy, std::abs(drift.last));
    if (isFree)
      drift.momentum = std::max(drift.momentum,
                                (momentum.angular - before.angular).norm() / before.angular.norm());
  }
  drift.energy /= kinetic;
  drift.last /= kinetic;
  return drift;
}

}  // namespace

void measureDrifts(const std::filesystem::path& folder, const std::vector<Problem>& problems) {
  std::ofstream csv(folder / "drift.csv");
  csv << "problem,engine,method,energy_worst,energy_last,angular_momentum_worst\n";
  for (const Problem& problem : problems) {
    if (!problem.lossless) continue;
    fmt::print("\n{}: {:g} s at {:g} ms\n{:<40} {:>12} {:>12} {:>12}\n", problem.name, kDuration,
               1e3 * kStep, "", "energy, most", "at the end", "momentum");
    for (const Method& method : methodsFor(problem)) {
      if (interrupted()) return;
      const Drift d = measure(problem, method);
      fmt::print("{:<40} {:>12.2e} {:>12.2e} {:>12.2e}\n", method.label, d.energy, d.last,
                 d.momentum);
      csv << fmt::format("{},{},{},{:.4g},{:.4g},{:.4g}\n", d.problem, method.engine, method.label,
                         d.energy, d.last, d.momentum)
          << std::flush;
    }
  }
}

}  // namespace softgauss::app
