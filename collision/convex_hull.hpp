// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Convex hull of a mesh: vertices, polygonal faces with outward normals, neighbours.
///
/// Coplanar triangles are merged into one face. A mesh without volume, whose vertices lie in a
/// plane to one part in a million of its size, becomes a convex polygon: the same vertices in two
/// faces, one for each side. Frame G is that of the mesh.

#include <memory>
#include <vector>

#include "engine/core/types.hpp"
#include "engine/model/shape.hpp"

namespace softgauss::collision {

struct HullFace {
  Vector3 normal = Vector3::Zero();  ///< unit, outward, in G
  std::vector<int> vertices;         ///< indices, counter-clockwise seen from outside
};

struct ConvexHull {
  std::vector<Vector3> vertices;  ///< in G [m], each an extreme point
  std::vector<HullFace> faces;    ///< at least 4, or 2 when flat
  bool flat = false;              ///< a convex polygon without thickness
  Vector3 centre = Vector3::Zero();      ///< of the axis-aligned box of the vertices, in G
  Vector3 halfExtents = Vector3::Zero(); ///< of that box [m]
  double boundingRadius = 0.0;           ///< about `centre` [m]

  /// The vertex farthest along d_G (any length); the lowest index on ties.
  const Vector3& support(const Vector3& d_G) const;
  /// Index of the face whose normal is most along d_G.
  int faceAlong(const Vector3& d_G) const;
};

/// Throws ModelError, naming the mesh's file, when there are fewer than three vertices or all lie
/// on one line: such a mesh has no surface.
ConvexHull makeConvexHull(const Mesh& mesh);

}  // namespace softgauss::collision
