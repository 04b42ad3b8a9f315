// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Triangles of a mesh file, by assimp.
///
/// An STL is read in place: its size bounds time and memory. How long assimp takes for an OBJ, a
/// DAE or a glTF no check can tell, so it reads them in a child process that has limits.

#include "softgauss/engine/model/shape.hpp"
#include "softgauss/io/detail/mesh_file.hpp"
#include "softgauss/io/mesh_images.hpp"

namespace softgauss::io::detail {

/// In the coordinates of the file. Material files beside it are read if they are no larger than
/// `largest` bytes. Throws ModelError.
Mesh importMesh(const MeshFile& file, std::uintmax_t largest);

/// The same with the images that cover its parts, as the file names them and without their bytes.
std::pair<Mesh, MeshImages> importWithImages(const MeshFile& file, std::uintmax_t largest);

}  // namespace softgauss::io::detail
