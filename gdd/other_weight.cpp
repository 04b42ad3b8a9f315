// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/other_weight.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "softgauss/gdd/goals/default_weight.hpp"

namespace softgauss::gdd {
namespace {

/// The goals of one controller under another, one of them with another weight, for as long as this
/// lives.
class Lent {
 public:
  Lent(const Model& model, GoalDirectedController& from, GoalDirectedController& to, double& weight,
       double tried)
      : model_(model), from_(from), to_(to), weight_(weight), before_(weight) {
    weight_ = tried;
    weighDefaults(model_, from_.goals);
    from_.goals.swap(to_.goals);
  }
  ~Lent() {
    from_.goals.swap(to_.goals);
    weight_ = before_;
    weighDefaults(model_, from_.goals);
  }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;

 private:
  const Model& model_;
  GoalDirectedController &from_, &to_;
  double& weight_;
  double before_;
};

}  // namespace

OtherWeight::OtherWeight(const Model& model, GoalDirectedController& controller)
    : model_(model), controller_(controller), trial_(model), data_(model) {
  trial_.limits = controller.limits;
  trial_.forceMetric = controller.forceMetric;
  trial_.takeSettings(controller);
}

double OtherWeight::toTry(double now, double left, double most, double wanted) {
  const double span = std::max(most - left, 1e-9 * most);
  const double needed = now * left / span * std::max(most - wanted, 0.0) / wanted;
  const double most10 = std::pow(10.0, std::floor(std::log10(kMostRaised * now)));
  const double least10 = std::pow(10.0, std::ceil(std::log10(10.0 * now)));
  const double power = std::pow(10.0, std::ceil(std::log10(std::max(needed, 1e-300))));
  return std::max(least10, std::min(most10, power));
}

std::optional<double> OtherWeight::errorOf(const Goal& goal, const GoalError& error,
                                           const State& state) {
  figures_.clear();
  goal.errors({model_, state, data_}, touching_, figures_);
  for (const GoalError& figure : figures_)
    if (std::strcmp(figure.what, error.what) == 0) return figure.value;
  return std::nullopt;
}

std::optional<double> OtherWeight::leaves(const Goal& goal, const GoalError& error, double& weight,
                                          double tried, const Input& input, const State& from,
                                          ContactSource* contacts, const Watch& watch) {
  const Lent lent(model_, controller_, trial_, weight, tried);
  State state = from;
  const double h = model_.options.timestep;
  double since = 0.0, least = kInfinity, largest = -kInfinity;
  for (double time = h; time <= kLongest; time += h) {
    if (isRefused(trial_.step(model_, input, state, data_, contacts))) return std::nullopt;
    state.time = from.time;
    contactForces(data_, touching_);
    if (watch) watch(data_, touching_, time);
    const std::optional<double> is = errorOf(goal, error, state);
    if (!is) return std::nullopt;
    least = std::min(least, *is), largest = std::max(largest, *is);
    if (largest - least > kRestChange * error.met)
      least = largest = *is, since = time;
    else if (time - since >= kRestTime)
      return *is;
  }
  return std::nullopt;
}

}  // namespace softgauss::gdd
