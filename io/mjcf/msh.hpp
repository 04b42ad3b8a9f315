// SPDX-License-Identifier: Apache-2.0
#pragma once

/// MSH, MuJoCo's own binary format of meshes.
///
/// Four integers, how many vertices, normals, texture coordinates and faces; then the vertices and
/// normals, three numbers each, the texture coordinates, two each, in single precision, and the
/// faces, three integers each, all in little-endian order. Of normals and texture coordinates there
/// are none or one for each vertex.

#include <cstdint>
#include <filesystem>

#include "softgauss/engine/model/shape.hpp"

namespace softgauss::io::mjcf {

bool isMsh(const std::filesystem::path& file);

/// Vertices and faces. Throws ModelError where the file is larger than `largest` bytes, or no such
/// mesh.
Mesh readMsh(const std::filesystem::path& file, std::uintmax_t largest);

}  // namespace softgauss::io::mjcf
