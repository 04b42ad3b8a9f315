// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Parts of a scene file that are used in several places.

#include <map>
#include <string>

#include "softgauss/engine/model/shape.hpp"
#include "softgauss/io/detail/yaml.hpp"
#include "softgauss/io/mesh.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss::io::detail {

/// The keys of a scene file.
inline const std::vector<std::string> kSceneKeys = {
    "name",    "timestep",     "gravity",     "ground", "materials", "robots",
    "objects", "actuators",    "constraints", "pairs",  "wrenches",  "options",
    "goals",   "control_cost", "collision",   "plan"};

/// Materials by name; "default" is there from the start.
using Materials = std::map<std::string, Material>;

/// Keys of a surface, which a material has and a pair may have, and what they say: it replaces
/// what `material` holds.
inline const std::vector<std::string> kSurfaceKeys = {"friction",
                                                      "torsional_friction",
                                                      "rolling_friction",
                                                      "condim",
                                                      "margin",
                                                      "priority",
                                                      "mix_weight",
                                                      "stiffness",
                                                      "rest_depth",
                                                      "damping",
                                                      "time_constant",
                                                      "damping_ratio",
                                                      "reference_stiffness",
                                                      "reference_damping",
                                                      "impedance"};
void readSurface(const YamlMap& map, Material& material);

/// `materials: {name: {friction: …}}`
Materials readMaterials(const YamlMap& map);
/// The material that the key `material` names, or the default one.
Material materialOf(const YamlMap& map, const Materials& materials);

/// Keys that say how soft a constraint is, and what they say.
inline const std::vector<std::string> kSoftnessKeys = {
    "time_constant", "damping_ratio", "reference_stiffness", "reference_damping", "impedance"};
void readSoftness(const YamlMap& map, Impedance& impedance);

/// The keys that give a pose, and the pose they give: `position`, and `rpy` or `quaternion`.
inline const std::vector<std::string> kPoseKeys = {"position", "rpy", "quaternion"};
Transform readPose(const YamlMap& map);

/// The keys of shapes, of which an object has one, and that shape.
inline const std::vector<std::string> kShapeKeys = {"sphere", "box",   "cylinder", "capsule",
                                                    "mesh",   "plane", "heights"};
Shape readShape(const YamlMap& map, MeshCache& meshes);

/// What the key `collide_as` says, or `otherwise`.
MeshUse readMeshUse(const YamlMap& map, MeshUse otherwise);

/// Refuses a mesh that encloses no volume, and so gives no mass.
void expectVolume(const YamlMap& map, const YamlMap::Entry& entry, const Shape& shape);

/// A file named relative to the scene's own folder; it must exist.
std::filesystem::path existingFile(const YamlMap& map, const YamlMap::Entry& entry,
                                   const std::string& text);

}  // namespace softgauss::io::detail
