// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The support of what stands: the convex hull of points, seen from above.

#include <algorithm>
#include <array>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/types.hpp"

namespace softgauss::gdd {

class SupportPolygon {
 public:
  struct Edge {
    Vector3 n;     ///< outwards, horizontal, of length 1
    double reach;  ///< n·p ≤ reach [m]
  };

  /// `up`: of length 1.
  explicit SupportPolygon(const Vector3& up);
  /// Points beyond the first 128 are left out.
  void add(const Vector3& p);
  bool empty() const { return count_ == 0; }
  double height() const { return height_; }  ///< of the lowest point [m]
  /// Finds edges and middle: to be called when all points are there. A line has two edges along it
  /// and one at each end, a point has four.
  void close();
  const Edge* begin() const { return edges_.data(); }
  const Edge* end() const { return edges_.data() + edgeCount_; }
  /// n·x on the edge of the support shrunk to `share` about its middle [m].
  double bound(const Edge& edge, double share) const {
    const double m = edge.n.dot(middle_);
    return m + share * (edge.reach - m);
  }
  /// How far p is on the way from `from` to an edge, the farthest of all: 0 above `from`, 1 at an
  /// edge. Where `from` is outside the support shrunk to `within`, that edge's way begins there.
  double wayToEdge(const Vector3& from, const Vector3& p, double within) const;
  bool has(const Vector3& p, double share) const {
    return std::all_of(begin(), end(),
                       [&](const Edge& edge) { return edge.n.dot(p) <= bound(edge, share); });
  }

 private:
  static constexpr int kMostPoints = 128;
  using Point = Eigen::Vector2d;

  int hull(std::array<Point, 2 * kMostPoints>& corners);
  void addEdge(const Point& n, const Point& p);

  Vector3 up_, t_, s_, middle_ = Vector3::Zero();
  std::array<Point, kMostPoints> points_;
  std::array<Edge, kMostPoints + 4> edges_;
  int count_ = 0, edgeCount_ = 0;
  double height_ = kInfinity;
};

}  // namespace softgauss::gdd
