// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mesh files in memory, looked at before assimp sees them.

#include <cstdint>
#include <filesystem>
#include <string>

namespace softgauss::io::detail {

/// Refuses a mesh: a ModelError that names its file, and the line unless it is 0.
[[noreturn]] void failMesh(const std::filesystem::path& file, const std::string& problem,
                           int line = 0);

/// More would take assimp's triangulation, whose time grows by a power of them, for ever.
inline constexpr std::size_t kMostCorners = 10000;

/// The bytes of a regular file of at most `largest` bytes. Throws ModelError.
std::string readMeshBytes(const std::filesystem::path& path, std::uintmax_t largest);

struct MeshFile {
  std::filesystem::path path;
  std::string format;  ///< ".stl", ".obj", ".dae", ".gltf" or ".glb"
  std::string text;    ///< without a byte-order mark; an ASCII STL in small letters
};

/// Throws ModelError, also where it is in no format that is read.
MeshFile loadMeshFile(const std::filesystem::path& path, std::uintmax_t largest);

/// Refuses an OBJ with a polygon of more than kMostCorners.
void checkObj(const MeshFile& file);

/// Refuses a DAE whose nodes contain themselves, or that has more than a million of them when each
/// node that stands for another is replaced by it, or with a polygon of more than kMostCorners.
void checkDae(const MeshFile& file);

}  // namespace softgauss::io::detail
