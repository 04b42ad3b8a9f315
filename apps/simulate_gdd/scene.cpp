// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/scene.hpp"

#include <fmt/format.h>

#include <set>

#include "apps/shared/ground.hpp"
#include "apps/simulate_gdd/error_control.hpp"
#include "apps/simulate_gdd/trial.hpp"
#include "collision/choose_meshes.hpp"
#include "engine/dynamics/coupled_mass.hpp"
#include "engine/dynamics/regular_mass.hpp"
#include "engine/model/followers.hpp"
#include "io/explain.hpp"
#include "io/goals.hpp"
#include "io/names.hpp"
#include "io/scene.hpp"
#include "io/step_warnings.hpp"
#include "io/warning_list.hpp"

namespace softgauss::app {
namespace {

/// `placed` are the bodies of joints whose position is given already.
void setJointPositions(const SimulateOptions& options, const Model& model, std::set<int> placed,
                       State& state) {
  std::set<std::string> seen;
  for (const auto& [name, value] : options.q0) {
    const auto fail = [&](const std::string& problem) {
      throw UsageError(fmt::format("--q0 {}: {}", name, problem));
    };
    if (const std::string problem = io::jointProblem(model, name); !problem.empty()) fail(problem);
    const int body = model.findJoint(name);
    if (!seen.insert(name).second) fail("is given twice");
    for (const JointRange& range : model.ranges)
      if (range.body == body && (value < range.lower || value > range.upper))
        fail(fmt::format("{} lies outside the joint's range {} .. {}", value, range.lower,
                         range.upper));
    state.q[model.bodies[body].q] = value;
    placed.insert(body);
  }
  placeFollowers(model, placed, state.q);
}

/// Links that goals on the command line name.
void checkLinks(const SimulateOptions& options, const Model& model) {
  const auto check = [&](const std::string& option, const std::string& link) {
    if (const std::string problem = io::linkProblem(model, link); !problem.empty())
      throw UsageError(option + ": " + problem);
  };
  for (const ReachArgument& reach : options.reach) check("--reach", reach.link);
  for (const std::string& link : options.hold) check("--hold", link);
}

/// Before anything is done that takes the square of the model's size.
void checkSize(const SimulateOptions& options, const Model& model) {
  if (model.nv > options.mostDofs)
    throw ModelError({options.model.string(), 0}, "model '" + model.name + "'",
                     fmt::format("has {} degrees of freedom, expected at most {} (--most-dofs "
                                 "allows more)",
                                 model.nv, options.mostDofs));
}

void setOptions(const SimulateOptions& options, ModelBuilder& builder) {
  if (options.timestep) builder.options.timestep = *options.timestep;
  if (options.exactDiagonal) builder.options.exactDiagonal = true;
  if (options.noSlip) builder.options.noSlip = true;
  if (options.levelSlip) builder.options.levelSlip = true;
  if (options.cone) builder.options.cone = *options.cone;
  if (options.effects) builder.options.effects = *options.effects;
  if (options.likeMujoco) builder.options.useMujocoModel(*options.likeMujoco);
}

io::UrdfOptions urdfOptions(const SimulateOptions& options) {
  io::UrdfOptions urdf;
  urdf.packagePaths = options.packagePaths;
  urdf.visualMeshes = !options.view.empty();
  urdf.largestMesh = static_cast<std::uintmax_t>(options.largestMesh * (1 << 20));
  urdf.base = options.base;
  urdf.zeroEffortIsUnlimited = options.zeroEffortIsUnlimited;
  urdf.meshes = options.meshes.value_or(io::MeshUse::automatic);
  return urdf;
}

/// Whether --base auto bolts the robot down: it would stand on its root alone.
bool standsOnItsRoot(const SimulateOptions& options, const Model& model) {
  State state(model);
  setJointPositions(options, model, {}, state);
  Kinematics k(model);
  computeKinematics(model, state, k);
  return !model.trees.empty() && model.floats(0) && looksBolted(model, k, 0);
}

/// A robot alone, as the command line says.
void loadRobot(const SimulateOptions& options, Scene& scene) {
  ModelBuilder builder = io::readUrdf(options.model, urdfOptions(options), &scene.contents);
  setOptions(options, builder);
  setErrorControl(options, {}, options.hasGoals(), builder);
  checkSteps(options, builder.options.timestep, {});
  if (options.base != BaseKind::automatic) scene.baseOrigin = BaseOrigin::option;
  if (options.guessBase) scene.baseOrigin = BaseOrigin::guess;
  scene.model = builder.build();
  if (options.guessBase && standsOnItsRoot(options, scene.model)) {
    builder.base = BaseKind::fixed;
    scene.model = builder.build();
  }
  checkSize(options, scene.model);

  // Whether there is ground by default is known only once the base is.
  std::optional<double> ground = options.ground;
  if (options.groundIsDefault && hasFloatingBase(scene.model)) ground = 0.0;
  if (ground) {
    addGround(builder, *ground, {});
    scene.model = builder.build();
  }
  scene.initial = State(scene.model);
  setJointPositions(options, scene.model, {}, scene.initial);
  if (options.baseHeight) {
    for (const Tree& tree : scene.model.trees)
      if (scene.model.bodies[tree.rootBody].joint == JointKind::floating)
        scene.initial.q[scene.model.bodies[tree.rootBody].q + 2] = *options.baseHeight;
  } else if (ground) {
    standOnGround(scene.model, *ground, nullptr, scene.initial);
  }
}

void loadSceneFile(const SimulateOptions& options, Scene& scene) {
  io::SceneFile file = io::readScene(options.model, urdfOptions(options));
  setOptions(options, file.builder);
  const bool goalsOfFile = file.hasGoals && !options.passive && options.torques.empty();
  std::vector<std::string> warnings =
      setErrorControl(options, file.integration, options.hasGoals() || goalsOfFile, file.builder);
  std::optional<double> ground = file.ground;
  if (!ground && !file.noGround && !file.starts.empty()) ground = 0.0;
  if (ground) addGround(file.builder, *ground, file.groundMaterial);
  scene.model = file.builder.build();
  checkSize(options, scene.model);
  checkSteps(options, scene.model.options.timestep,
             options.timestep ? SourceLocation{} : file.timestepWhere);
  for (std::string& warning : warnings) scene.model.warnings.push_back(std::move(warning));
  scene.contents = file.contents;
  scene.baseOrigin = BaseOrigin::scene;
  scene.hasGoals = file.hasGoals;
  if (file.gddSolver) scene.gddSolver = *file.gddSolver;
  if (file.throughFcl && !options.throughFcl && options.islands)
    throw ModelError(file.collisionWhere, "key 'collision'",
                     "found fcl, which looks at the whole scene, expected own beside --islands");
  scene.fileSaysFcl = file.throughFcl;
  scene.materials = file.materials;
  scene.wrenches = file.wrenches;
  scene.actuators = file.actuators;
  scene.schedule = io::WrenchSchedule(scene.model, file.wrenches);
  scene.initial = file.initialState(scene.model);
  setJointPositions(options, scene.model, file.placedJoints(scene.model), scene.initial);
  if (!ground) return;
  std::vector<std::string> standing;
  for (const io::SceneFile::Start& start : file.starts)
    if (start.onGround) standing.push_back(start.link);
  standOnGround(scene.model, *ground, &standing, scene.initial);
}

/// Refuses a start in which the mass matrix is singular, with the place of the link in its file.
void expectRegularStart(Scene& scene) {
  steadyCoupledJoints(scene.model, scene.initial.q);
  const auto refuseIfSingular = [&](const VectorX& q) {
    const std::optional<SingularMass> why = findSingularMass(scene.model, q);
    if (!why) return;
    const auto place = scene.contents.places.find(why->link);
    throw ModelError(place == scene.contents.places.end() ? SourceLocation{} : place->second,
                     why->element, why->problem);
  };
  refuseIfSingular(scene.initial.q);
  // The weights of rows are of joints at zero, or else of q0 (inverse_weight.hpp).
  if (findSingularMass(scene.model, scene.model.q0)) scene.model.q0 = scene.initial.q;
}

/// What the step cannot carry from this start.
void addStepWarnings(Scene& scene) {
  Kinematics k(scene.model);
  computeKinematics(scene.model, scene.initial, k);
  ContactSet touching;
  scene.contacts->detect(scene.model, k, touching);
  for (std::string& warning : io::stepWarnings(scene.model, touching))
    scene.model.warnings.push_back(std::move(warning));
  scene.model.warnings = io::grouped(scene.model.warnings);
}

/// Where contacts come from. Throws ModelError where a mesh cannot collide.
void prepareContacts(const SimulateOptions& options, Scene& scene) {
  collision::PreparedMeshes meshes;
  // MuJoCo takes hulls.
  if (options.meshes || scene.model.options.ownSoftness)
    collision::chooseMeshes(scene.model, meshes);
  scene.contacts = std::make_unique<collision::SceneContacts>(
      scene.model, collision::SceneContacts::kBroadphasePairs, true, &meshes);
  if (options.throughFcl.value_or(scene.fileSaysFcl))
    scene.throughFcl = std::make_unique<collision::FclContacts>(scene.model, &meshes);
  if (std::optional<std::string> told = collision::baseWarning(scene.contacts->filter()))
    scene.model.warnings.push_back(std::move(*told));
}

}  // namespace

std::unique_ptr<Scene> loadScene(const SimulateOptions& options) {
  auto scene = std::make_unique<Scene>();
  if (options.isScene())
    loadSceneFile(options, *scene);
  else
    loadRobot(options, *scene);
  if (options.gddSolver) scene->gddSolver = *options.gddSolver;
  checkOutputs(options, scene->contents.files);
  checkLinks(options, scene->model);
  expectRegularStart(*scene);
  try {
    prepareContacts(options, *scene);
  } catch (const ModelError& error) {
    // Of a mesh that has no surface, say: collision knows its file alone.
    for (const auto& [file, place] : scene->contents.meshPlaces)
      if (std::string(error.what()).starts_with(file))
        throw ModelError(place.first, place.second, error.what());
    throw;
  }
  scene->bases = baseNotes(scene->model, scene->initial, *scene->contacts, scene->baseOrigin);
  addStepWarnings(*scene);
  return scene;
}

/// Of the posture about the start that goals on the command line come with: it holds what they
/// leave free, and takes less than a millimetre of a reach.
constexpr double kWeakPosture = 0.01;

void setUp(const SimulateOptions& options, const Scene& scene,
           gdd::GoalDirectedController& controller) {
  controller.solver = scene.gddSolver;
  controller.box = io::controlBox(scene.model, scene.actuators);
  if (options.passive || !options.torques.empty()) return;
  std::vector<std::unique_ptr<gdd::Goal>> goals;
  for (const std::filesystem::path& file :
       {scene.hasGoals ? options.model : std::filesystem::path(), options.goals}) {
    if (file.empty()) continue;
    io::GoalFile asked = io::readGoalFile(file, scene.model, scene.initial);
    if (asked.controlCost) controller.controlCost = *asked.controlCost;
    for (std::unique_ptr<gdd::Goal>& goal : asked.goals) goals.push_back(std::move(goal));
  }
  for (const ReachArgument& r : options.reach) {
    auto goal = std::make_unique<gdd::Reach>(scene.model, r.link, r.p_WTarget, r.p_FP);
    if (r.weight) goal->weight = *r.weight;
    goals.push_back(std::move(goal));
  }
  for (const std::string& link : options.hold)
    goals.push_back(std::make_unique<gdd::Hold>(scene.model, link));
  if (options.hasOwnGoals()) {
    auto posture = std::make_unique<gdd::Posture>(scene.initial.q);
    posture->weight = options.posture.value_or(kWeakPosture);
    posture->onlyRegularises = !options.posture;
    goals.push_back(std::move(posture));
    goals.push_back(std::make_unique<gdd::VirtualDamping>());
  }
  if (options.controlCost) controller.controlCost = *options.controlCost;
  controller.goals = std::move(goals);
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
  context.apartPairs = filter.apartPairs;
  context.costs = tryEffects(scene);
  context.materials = scene.materials;
  for (const collision::ExcludedPair& pair : filter.excluded) {
    const bool adjacent = pair.reason == collision::ExclusionReason::adjacent;
    context.filtered.push_back(
        {pair.linkA, pair.linkB, adjacent ? "joined by a joint" : "overlap at the start",
         adjacent ? std::string() : fmt::format("by {:.2g} mm", 1e3 * pair.depth)});
  }
  return io::explain(scene.model, context);
}

}  // namespace softgauss::app
