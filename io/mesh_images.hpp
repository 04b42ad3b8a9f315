// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Images that cover meshes, by the materials of OBJ and DAE files. They are for viewers alone: no
/// Mesh has them, and they are read where somebody looks.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "softgauss/engine/model/shape.hpp"
#include "softgauss/io/mesh.hpp"

namespace softgauss::io {

struct MeshImages {
  /// A PNG or JPEG file, whole.
  struct Image {
    std::string file, bytes;
  };
  std::vector<Image> images;
  std::vector<int> ofPart;  ///< (Mesh::parts) the image that covers it; −1: none
  /// (3 × triangles) where in its part's image a corner is, to the right and up, 0 to 1 across it.
  std::vector<std::array<float, 2>> places;
  std::vector<std::string> notShown;  ///< what cannot be shown, and why
};

/// Of a mesh that was read from Mesh::file; empty where it has none. Files larger than `largest`
/// bytes are not read. Whatever is wrong with the files is told in `notShown`.
MeshImages imagesOf(const Mesh& mesh, std::uintmax_t largest = kLargestMesh);

/// "image/png" or "image/jpeg" by the first bytes of a file; null: neither.
const char* imageType(const std::string& bytes);

}  // namespace softgauss::io
