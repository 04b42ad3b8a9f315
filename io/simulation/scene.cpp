// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "softgauss/collision/choose_meshes.hpp"
#include "softgauss/engine/dynamics/coupled_mass.hpp"
#include "softgauss/engine/dynamics/regular_mass.hpp"
#include "softgauss/engine/step/sleep.hpp"
#include "softgauss/io/inputs.hpp"
#include "softgauss/io/mjcf.hpp"
#include "softgauss/io/mjcf/option.hpp"
#include "softgauss/io/simulation/error_control.hpp"
#include "softgauss/io/simulation/ground.hpp"
#include "softgauss/io/step_warnings.hpp"
#include "softgauss/io/warning_list.hpp"

namespace softgauss {
namespace {

/// Before anything is done that takes the square of the model's size.
void checkSize(const SimulationOptions& options, const Scene& scene) {
  if (scene.model.nv > options.mostDofs)
    throw ModelError({scene.file.string(), 0}, "model '" + scene.model.name + "'",
                     fmt::format("has {} degrees of freedom, expected at most {} (--most-dofs "
                                 "allows more)",
                                 scene.model.nv, options.mostDofs));
}

void setOptions(const SimulationOptions& options, Options& o) {
  if (options.timestep) o.timestep = *options.timestep;
  if (options.exactDiagonal) o.exactDiagonal = true;
  if (options.mechanisms) o.mechanisms = *options.mechanisms;
  if (options.cone) o.cone = *options.cone;
  if (options.sleep) o.sleep = *options.sleep;
  if (options.effects) o.effects = *options.effects;
  if (options.likeMujoco) o.useMujocoModel(*options.likeMujoco);
}

io::UrdfOptions urdfOptions(const SimulationOptions& options) {
  io::UrdfOptions urdf;
  urdf.packagePaths = options.packagePaths;
  urdf.visualMeshes = options.visualMeshes;
  urdf.largestMesh = static_cast<std::uintmax_t>(options.largestMesh * (1 << 20));
  urdf.base = options.base;
  urdf.zeroEffortIsUnlimited = options.zeroEffortIsUnlimited;
  urdf.inferInertia = options.inferInertia;
  urdf.meshes = options.meshes.value_or(io::MeshUse::automatic);
  return urdf;
}

/// Whether --base auto bolts the robot down: it would stand on its root alone.
bool standsOnItsRoot(const SimulationOptions& options, const Model& model) {
  State state(model);
  setJointPositions(model, options.q0, state);
  Kinematics k(model);
  computeKinematics(model, state, k);
  return !model.trees.empty() && model.floats(0) && looksBolted(model, k, 0);
}

/// Reads the SRDF of the URDF, if there is one. What it keeps apart never collides.
void readSrdfOf(const SimulationOptions& options, Scene& scene, ModelBuilder& builder) {
  io::SrdfChoice choice{options.srdf, options.state, true, "--srdf FILE"};
  // MuJoCo knows no SRDF.
  choice.search = builder.options.constraintModel == ConstraintModel::softgauss;
  std::vector<std::string> warnings;
  io::Srdf srdf = io::chooseSrdf(scene.file, builder.name(), choice, {scene.file.string(), 0},
                                 fmt::format("state '{}'", options.state), warnings);
  for (std::string& warning : warnings) builder.warning(std::move(warning));
  if (srdf.file.empty()) return;
  scene.contents.files.push_back(srdf.file);
  for (const auto& [linkA, linkB] : srdf.apartAmong(scene.contents.linkNames))
    builder.keepApart(linkA, linkB);
  if (options.srdf.empty())
    scene.notes.push_back(describe(srdf, scene.contents.linkNames, "--state"));
  scene.srdfs.push_back({std::move(srdf), options.state, ""});
}

/// The joints at the start.
void placeJoints(const SimulationOptions& options, Scene& scene) {
  scene.initial = State(scene.model);
  for (const io::RobotSrdf& robot : scene.srdfs)
    if (!robot.state.empty())
      for (std::string& warning :
           io::placeState(scene.model, robot.srdf, robot.state, "", scene.initial.q))
        scene.model.warnings.push_back(std::move(warning));
  setJointPositions(scene.model, options.q0, scene.initial);
}

/// A robot alone, as the options say.
void loadRobot(const SimulationOptions& options, Scene& scene) {
  ModelBuilder builder = io::readUrdf(scene.file, urdfOptions(options), &scene.contents);
  setOptions(options, builder.options);
  setErrorControl(options, {}, builder.options);
  readSrdfOf(options, scene, builder);
  if (options.base != BaseKind::automatic) scene.baseOrigin = BaseOrigin::option;
  if (options.guessBase) scene.baseOrigin = BaseOrigin::guess;
  scene.model = builder.build();
  if (options.guessBase && standsOnItsRoot(options, scene.model)) {
    builder.base = BaseKind::fixed;
    scene.model = builder.build();
  }
  checkSize(options, scene);

  // Whether there is ground by default is known only once the base is.
  scene.ground = options.ground;
  if (options.groundIsDefault && hasFloatingBase(scene.model)) scene.ground = 0.0;
  if (scene.ground) {
    addGround(builder, *scene.ground, {});
    scene.model = builder.build();
  }
  placeJoints(options, scene);
  if (options.baseHeight) {
    for (const Tree& tree : scene.model.trees)
      if (scene.model.bodies[tree.rootBody].joint == JointKind::floating)
        scene.initial.q[scene.model.bodies[tree.rootBody].q + 2] = *options.baseHeight;
  } else if (scene.ground) {
    standOnGround(scene.model, *scene.ground, nullptr, scene.initial);
  }
}

void loadSceneFile(const SimulationOptions& options, Scene& scene) {
  if (!options.state.empty() || !options.srdf.empty())
    throw OptionError(fmt::format("{} is for a URDF; a scene file says it itself",
                                  options.state.empty() ? "srdf" : "state"));
  io::SceneFile file = io::readScene(scene.file, urdfOptions(options));
  setOptions(options, file.builder.options);
  std::vector<std::string> warnings =
      setErrorControl(options, file.integration, file.builder.options);
  scene.ground = file.ground;
  if (!scene.ground && !file.noGround && !file.starts.empty()) scene.ground = 0.0;
  if (scene.ground) addGround(file.builder, *scene.ground, file.groundMaterial);
  scene.model = file.builder.build();
  if (options.withoutServos)
    for (Dof& dof : scene.model.dofs) dof.servo = {};
  checkSize(options, scene);
  for (std::string& warning : warnings) scene.model.warnings.push_back(std::move(warning));
  scene.contents = file.contents;
  scene.baseOrigin = BaseOrigin::scene;
  scene.hasGoals = file.hasGoals;
  if (file.gddSolver) scene.gddSolver = *file.gddSolver;
  scene.fileSaysFcl = file.throughFcl;
  if (!options.timestep) scene.timestepWhere = file.timestepWhere;
  scene.collisionWhere = file.collisionWhere;
  scene.materials = file.materials;
  scene.srdfs = file.srdfs;
  scene.notes = file.notes;
  scene.wrenches = file.wrenches;
  scene.actuators = file.actuators;
  scene.schedule = io::WrenchSchedule(scene.model, file.wrenches);
  scene.initial = file.initialState(scene.model, &scene.model.warnings);
  setJointPositions(scene.model, options.q0, scene.initial);
  if (!scene.ground) return;
  std::vector<std::string> standing;
  for (const io::SceneFile::Start& start : file.starts)
    if (start.onGround) standing.push_back(start.link);
  standOnGround(scene.model, *scene.ground, &standing, scene.initial);
}

/// What an MJCF says by numbers that softgauss gives another meaning.
void noteMeanings(const io::MjcfFile& file, const Options& o, Scene& scene) {
  const bool likeMujoco = o.constraintModel == ConstraintModel::mujoco;
  if (file.givesSoftness && !likeMujoco)
    scene.notes.emplace_back(
        "solref and solimp of the file: by softgauss's law, with MuJoCo's numbers "
        "(--compatibility mujoco: by MuJoCo's)");
  if (file.namesIntegrator && (!likeMujoco || file.integrator == "implicitfast"))
    scene.notes.push_back(fmt::format("integrator {} of the file: {} steps in its place",
                                      file.integrator, integratorName(o.integrator)));
}

/// An MJCF: bodies stand where it puts them, on ground that it has as a plane.
void loadMjcf(const SimulationOptions& options, Scene& scene) {
  for (const auto& [given, option] :
       {std::pair(options.base != BaseKind::automatic || options.guessBase, "base"),
        {options.baseHeight.has_value(), "base-height"},
        {!options.srdf.empty() && options.srdf != "none", "srdf"}})
    if (given) throw OptionError(fmt::format("{} is for a URDF; an MJCF says it itself", option));
  io::MjcfFile file = io::readMjcf(scene.file, urdfOptions(options));
  ModelBuilder& builder = file.scene.builder;
  setOptions(options, builder.options);
  io::IntegrationKeys keys;
  if (builder.options.constraintModel == ConstraintModel::mujoco) {
    builder.options.integrator = io::mjcf::integratorOf(file.integrator);
    keys.integrator = true;
  }
  setErrorControl(options, keys, builder.options);
  scene.notes = file.scene.notes;
  noteMeanings(file, builder.options, scene);
  scene.ground = options.ground;
  if (scene.ground) addGround(builder, *scene.ground, {});
  scene.model = builder.build();
  checkSize(options, scene);
  scene.contents = file.scene.contents;
  scene.baseOrigin = BaseOrigin::scene;
  scene.actuators = file.scene.actuators;
  if (!options.timestep) scene.timestepWhere = file.scene.timestepWhere;
  if (!options.withoutServos) file.setServos(scene.model, options.state);
  scene.initial = file.initialState(scene.model, options.state);
  setJointPositions(scene.model, options.q0, scene.initial);
}

/// Refuses a start in which the mass matrix is singular, with the place of the link in its file.
void expectRegularStart(Scene& scene) {
  regulariseCoupledJoints(scene.model, scene.initial.q);
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
void prepareContacts(const SimulationOptions& options, Scene& scene) {
  collision::PreparedMeshes meshes;
  // MuJoCo takes hulls.
  if (options.meshes || scene.model.options.constraintModel == ConstraintModel::softgauss)
    collision::chooseMeshes(scene.model, meshes);
  scene.contacts = std::make_unique<collision::SceneContacts>(
      scene.model, collision::SceneContacts::kBroadphasePairs, true, &meshes);
  if (options.throughFcl.value_or(scene.fileSaysFcl))
    scene.throughFcl = std::make_unique<collision::FclContacts>(scene.model, &meshes);
  if (std::optional<std::string> told = collision::baseWarning(scene.contacts->filter()))
    scene.model.warnings.push_back(std::move(*told));
}

/// How a user has robots start elsewhere.
std::string otherStart(const Scene& scene) {
  std::vector<std::string> states;
  for (const io::RobotSrdf& robot : scene.srdfs)
    for (const std::string& state : robot.srdf.stateNames())
      if (state != robot.state) states.push_back(state);
  const bool isFile = isSceneFile(scene.file);
  if (states.empty()) return isFile ? "the key 'joints'" : "--q0 JOINT=VALUE";
  return fmt::format("{} {}", isFile ? "the key 'state':" : "--state", fmt::join(states, ", "));
}

}  // namespace

bool isSceneFile(const std::filesystem::path& file) {
  if (file == io::kStandardInput) return !io::standardInputIsXml();
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

std::unique_ptr<Scene> loadScene(const std::filesystem::path& file,
                                 const SimulationOptions& options) {
  auto scene = std::make_unique<Scene>();
  scene->file = file;
  if (isSceneFile(file))
    loadSceneFile(options, *scene);
  else if (io::isMjcf(file))
    loadMjcf(options, *scene);
  else
    loadRobot(options, *scene);
  if (options.gddSolver) scene->gddSolver = *options.gddSolver;
  if (const Options& o = scene->model.options; o.sleep.enabled && !Sleepers::mayBeOf(o))
    throw OptionError(fmt::format("sleep: {}", Sleepers::kIntegrators));
  expectRegularStart(*scene);
  try {
    prepareContacts(options, *scene);
  } catch (const ModelError& error) {
    // Of a mesh that has no surface, say: collision knows its file alone.
    for (const auto& [mesh, place] : scene->contents.meshPlaces)
      if (std::string(error.what()).starts_with(mesh))
        throw ModelError(place.first, place.second, error.what());
    throw;
  }
  scene->bases = baseNotes(scene->model, scene->initial, *scene->contacts, scene->baseOrigin,
                           otherStart(*scene));
  for (const std::string& stance : scene->bases.stances) scene->model.warnings.push_back(stance);
  addStepWarnings(*scene);
  return scene;
}

std::unique_ptr<Scene> copyOf(const Scene& scene) {
  auto copy = std::make_unique<Scene>();
  static_cast<SceneParts&>(*copy) = scene;
  copy->contacts = std::make_unique<collision::SceneContacts>(copy->model);
  if (scene.throughFcl) copy->throughFcl = std::make_unique<collision::FclContacts>(copy->model);
  return copy;
}

std::string failureText(const Model& model, const State& state, const Data& data) {
  if (data.stats.status == SolveStatus::badInput)
    return fmt::format("the step at t = {:.6g} s was refused: {}", state.time,
                       describe(model, data.stats.badInput));
  std::string where = "the state";
  if (data.stats.badDof >= 0)
    where = fmt::format("joint '{}'", model.jointNames[model.dofs[data.stats.badDof].body]);
  std::string deepest;
  double depth = 0.0;
  for (const Contact& c : data.contacts.contacts) {
    if (!(-c.distance > depth)) continue;
    depth = -c.distance;
    deepest =
        fmt::format("; deepest contact: {} on {}, {:.3g} m", model.geometries[c.geometryA].name,
                    model.geometries[c.geometryB].name, depth);
  }
  return fmt::format("the simulation became non-finite at t = {:.6g} s at {}{}", state.time, where,
                     deepest);
}

}  // namespace softgauss
