// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/divergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "apps/accuracy_cost/engine_under_test.hpp"
#include "apps/shared/pose_error.hpp"
#include "apps/shared/progress.hpp"

namespace softgauss::app {

Divergence measureDivergence(const Problem& problem) {
  constexpr int kSteps = 128;          // a period
  constexpr double kPush = 1e-9;       // [m/s or rad/s]
  constexpr double kRounding = 1e-13;  // below it a difference is not told [m]
  const Method euler{"softgauss", "semi-implicit-euler", ""};
  const auto one = makeEngine(problem, euler, kPeriod / kSteps);
  const auto other = makeEngine(problem, euler, kPeriod / kSteps);
  const Model& model = one->model();
  State start(model);
  if (problem.start) problem.start(model, start);
  one->start(start);
  // Signs alternate, so that the push is no symmetry of the scene.
  for (int i = 0; i < model.nv; ++i) start.v[i] += i % 2 == 0 ? kPush : -kPush;
  other->start(start);

  LinkPoses a(model), b(model);
  std::vector<double> d;
  for (int k = 0; k < problem.periods && !interrupted(); ++k) {
    VectorX tau = VectorX::Zero(model.nv);
    if (problem.force) problem.force(model, k * kPeriod, tau);
    if (!one->advance(tau, kSteps) || !other->advance(tau, kSteps)) break;
    a.set(one->state());
    b.set(other->state());
    d.push_back(a.against(b).total);
  }
  Divergence divergence;
  const std::size_t window = problem.contact ? problem.windowPeriods : d.size();
  for (std::size_t k = 0; k < d.size(); ++k) {
    divergence.whole = std::max(divergence.whole, d[k] / std::max(d[0], kRounding));
    if (k >= window)
      divergence.window = std::max(divergence.window, d[k] / std::max(d[k - window], kRounding));
  }
  if (!problem.contact) divergence.window = divergence.whole;
  return divergence;
}

void writeDivergences(const std::filesystem::path& folder, const std::vector<Problem>& problems) {
  std::ofstream csv(folder / "divergence.csv");
  csv << "problem,whole,window\n";
  fmt::print("{:<22} {:>16} {:>16}\n", "a difference grows", "in all", "in a window");
  for (const Problem& problem : problems) {
    const Divergence p = measureDivergence(problem);
    if (interrupted()) return;
    fmt::print("{:<22} {:>16.2g} {:>16.2g}\n", problem.name, p.whole, p.window);
    csv << fmt::format("{},{:.4g},{:.4g}\n", problem.name, p.whole, p.window) << std::flush;
  }
}

}  // namespace softgauss::app
