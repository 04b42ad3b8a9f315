// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The surface of a mesh, triangle by triangle, made ready for tests of pairs.
///
/// Each triangle faces the side from which its corners are seen counter-clockwise, and is met from
/// there. Which normals a contact on it may have follows from what is beside it. At a point x of a
/// surface the unit vector m is a normal if x is a highest point of the surface near x along m:
///
///   on a face      m = its own normal
///   on an edge     m·(w − x) ≤ 0 for the far corner w of both triangles: the arc between the two
///                  normals where the edge is convex, nothing where it is flat or hollow
///   on a corner    m·(w − x) ≤ 0 for all corners w around
///
/// So a point inside an edge between coplanar triangles has one normal, whichever of the two found
/// it: inner edges do not show. A rim, beyond which there is nothing, is met from all around.  (The
/// regions over faces, edges and corners are Voronoi's: Mirtich, V-Clip, ACM Transactions on
/// Graphics 17(3), 1998.)

#include <array>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "softgauss/collision/convex_hull.hpp"
#include "softgauss/collision/support.hpp"

namespace softgauss::collision {

namespace detail {
class TriangleTree;
}

/// A triangle of the surface, with what is beside it.
struct SurfaceTriangle {
  std::array<int, 3> corners{};  ///< vertices
  Vector3 normal = Vector3::Zero();
  /// The triangle beyond edge k, from corner k to corner k + 1; −1 at a rim and where more than two
  /// meet.
  std::array<int, 3> across{-1, -1, -1};
  std::array<bool, 3> isHollow{};  ///< whether the triangle beyond edge k rises above this one
};

class TriangleMesh {
 public:
  /// Throws ModelError, naming the mesh's file and a place, where a number is not finite, no
  /// triangle has an area, or two triangles face opposite sides across their edge.
  explicit TriangleMesh(std::shared_ptr<const Mesh> mesh);
  ~TriangleMesh();
  TriangleMesh(const TriangleMesh&) = delete;
  TriangleMesh& operator=(const TriangleMesh&) = delete;

  int size() const { return static_cast<int>(triangles_.size()); }
  int vertices() const { return static_cast<int>(mesh_->vertices.size()); }
  const SurfaceTriangle& operator[](int t) const { return triangles_[static_cast<std::size_t>(t)]; }
  const Vector3& vertex(int v) const { return mesh_->vertices[static_cast<std::size_t>(v)]; }
  /// With its corners, in G.
  Triangle triangle(int t) const;
  /// The triangle that meets a shape along the unit vector m_G, out of the surface, at the point of
  /// triangle t that is farthest along m: of those around that point, the one that faces m most.
  /// −1 where m is no normal of the surface there. m may be off by `tilt` [rad].
  int owner(int t, const Vector3& m_G, double tilt) const;
  /// Whether the surface encloses a solid: no edge is a rim, and it faces outwards. What is closed
  /// and faces inwards is the wall of a room.
  bool isClosed() const { return closed_; }
  /// Whether it is the surface of a convex body: closed, of one piece, without hollow edges.
  bool isConvex() const { return convex_; }
  /// Whether a closed surface encloses a point, by the number of its triangles above it. `scratch`
  /// keeps memory from call to call.
  bool encloses(const Vector3& p_G, std::vector<int>& scratch) const;
  /// Whether a closed surface encloses another one that it does not touch. At the poses X_WG of
  /// this and X_WO of the other.
  bool holds(const Transform& X_WG, const TriangleMesh& other, const Transform& X_WO,
             std::vector<int>& scratch) const;

  /// Whether any triangle's own box comes nearer than `radius` to a point, along each axis of G.
  bool comesNear(const Vector3& p_G, double radius) const;
  const detail::TriangleTree& tree() const { return *tree_; }
  const Vector3& centre() const { return centre_; }  ///< of its axis-aligned box, in G [m]
  const Vector3& halfExtents() const { return halfExtents_; }    ///< of that box [m]
  double boundingRadius() const { return halfExtents_.norm(); }  ///< about the centre [m]
  int withoutArea() const { return withoutArea_; }  ///< triangles of the file that were left out
  std::size_t bytes() const;

 private:
  void takeTriangles();
  void joinEdges();
  double sixVolumes() const;
  void findHollows();
  /// Of a closed surface without hollow edges: whether all of it hangs together.
  bool isOnePiece() const;
  /// All triangles around vertex v.
  std::span<const int> around(int v) const { return around_.of(v); }
  /// Whether no corner of a triangle lies higher along m than vertex v.
  bool staysBelow(int t, int v, const Vector3& m_G, double tilt) const;

  std::shared_ptr<const Mesh> mesh_;
  std::vector<SurfaceTriangle> triangles_;
  IndexLists around_;  ///< triangles of each vertex
  std::unique_ptr<detail::TriangleTree> tree_;
  Vector3 centre_ = Vector3::Zero();
  Vector3 halfExtents_ = Vector3::Zero();
  int withoutArea_ = 0;
  bool closed_ = true, convex_ = false;
};

}  // namespace softgauss::collision
