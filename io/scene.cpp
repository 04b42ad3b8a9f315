// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/model/mass_properties.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/mesh_defects.hpp"
#include "softgauss/io/detail/scene_actuators.hpp"
#include "softgauss/io/detail/scene_constraints.hpp"
#include "softgauss/io/detail/scene_options.hpp"
#include "softgauss/io/detail/scene_parts.hpp"
#include "softgauss/io/detail/scene_srdf.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/unit_mistakes.hpp"

namespace softgauss::io {
namespace {

using detail::Range;
using detail::YamlMap;
using detail::YamlValue;

constexpr double kWater = 1000.0;  ///< default density [kg/m³]

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Reads one scene, part by part.
class SceneReader {
 public:
  SceneReader(const YamlMap& top, const UrdfOptions& options)
      : top_(top), urdfOptions_(options), meshes_(options.largestMesh) {}

  SceneFile read() {
    top_.expectOnly(detail::kSceneKeys);
    std::string name = std::filesystem::path(top_.file()).stem().string();
    if (const auto* entry = top_.find("name")) name = top_.name(*entry);
    scene_.builder = ModelBuilder(name);
    top_.read("timestep", scene_.builder.options.timestep, Range::positive);
    if (const auto* entry = top_.find("timestep"))
      scene_.timestepWhere = {top_.file(), entry->line};
    top_.read("gravity", scene_.builder.options.gravity);
    materials_["default"];
    if (const auto* entry = top_.find("materials"))
      materials_ = detail::readMaterials(top_.map(*entry));
    scene_.materials.assign(materials_.begin(), materials_.end());
    scene_.groundMaterial = materials_.at("default");
    if (const auto* entry = top_.find("ground")) readGround(*entry);
    if (const auto* entry = top_.find("options"))
      scene_.integration =
          detail::readOptions(top_.map(*entry), scene_.builder.options, scene_.gddSolver);
    const auto forEach = [&](const char* key, const char* noun, auto&& readOne) {
      const YamlMap::Entry* entry = top_.find(key);
      if (!entry) return;
      std::size_t number = 0;
      for (const YamlValue& item : top_.list(*entry)) {
        const std::string label = fmt::format("{} {}", noun, ++number);
        if (item.kind != YamlValue::Kind::map)
          throw ModelError({top_.file(), item.line}, label,
                           fmt::format("found {}, expected a map {{…}}", item.described()));
        readOne(YamlMap(top_.file(), label + ": ", "", item));
      }
    };
    forEach("robots", "robot", [&](const YamlMap& map) { readRobot(map); });
    forEach("objects", "object", [&](const YamlMap& map) { readObject(map); });
    std::set<std::string> actuatorNames;
    forEach("actuators", "actuator", [&](const YamlMap& map) {
      scene_.actuators.push_back(detail::readActuator(map, joints_, scene_.builder, actuatorNames));
    });
    detail::expectIndependent(scene_.actuators);
    if (const auto* entry = top_.find("constraints")) {
      std::size_t number = 0;
      const detail::SceneNames names{linkNames(), joints_};
      for (const YamlValue& item : top_.list(*entry))
        detail::readConstraint(top_.file(), item, ++number, names, scene_.builder);
    }
    readPairsAndWrenches(forEach);
    if (scene_.contents.links == 0)
      throw ModelError({top_.file(), top_.line()}, "scene",
                       top_.find("goals")
                           ? "holds goals alone, expected robots or objects too; give "
                             "it as --goals FILE behind a MODEL"
                           : "holds nothing, expected a list of robots or of "
                             "objects");
    for (const std::filesystem::path& file : meshes_.files()) scene_.contents.files.push_back(file);
    std::vector<std::string> warnings;
    unsoundHulls_.appendTo(warnings);
    for (std::string& warning : warnings) scene_.builder.warning(std::move(warning));
    scene_.hasGoals = top_.find("goals") != nullptr;
    if (const auto* entry = top_.find("collision")) {
      scene_.throughFcl = top_.choice(*entry, {"own", "fcl"}) == "fcl";
      scene_.collisionWhere = {top_.file(), entry->line};
    }
    return std::move(scene_);
  }

 private:
  void readGround(const YamlMap::Entry& entry) {
    if (entry.value.kind == YamlValue::Kind::text && entry.value.text == "none") {
      scene_.noGround = true;
    } else if (entry.value.kind == YamlValue::Kind::map) {
      const YamlMap map = top_.map(entry);
      map.expectOnly({"height", "material"});
      scene_.ground = 0.0;
      map.read("height", *scene_.ground, Range::any);
      scene_.groundMaterial = detail::materialOf(map, materials_);
    } else {
      if (!entry.value.finiteNumber())
        top_.fail(entry, fmt::format("found {}, expected a height [m], none, or a map {{height: …, "
                                     "material: …}}",
                                     entry.value.described()));
      scene_.ground = top_.number(entry);
    }
  }

  /// What names links and shapes of everything above it.
  template <class ForEach>
  void readPairsAndWrenches(const ForEach& forEach) {
    const std::set<std::string> links = linkNames();
    forEach("wrenches", "wrench",
            [&](const YamlMap& map) { scene_.wrenches.push_back(detail::readWrench(map, links)); });
    if (!scene_.noGround) surfaces_.try_emplace("ground", scene_.groundMaterial);
    const std::set<std::string> all = linkNames();
    forEach("pairs", "pair", [&](const YamlMap& map) {
      detail::readPair(map, materials_, surfaces_, all, scene_.builder);
    });
  }

  /// Of links and objects, and of the ground once it has a surface.
  std::set<std::string> linkNames() const {
    std::set<std::string> names;
    for (const auto& [link, surface] : surfaces_) names.insert(names.end(), link);
    return names;
  }

  /// A name that nothing else in the scene has, or none where there is but one thing of its kind.
  std::string ownName(const YamlMap& map, bool mayBeNameless) {
    const YamlMap::Entry* entry = map.find("name");
    if (!entry && mayBeNameless) return {};
    const YamlMap::Entry& found = entry ? *entry : map.required("name", "a name of its own");
    const std::string name = map.name(found);
    if (name.empty() || name == "world" || name == "ground" || name.find('/') != std::string::npos)
      map.fail(found, fmt::format("found {}, expected a name without '/' other than world and "
                                  "ground",
                                  detail::quotedText(name)));
    if (!names_.insert(name).second)
      map.fail(found, fmt::format("found {} a second time, expected a name of its own",
                                  detail::quotedText(name)));
    return name;
  }

  bool flag(const YamlMap& map, const std::string& key, bool otherwise) {
    const YamlMap::Entry* entry = map.find(key);
    return entry ? map.boolean(*entry) : otherwise;
  }

  /// The pose of a robot or an object, with a warning where its angles are probably degrees.
  Transform readPose(const YamlMap& map) {
    const Transform X = detail::readPose(map);
    if (const YamlMap::Entry* rpy = map.find("rpy")) {
      const Vector3 angles = map.vector3(*rpy);
      const std::string meant = detail::radiansMeant({angles.x(), angles.y(), angles.z()});
      if (!meant.empty())
        scene_.builder.warning(fmt::format(
            "rpy of more than a turn, used as written: line {} ({} if it is in degrees)", rpy->line,
            meant));
    }
    return X;
  }

  /// How a floating root starts; a fixed one has no such keys.
  void readStart(const YamlMap& map, const std::string& root, bool floats) {
    SceneFile::Start start;
    start.link = root;
    for (const char* key : {"velocity", "angular_velocity", "on_ground"})
      if (const auto* entry = map.find(key); entry && !floats)
        map.fail(*entry, "is for what floats, and this is fixed to the world");
    map.read("velocity", start.velocity);
    map.read("angular_velocity", start.angularVelocity);
    start.onGround = flag(map, "on_ground", !map.find("position"));
    if (const auto* asked = map.find("on_ground"); asked && start.onGround && scene_.noGround)
      map.fail(*asked,
               "found true with ground: none, where there is no ground to stand on; expected a "
               "position, or ground: {height: …}");
    if (floats) scene_.starts.push_back(start);
  }

  void readRobot(const YamlMap& map) {
    map.expectOnly(std::vector<std::string>{"name", "urdf", "base"} + detail::kPoseKeys +
                   std::vector<std::string>{"velocity", "angular_velocity", "on_ground", "joints",
                                            "joint_velocities", "joint_parameters", "material",
                                            "materials", "collide_as", "srdf", "state"});
    const std::size_t robots = top_.find("robots")->value.items.size();
    const std::string name = ownName(map, robots == 1);
    const YamlMap::Entry& urdf = map.required("urdf", "the name of a URDF file");
    const std::filesystem::path file = detail::existingFile(map, urdf, map.name(urdf));

    UrdfOptions options = urdfOptions_;
    options.base = BaseKind::automatic;
    if (const auto* entry = map.find("base"))
      options.base = map.choice(*entry, {"fixed", "floating"}) == "fixed" ? BaseKind::fixed
                                                                          : BaseKind::floating;
    options.meshes = detail::readMeshUse(map, options.meshes);
    options.material = detail::materialOf(map, materials_);
    if (const auto* entry = map.find("materials")) {
      const YamlMap links = map.map(*entry);
      std::vector<std::string> known;
      for (const auto& [material, parameters] : materials_) known.push_back(material);
      for (const YamlMap::Entry& link : links.entries())
        options.linkMaterials[link.key] = materials_.at(links.choice(link, known));
    }
    UrdfContents contents;
    ModelBuilder robot = readUrdf(file, options, &contents);
    if (const auto* entry = map.find("materials"))
      expectNames(map.map(*entry), contents.linkNames, "link");
    if (const auto* entry = map.find("joint_parameters")) {
      const YamlMap joints = map.map(*entry);
      expectNames(joints, contents.scalarJoints, "joint of one degree of freedom");
      detail::readJointParameters(joints, robot);
    }
    const std::string prefix = name.empty() ? "" : name + "/";
    detail::readSrdfKeys(map, file, contents, prefix, robot, scene_);
    robot.X_WRoot = readPose(map);
    scene_.builder.add(robot, name);
    for (const std::string& link : contents.linkNames) {
      const auto own = options.linkMaterials.find(link);
      surfaces_[prefix + link] =
          own == options.linkMaterials.end() ? options.material : own->second;
    }
    const auto readJoints = [&](const char* key, auto& values) {
      const YamlMap::Entry* entry = map.find(key);
      if (!entry) return;
      const YamlMap joints = map.map(*entry);
      expectNames(joints, contents.scalarJoints, "joint of one degree of freedom");
      for (const YamlMap::Entry& joint : joints.entries())
        values.push_back({prefix + joint.key,
                          joints.number(joint),
                          {map.file(), joint.line},
                          joints.element(joint)});
    };
    readJoints("joints", scene_.positions);
    readJoints("joint_velocities", scene_.velocities);
    for (const std::string& joint : contents.scalarJoints) joints_.insert(prefix + joint);
    const std::string root = robot.rootLinks().front();
    if (root == "world" && name.empty() && options.base == BaseKind::floating &&
        contents.floatingLink.empty())
      map.fail(
          *map.find("base"),
          "found floating, but the root link is 'world', which stands for the world and cannot "
          "float; expected fixed, or a name for the robot, or another one for its root link");
    if (root == "world" && name.empty() &&
        !(robot.X_WRoot.p.isZero(0.0) && robot.X_WRoot.R.isIdentity(0.0)))
      map.fail(*map.find("urdf"),
               "has the root 'world', so it stands where the world is; expected "
               "a name beside its position");
    const bool rootFloats = options.base == BaseKind::floating ||
                            (options.base == BaseKind::automatic && root != "world");
    readStart(map, prefix + (rootFloats ? root : contents.floatingLink),
              rootFloats || !contents.floatingLink.empty());
    scene_.contents.files.insert(scene_.contents.files.end(), contents.files.begin(),
                                 contents.files.end());
    for (const auto& [link, place] : contents.places)
      scene_.contents.places.emplace(prefix + link, place);
    scene_.contents.meshPlaces.insert(contents.meshPlaces.begin(), contents.meshPlaces.end());
    scene_.contents.links += contents.links;
    scene_.contents.joints += contents.joints;
    scene_.contents.mass += contents.mass;
  }

  static void expectNames(const YamlMap& map, const std::vector<std::string>& names,
                          const char* noun) {
    const std::set<std::string> known(names.begin(), names.end());
    for (const YamlMap::Entry& entry : map.entries())
      if (known.count(entry.key) == 0)
        map.fail(entry, fmt::format("found no {} of that name in the URDF{}", noun,
                                    detail::offered(entry.key, names)));
  }

  void readObject(const YamlMap& map) {
    map.expectOnly(std::vector<std::string>{"name"} + detail::kShapeKeys + detail::kPoseKeys +
                   std::vector<std::string>{"mass", "density", "fixed", "velocity",
                                            "angular_velocity", "on_ground", "material", "color",
                                            "collide_as"});
    const std::string name = ownName(map, false);
    Shape shape = detail::readShape(map, meshes_);
    const bool isLandscape = map.find("heights") != nullptr;
    const bool fixed = flag(map, "fixed", shape.kind == ShapeKind::plane || isLandscape);
    if (isLandscape) scene_.contents.files.emplace_back(shape.mesh->file);
    if (!fixed && isLandscape)
      map.fail(*map.find("heights"), "found a landscape that moves, expected it to be fixed");
    const YamlMap::Entry* mass = map.find("mass");
    const YamlMap::Entry* density = map.find("density");
    for (const YamlMap::Entry* entry : {mass, density})
      if (entry && fixed) map.fail(*entry, "is for what moves, and this is fixed to the world");
    if (mass && density)
      map.fail(*density,
               fmt::format("found beside mass in line {}, expected one of them", mass->line));
    if (!fixed && shape.kind == ShapeKind::plane)
      map.fail(*map.find("plane"), "found a plane that moves, expected it to be fixed");

    const MeshUse use = detail::readMeshUse(map, urdfOptions_.meshes);
    if (const YamlMap::Entry* entry = map.find("collide_as"); entry && !map.find("mesh"))
      map.fail(*entry, "is for a mesh, and this is none");
    const bool isMesh = shape.kind == ShapeKind::mesh;
    if (isMesh && use == MeshUse::triangles) shape = Shape::surface(shape.mesh);
    if (isMesh && use == MeshUse::hull) unsoundHulls_.look(*shape.mesh, "object '" + name + "'");

    LinkSpec link;
    link.name = name;
    link.where = {map.file(), map.line()};
    if (!fixed) {
      if (const YamlMap::Entry* mesh = map.find("mesh")) detail::expectVolume(map, *mesh, shape);
      const MassProperties solid =
          solidOf(shape, density ? map.number(*density, Range::positive) : kWater);
      if (!(solid.mass > 0.0))
        throw ModelError(link.where, "object '" + name + "'",
                         "is too small to have a volume, expected larger numbers");
      const double scale = mass ? map.number(*mass, Range::positive) / solid.mass : 1.0;
      link.mass = scale * solid.mass;
      link.com = solid.com;
      link.I_Lcm = scale * solid.I_Gcm;
    }
    ModelBuilder object;
    object.base = fixed ? BaseKind::fixed : BaseKind::floating;
    object.X_WRoot = readPose(map);
    GeometrySpec geometry;
    geometry.name = name;
    geometry.link = name;
    geometry.shape = shape;
    geometry.material = detail::materialOf(map, materials_);
    geometry.where = link.where;
    geometry.automaticMesh = isMesh && use == MeshUse::automatic;
    VisualSpec visual;
    visual.link = name;
    visual.shape = shape;
    if (const auto* entry = map.find("color")) {
      visual.rgba.head<3>() = map.vector3(*entry);
      if (visual.rgba.head<3>().minCoeff() < 0.0 || visual.rgba.head<3>().maxCoeff() > 1.0)
        map.fail(*entry, "found a number outside 0 to 1, expected red, green and blue within");
      object.visual(visual);
    }
    surfaces_[name] = geometry.material;
    scene_.contents.places.emplace(name, link.where);
    if (isMesh)
      scene_.contents.meshPlaces.emplace(
          shape.mesh->file, std::pair(link.where, "object " + detail::quotedText(name)));
    scene_.contents.links += 1;
    scene_.contents.mass += link.mass;
    scene_.builder.add(object.link(link).geometry(geometry), "");
    readStart(map, name, !fixed);
  }

  const YamlMap& top_;
  const UrdfOptions& urdfOptions_;
  SceneFile scene_;
  detail::Materials materials_;
  std::map<std::string, Material> surfaces_;  ///< of links, objects and the ground
  MeshCache meshes_;
  detail::UnsoundHulls unsoundHulls_;
  std::set<std::string> names_;
  std::set<std::string> joints_;  ///< of one degree of freedom
};

}  // namespace

SceneFile readScene(const std::filesystem::path& file, const UrdfOptions& options) {
  const std::string text = detail::readInput(file.string(), "a scene");
  const std::string path = detail::inputName(file.string());
  const YamlValue root = detail::parseYaml(path, text, "robots: [...] or objects: [...]");
  if (root.kind != YamlValue::Kind::map)
    throw ModelError({path, root.line}, "file",
                     fmt::format("found {}, expected keys such as robots: [...] and objects: [...]",
                                 root.described()));
  return SceneReader(YamlMap(path, "", "", root), options).read();
}

}  // namespace softgauss::io
