// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far shapes are apart: what the engine's users ask of a collision library, besides contacts.

#include <array>
#include <span>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/spatial.hpp"

namespace softgauss {

/// A point of the surface of a shape A and one of a shape B that lie opposite each other.
struct NearPoints {
  Vector3 p_WA = Vector3::Zero();  ///< world [m]
  Vector3 p_WB = Vector3::Zero();  ///< p_WA + distance n_W
  Vector3 n_W = Vector3::UnitZ();  ///< unit, from A to B
  double distance = kInfinity;     ///< [m]; < 0 where the shapes overlap
  /// Unit directions across n in which A's surface is straight there: two of a flat face, one of an
  /// edge, else zeros; and the same of B. Where they turn, n turns.
  std::array<Vector3, 2> alongA{Vector3::Zero(), Vector3::Zero()};
  std::array<Vector3, 2> alongB{Vector3::Zero(), Vector3::Zero()};
};

class ShapeDistances {
 public:
  virtual ~ShapeDistances() = default;

  /// Where geometries a and b of the model, of which at least one moves, are nearest, at poses X_WA
  /// and X_WB: the first pair of points is at their distance. Of faces that lie opposite each other
  /// the corners follow, so that a face that tilts has no point that jumps. Nothing for two planes,
  /// and where a pose is not finite. Valid until the next call. Depends on the poses alone.
  virtual std::span<const NearPoints> between(int a, const Transform& X_WA, int b,
                                              const Transform& X_WB) noexcept = 0;
};

}  // namespace softgauss
