// SPDX-License-Identifier: Apache-2.0
/// Joint positions by name, and the control of a scene.

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "softgauss/collision/clearance.hpp"
#include "softgauss/engine/model/followers.hpp"
#include "softgauss/io/detail/unit_mistakes.hpp"
#include "softgauss/io/names.hpp"
#include "softgauss/io/simulation/scene.hpp"

namespace softgauss {

void setJointPositions(const Model& model, const std::vector<std::pair<std::string, double>>& q0,
                       State& state) {
  std::set<std::string> seen;
  std::set<int> placed;
  for (const auto& [name, value] : q0) {
    const auto fail = [&joint = name](const std::string& problem) {
      throw OptionError(fmt::format("q0 {}: {}", joint, problem));
    };
    if (const std::string problem = io::jointProblem(model, name); !problem.empty()) fail(problem);
    const int body = model.findJoint(name);
    if (!seen.insert(name).second) fail("is given twice");
    for (const JointRange& range : model.ranges)
      if (range.body == body && (value < range.lower || value > range.upper))
        fail(fmt::format("{} lies outside the joint's range {} .. {}{}", value, range.lower,
                         range.upper, io::detail::radiansMeant(model, range, value)));
    state.q[model.bodies[body].q] = value;
    placed.insert(body);
  }
  placeFollowers(model, placed, state.q);
  for (const auto& [name, value] : q0) {
    const double asked = followedPosition(model, model.findJoint(name), state.q).value_or(value);
    if (std::abs(value - asked) > kFollowerTolerance)
      throw OptionError(fmt::format(
          "q0 {}: {} found, expected {:.6g}, for it follows another joint; give its leader", name,
          value, asked));
  }
}

namespace {

/// Distances of the scene's shapes, the same for all goals that ask.
io::DistancesMaker distancesOf(const Scene& scene) {
  return [&scene, made = std::make_shared<std::shared_ptr<ShapeDistances>>()](const Model& model) {
    if (!*made) *made = std::make_shared<collision::Clearance>(model, scene.contacts->meshes());
    return *made;
  };
}

}  // namespace

io::GoalFile readGoalFile(const std::filesystem::path& file, const Scene& scene) {
  return io::readGoalFile(file, scene.model, scene.initial, distancesOf(scene));
}

io::GoalFile parseGoals(const std::string& text, const std::string& name, const Scene& scene) {
  return io::parseGoals(text, name, scene.model, scene.initial, distancesOf(scene));
}

void addGoals(const std::filesystem::path& file, const Scene& scene,
              gdd::GoalDirectedController& controller) {
  io::GoalFile asked = readGoalFile(file, scene);
  if (asked.controlCost) controller.controlCost = *asked.controlCost;
  for (std::unique_ptr<gdd::Goal>& goal : asked.goals) controller.goals.push_back(std::move(goal));
  gdd::weighDefaults(scene.model, controller.goals);
}

void setUpControl(const Scene& scene, const SimulationOptions& options,
                  gdd::GoalDirectedController& controller) {
  controller.solver = scene.gddSolver;
  controller.limits = io::controlLimits(scene.model, scene.actuators);
  controller.motionLimits.reset();
  if (!options.ignoreVelocityLimits) controller.motionLimits.emplace();
  controller.goals.clear();
  if (scene.hasGoals && !options.withoutGoals) addGoals(scene.file, scene, controller);
  if (options.controlCost) controller.controlCost = *options.controlCost;
  if (options.iterationBudget) controller.iterationBudget = *options.iterationBudget;
  if (options.timeBudget) controller.timeBudget = *options.timeBudget;
}

/// The posture yields to reaches and holds (9.24), lets a robot that stands lean no further than
/// they ask for, and brings to rest what they leave free (docs/robots.md).
std::vector<std::unique_ptr<gdd::Goal>> regularisers(const VectorX& q,
                                                     std::optional<double> postureWeight) {
  auto posture = std::make_unique<gdd::Posture>(q);
  posture->weight = postureWeight.value_or(gdd::Posture::kDefaultWeight);
  posture->isRegulariser = !postureWeight;
  std::vector<std::unique_ptr<gdd::Goal>> goals;
  goals.push_back(std::move(posture));
  goals.push_back(std::make_unique<gdd::VirtualDamping>());
  return goals;
}

std::vector<std::unique_ptr<gdd::Goal>> balanceOf(const Scene& scene,
                                                  const SimulationOptions& options) {
  if (options.noBalance) return {};
  return gdd::StandingBalance::ofRobotsThatStand(scene.model, scene.initial, *scene.contacts);
}

}  // namespace softgauss
