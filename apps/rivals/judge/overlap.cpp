// SPDX-License-Identifier: Apache-2.0
#include "apps/rivals/judge/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rivals {
namespace {

struct Segment {
  Vector3d from, to;
};

/// The axis of a capsule, or the centre of a sphere twice.
Segment axisOf(const Shape& s, const Isometry3d& X) {
  const Vector3d half =
      s.kind == ShapeKind::capsule ? Vector3d(s.size[1] * X.linear().col(2)) : Vector3d::Zero();
  return {X.translation() - half, X.translation() + half};
}

double pointToSegment(const Vector3d& p, const Segment& s) {
  const Vector3d d = s.to - s.from;
  const double length = d.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - s.from).dot(d) / length, 0.0, 1.0) : 0.0;
  return (p - s.from - t * d).norm();
}

/// Least over the inner points of both lines, where they have one, and over the ends.
double segmentToSegment(const Segment& a, const Segment& b) {
  double least = std::min({pointToSegment(a.from, b), pointToSegment(a.to, b),
                           pointToSegment(b.from, a), pointToSegment(b.to, a)});
  const Vector3d u = a.to - a.from, v = b.to - b.from, w = a.from - b.from;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
  if (det > 1e-12 * uu * vv) {
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / det,
                 t = (uu * v.dot(w) - uv * u.dot(w)) / det;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)
      least = std::min(least, (w + s * u - t * v).norm());
  }
  return least;
}

double pointToBox(const Vector3d& p, const Shape& box, const Isometry3d& X) {
  const Vector3d d = (X.inverse() * p).cwiseAbs() - box.size;
  return d.maxCoeff() > 0.0 ? d.cwiseMax(0.0).norm() : d.maxCoeff();
}

/// The distance to a box is convex along a line: a search by thirds finds its least.
double segmentToBox(const Segment& s, const Shape& box, const Isometry3d& X) {
  double low = 0.0, high = 1.0;
  const auto at = [&](double t) { return pointToBox(s.from + t * (s.to - s.from), box, X); };
  for (int i = 0; i < 80; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
  }
  return std::min({at(low), at(0.0), at(1.0)});
}

/// The axis on which two boxes are furthest apart, or overlap least, of the fifteen that can be it.
double boxToBox(const Shape& a, const Isometry3d& X, const Shape& b, const Isometry3d& Y) {
  double most = -std::numeric_limits<double>::infinity();
  const auto look = [&](const Vector3d& axis) {
    if (axis.norm() < 1e-6) return;  // of parallel edges: a face has it
    const Vector3d n = axis.normalized();
    const double reach = (X.linear().transpose() * n).cwiseAbs().dot(a.size) +
                         (Y.linear().transpose() * n).cwiseAbs().dot(b.size);
    most = std::max(most, std::abs(n.dot(Y.translation() - X.translation())) - reach);
  };
  for (int i = 0; i < 3; ++i) {
    look(X.linear().col(i));
    look(Y.linear().col(i));
    for (int j = 0; j < 3; ++j) look(X.linear().col(i).cross(Y.linear().col(j)));
  }
  return most;
}

double radiusOf(const Shape& s) { return s.kind == ShapeKind::box ? 0.0 : s.size[0]; }

/// Of a sphere around the shape's origin that holds it.
double boundOf(const Shape& s) {
  return s.kind == ShapeKind::box      ? s.size.norm()
         : s.kind == ShapeKind::sphere ? s.size[0]
                                       : s.size[0] + s.size[1];
}

}  // namespace

double distanceOf(const Shape& a, const Isometry3d& X_WA, const Shape& b, const Isometry3d& X_WB) {
  if (a.kind == ShapeKind::box && b.kind == ShapeKind::box) return boxToBox(a, X_WA, b, X_WB);
  if (b.kind == ShapeKind::box) return distanceOf(b, X_WB, a, X_WA);
  if (a.kind == ShapeKind::box) return segmentToBox(axisOf(b, X_WB), a, X_WA) - radiusOf(b);
  return segmentToSegment(axisOf(a, X_WA), axisOf(b, X_WB)) - radiusOf(a) - radiusOf(b);
}

double lowestPoint(const Shape& s, const Isometry3d& X) {
  const Vector3d down = X.linear().transpose() * Vector3d::UnitZ();
  const double reach = s.kind == ShapeKind::box      ? down.cwiseAbs().dot(s.size)
                       : s.kind == ShapeKind::sphere ? s.size[0]
                                                     : std::abs(down[2]) * s.size[1] + s.size[0];
  return X.translation()[2] - reach;
}

double deepestOverlap(const Scene& scene, const std::vector<BodyState>& states) {
  struct Placed {
    const Shape* shape;
    Isometry3d pose;
    std::size_t body;
  };
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < states.size(); ++i)
    for (const Shape& s : scene.bodies[i].shapes)
      placed.push_back({&s, states[i].pose() * s.pose, i});
  double deepest = 0.0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Placed& a = placed[i];
    if (scene.ground) deepest = std::max(deepest, -lowestPoint(*a.shape, a.pose));
    for (std::size_t j = i + 1; scene.collide && j < placed.size(); ++j) {
      const Placed& b = placed[j];
      const double apart = (a.pose.translation() - b.pose.translation()).norm();
      if (a.body == b.body || apart > boundOf(*a.shape) + boundOf(*b.shape)) continue;
      deepest = std::max(deepest, -distanceOf(*a.shape, a.pose, *b.shape, b.pose));
    }
  }
  return deepest;
}

}  // namespace rivals
