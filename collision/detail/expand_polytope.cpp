// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "softgauss/collision/detail/minkowski.hpp"

namespace softgauss::collision::detail {
namespace {

/// A polytope inside D, of triangles with outward normals, in fixed memory.
class Polytope {
 public:
  static constexpr int kMaxPoints = 100;
  static constexpr int kMaxFaces = 2 * kMaxPoints;

  struct Face {
    std::array<int, 3> corners;  ///< counter-clockwise from outside
    Vector3 normal;              ///< unit
  };

  int addPoint(const Vector3& x) {
    points_[static_cast<std::size_t>(pointCount_)] = x;
    return pointCount_++;
  }
  const Vector3& point(int i) const { return points_[static_cast<std::size_t>(i)]; }
  bool full() const { return pointCount_ >= kMaxPoints || faceCount_ + 3 >= kMaxFaces; }

  void addFace(int a, int b, int c) {
    if (faceCount_ >= kMaxFaces) return;
    const auto i = static_cast<std::size_t>(faceCount_++);
    Face& face = faces_[i];
    face = {{a, b, c}, (point(b) - point(a)).cross(point(c) - point(a))};
    const double area = face.normal.norm();
    heights_[i] = kInfinity;
    // A sliver has no direction of its own, but keeps the surface closed.
    if (!(area > 1e-300)) return;
    face.normal /= area;
    heights_[i] = face.normal.dot(point(a));
  }

  /// The untried face nearest to the origin, or −1.
  int nearest() const {
    int best = -1;
    double lowest = kInfinity;
    for (int i = 0; i < faceCount_; ++i)
      if (height(i) < lowest) lowest = height(i), best = i;
    return best;
  }
  const Vector3& normal(int face) const { return faces_[static_cast<std::size_t>(face)].normal; }
  /// Of a face's plane above the origin along its normal.
  double height(int face) const { return heights_[static_cast<std::size_t>(face)]; }
  /// No point of D lies above the face.
  void setTried(int face) { heights_[static_cast<std::size_t>(face)] = kInfinity; }

  /// Replaces the faces that see the point w by a fan from w to their rim. A face sees w when w is
  /// above it by more than `coplanar`.
  void include(const Vector3& w, double coplanar) {
    const int apex = addPoint(w);
    rimCount_ = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(faceCount_); ++i) {
      const Face& face = faces_[i];
      if (face.normal.dot(w - point(face.corners[0])) > coplanar) {
        for (std::size_t k = 0; k < 3; ++k) toggleRim(face.corners[k], face.corners[(k + 1) % 3]);
        continue;
      }
      if (kept != i) {
        faces_[kept] = face;
        heights_[kept] = heights_[i];
      }
      ++kept;
    }
    faceCount_ = static_cast<int>(kept);
    for (int k = 0; k < rimCount_; ++k) {
      const auto& edge = rim_[static_cast<std::size_t>(k)];
      addFace(edge[0], edge[1], apex);
    }
  }

 private:
  /// An edge between two removed faces appears twice, in both senses, and is none of the rim.
  void toggleRim(int a, int b) {
    for (int k = 0; k < rimCount_; ++k) {
      auto& edge = rim_[static_cast<std::size_t>(k)];
      if (edge[0] != b || edge[1] != a) continue;
      edge = rim_[static_cast<std::size_t>(--rimCount_)];
      return;
    }
    if (rimCount_ < static_cast<int>(rim_.size()))
      rim_[static_cast<std::size_t>(rimCount_++)] = {a, b};
  }

  std::array<Vector3, kMaxPoints> points_;
  std::array<Face, kMaxFaces> faces_;
  std::array<double, kMaxFaces> heights_;  ///< infinite where tried
  std::array<std::array<int, 2>, kMaxFaces> rim_;
  int pointCount_ = 0, faceCount_ = 0, rimCount_ = 0;
};

/// Adds points of D until the simplex has volume; false when D is flat to within `thin`. Directions
/// in which D turns out to be thin count as tried.
bool complete(Minkowski& D, Simplex& s, double thin) {
  if (s.count == 0) s.add(D.support(Vector3::UnitX()));
  for (int axis = 0; s.count == 1 && axis < 3; ++axis)
    for (double sign : {1.0, -1.0}) {
      const Vector3 w = D.support(sign * Vector3::Unit(axis));
      if (s.count == 1 && (w - s[0]).norm() > thin) s.add(w);
    }
  if (s.count == 2) {
    const Vector3 line = (s[1] - s[0]).normalized();
    const Vector3 e = line.unitOrthogonal(), f = line.cross(e);
    for (const Vector3& d : {e, Vector3(-e), f, Vector3(-f)}) {
      if (s.count > 2) break;
      const Vector3 w = D.support(d);
      if ((w - s[0]).cross(line).norm() > thin) s.add(w);
    }
  }
  if (s.count == 3) {
    const Vector3 normal = (s[1] - s[0]).cross(s[2] - s[0]).normalized();
    for (double sign : {1.0, -1.0}) {
      if (s.count > 3) break;
      const Vector3 w = D.support(sign * normal);
      if (std::abs(normal.dot(w - s[0])) > thin) s.add(w);
    }
  }
  return s.count == 4;
}

}  // namespace

void expandPolytope(Minkowski& D, const Simplex& start, double size) {
  Simplex s = start;
  if (!complete(D, s, 1e-9 * size)) return;
  Polytope polytope;
  for (int i = 0; i < 4; ++i) polytope.addPoint(s[i]);
  const bool positive = (s[1] - s[0]).cross(s[2] - s[0]).dot(s[3] - s[0]) > 0.0;
  const int b = positive ? 2 : 1, c = positive ? 1 : 2;
  polytope.addFace(0, b, c);
  polytope.addFace(0, c, 3);
  polytope.addFace(c, b, 3);
  polytope.addFace(b, 0, 3);

  // No direction is better than the nearest face: stop when one tried comes close to it.
  const double tolerance = 1e-9 * size;
  while (!polytope.full()) {
    const int face = polytope.nearest();
    if (face < 0 || !(-D.best().separation - polytope.height(face) > tolerance)) return;
    const Vector3 n = polytope.normal(face);
    const Vector3 w = D.support(n);
    if (n.dot(w) - polytope.height(face) > tolerance)
      polytope.include(w, 0.1 * tolerance);
    else
      polytope.setTried(face);
  }
}

}  // namespace softgauss::collision::detail
