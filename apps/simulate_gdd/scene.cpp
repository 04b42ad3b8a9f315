// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/scene.hpp"

#include <fmt/format.h>

#include "apps/simulate_gdd/trial.hpp"
#include "softgauss/collision/clearance.hpp"
#include "softgauss/io/explain.hpp"
#include "softgauss/io/names.hpp"

namespace softgauss::app {
namespace {

/// Links that goals on the command line name.
void checkLinks(const SimulateOptions& options, const Model& model) {
  const auto check = [&](const std::string& option, const std::string& link) {
    if (const std::string problem = io::linkProblem(model, link); !problem.empty())
      throw UsageError(option + ": " + problem);
  };
  for (const ReachArgument& reach : options.reach) check("--reach", reach.link);
  for (const std::string& link : options.hold) check("--hold", link);
}

}  // namespace

SimulationOptions loadOptions(const SimulateOptions& options) {
  SimulationOptions load = options;
  load.visualMeshes = !options.view.empty() || options.live;
  load.withoutServos = options.passive || !options.torques.empty();
  load.withoutGoals = load.withoutServos || options.servos || options.plan || options.mpc;
  return load;
}

std::unique_ptr<Scene> loadScene(const SimulateOptions& options) {
  std::unique_ptr<Scene> scene;
  try {
    scene = softgauss::loadScene(options.model, loadOptions(options));
  } catch (const OptionError& error) {
    throw UsageError("--" + std::string(error.what()));
  }
  checkSteps(options, scene->model.options.timestep, scene->timestepWhere);
  checkOutputs(options, scene->contents.files);
  checkLinks(options, scene->model);
  return scene;
}

void setUp(const SimulateOptions& options, const Scene& scene,
           gdd::GoalDirectedController& controller) {
  setUpControl(scene, loadOptions(options), controller);
  if (options.passive || options.servos || !options.torques.empty()) return;
  if (!options.goals.empty()) addGoals(options.goals, scene, controller);
  for (const ReachArgument& r : options.reach) {
    auto goal = std::make_unique<gdd::Reach>(scene.model, r.link, r.p_WTarget, r.p_FP);
    if (r.weight) goal->weight = *r.weight, goal->defaultWeight.giveUp();
    controller.goals.push_back(std::move(goal));
  }
  for (const std::string& link : options.hold)
    controller.goals.push_back(std::make_unique<gdd::Hold>(scene.model, link));
  const bool fromFile = scene.hasGoals || !options.goals.empty();  // they hold what they say
  if (!fromFile && (!options.reach.empty() || options.acted()))
    for (std::unique_ptr<gdd::Goal>& goal : balanceOf(scene, options))
      controller.goals.push_back(std::move(goal));
  if (options.hasOwnGoals())
    for (std::unique_ptr<gdd::Goal>& goal : regularisers(scene.initial.q, options.posture))
      controller.goals.push_back(std::move(goal));
  gdd::weighDefaults(scene.model, controller.goals);
  if (options.controlCost) controller.controlCost = *options.controlCost;
  if (options.changeGoals) options.changeGoals(controller);
}

std::string explainScene(const Scene& scene) {
  io::ExplainContext context;
  context.contents = scene.contents;
  context.wrenches = scene.wrenches;
  context.actuators = scene.actuators;
  const collision::PairFilter& filter = scene.contacts->filter();
  context.testedPairs = static_cast<int>(filter.pairs.size());
  for (const collision::GeometryPair& pair : filter.pairs)
    context.pairs.emplace_back(pair.a, pair.b);
  context.unreachablePairs = filter.unreachablePairs;
  context.costs = tryEffects(scene);
  context.materials = scene.materials;
  for (const collision::ExcludedPair& pair : filter.excluded) {
    using Reason = collision::ExclusionReason;
    context.filtered.push_back({pair.linkA, pair.linkB,
                                pair.reason == Reason::adjacent   ? "joined by a joint"
                                : pair.reason == Reason::disabled ? "never tested, as the SRDF says"
                                                                  : "overlap at the start",
                                pair.reason == Reason::overlapsInitially
                                    ? fmt::format("by {:.2g} mm", 1e3 * pair.depth)
                                    : std::string()});
  }
  Kinematics kinematics(scene.model);
  computeKinematics(scene.model, scene.initial, kinematics);
  collision::Clearance distances(scene.model, scene.contacts->meshes());
  for (const auto& [a, b, distance] : collision::clearances(scene.model, kinematics, distances))
    context.clearances.push_back({a, b, distance});
  return io::explain(scene.model, context);
}

}  // namespace softgauss::app
