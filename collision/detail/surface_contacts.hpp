// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts of a convex shape A with a surface of triangles.
///
/// Everything happens in the axes of the surface. With n the normal of a triangle T, the shape is
/// out of reach of T where it lies in front of the plane of T by the margin, or behind it. What
/// remains falls into patches (surface_patches.hpp): pieces of the surface that are convex, or
/// flat.
///
///   1. Each triangle that A overlaps is met along the direction m in which it and A do so least
///      (convex_pairs.hpp), if m is a normal of the surface there (triangle_mesh.hpp). Nothing that
///      has been pushed in by δ is deeper than δ along it.
///   2. m is none where A is deeper in the surface than the triangle is wide. Triangles of which no
///      contact of 1 frees A, if it is moved out along it by its depth, are met by patches, as
///      convex bodies are. The patch of one plane into which A is sunk a little is met along n.
///      What is convex as a whole is a patch from the start.
///   3. Where that m is no normal either, each triangle is met along its n, if some of A lies over
///      it. But where another contact frees A of T by a shorter way, and T itself can be left by a
///      shorter way than along n, T is left to that: of a wall, the far side does not pull what has
///      entered from the near one.
///   4. If nothing came of 1 to 3, of the triangles that A overlaps the one whose plane is nearest
///      gives one contact; and if A overlaps none but its centre is inside a closed surface, the
///      nearest point of the surface does.
///
/// A ball needs 1 alone: its contact with a triangle is exact.
///
/// A contact has the points of A's face along −m that lie over its triangle or over those in one
/// plane with it (prism_clip.hpp). Points are then thinned (surface_reduction.hpp).

#include <vector>

#include "softgauss/collision/detail/box.hpp"
#include "softgauss/collision/detail/convex_pairs.hpp"
#include "softgauss/collision/detail/surface_patches.hpp"
#include "softgauss/collision/detail/surface_reduction.hpp"
#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/collision/triangle_mesh.hpp"

namespace softgauss::collision::detail {

/// What a pair remembers: the triangles in a box about the shape that is larger than needed, so
/// that they need not be looked for until the shape has left it. It changes no contact.
struct SurfaceReach {
  Box fat;  ///< in the axes of the surface; empty: nothing is known
  std::vector<int> triangles;
};

/// Keeps its memory from pair to pair.
class SurfaceContacts {
 public:
  /// Finds the contacts with distance < margin; false where a pose is not finite. X_WB is that of
  /// the surface. `reach`: of this pair, or null.
  bool find(const Collider& a, const Transform& X_WA, const TriangleMesh& surface,
            const Transform& X_WB, double margin, SurfaceReach* reach = nullptr);
  /// The same for a half-space A: the corners of the surface that are in it, thinned.
  bool findOnPlane(const Transform& X_WA, const TriangleMesh& surface, const Transform& X_WB,
                   double margin);
  /// Of the last search: in the world, normals from A to the surface.
  const std::vector<PairContact>& points() const { return points_; }
  /// Turns the normals over.
  void flip();
  /// Of the last search: how many points were left to others beside them.
  int reduced() const { return reduced_; }

 private:
  /// A contact: its normal m out of the surface, the distance along m, the triangle that it is on.
  struct Meeting {
    Vector3 m;
    double distance;
    int owner;
  };
  struct Query {
    const Collider& a;
    Transform X_GA;
    const TriangleMesh& surface;
    double margin;
    double size;  ///< of A: its least half extent [m]
  };

  void findTriangles(const Query& q, const Box& box, SurfaceReach* reach);
  bool lookAt(const Query& q, int t);
  bool meetBall(const Query& q);
  bool meetEach(const Query& q);
  bool meetPatch(const Query& q, const SurfacePatch& patch);
  void meetAt(const Query& q, const Collider& collider, int owner, Vector3 m, double distance);
  bool frees(const Query& q, const Meeting& meeting, int t) const;
  bool isMet(const Query& q, int t) const;
  void meetWaiting(const Query& q);
  bool isLeftToOthers(const Query& q, const NearTriangle& near, double depth) const;
  /// Adds the points over the triangles in one plane with `owner`; returns the least distance.
  double addPointsOver(const Query& q, int owner, const Vector3& m);
  void meetDeepest(const Query& q);
  void leaveInside(const Query& q);

  std::vector<int> found_;
  std::vector<NearTriangle> near_, open_, waiting_;
  SurfacePatches patches_;
  std::vector<Meeting> meetings_;
  std::vector<PairContact> points_;
  SurfaceReduction reduction_;
  int reduced_ = 0;
};

}  // namespace softgauss::collision::detail
