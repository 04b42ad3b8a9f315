// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/plan_search.hpp"

#include <cmath>
#include <numbers>

#include "softgauss/gdd/planning/planner.hpp"

namespace softgauss::planning {

double NormalNumbers::uniform() {
  return (static_cast<double>(bits_() >> 11) + 0.5) / 9007199254740992.0;
}

double NormalNumbers::next() {
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

void addSmoothMotion(NormalNumbers& random, double sigma, double step, std::vector<VectorX>& a) {
  constexpr int kWaves = 4;
  if (a.empty()) return;
  const double whole = step * static_cast<double>(a.size());
  for (Eigen::Index i = 0; i < a[0].size(); ++i) {
    for (int k = 1; k <= kWaves; ++k) {
      const double rate = std::numbers::pi / whole, c = sigma * random.next() * rate * rate;
      for (std::size_t t = 0; t < a.size(); ++t)
        a[t][i] += c * std::cos(k * rate * (static_cast<double>(t) + 0.5) * step);
    }
  }
}

const MotionPlan& Planner::search(const State& state, const PlanSearch& search,
                                  const PlanOptions& options) {
  constexpr double kLeast = 0.02;  // of reach
  if (!feasible_.hasTrajectory() || stopped_) return plan_;
  NormalNumbers random(search.seed);
  MotionPlan best = plan_;
  keep();
  for (int i = 0; i < search.tries && !stopped_; ++i) {
    std::vector<VectorX> a = best.a;
    const double sigma = search.reach * std::pow(kLeast, random.uniform());
    addSmoothMotion(random, sigma, model_->options.timestep, a);
    const MotionPlan& found = solve(state, options, a);
    best.seconds += found.seconds, best.iterations += found.iterations;
    if (!feasible_.hasTrajectory() || !(found.cost < best.cost)) continue;
    const double seconds = best.seconds;
    const int iterations = best.iterations;
    best = found;
    best.seconds = seconds, best.iterations = iterations;
    keep();
  }
  plan_ = best;
  if (stopped_) plan_.status = PlanStatus::interrupted;
  takeKept();
  return plan_;
}

}  // namespace softgauss::planning
