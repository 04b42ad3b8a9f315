// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/company.hpp"

#include <cmath>
#include <limits>

#include "apps/simulate_gdd/live_run.hpp"
#include "apps/simulate_gdd/plan_run.hpp"
#include "apps/simulate_gdd/play_run.hpp"
#include "softgauss/io/simulation/named_states.hpp"
#include "softgauss/io/simulation/time_grid.hpp"

namespace softgauss::app {

Company::Company(const SimulateOptions& options, Scene& scene, State& state,
                 std::optional<Data>& data, gdd::GoalDirectedController& controller)
    : options_(options), model_(scene.model), state_(state), controller_(controller) {
  steps_ = std::isfinite(options.duration) ? stepsIn(options.duration, model_.options.timestep)
                                           : std::numeric_limits<long>::max();
  if (options.acted())
    hands_.emplace(live::RunParts{scene.model, state, instant_, data, controller},
                   controller.goals.empty(), namedStates(scene),
                   options.planControl ? "a plan is of the world as it was loaded" : "");
}

void Company::join(const Scene& scene, const gdd::GoalContext& start) {
  if (!options_.play.empty()) {
    auto play = std::make_unique<PlayRun>(options_.play, *hands_, model_.options.timestep);
    if (!std::isfinite(options_.duration)) steps_ = play->steps();
    companions_.push_back(std::move(play));
  }
#ifdef SOFTGAUSS_WITH_LIVE
  if (options_.live)
    companions_.push_back(std::make_unique<LiveRun>(options_, scene, *hands_, controller_, start));
#else
  (void)scene, (void)start, (void)controller_;
#endif
  if (options_.planControl)
    companions_.push_back(std::make_unique<PlanRun>(
        *options_.planControl, state_, [this](const std::string& message) { tell(message); }));
}

std::string Company::announcement() const {
  std::string text;
  for (const auto& companion : companions_) text += companion->announcement();
  return text;
}

void Company::countStep() {
  ++taken_;
  ++instant_;
  state_.time = static_cast<double>(instant_) * model_.options.timestep;
  if (!hands_) return;
  hands_->takeStep();
  hands_->afterStep();
}

}  // namespace softgauss::app
