// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is made of meshes once: hulls and surfaces, shared by all geometries of a mesh and by the
/// parts of a model.

#include <map>
#include <memory>

#include "softgauss/collision/convex_hull.hpp"
#include "softgauss/collision/triangle_mesh.hpp"

namespace softgauss::collision {

struct PreparedMeshes {
  std::map<const Mesh*, std::shared_ptr<const ConvexHull>> hulls;
  std::map<const Mesh*, std::shared_ptr<const TriangleMesh>> surfaces;

  /// Made where it is not there yet. They throw what makeConvexHull() and TriangleMesh() throw.
  std::shared_ptr<const ConvexHull> hull(const std::shared_ptr<const Mesh>& mesh) {
    auto& shared = hulls[mesh.get()];
    if (!shared) shared = std::make_shared<ConvexHull>(makeConvexHull(*mesh));
    return shared;
  }
  std::shared_ptr<const TriangleMesh> surface(const std::shared_ptr<const Mesh>& mesh) {
    auto& shared = surfaces[mesh.get()];
    if (!shared) shared = std::make_shared<TriangleMesh>(mesh);
    return shared;
  }
};

}  // namespace softgauss::collision
