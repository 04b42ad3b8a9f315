// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Reads URDF files.
///
/// Versions 1.0, 1.1 (quat_xyzw, capsule) and 1.2 (more limits, which have no effect).
/// Everything that carries physics is read strictly: a number that is no number, a missing part, an
/// unknown link or type, a pose or a version that is not known, a mesh that is not there end in a
/// ModelError `file:line: element: what was found, what was expected`. What is not read
/// (transmissions, sensors, …), and what a user should know, is in Model::warnings. Angles [rad],
/// SI units throughout.
///
/// A <gazebo> of a link gives its friction where nobody else does, by mu1 and mu2, and that then
/// counts against surfaces of other files.
/// effort is the control limits, |u| ≤ effort; 0 means not actuated (ModelBuilder says which);
/// none means no box. A mimic joint is coupled to its leader (4.6) and not actuated.

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/mesh.hpp"

namespace softgauss::io {

/// What meshes collide as.
enum class MeshUse {
  automatic,  ///< as Geometry::automaticMesh: their hulls until collision::chooseMeshes()
  hull,       ///< their convex hulls
  triangles   ///< their triangles
};

struct UrdfOptions {
  /// Where package://NAME/… is sought first: folders that hold NAME, or are called NAME. Then
  /// ROS_PACKAGE_PATH, then the folders above the URDF.
  std::vector<std::filesystem::path> packagePaths;
  /// Read the meshes of visuals too. If not, a visual's Mesh has its file and no vertices.
  bool visualMeshes = false;
  BaseKind base = BaseKind::automatic;
  MeshUse meshes = MeshUse::automatic;        ///< of collision shapes
  std::uintmax_t largestMesh = kLargestMesh;  ///< a file that is larger is not read [bytes]
  bool zeroEffortIsUnlimited = false;
  bool inferInertia = false;                      ///< of moving links without, from their shapes
  Material material;                              ///< of collision shapes
  std::map<std::string, Material> linkMaterials;  ///< of those of some links instead
};

/// What the file holds, before links are merged; for --explain and the summary.
struct UrdfContents {
  int links = 0;
  int joints = 0;
  double mass = 0.0;                         ///< [kg] of all links, those fixed to the world too
  std::vector<std::filesystem::path> files;  ///< that were read: the URDF and its meshes
  std::vector<std::string> linkNames;
  std::string floatingLink;                      ///< of a joint of type floating, if there is one
  std::vector<std::string> scalarJoints;         ///< names of the joints of one degree of freedom
  std::map<std::string, SourceLocation> places;  ///< where links, by name, are written
  /// Where collision meshes, by file, are first named, and in which element.
  std::map<std::string, std::pair<SourceLocation, std::string>> meshPlaces;
};

/// Throws ModelError. Options may still be set on the builder; its build() checks the rest.
ModelBuilder readUrdf(const std::filesystem::path& file, const UrdfOptions& options = {},
                      UrdfContents* contents = nullptr);

/// readUrdf(...).build(), and regulariseCoupledJoints() at its q0.
Model loadUrdf(const std::filesystem::path& file, const UrdfOptions& options = {});

}  // namespace softgauss::io
