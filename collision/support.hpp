// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Support points and support faces of convex shapes.
///
/// The support point of a shape along a direction d is its point farthest along d. The support face
/// is the flat piece of its surface there: the polygon of a box, hull, triangle or cylinder end,
/// the straight line on the side of a cylinder or capsule or on the rim of a triangle, or a single
/// point. The separation of two shapes along
/// a unit vector n,
///   σ(n) = min over B of n·x − max over A of n·x,
/// is a lower bound of their signed distance, and equal to it for the best n.

#include <array>
#include <span>

#include "softgauss/collision/convex_hull.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss::collision {

/// A triangle of a surface, in the frame G of its mesh.
struct Triangle {
  std::array<Vector3, 3> corners;  ///< [m], counter-clockwise seen against the normal
  Vector3 normal;                  ///< unit
};

/// A shape of any kind but the plane; a mesh brings its hull, a surface some of its triangles,
/// which together bound a convex piece.
struct Convex {
  const Shape* shape = nullptr;
  const ConvexHull* hull = nullptr;          ///< set when shape->kind is mesh
  std::span<const Triangle> triangles = {};  ///< not empty when shape->kind is triangles
};

/// A flat convex piece of a surface: a point, a segment, or a polygon in the order of its rim.
struct SupportFace {
  static constexpr int kCapacity = 16;
  int count = 0;
  std::array<Vector3, kCapacity> points;  ///< world [m]

  void add(const Vector3& x) { points[static_cast<std::size_t>(count++)] = x; }
  const Vector3& operator[](int i) const { return points[static_cast<std::size_t>(i)]; }
};

/// Radius by which a shape surrounds its core: a point for the sphere, a segment for the capsule,
/// the shape itself for the others, with radius 0.
double coreRadius(const Shape& shape);

/// The point of the core of a shape at pose X_WG farthest along d_W (any length), in the world.
Vector3 corePoint(const Convex& convex, const Transform& X_WG, const Vector3& d_W);

/// The same of the shape itself.
Vector3 supportPoint(const Convex& convex, const Transform& X_WG, const Vector3& d_W);

/// The flat piece of surface that faces d_W (unit).
SupportFace supportFace(const Convex& convex, const Transform& X_WG, const Vector3& d_W);

/// Outward unit normal of the face that supportFace() returns when it is a polygon, else zero.
Vector3 supportFaceNormal(const Convex& convex, const Transform& X_WG, const Vector3& d_W);

/// σ(n) of the unit vector n_W [m].
double separationAlong(const Convex& a, const Transform& X_WA, const Convex& b,
                       const Transform& X_WB, const Vector3& n_W);

}  // namespace softgauss::collision
