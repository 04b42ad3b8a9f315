// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/oddities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/simulate_gdd/names.hpp"

namespace softgauss::app {
namespace {

constexpr double kOutsideShare = 0.05;
constexpr double kOutsideAngle = 0.1, kOutsideLength = 0.01;
constexpr double kFastInRange = 300.0, kFastWithout = 3000.0, kFastSlide = 100.0;
constexpr double kGainShare = 0.05;
constexpr double kLift = 1e-3;  // [m]

std::string firstAt(double time) { return fmt::format(", first at {:.4g} s", time); }

}  // namespace

Oddities::Oddities(const Model& model, bool passive)
    : model_(model), passive_(passive), rangeOf_(model.bodies.size(), nullptr) {
  for (const JointRange& range : model.ranges) rangeOf_[range.body] = &range;
  lift_ = std::max(kLift * model.totalMass() * model.options.gravity.norm(), 1e-9);
}

bool Oddities::note(std::map<int, Seen>& kind, int body, double time, double amount) {
  const bool isFirst = kind.empty();
  Seen& seen = kind.try_emplace(body, Seen{time, amount}).first->second;
  seen.worst = std::max(seen.worst, amount);
  return isFirst;
}

std::vector<std::string> Oddities::observe(const State& state, double time, double energy,
                                           double kineticEnergy) {
  std::vector<std::string> now;
  for (int b = 1; b < model_.bodyCount(); ++b) {
    const Body& body = model_.bodies[b];
    if (body.dofs != 1) continue;
    const bool turns = body.joint == JointKind::revolute;
    const JointRange* range = rangeOf_[b];
    if (range) {
      const double q = state.q[body.q];
      const double over = std::max(range->lower - q, q - range->upper);
      const double width = range->upper - range->lower;
      if (over > std::max(turns ? kOutsideAngle : kOutsideLength,
                          std::isfinite(width) ? kOutsideShare * width : 0.0) &&
          note(outside_, b, time, over))
        now.push_back(rangeText(b, outside_[b], ""));
    }
    const double speed = std::abs(state.v[body.v]);
    if (speed > (!turns  ? kFastSlide
                 : range ? kFastInRange
                         : kFastWithout) &&
        note(fast_, b, time, speed))
      now.push_back(speedText(b, fast_[b], ""));
  }
  if (!started_) startEnergy_ = energy;
  started_ = true;
  mostKinetic_ = std::max(mostKinetic_, kineticEnergy);
  const double gain = energy - startEnergy_;
  if (!passive_ || !(gain > std::max(kGainShare * mostKinetic_, lift_))) return now;
  gain_ = std::max(gain_, gain);
  if (gainTime_ >= 0.0) return now;
  gainTime_ = time;
  fastest_ = fastestBody(state);
  now.push_back(energyText(""));
  return now;
}

bool Oddities::fits() const {
  const auto hasJoint = [&](int body) {
    return body > 0 && body < model_.bodyCount() && model_.bodies[body].dofs == 1;
  };
  return std::all_of(fast_.begin(), fast_.end(),
                     [&](const auto& seen) { return hasJoint(seen.first); }) &&
         std::all_of(outside_.begin(), outside_.end(),
                     [&](const auto& seen) {
                       return hasJoint(seen.first) && rangeOf_[seen.first] != nullptr;
                     }) &&
         fastest_ >= 0 && fastest_ < model_.bodyCount();
}

int Oddities::fastestBody(const State& state) const {
  int fastest = 0;
  double most = 0.0;
  for (int b = 1; b < model_.bodyCount(); ++b)
    if (const Body& body = model_.bodies[b]; body.dofs > 0)
      if (const double v = state.v.segment(body.v, body.dofs).cwiseAbs().maxCoeff(); v > most)
        most = v, fastest = b;
  return fastest;
}

std::string Oddities::rangeText(int body, const Seen& seen, const std::string& when) const {
  const char* unit = model_.bodies[body].joint == JointKind::revolute ? "rad" : "m";
  const char* what = seen.time == 0.0
                         ? "another start, or a range as the robot has it"
                         : "a smaller --timestep, a range as the robot has it, or armature on "
                           "light links";
  return fmt::format("joint '{}' is {:.3g} {} outside its range {:.4g} .. {:.4g}{}; try {}",
                     model_.jointNames[body], seen.worst, unit, rangeOf_[body]->lower,
                     rangeOf_[body]->upper, when, what);
}

std::string Oddities::speedText(int body, const Seen& seen, const std::string& when) const {
  const bool turns = model_.bodies[body].joint == JointKind::revolute;
  return fmt::format(
      "joint '{}' moves at {:.4g} {}, which no joint does{}; try a smaller "
      "--timestep, damping or armature on it, or a larger inertia of link '{}'",
      model_.jointNames[body], seen.worst, turns ? "rad/s" : "m/s", when, model_.bodyNames[body]);
}

std::string Oddities::energyText(const std::string& when) const {
  return fmt::format(
      "the energy of the scene increases by {:.3g} J without a source{}{}; try a smaller "
      "--timestep, --integrator implicit-midpoint, or a start without overlaps",
      gain_, when,
      fastest_ > 0 ? fmt::format(", joint '{}' moving fastest", model_.jointNames[fastest_]) : "");
}

std::vector<std::string> Oddities::sentences() const {
  std::vector<std::string> out;
  const auto tell = [&](const std::map<int, Seen>& kind, auto&& text) {
    if (kind.empty()) return;
    const auto worst = std::max_element(kind.begin(), kind.end(), [](const auto& a, const auto& b) {
      return a.second.worst < b.second.worst;
    });
    std::vector<std::string> others;
    for (const auto& [body, seen] : kind)
      if (body != worst->first) others.push_back(model_.jointNames[body]);
    double first = kInfinity;
    for (const auto& [body, seen] : kind) first = std::min(first, seen.time);
    out.push_back(text(worst->first, worst->second, firstAt(first)) +
                  (others.empty() ? "" : "; the same of " + listed(others)));
  };
  tell(outside_, [&](int body, const Seen& seen, const std::string& when) {
    return rangeText(body, seen, when);
  });
  tell(fast_, [&](int body, const Seen& seen, const std::string& when) {
    return speedText(body, seen, when);
  });
  if (gainTime_ >= 0.0) out.push_back(energyText(firstAt(gainTime_)));
  return out;
}

}  // namespace softgauss::app
