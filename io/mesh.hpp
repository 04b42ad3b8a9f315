// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Triangle meshes from STL (ASCII in any letters, and binary), OBJ and DAE files.
///
/// Triangles only: polygons are triangulated, lines and points are left out. Corners with exactly
/// the same coordinates become one vertex. Transforms of the file's nodes are applied.
/// Colours are those of the file's materials, diffuse, without textures.
/// DAE as ROS tools read it: <unit> scales to metres, <up_axis> is ignored (RViz and Gazebo ignore
/// it, and robots are drawn to look right there). STL and OBJ have no unit: the URDF's scale says.

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "engine/model/shape.hpp"

namespace softgauss::io {

/// Reads a mesh and multiplies its coordinates by `scale`; a mirroring scale turns the triangles
/// so that they still face outwards. Throws ModelError naming the file when it cannot be read,
/// holds no triangle, or a coordinate is not finite.
Mesh readMesh(const std::filesystem::path& file, const Vector3& scale = Vector3::Ones());

/// Meshes by file and scale, so that each file is read once.
class MeshCache {
 public:
  std::shared_ptr<const Mesh> get(const std::filesystem::path& file, const Vector3& scale);
  std::vector<std::filesystem::path> files() const;  ///< that were read

 private:
  std::map<std::filesystem::path, std::shared_ptr<const Mesh>> files_;  ///< unscaled
  std::map<std::pair<std::filesystem::path, std::array<double, 3>>, std::shared_ptr<const Mesh>>
      scaled_;
};

}  // namespace softgauss::io
