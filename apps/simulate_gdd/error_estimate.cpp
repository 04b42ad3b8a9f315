// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/error_estimate.hpp"

#include <cmath>

namespace softgauss::app {
namespace {

Model halved(Model model) {
  model.options.timestep *= 0.5;
  model.options.integrationTolerance /= 64.0;
  return model;
}

double factorOf(const Options& options) {
  if (options.stepDoubling) return 1.0;
  switch (options.integrator) {
    case Integrator::semiImplicitEuler:
    case Integrator::implicit:
      return 2.0;
    case Integrator::implicitMidpoint:
      return 4.0 / 3.0;
    case Integrator::rungeKutta4:
      return 16.0 / 15.0;
    case Integrator::dormandPrince:
      return 1.0;
  }
  return 1.0;
}

}  // namespace

ErrorEstimate::ErrorEstimate(const Model& model, const State& start, bool withGoals)
    : withGoals_(withGoals),
      factor_(factorOf(model.options)),
      model_(halved(model)),
      contacts_(model_),
      data_(model_),
      state_(start),
      run_(model),
      halves_(model) {}

void ErrorEstimate::observe(const State& before, const Input& input, const State& after) {
  if (lost_) return;
  if (withGoals_) state_ = before;
  for (int half = 0; half < 2 && !lost_; ++half)
    lost_ = isRefused(step(model_, input, state_, data_, &contacts_));
  if (lost_) return;
  run_.set(after);
  halves_.set(state_);
  const PoseError e = run_.against(halves_);
  total_ += withGoals_ ? e.total : e.total * e.total;
  turned_ += withGoals_ ? e.orientation : e.orientation * e.orientation;
  ++steps_;
}

io::ErrorOutcome ErrorEstimate::outcome() const {
  io::ErrorOutcome outcome;
  outcome.estimated = true;
  outcome.ofSteps = withGoals_;
  const auto result = [&](double sum) {
    if (lost_) return kInfinity;
    if (steps_ == 0) return 0.0;
    return factor_ * (withGoals_ ? sum : std::sqrt(sum / static_cast<double>(steps_)));
  };
  outcome.position = result(total_);
  outcome.orientation = result(turned_);
  return outcome;
}

}  // namespace softgauss::app
