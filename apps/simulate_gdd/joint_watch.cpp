// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/joint_watch.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::app {
namespace {

constexpr double kMemory = 0.5;         // [s]
constexpr double kOftenNow = 0.2;       // share of the recent steps
constexpr double kOften = 0.05;         // share of all steps
constexpr double kAtEndAngle = 0.01;    // [rad] nearer is at the end of the range
constexpr double kAtEndLength = 1e-3;   // [m]
constexpr double kAtEndShare = 0.01;    // of the range, where that is less
constexpr double kTooFast = 1.05;       // of it: joints that are held to it stay below
constexpr double kChatterShare = 0.05;  // of the bound
constexpr double kLeastChatter = 0.01;  // [N m or N]

std::vector<WatchedControl> worstFirst(std::vector<WatchedControl> list) {
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.amount > b.amount; });
  return list;
}

}  // namespace

JointWatch::JointWatch(const Model& model, const gdd::ControlLimits& limits)
    : model_(model), fastest_(VectorX::Zero(model.nv)) {
  for (int i = 0; i < model.nv; ++i) {
    const Dof& dof = model.dofs[i];
    if (!dof.actuated) continue;
    Control control{model.jointNames[dof.body],
                    model.bodies[dof.body].joint == JointKind::prismatic ? "N" : "N m",
                    {i},
                    dof.effortLower,
                    dof.effortUpper};
    controls_.push_back(std::move(control));
  }
  if (!limits.transmission) return;
  for (const gdd::Actuator& actuator : limits.transmission->actuators()) {
    Control control{actuator.name, "", {}, actuator.lower, actuator.upper};
    for (const gdd::Actuator::Pull& pull : actuator.pulls) control.dofs.push_back(pull.dof);
    controls_.push_back(std::move(control));
    ++actuators_;
  }
  // Of a joint that actuators pull, the effort is no bound.
  for (std::size_t i = 0; i + actuators_ < controls_.size(); ++i)
    controls_[i].actuated = !limits.transmission->pulls(controls_[i].dofs[0]);
}

void JointWatch::see(Control& control, double u, double forget) {
  const bool full = control.actuated && (u <= control.lower || u >= control.upper);
  control.recent = forget * control.recent + (1.0 - forget) * (full ? 1.0 : 0.0);
  control.full += full ? 1 : 0;
  const double jump = steps_ > 0 ? u - control.last : 0.0;
  const bool turns = jump * control.jump < 0.0;
  control.jumps = forget * control.jumps +
                  (1.0 - forget) * (turns ? std::min(std::abs(jump), std::abs(control.jump)) : 0.0);
  control.jump = jump;
  control.last = u;
  control.largest = std::max(control.largest, std::abs(u));
}

void JointWatch::observe(const VectorX& tau, const VectorX& commands, const State& state,
                         double h) {
  const double forget = std::exp(-h / kMemory);
  const std::size_t joints = controls_.size() - actuators_;
  for (std::size_t i = 0; i < joints; ++i) see(controls_[i], tau[controls_[i].dofs[0]], forget);
  for (std::size_t k = 0; k < actuators_ && static_cast<Eigen::Index>(k) < commands.size(); ++k)
    see(controls_[joints + k], commands[static_cast<Eigen::Index>(k)], forget);
  v_ = state.v;
  q_ = state.q;
  for (int i = 0; i < model_.nv; ++i) fastest_[i] = std::max(fastest_[i], std::abs(v_[i]));
  ++steps_;
}

bool JointWatch::concerns(const Control& control, const std::vector<char>& counts) const {
  return control.actuated && std::any_of(control.dofs.begin(), control.dofs.end(),
                                         [&](int dof) { return counts[dof] != 0; });
}

std::vector<std::string> JointWatch::saturatedNow(const std::vector<char>& counts) const {
  std::vector<std::string> names;
  for (const Control& control : controls_)
    if (concerns(control, counts) && control.recent > kOftenNow) names.push_back(control.name);
  return names;
}

std::vector<std::string> JointWatch::atRangeEnd(const std::vector<char>& counts) const {
  std::vector<std::string> names;
  for (const JointRange& range : model_.ranges) {
    const Body& body = model_.bodies[range.body];
    const double q = q_[body.q];
    const double most = body.joint == JointKind::prismatic ? kAtEndLength : kAtEndAngle;
    const double near = std::min(most, kAtEndShare * (range.upper - range.lower));
    if (counts[body.v] && (q < range.lower + near || q > range.upper - near))
      names.push_back(model_.jointNames[range.body]);
  }
  return names;
}

double JointWatch::speed(const std::vector<char>& counts) const {
  double most = 0.0;
  for (int i = 0; i < model_.nv; ++i)
    if (counts[i]) most = std::max(most, std::abs(v_[i]));
  return most;
}

std::vector<WatchedControl> JointWatch::saturated() const {
  std::vector<WatchedControl> list;
  for (const Control& control : controls_) {
    const double share = steps_ > 0 ? static_cast<double>(control.full) / steps_ : 0.0;
    if (share > kOften) list.push_back({control.name, share});
  }
  return worstFirst(std::move(list));
}

std::vector<WatchedControl> JointWatch::chattering() const {
  std::vector<WatchedControl> list;
  for (const Control& control : controls_) {
    const double bound = std::max(-control.lower, control.upper);
    const double scale = std::isfinite(bound) && bound > 0.0 ? bound : control.largest;
    if (control.actuated && control.jumps > std::max(kChatterShare * scale, kLeastChatter))
      list.push_back({control.name, control.jumps, control.unit});
  }
  return worstFirst(std::move(list));
}

std::vector<FastJoint> JointWatch::tooFast() const {
  std::vector<FastJoint> list;
  for (int i = 0; i < model_.nv; ++i) {
    const double limit = model_.dofs[i].velocityLimit;
    if (!(fastest_[i] > kTooFast * limit)) continue;
    const int body = model_.dofs[i].body;
    const bool slides = model_.bodies[body].joint == JointKind::prismatic;
    list.push_back({model_.jointNames[body], fastest_[i], limit, slides ? "m/s" : "rad/s"});
  }
  std::stable_sort(list.begin(), list.end(), [](const FastJoint& a, const FastJoint& b) {
    return a.speed * b.limit > b.speed * a.limit;
  });
  return list;
}

}  // namespace softgauss::app
