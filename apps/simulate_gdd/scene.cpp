// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "collision/lowest_point.hpp"
#include "io/explain.hpp"
#include "io/goals.hpp"

namespace softgauss::app {
namespace {

/// More would take minutes to load and gigabytes to hold.
constexpr int kMostDofs = 2000;

bool hasFloatingBase(const Model& model) {
  for (const Body& body : model.bodies)
    if (body.joint == JointKind::floating) return true;
  return false;
}

void setJointPositions(const SimulateOptions& options, const Model& model, State& state) {
  std::set<std::string> seen;
  for (const auto& [name, value] : options.q0) {
    const int body = model.findJoint(name);
    if (body < 0 || model.bodies[body].dofs != 1)
      throw ModelError({}, "--q0 " + name,
                       "the model has no joint of one degree of freedom of that name");
    if (!seen.insert(name).second) throw ModelError({}, "--q0 " + name, "is given twice");
    for (const JointRange& range : model.ranges)
      if (range.body == body && (value < range.lower || value > range.upper))
        throw ModelError({}, "--q0 " + name,
                         fmt::format("{} lies outside the joint's range {} .. {}", value,
                                     range.lower, range.upper));
    state.q[model.bodies[body].q] = value;
  }
}

/// Stands every floating tree on the ground, or at the wished height.
void placeBases(const SimulateOptions& options, const Model& model, std::optional<double> ground,
                State& state) {
  Kinematics k(model);
  computeKinematics(model, state, k);
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t) {
    const Body& root = model.bodies[model.trees[t].rootBody];
    if (root.joint != JointKind::floating) continue;
    double& z = state.q[root.q + 2];
    if (options.baseHeight) {
      z = *options.baseHeight;
    } else if (ground) {
      const double lowest = collision::lowestPoint(model, k, t);
      if (std::isfinite(lowest)) z += *ground - lowest;
    }
  }
}

}  // namespace

std::unique_ptr<Scene> loadScene(const SimulateOptions& options) {
  auto scene = std::make_unique<Scene>();
  io::UrdfOptions urdf;
  urdf.packagePaths = options.packagePaths;
  urdf.visualMeshes = !options.view.empty();
  urdf.base = options.base;
  urdf.zeroEffortIsUnlimited = options.zeroEffortIsUnlimited;
  ModelBuilder builder = io::readUrdf(options.model, urdf, &scene->contents);
  builder.options.timestep = options.timestep;
  builder.options.effects = options.effects;
  builder.options.midpointCoriolis = !options.likeMujoco;
  scene->model = builder.build();

  // Whether there is ground by default is known only once the base is.
  std::optional<double> ground = options.ground;
  if (options.groundIsDefault && hasFloatingBase(scene->model)) ground = 0.0;
  if (ground) {
    GeometrySpec plane;
    plane.name = "ground";
    plane.link = "world";
    plane.shape = Shape::plane();
    plane.X_LG.p.z() = *ground;
    builder.geometry(plane);
    scene->model = builder.build();
  }
  if (scene->model.nv > kMostDofs)
    throw ModelError(
        {options.model.string(), 0}, "model '" + scene->model.name + "'",
        fmt::format("has {} degrees of freedom, expected at most {}", scene->model.nv, kMostDofs));
  scene->contacts = std::make_unique<collision::SceneContacts>(scene->model);
  scene->initial = State(scene->model);
  setJointPositions(options, scene->model, scene->initial);
  placeBases(options, scene->model, ground, scene->initial);
  return scene;
}

std::vector<std::unique_ptr<gdd::Goal>> makeGoals(const SimulateOptions& options,
                                                  const Scene& scene) {
  std::vector<std::unique_ptr<gdd::Goal>> goals;
  if (!options.goals.empty()) goals = io::readGoals(options.goals, scene.model, scene.initial);
  for (const ReachArgument& r : options.reach)
    goals.push_back(std::make_unique<gdd::Reach>(scene.model, r.link, r.p_WTarget, r.p_FP));
  if (!options.reach.empty()) goals.push_back(std::make_unique<gdd::VirtualDamping>());
  return goals;
}

std::string explainScene(const Scene& scene) {
  io::ExplainContext context;
  context.contents = scene.contents;
  const collision::PairFilter& filter = scene.contacts->filter();
  context.testedPairs = static_cast<int>(filter.pairs.size());
  for (const collision::ExcludedPair& pair : filter.excluded) {
    const bool adjacent = pair.reason == collision::ExclusionReason::adjacent;
    context.filtered.push_back(
        {pair.linkA, pair.linkB, adjacent ? "joined by a joint" : "overlap at the start",
         adjacent ? std::string() : fmt::format("by {:.2g} mm", 1e3 * pair.depth)});
  }
  return io::explain(scene.model, context);
}

}  // namespace softgauss::app
