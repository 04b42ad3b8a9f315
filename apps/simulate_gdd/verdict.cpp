// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

namespace softgauss::app {
namespace {

constexpr double kReachedShare = 0.8;
constexpr double kMemory = 0.5;    // [s] over which saturation is remembered
constexpr double kMoving = 0.05;   // [m/s or rad/s] faster is still on its way
constexpr double kAtLimit = 0.01;  // [rad or m] nearer is at the end of the range
constexpr std::size_t kMostNames = 6;

/// "a, b, c and 3 more"
std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMostNames; ++i)
    text += (i > 0 ? ", " : "") + names[i];
  if (names.size() > kMostNames) text += fmt::format(" and {} more", names.size() - kMostNames);
  return text;
}

}  // namespace

Verdict::Verdict(const Model& model, const gdd::ControlBox& box)
    : model_(model), box_(box), saturated_(VectorX::Zero(model.nv)) {
  if (box.transmission)
    full_ = VectorX::Zero(static_cast<Eigen::Index>(box.transmission->actuators().size()));
}

void Verdict::observe(const VectorX& tau, const VectorX& commands, const State& state) {
  const double forget = std::exp(-model_.options.timestep / kMemory);
  for (Eigen::Index k = 0; k < commands.size(); ++k) {
    const gdd::Actuator& actuator = box_.transmission->actuators()[static_cast<std::size_t>(k)];
    const bool full = commands[k] <= actuator.lower || commands[k] >= actuator.upper;
    full_[k] = forget * full_[k] + (1.0 - forget) * (full ? 1.0 : 0.0);
  }
  for (int i = 0; i < model_.nv; ++i) {
    const Dof& dof = model_.dofs[i];
    const bool full = dof.actuated && (tau[i] <= dof.effortLower || tau[i] >= dof.effortUpper);
    saturated_[i] = forget * saturated_[i] + (1.0 - forget) * (full ? 1.0 : 0.0);
  }
  speed_ = state.v;
  q_ = state.q;
}

std::string Verdict::heldBack() const {
  std::vector<std::string> weak, ended;
  bool anyActuated = false;
  for (int i = 0; i < model_.nv; ++i) {
    anyActuated |= model_.dofs[i].actuated;
    if (saturated_[i] > 0.2) weak.push_back(model_.jointNames[model_.dofs[i].body]);
  }
  for (Eigen::Index k = 0; k < full_.size(); ++k)
    if (full_[k] > 0.2)
      weak.push_back(box_.transmission->actuators()[static_cast<std::size_t>(k)].name);
  if (!anyActuated) return "no joint is actuated";
  for (const JointRange& range : model_.ranges) {
    const double q = q_[model_.bodies[range.body].q];
    if (q < range.lower + kAtLimit || q > range.upper - kAtLimit)
      ended.push_back(model_.jointNames[range.body]);
  }
  std::string text;
  const auto add = [&](const std::string& reason) { text += (text.empty() ? "" : "; ") + reason; };
  if (!weak.empty()) add("at their torque limit: " + list(weak));
  if (!ended.empty()) add("at the end of their range: " + list(ended));
  if (speed_.cwiseAbs().maxCoeff() > kMoving)
    add("the robot was still moving when the time was up");
  if (text.empty()) text = "out of reach, or other goals and the cost of torques outweigh it";
  return text;
}

std::vector<std::string> Verdict::unreached(const std::vector<io::GoalOutcome>& goals) const {
  std::vector<std::string> sentences;
  if (q_.size() == 0) return sentences;
  for (const io::GoalOutcome& goal : goals) {
    if (goal.nearer() >= kReachedShare) continue;
    sentences.push_back(fmt::format("goal '{}' not reached ({:.3g} m left of {:.3g} m): {}",
                                    goal.name, goal.finalError, goal.initialError, heldBack()));
  }
  return sentences;
}

}  // namespace softgauss::app
