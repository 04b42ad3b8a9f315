// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What of a face lies over a triangle.
///
/// Seen along m, a triangle is met by what lies within the prism on it along m. A face (a point, a
/// segment or a polygon) is cut along the three sides of the prism, one after the other (Sutherland
/// and Hodgman, Communications of the ACM 17(1), 1974). A point x of what is left is at the
/// distance
///
///   d = n·(x − a)/(n·m)
///
/// from the triangle, along m: n its normal, a a corner, n·m > 0.
///
/// Where the surface goes on in the same plane beyond a side, that side is inner: the triangles of
/// the plane together cut no corner there. A corner of the triangle is one of theirs only where
/// their outline turns.

#include "softgauss/collision/support.hpp"

namespace softgauss::collision::detail {

/// The corners of what is left that all triangles of the plane leave; none where the face lies
/// beside the triangle.
struct ClippedFace {
  static constexpr int kCapacity = SupportFace::kCapacity + 4;
  int count = 0;
  std::array<Vector3, kCapacity> points;  ///< in the axes of the triangle [m]

  void add(const Vector3& x) {
    if (count < kCapacity) points[static_cast<std::size_t>(count++)] = x;
  }
  const Vector3& operator[](int i) const { return points[static_cast<std::size_t>(i)]; }
};

/// A triangle among those of its plane.
struct PlanePiece {
  Triangle triangle;
  std::array<bool, 3> isInner{};  ///< side k, from corner k to corner k + 1
  std::array<bool, 3> turns{};    ///< the outline at corner k
};

ClippedFace clipToPrism(const SupportFace& face, const PlanePiece& piece, const Vector3& m);

inline double heightAbove(const Triangle& triangle, const Vector3& x, const Vector3& m) {
  return triangle.normal.dot(x - triangle.corners[0]) / triangle.normal.dot(m);
}

}  // namespace softgauss::collision::detail
