// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pieces of a surface in reach of a shape that are convex.
///
/// A patch grows from triangle to triangle, across edges that are convex or flat, as long as no
/// edge within it is hollow. Then it bends one way everywhere, and is part of the surface of a
/// convex body. Which patch a triangle belongs to depends on the triangles in reach alone, which
/// come in rising order.

#include <span>
#include <vector>

#include "softgauss/collision/detail/convex_pairs.hpp"
#include "softgauss/collision/detail/prism_clip.hpp"
#include "softgauss/collision/triangle_mesh.hpp"

namespace softgauss::collision::detail {

/// What the directions of contacts may be off by: those of balls and of pairs of triangles are
/// exact, others are searched for [rad].
inline constexpr double kExactTilt = 1e-6, kSearchTilt = 1e-4;
/// Cosine of 1e-3: what lies so nearly flat on a face touches it along its normal.
inline constexpr double kNearlyFace = 1.0 - 0.5e-6;

/// A triangle in reach: its plane is crossed, or nearly.
struct NearTriangle {
  int t;
  double low;  ///< of the shape's lowest point above the plane of t [m]
};

struct SurfacePatch {
  std::span<const NearTriangle> near;
  std::span<const Triangle> triangles;  ///< theirs
  bool isPlain;  ///< all in one plane, which goes on or rises beyond every edge

  /// The triangle that is highest along m, and of those the one that faces m most.
  int highest(const Vector3& m) const;
};

/// What convex_pairs.hpp sees of triangles, which must outlive it.
Collider colliderOf(std::span<const Triangle> triangles);

/// Whether two triangles of a surface lie in one plane, to the rounding of small triangles; `size`
/// [m] is that of the shape that tells a step from none.
bool inOnePlane(const TriangleMesh& surface, int s, int t, double size);

/// Triangle t of the plane of `owner`: which of its sides and corners are on the outline.
PlanePiece pieceOf(const TriangleMesh& surface, int owner, int t, double size);

/// Keeps its memory from surface to surface.
class SurfacePatches {
 public:
  /// Of triangles in rising order.
  void grow(const TriangleMesh& surface, std::span<const NearTriangle> near, double size);
  int size() const { return static_cast<int>(begin_.size()) - 1; }
  SurfacePatch operator[](int p) const;
  /// The patch of triangle t of `near`, as given to grow(); −1 where it is not among them.
  int of(int t, std::span<const NearTriangle> near) const;

 private:
  void growFrom(const TriangleMesh& surface, std::span<const NearTriangle> near, int seed);
  /// Place of triangle t among those in reach, −1 where it is not.
  static int placeOf(std::span<const NearTriangle> near, int t);

  std::vector<int> patchOf_;         ///< of each triangle in reach; −1: none yet
  std::vector<int> order_;           ///< places in reach, patch by patch
  std::vector<int> begin_;           ///< of each patch in order_, and its end
  std::vector<NearTriangle> near_;   ///< in that order
  std::vector<Triangle> triangles_;  ///< theirs
  std::vector<char> isPlain_;
};

}  // namespace softgauss::collision::detail
