// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What keeps a mesh from enclosing a volume, in words, with the first place of each kind.

#include <string>
#include <vector>

#include "softgauss/engine/model/closed_surface.hpp"

namespace softgauss::io::detail {

/// "3 edges at holes (the first from (0 0 0) to (1 0 0))"; empty where there is no defect.
/// Coordinates are the mesh's own [m], scale applied; triangles are counted from 1.
std::vector<std::string> describeDefects(const Mesh& mesh, const SurfaceDefects& defects);

/// Meshes that were asked for as hulls though their surfaces are open or inconsistently wound.
class UnsoundHulls {
 public:
  /// `owner` names the link or the object.
  void look(const Mesh& mesh, const std::string& owner);
  /// One warning for all, if there were any.
  void appendTo(std::vector<std::string>& warnings) const;

 private:
  std::vector<std::string> found_;
};

}  // namespace softgauss::io::detail
