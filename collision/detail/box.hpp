// SPDX-License-Identifier: Apache-2.0
#pragma once

/// An axis-aligned box.

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/types.hpp"

namespace softgauss::collision::detail {

/// Empty at first [m].
struct Box {
  Vector3 lower = Vector3::Constant(kInfinity);
  Vector3 upper = Vector3::Constant(-kInfinity);

  void add(const Vector3& centre, double radius) {
    lower = lower.cwiseMin((centre.array() - radius).matrix());
    upper = upper.cwiseMax((centre.array() + radius).matrix());
  }
  bool overlaps(const Box& o) const {
    return (lower.array() <= o.upper.array()).all() && (o.lower.array() <= upper.array()).all();
  }
  bool contains(const Box& o) const {
    return (lower.array() <= o.lower.array()).all() && (o.upper.array() <= upper.array()).all();
  }
};

}  // namespace softgauss::collision::detail
