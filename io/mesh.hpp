// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Triangle meshes from STL (ASCII in any letters, and binary), OBJ, DAE and glTF 2 files.
///
/// Triangles only: polygons are triangulated, lines and points are left out. Corners with exactly
/// the same coordinates become one vertex. Transforms of the file's nodes are applied.
/// Colours are those of the file's materials, diffuse, without textures.
/// DAE as ROS tools read it: `<unit>` scales to metres, `<up_axis>` is ignored (RViz and Gazebo
/// ignore it, and robots are drawn to look right there). STL and OBJ have no unit: the URDF's scale
/// says. A glTF is in metres, with its axes as they are in the file; its images are not shown.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "softgauss/engine/model/shape.hpp"

namespace softgauss::io {

/// The largest file that is read where nobody says otherwise [bytes].
inline constexpr std::uintmax_t kLargestMesh = 64u << 20;
/// A mesh has at most a triangle for so many bytes of the largest file: its convex hull takes some
/// 10 µs a triangle.
inline constexpr std::uintmax_t kBytesOfTriangle = 128;

/// Reads a mesh and multiplies its coordinates by `scale`; a mirroring scale turns the triangles
/// so that they still face outwards. Throws ModelError naming the file when it cannot be read, is
/// larger than `largest` bytes, holds no triangle or a polygon of more than 10,000 corners, when a
/// coordinate is not finite, or a node of a DAE contains itself. All but STL are read in a child
/// process, which may take 10 s of processor time and 1 GB.
Mesh readMesh(const std::filesystem::path& file, const Vector3& scale = Vector3::Ones(),
              std::uintmax_t largest = kLargestMesh);

/// Meshes by file and scale, so that each file is read once.
class MeshCache {
 public:
  explicit MeshCache(std::uintmax_t largest = kLargestMesh) : largest_(largest) {}

  std::shared_ptr<const Mesh> get(const std::filesystem::path& file, const Vector3& scale);
  std::vector<std::filesystem::path> files() const;  ///< that were read

 private:
  std::uintmax_t largest_;
  std::map<std::filesystem::path, std::shared_ptr<const Mesh>> files_;  ///< unscaled
  std::map<std::pair<std::filesystem::path, std::array<double, 3>>, std::shared_ptr<const Mesh>>
      scaled_;
};

}  // namespace softgauss::io
