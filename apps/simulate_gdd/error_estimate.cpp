// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/error_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/io/scene.hpp"

namespace softgauss::app {
namespace {

constexpr double kFirstOrder = 2.0;  // 2^p/(2^p − 1)

/// Of the tolerance of error control: the fifth order is cheap to tighten, the first is not.
constexpr double kDormandPrinceShare = 1.0 / 1024.0, kDoublingShare = 1.0 / 64.0;

constexpr double kShortestPart = 1.0 / 1024.0;  // of the step

Model halved(Model model) {
  Options& options = model.options;
  options.timestep *= 0.5;
  options.sleep.enabled = false;
  options.integrationTolerance *= options.stepDoubling ? kDoublingShare : kDormandPrinceShare;
  return model;
}

Model halvedByDormandPrince(Model model) {
  model.options.integrator = Integrator::dormandPrince;
  return halved(std::move(model));
}

double factorOf(const Options& options) {
  if (options.stepDoubling) return 1.0;
  switch (options.integrator) {
    case Integrator::semiImplicitEuler:
    case Integrator::leapfrog:  // where rows act
    case Integrator::implicit:
      return kFirstOrder;
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

ErrorEstimate::Halves::Halves(const Model& halved, const State& start, double f)
    : factor(f), model(halved), contacts(model), data(model), state(start), poses(model) {}

double ErrorEstimate::Halves::tunnellingLengthBound(double half, double left) {
  const double most = std::min(half, left);
  if (!contacts.mayTouch() || io::controlsError(model.options)) return most;
  computeKinematics(model, state, data.kinematics);
  const double sight = contacts.tunnellingTimeBound(model, data.kinematics, 2.0 * most,
                                                    ContactSource::TimeDirection::forward);
  return std::min(most, std::max(0.5 * sight, 2.0 * kShortestPart * half));
}

ErrorEstimate::ErrorEstimate(const Model& model, const State& start, const OutsideInput& outside,
                             bool withGoals)
    : outside_(outside), withGoals_(withGoals), run_(model) {
  // Equality constraints of the leapfrog are its own (3.14): no other method's motion is theirs.
  const bool tied = !(model.connections.empty() && model.welds.empty() && model.couplings.empty());
  const Integrator integrator = model.options.integrator;
  const bool divides =
      integrator == Integrator::implicitMidpoint || (integrator == Integrator::leapfrog && !tied);
  if (divides && !model.options.stepDoubling)
    halves_.push_back(std::make_unique<Halves>(halvedByDormandPrince(model), start, 1.0));
  halves_.push_back(std::make_unique<Halves>(halved(model), start, factorOf(model.options)));
}

void ErrorEstimate::observe(const State& before, const Input& input, const State& after,
                            double length) {
  run_.set(after);
  for (const auto& halves : halves_)
    if (!halves->lost) observe(*halves, before, input, length);
  ++steps_;
}

void ErrorEstimate::observe(Halves& h, const State& before, const Input& input, double length) {
  if (withGoals_) h.state = before;
  input_ = input;
  for (double left = length; left > 1e-9 * length && !h.lost;) {
    h.model.options.timestep = h.tunnellingLengthBound(0.5 * length, left);
    left -= h.model.options.timestep;
    outside_.at(h.model, h.state, h.data.kinematics, input_);
    if (input_.tau != input.tau) h.factor = std::max(h.factor, kFirstOrder);
    h.lost = isRefused(step(h.model, input_, h.state, h.data, &h.contacts));
  }
  if (h.lost) return;
  h.poses.set(h.state);
  const PoseError e = run_.against(h.poses);
  h.total += withGoals_ ? e.total : e.total * e.total;
  h.turned += withGoals_ ? e.orientation : e.orientation * e.orientation;
}

io::ErrorOutcome ErrorEstimate::outcome() const {
  io::ErrorOutcome outcome;
  outcome.estimated = true;
  outcome.ofSteps = withGoals_;
  outcome.position = outcome.orientation = kInfinity;
  for (const auto& h : halves_) {
    if (h->lost) continue;
    const auto result = [&](double sum) {
      if (steps_ == 0) return kInfinity;  // the first one was refused
      return h->factor * (withGoals_ ? sum : std::sqrt(sum / static_cast<double>(steps_)));
    };
    outcome.position = result(h->total);
    outcome.orientation = result(h->turned);
    break;
  }
  return outcome;
}

}  // namespace softgauss::app
