// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which geometries of a large scene are near each other: sort and sweep.
///
/// Bounding spheres are sorted by where they begin along the axis on which the centres spread most.
/// Walking along it, a sphere can only touch those that begin before it ends, and of these only the
/// ones whose distance is below the sum of the radii.

#include <utility>
#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::collision::detail {

class Broadphase {
 public:
  /// Radii of the bounding spheres [m], margins included.
  explicit Broadphase(std::vector<double> radii);

  /// Appends to `near` every pair (i < j) of spheres about `centres` that touch, radii being larger
  /// by `growth` [m], in no particular order.
  void findNear(const std::vector<Vector3>& centres, double growth,
                std::vector<std::pair<int, int>>& near);

 private:
  struct Sphere {
    double begin;  ///< along the axis [m]
    double radius;
    Vector3 centre;
    int index;
  };
  std::vector<double> radii_;
  std::vector<Sphere> sorted_;
};

}  // namespace softgauss::collision::detail
