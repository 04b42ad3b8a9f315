// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The Minkowski difference D = A − B of two cores, as a support function that keeps the best
/// direction it was ever asked for.

#include "softgauss/collision/detail/separating_direction.hpp"

namespace softgauss::collision::detail {

class Minkowski {
 public:
  Minkowski(const Convex& a, const Transform& X_WA, const Convex& b, const Transform& X_WB,
            double enough)
      : a_(a),
        b_(b),
        X_A_{X_WA.R, Vector3::Zero()},
        X_B_{X_WB.R, X_WB.p - X_WA.p},
        enough_(enough) {}

  /// The point of D farthest along the unit vector n. Its height there is −σ(n).
  Vector3 support(const Vector3& n) {
    const Vector3 w = corePoint(a_, X_A_, n) - corePoint(b_, X_B_, -n);
    const double separation = -n.dot(w);
    if (separation > best_.separation) best_ = {n, separation};
    return w;
  }
  bool foundEnough() const { return best_.separation >= enough_; }
  const SeparatingDirection& best() const { return best_; }

 private:
  const Convex& a_;
  const Convex& b_;
  Transform X_A_,
      X_B_;  ///< relative to the origin of A, whose distance from the world's is rounding
  double enough_;
  SeparatingDirection best_;
};

/// Points of D whose convex hull approaches the origin.
struct Simplex {
  int count = 0;
  std::array<Vector3, 4> points;

  void add(const Vector3& w) { points[static_cast<std::size_t>(count++)] = w; }
  const Vector3& operator[](int i) const { return points[static_cast<std::size_t>(i)]; }
};

/// Keeps of the simplex the points that carry its point nearest to the origin, and returns that
/// point: zero with all four points kept when a tetrahedron contains the origin.
Vector3 nearestToOrigin(Simplex& simplex);

/// EPA: from a simplex that contains the origin, or nearly, to the faces of D around the origin.
/// Its result is D.best().
void expandPolytope(Minkowski& D, const Simplex& simplex, double size);

}  // namespace softgauss::collision::detail
