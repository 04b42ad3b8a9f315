// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How long two shapes that fly at each other can be left alone without one passing through the
/// other unseen.
///
/// A point of a shape moves by at most |v| + |ω| ℓ: v of the centre, ℓ how far from it spin moves
/// the surface. Two shapes of thicknesses t take (t_A + t_B)/u at least to pass through each other,
/// u the largest speed of a point of one against a point of the other:
///
///   u = |v_B − v_A| + |ω_A| ℓ_A + |ω_B| ℓ_B
///   T = max(τ, ½ (t_A + t_B)/u),   τ = max_n gap_n/c_n                                     (7.7)
///
/// τ is a time in which they do not touch. n runs over the line of centres and the axes of both
/// boxes about the shapes; gap_n is the distance of the two shadows on n and c_n ≤ u bounds how
/// fast it closes. In T a pass through the middle is looked at four times where looks are ½ T
/// apart; one that merely grazes an edge may be missed.

#include "softgauss/collision/convex_hull.hpp"
#include "softgauss/collision/triangle_mesh.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss::collision {

inline constexpr double kPassShare = 0.5;  ///< of the least time of a pass, T of (7.7)

/// Of a shape, about the centre of its bounding sphere [m].
struct Extent {
  double thickness = 0.0;  ///< least width, or less; ∞ for a half-space
  double lever = 0.0;      ///< ℓ
};

/// `hull`: of a mesh, `surface`: of triangles, else null.
Extent extentOf(const Shape& shape, const ConvexHull* hull, const TriangleMesh* surface = nullptr);

/// A shape on its way.
struct MovingShape {
  const Shape* shape;
  const ConvexHull* hull;
  Extent extent;
  const Transform* X_WG;  ///< R(:, z) alone is read of a capsule, none of R of a sphere
  Vector3 centre;         ///< world [m]
  Vector3 v, omega;       ///< of the centre, world
  const TriangleMesh* surface = nullptr;

  /// No point is faster [m/s].
  double speed() const { return v.norm() + omega.norm() * extent.lever; }
  /// Whether T of (7.7) may be below `longest` [s] for a pair of which the other is no faster for
  /// its thickness.
  bool mayTunnel(double longest) const { return longest * speed() > kPassShare * extent.thickness; }
};

/// Half of the shadow on the unit vector n, or more [m].
double halfWidth(const MovingShape& shape, const Vector3& n);

/// T of (7.7) [s], or `longest` where that is less. The shapes touch at `margin`.
double tunnellingTimeBound(const MovingShape& a, const MovingShape& b, double margin,
                           double longest);

}  // namespace softgauss::collision
