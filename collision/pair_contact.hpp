// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a test of two shapes A and B finds: at most eight points with distance < margin.
///
/// At every point the normal n is a unit vector from A to B and distance d is signed, negative when
/// the shapes overlap. With p the point, p − n d/2 lies on the surface of A and p + n d/2 on that
/// of B.

#include <array>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::collision {

struct PairContact {
  Vector3 p_WC;     ///< midway between the two surfaces [m], world
  Vector3 n_W;      ///< unit normal from A to B, world
  double distance;  ///< [m]
};

/// Points of one pair, without heap memory.
struct PairContacts {
  static constexpr int kCapacity = 8;

  int count = 0;
  Vector3 tangent_W = Vector3::Zero();  ///< wished first tangent of all points; zero: none
  std::array<PairContact, kCapacity> points;

  void clear() {
    count = 0;
    tangent_W.setZero();
  }
  void add(const Vector3& p_WC, const Vector3& n_W, double distance) {
    if (count < kCapacity) points[static_cast<std::size_t>(count++)] = {p_WC, n_W, distance};
  }
  void add(const PairContact& contact) { add(contact.p_WC, contact.n_W, contact.distance); }
  /// Turns contacts of (B, A) into contacts of (A, B).
  void flip() {
    for (int i = 0; i < count; ++i) points[static_cast<std::size_t>(i)].n_W *= -1.0;
  }
  const PairContact& operator[](int i) const { return points[static_cast<std::size_t>(i)]; }
};

}  // namespace softgauss::collision
