// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts of two surfaces of triangles, A and B, neither of which need be convex.
///
/// Everything happens in the axes of B. The hierarchies of the two find the triangles of A and of
/// B that touch.
///
///   1. Each pair of them is met along the direction m, out of B, in which the two triangles
///      overlap least (triangle_pairs.hpp), if m is a normal of B there and −m one of A
///      (triangle_mesh.hpp): a corner on a face, sides that cross, faces that lie on each other.
///      Nothing that has been pushed in by δ is deeper than δ along it.
///   2. m is none where A is deeper in B than the triangles are wide. Pairs that no contact of 1
///      frees, if A is moved out along it by its depth, are met by patches: convex pieces of both
///      surfaces (surface_patches.hpp) meet as convex bodies do, if their m is a normal of both.
///   3. What still is not freed, of closed surfaces, is met between the normals of the two
///      triangles, by as much as these two overlap along it.
///
/// A contact has the points of A's face that lie over B's, along m (prism_clip.hpp). Points are
/// then thinned (surface_reduction.hpp).

#include <optional>
#include <utility>
#include <vector>

#include "softgauss/collision/detail/box.hpp"
#include "softgauss/collision/detail/surface_patches.hpp"
#include "softgauss/collision/detail/surface_reduction.hpp"
#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/collision/triangle_mesh.hpp"

namespace softgauss::collision::detail {

/// Keeps its memory from pair to pair.
class SurfacePairs {
 public:
  /// Finds the contacts with distance < margin; false where a pose is not finite.
  bool find(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
            const Transform& X_WB, double margin);
  /// Of the last search: in the world, normals from A to B.
  const std::vector<PairContact>& points() const { return points_; }
  /// Of the last search: whether any triangles touched. If none did, the surfaces are apart or one
  /// is within the other.
  bool touch() const { return !touching_.empty(); }
  /// Of the last search: how many points were left to others beside them.
  int reduced() const { return reduced_; }

 private:
  /// Triangles s of A and t of B that touch: `distance` along m, out of B.
  struct Touching {
    int s, t;
    Vector3 m;
    double distance;
  };
  /// A contact along m, on the triangles that face it most on both surfaces.
  struct Meeting {
    Vector3 m;
    double distance;
    int ownerA, ownerB;
  };
  struct Query {
    const TriangleMesh& a;
    const TriangleMesh& b;
    Transform X_BA;
    double margin;
    double size;  ///< of the smaller one [m]
    Box region;   ///< where the boxes about the two overlap

    Triangle triangleA(int s) const;
    Vector3 normalA(int s) const { return X_BA.R * a[s].normal; }
  };

  void findTouching(const Query& q);
  void meetEach(const Query& q);
  void meetPatches(const Query& q);
  void growPatches(const Query& q);
  void meetBetween(const Query& q);
  void meetAt(const Query& q, Meeting meeting, const Collider& colliderA,
              const Collider& colliderB);
  double addPointsOver(const Query& q, const Meeting& meeting);
  bool isMet(const Query& q, const Touching& pair) const;
  std::optional<Meeting> meetingOf(const Query& q, const Touching& pair) const;
  bool isFreed(const Query& q, const Touching& pair) const;

  std::vector<std::pair<int, int>> found_;
  std::vector<Touching> touching_, open_;
  std::vector<Meeting> meetings_;
  std::vector<NearTriangle> nearA_, nearB_;
  SurfacePatches patchesA_, patchesB_;
  std::vector<std::pair<int, int>> patchPairs_;
  std::vector<int> inRegion_, under_;  ///< triangles of A, and of B under one of them
  bool regionIsKnown_ = false;
  std::vector<PairContact> points_;
  SurfaceReduction reduction_;
  int reduced_ = 0;
};

}  // namespace softgauss::collision::detail
