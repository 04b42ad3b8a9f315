// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/support_polygon.hpp"

#include <cmath>

namespace softgauss::gdd {
namespace {

constexpr double kNoArea = 1e-8;  // [m²]: corners in a line

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

SupportPolygon::SupportPolygon(const Vector3& up) : up_(up) {
  const Vector3 x = std::abs(up.x()) < 0.9 ? Vector3::UnitX() : Vector3::UnitY();
  t_ = (x - x.dot(up) * up).normalized();
  s_ = up.cross(t_);
}

void SupportPolygon::add(const Vector3& p) {
  if (count_ < kMostPoints) points_[idx(count_++)] = {t_.dot(p), s_.dot(p)};
  height_ = std::min(height_, up_.dot(p));
}

void SupportPolygon::addEdge(const Point& n, const Point& p) {
  edges_[idx(edgeCount_++)] = {n.x() * t_ + n.y() * s_, n.dot(p)};
}

/// Corners, counter-clockwise (Andrew's monotone chain); how many.
int SupportPolygon::hull(std::array<Point, 2 * kMostPoints>& corners) {
  std::sort(points_.begin(), points_.begin() + count_, [](const Point& a, const Point& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  int n = 0, first = 0;
  const auto add = [&](const Point& p) {
    while (n >= first + 2 &&
           cross(corners[idx(n - 1)] - corners[idx(n - 2)], p - corners[idx(n - 1)]) <= kNoArea)
      --n;
    corners[idx(n++)] = p;
  };
  for (int i = 0; i < count_; ++i) add(points_[idx(i)]);
  first = --n;
  for (int i = count_; i-- > 0;) add(points_[idx(i)]);
  return std::max(1, n - 1);
}

void SupportPolygon::close() {
  std::array<Point, 2 * kMostPoints> corners;
  const int n = hull(corners);
  Point middle = Point::Zero();
  double area = 0.0;
  for (int i = 0; i < n; ++i) {
    const Point &a = corners[idx(i)], &b = corners[idx((i + 1) % n)];
    const Point along = b - a;
    if (n > 2 || (n == 2 && i == 0)) {
      const Point normal = Point(along.y(), -along.x()).normalized();
      addEdge(normal, a);
      if (n == 2)
        addEdge(-normal, a), addEdge(along.normalized(), b), addEdge(-along.normalized(), a);
    }
    const double twice = cross(a - corners[0], b - corners[0]);
    area += twice;
    middle += n > 2 ? Point(twice / 3.0 * (a + b + corners[0])) : Point(a / n);
  }
  if (n == 1)
    for (const Point& axis : {Point(1, 0), Point(-1, 0), Point(0, 1), Point(0, -1)})
      addEdge(axis, corners[0]);
  if (n > 2) middle /= area;
  middle_ = middle.x() * t_ + middle.y() * s_;
}

double SupportPolygon::wayToEdge(const Vector3& from, const Vector3& p, double within) const {
  double way = 0.0;
  for (const Edge& edge : *this) {
    const double start = std::min(edge.n.dot(from), bound(edge, within));
    const double gone = edge.n.dot(p) - start;
    if (gone > 0.0)
      way = std::max(way, start < edge.reach ? gone / (edge.reach - start) : kInfinity);
  }
  return way;
}

}  // namespace softgauss::gdd
