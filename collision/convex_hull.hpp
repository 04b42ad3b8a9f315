// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Convex hull of a mesh: vertices, polygonal faces with outward normals, neighbours.
///
/// Coplanar triangles are merged into one face. A mesh without volume, whose vertices lie in a
/// plane to one part in a million of its size, becomes a convex polygon: the same vertices in two
/// faces, one for each side. Frame G is that of the mesh.

#include <array>
#include <span>
#include <vector>

#include "softgauss/engine/core/types.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss::collision {

struct HullFace {
  Vector3 normal = Vector3::Zero();  ///< unit, outward, in G
  std::vector<int> vertices;         ///< indices, counter-clockwise seen from outside
};

/// Lists of indices of different lengths, one for each vertex, in one array.
struct IndexLists {
  std::vector<int> start;  ///< list of vertex v: indices[start[v]] … indices[start[v + 1] − 1]
  std::vector<int> indices;

  std::span<const int> of(int v) const {
    const auto i = static_cast<std::size_t>(v);
    return {indices.data() + start[i], indices.data() + start[i + 1]};
  }
};

struct ConvexHull {
  std::vector<Vector3> vertices;          ///< in G [m], each an extreme point
  std::vector<HullFace> faces;            ///< at least 4, or 2 when flat
  IndexLists neighbours;                  ///< of each vertex, along the edges
  std::vector<Vector3> neighbourPoints;   ///< where those are, in their order: for speed
  IndexLists facesAround;                 ///< of each vertex
  std::array<int, 8> octants{};           ///< support vertex of (±1, ±1, ±1); bit 0 set means +x
  bool flat = false;                      ///< a convex polygon without thickness
  Vector3 centre = Vector3::Zero();       ///< of the axis-aligned box of the vertices, in G
  Vector3 halfExtents = Vector3::Zero();  ///< of that box [m]
  double boundingRadius = 0.0;            ///< about `centre` [m]

  /// Index of the vertex farthest along d_G (any length). Climbs from neighbour to neighbour, which
  /// on a convex body ends at the top.
  int supportVertex(const Vector3& d_G) const;
  const Vector3& support(const Vector3& d_G) const {
    return vertices[static_cast<std::size_t>(supportVertex(d_G))];
  }
  /// Index of the face at that vertex whose normal is most along d_G.
  int supportFace(const Vector3& d_G) const;
};

/// Throws ModelError, naming the mesh's file, when there are fewer than three vertices or all lie
/// on one line: such a mesh has no surface.
ConvexHull makeConvexHull(const Mesh& mesh);

/// The surface of a hull as triangles, for viewers.
Mesh triangulated(const ConvexHull& hull);

}  // namespace softgauss::collision
