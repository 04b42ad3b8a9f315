// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/triangle_pairs.hpp"

#include <algorithm>

namespace softgauss::collision::detail {
namespace {

/// A face is preferred to another direction up to this loss of separation, relative to size, and
/// sides count as parallel below this sine.
constexpr double kFacePreference = 1e-6, kParallel = 1e-6;

Vector3 side(const Triangle& t, std::size_t k) { return t.corners[(k + 1) % 3] - t.corners[k]; }

/// Keeps the best of the directions that it is shown.
struct Best {
  const Triangle &a, &b;
  double enough;
  Separation found{Vector3::UnitZ(), -kInfinity};

  /// Whether nothing more is asked.
  bool isEnough() const { return found.distance >= enough; }
  void offer(const Vector3& n, double handicap) {
    for (const double sign : {1.0, -1.0}) {
      const double separation = separationAlong(a, b, sign * n);
      if (separation - handicap > found.distance) found = {sign * n, separation};
    }
  }
};

}  // namespace

double separationAlong(const Triangle& a, const Triangle& b, const Vector3& n) {
  double highest = -kInfinity, lowest = kInfinity;
  for (const Vector3& x : a.corners) highest = std::max(highest, n.dot(x));
  for (const Vector3& x : b.corners) lowest = std::min(lowest, n.dot(x));
  return lowest - highest;
}

Separation separateTriangles(const Triangle& a, const Triangle& b, double enough) {
  Best best{a, b, enough};
  best.offer(b.normal, 0.0);
  if (best.isEnough()) return best.found;
  best.offer(a.normal, 0.0);
  double size = 0.0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max(size, side(a, k).squaredNorm());
  const double handicap = kFacePreference * std::sqrt(size);
  for (std::size_t i = 0; i < 3 && !best.isEnough(); ++i) {
    best.offer(a.normal.cross(side(a, i)).normalized(), handicap);
    best.offer(b.normal.cross(side(b, i)).normalized(), handicap);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 u = side(a, i), w = side(b, k), n = u.cross(w);
      if (n.squaredNorm() < kParallel * kParallel * u.squaredNorm() * w.squaredNorm()) continue;
      best.offer(n.normalized(), handicap);
    }
  }
  return best.found;
}

}  // namespace softgauss::collision::detail
