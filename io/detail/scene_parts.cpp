// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/scene_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/model/mass_properties.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/mesh_defects.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/height_field.hpp"

namespace softgauss::io::detail {
namespace {

/// Two keys that say the same in different words.
[[noreturn]] void refuseBeside(const YamlMap& map, const YamlMap::Entry& entry,
                               const YamlMap::Entry& other) {
  map.fail(entry, fmt::format("found beside {} in line {}, expected one or the other", other.key,
                              other.line));
}

void readImpedance(const YamlMap& map, Impedance& impedance) {
  map.expectOnly({"minimum", "maximum", "width", "midpoint", "power"});
  const auto share = [&](const std::string& key, double& x) {
    const YamlMap::Entry* entry = map.find(key);
    if (!entry) return;
    x = map.number(*entry);
    if (!(x > 0.0 && x < 1.0))
      map.fail(*entry, fmt::format("found {}, expected a number between 0 and 1",
                                   entry->value.described()));
  };
  share("minimum", impedance.dMin);
  share("maximum", impedance.dMax);
  share("midpoint", impedance.midpoint);
  map.read("width", impedance.width, Range::positive);
  if (const YamlMap::Entry* entry = map.find("power")) {
    impedance.power = map.number(*entry);
    if (impedance.power < 1.0)
      map.fail(*entry, fmt::format("found {}, expected a number >= 1", entry->value.described()));
  }
}

/// A contact's softness in physical units, if the map has one.
bool readSpring(const YamlMap& map, std::optional<ContactSpring>& spring) {
  const auto *stiffness = map.find("stiffness"), *depth = map.find("rest_depth");
  const auto *damping = map.find("damping"), *ratio = map.find("damping_ratio");
  const YamlMap::Entry* by = stiffness ? stiffness : depth;
  if (!by) {
    if (damping)
      map.fail(*damping, "found without stiffness [N/m] or rest_depth [m], expected one of them");
    return false;
  }
  if (stiffness && depth) refuseBeside(map, *depth, *stiffness);
  if (damping && ratio) refuseBeside(map, *ratio, *damping);
  for (const char* key : {"time_constant", "reference_stiffness", "reference_damping", "impedance"})
    if (const auto* other = map.find(key)) refuseBeside(map, *other, *by);
  spring.emplace();
  map.read("stiffness", spring->stiffness, Range::positive);
  map.read("rest_depth", spring->restDepth, Range::positive);
  spring->dampingRatio = damping ? 0.0 : 1.0;
  map.read("damping", spring->damping, Range::notNegative);
  map.read("damping_ratio", spring->dampingRatio, Range::notNegative);
  return true;
}

int readPriority(const YamlMap& map, const YamlMap::Entry& entry) {
  constexpr double kHighest = 1e6;
  const double priority = map.number(entry);
  if (priority != std::round(priority) || std::abs(priority) > kHighest)
    map.fail(entry, fmt::format("found {}, expected a whole number within {:g}",
                                entry.value.described(), kHighest));
  return static_cast<int>(priority);
}

}  // namespace

void readSurface(const YamlMap& map, Material& m) {
  if (const auto* gap = map.find("gap"))
    map.fail(*gap,
             "is not known: in MuJoCo 3.9 and later a gap lists contacts that do not push yet; "
             "expected none, or for older files the margin less the gap as margin");
  map.read("friction", m.slidingFriction, Range::notNegative);
  map.read("torsional_friction", m.torsionalFriction, Range::notNegative);
  map.read("rolling_friction", m.rollingFriction, Range::notNegative);
  if (const auto* entry = map.find("condim")) m.condim = map.integer(*entry, {1, 3, 4, 6});
  map.read("margin", m.margin, Range::notNegative);
  if (const auto* entry = map.find("priority")) m.priority = readPriority(map, *entry);
  map.read("mix_weight", m.mixWeight, Range::notNegative);
  if (readSpring(map, m.spring)) return;
  for (const std::string& key : kSoftnessKeys)
    if (map.find(key)) m.spring.reset();
  readSoftness(map, m.impedance);
}

void readSoftness(const YamlMap& map, Impedance& impedance) {
  if (map.find("time_constant") || map.find("damping_ratio")) impedance.direct.reset();
  map.read("time_constant", impedance.timeConstant, Range::positive);
  map.read("damping_ratio", impedance.dampingRatio, Range::positive);
  const auto* stiffness = map.find("reference_stiffness");
  const auto* damping = map.find("reference_damping");
  if (stiffness || damping) {
    for (const char* key : {"time_constant", "damping_ratio"})
      if (const auto* other = map.find(key))
        refuseBeside(map, *other, stiffness ? *stiffness : *damping);
    impedance.direct.emplace();
    impedance.direct->stiffness = map.number(
        map.required("reference_stiffness", "it beside reference_damping"), Range::notNegative);
    impedance.direct->damping = map.number(
        map.required("reference_damping", "it beside reference_stiffness"), Range::notNegative);
  }
  if (const auto* entry = map.find("impedance")) readImpedance(map.map(*entry), impedance);
}

Materials readMaterials(const YamlMap& map) {
  Materials materials;
  materials["default"];
  for (const YamlMap::Entry& entry : map.entries()) {
    const YamlMap surface = map.map(entry);
    readSurface(surface, materials[entry.key] = Material{});
    surface.expectOnly(kSurfaceKeys);
  }
  return materials;
}

Material materialOf(const YamlMap& map, const Materials& materials) {
  const YamlMap::Entry* entry = map.find("material");
  const auto known = materials.find(entry ? entry->value.text : "default");
  if (known != materials.end()) return known->second;
  std::vector<std::string> names;
  for (const auto& [name, material] : materials) names.push_back(name);
  return materials.at(map.choice(*entry, names));  // tells the names
}

Transform readPose(const YamlMap& map) {
  Transform X;
  map.read("position", X.p);
  const YamlMap::Entry* rpy = map.find("rpy");
  const YamlMap::Entry* quaternion = map.find("quaternion");
  if (rpy && quaternion)
    map.fail(*quaternion,
             fmt::format("found beside rpy in line {}, expected one of them", rpy->line));
  if (rpy) X.R = rpyRotation(map.vector3(*rpy));
  if (quaternion) {
    const char* const expected = "four numbers [w, x, y, z] of length 1";
    const std::vector<double> items = map.numbers(*quaternion, 4, 4, expected);
    const Eigen::Vector4d q(items[0], items[1], items[2], items[3]);
    if (std::abs(q.norm() - 1.0) > 1e-3)
      map.fail(*quaternion,
               fmt::format("found {}, expected {}", quaternion->value.described(), expected));
    X.R = Quaternion(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }
  return X;
}

namespace {

/// `heights: {file, size, height, base}`
Shape readLandscape(const YamlMap& map) {
  map.expectOnly({"file", "size", "height", "base"});
  const YamlMap::Entry& file = map.required("file", "the name of a .png or .csv file");
  const YamlMap::Entry& size = map.required("size", "two lengths [x, y] [m]");
  const std::vector<double> lengths =
      map.numbers(size, 2, 2, "two lengths above 0, [x, y] [m]", Range::positive);
  const double height =
      map.number(map.required("height", "the height of white, or of 1 in a .csv [m]"), Range::any);
  double base = 0.5 * std::min(lengths[0], lengths[1]);
  map.read("base", base, Range::positive);
  const std::filesystem::path path = existingFile(map, file, map.name(file));
  Mesh mesh = heightFieldMesh(readHeights(path), lengths[0], lengths[1], height, base);
  mesh.file = path.string();
  return Shape::surface(std::make_shared<const Mesh>(std::move(mesh)));
}

}  // namespace

Shape readShape(const YamlMap& map, MeshCache& meshes) {
  const YamlMap::Entry* found = nullptr;
  for (const std::string& key : kShapeKeys) {
    const YamlMap::Entry* entry = map.find(key);
    if (entry && found)
      map.fail(*entry, fmt::format("found beside {} in line {}, expected one shape", found->key,
                                   found->line));
    if (entry) found = entry;
  }
  const YamlMap::Entry& only =
      found ? *found : map.required("sphere", "a shape: one of " + listed(kShapeKeys));
  const YamlMap size = map.map(only);
  const auto length = [&](const std::string& key) {
    return size.number(size.required(key, "a length [m]"), Range::positive);
  };
  if (only.key == "plane") {
    size.expectOnly({});
    return Shape::plane();
  }
  if (only.key == "sphere") {
    size.expectOnly({"radius"});
    return Shape::sphere(length("radius"));
  }
  if (only.key == "box") {
    size.expectOnly({"size"});
    const YamlMap::Entry& entry = size.required("size", "three lengths [x, y, z] [m]");
    const Vector3 full = size.vector3(entry);
    if (!(full.minCoeff() >= kSmallestNumber))
      size.fail(entry,
                full.minCoeff() > 0.0
                    ? fmt::format("found a length below {:g}, expected more", kSmallestNumber)
                    : "found a length of 0 or less, expected more");
    return Shape::box(0.5 * full);
  }
  if (only.key == "mesh") {
    size.expectOnly({"file", "scale"});
    const YamlMap::Entry& entry = size.required("file", "the name of a mesh file");
    Vector3 scale = Vector3::Ones();
    size.read("scale", scale);
    return Shape::hull(meshes.get(existingFile(size, entry, size.name(entry)), scale));
  }
  if (only.key == "heights") return readLandscape(size);
  size.expectOnly({"radius", "length"});
  const double radius = length("radius"), half = 0.5 * length("length");
  return only.key == "cylinder" ? Shape::cylinder(radius, half) : Shape::capsule(radius, half);
}

MeshUse readMeshUse(const YamlMap& map, MeshUse otherwise) {
  const YamlMap::Entry* entry = map.find("collide_as");
  if (!entry) return otherwise;
  return map.choice(*entry, {"hull", "triangles"}) == "hull" ? MeshUse::hull : MeshUse::triangles;
}

void expectVolume(const YamlMap& map, const YamlMap::Entry& entry, const Shape& shape) {
  std::vector<std::string> found = describeDefects(*shape.mesh, surfaceDefects(*shape.mesh));
  if (found.empty() && !(solidOf(shape, 1.0).mass > 0.0))
    found.push_back("triangles that enclose nothing");
  if (!found.empty())
    map.fail(entry, fmt::format("found {} with {}: its volume, and so its mass, is undefined; "
                                "expected a closed mesh whose triangles face outwards; try a mesh "
                                "tool that fills holes and orients faces, or a robot, whose URDF "
                                "gives the inertia",
                                quotedText(shape.mesh->file), listed(found)));
}

std::filesystem::path existingFile(const YamlMap& map, const YamlMap::Entry& entry,
                                   const std::string& text) {
  std::filesystem::path path = text;
  if (path.is_relative()) path = std::filesystem::path(map.file()).parent_path() / path;
  if (std::string problem = inputProblem(path.string()); !problem.empty())
    map.fail(entry,
             fmt::format("found no file {}: {}; expected one, relative to the scene's folder",
                         quotedText(path.string()), problem));
  return path;
}

}  // namespace softgauss::io::detail
