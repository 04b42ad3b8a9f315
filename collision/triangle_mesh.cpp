// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "softgauss/collision/detail/fcl_triangle_tree.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision {
namespace {

/// What counts as flat [rad]: above the rounding of single precision in a mesh's file.
constexpr double kFlat = 1e-6;

ModelError meshError(const Mesh& mesh, const std::string& problem) {
  return {SourceLocation{mesh.file, 0}, "mesh", problem};
}

std::string text(const Vector3& x) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "(%.6g %.6g %.6g) m", x.x(), x.y(), x.z());
  return buffer;
}

/// Side k of a triangle, from its lower to its higher vertex or the other way.
struct Side {
  int low, high, triangle, k;
  bool upwards;
};

}  // namespace

TriangleMesh::TriangleMesh(std::shared_ptr<const Mesh> mesh) : mesh_(std::move(mesh)) {
  for (const Vector3& v : mesh_->vertices)
    if (!v.allFinite()) throw meshError(*mesh_, "a vertex is not finite");
  takeTriangles();
  joinEdges();
  closed_ = closed_ && sixVolumes() > 0.0;
  findHollows();
  const bool isHollow = std::any_of(triangles_.begin(), triangles_.end(), [](const auto& t) {
    return t.isHollow[0] || t.isHollow[1] || t.isHollow[2];
  });
  convex_ = closed_ && !isHollow && isOnePiece();
  std::vector<std::array<int, 3>> corners;
  corners.reserve(triangles_.size());
  for (const SurfaceTriangle& t : triangles_) corners.push_back(t.corners);
  try {
    tree_ = std::make_unique<detail::TriangleTree>(mesh_->vertices, corners);
  } catch (const std::exception& error) {
    throw meshError(*mesh_, error.what());
  }
}

TriangleMesh::~TriangleMesh() = default;

/// Those that have an area, their box, and which are around each vertex.
void TriangleMesh::takeTriangles() {
  Vector3 lower = Vector3::Constant(kInfinity), upper = -lower;
  std::vector<int> count(mesh_->vertices.size() + 1, 0);
  triangles_.reserve(mesh_->triangles.size());
  for (const std::array<int, 3>& corners : mesh_->triangles) {
    const Vector3 &a = vertex(corners[0]), &b = vertex(corners[1]), &c = vertex(corners[2]);
    const Vector3 normal = (b - a).cross(c - a);
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    // Thinner than rounding, it has no normal.
    if (!(normal.norm() > 1e-12 * longest)) {
      ++withoutArea_;
      continue;
    }
    SurfaceTriangle t;
    t.corners = corners;
    t.normal = normal.normalized();
    triangles_.push_back(t);
    for (const int v : corners) {
      ++count[idx(v + 1)];
      lower = lower.cwiseMin(vertex(v));
      upper = upper.cwiseMax(vertex(v));
    }
  }
  if (triangles_.empty()) throw meshError(*mesh_, "no triangle has an area, expected a surface");
  centre_ = 0.5 * (lower + upper);
  halfExtents_ = 0.5 * (upper - lower);

  for (std::size_t v = 1; v < count.size(); ++v) count[v] += count[v - 1];
  around_.start = count;
  around_.indices.resize(3 * triangles_.size());
  std::vector<int> next(count.begin(), count.end() - 1);
  for (int t = 0; t < size(); ++t)
    for (const int v : (*this)[t].corners) around_.indices[idx(next[idx(v)]++)] = t;
}

void TriangleMesh::joinEdges() {
  std::vector<Side> sides;
  sides.reserve(3 * triangles_.size());
  for (int t = 0; t < size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int from = (*this)[t].corners[idx(k)], to = (*this)[t].corners[idx((k + 1) % 3)];
      sides.push_back({std::min(from, to), std::max(from, to), t, k, from < to});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::tie(x.low, x.high, x.triangle) < std::tie(y.low, y.high, y.triangle);
  });
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    if (j - i != 2) closed_ = closed_ && (j - i) % 2 == 0;
    if (j - i != 2) continue;
    const Side &x = sides[i], &y = sides[i + 1];
    if (x.upwards == y.upwards)
      throw meshError(*mesh_, "two triangles face opposite sides across the edge from " +
                                  text(vertex(x.low)) + " to " + text(vertex(x.high)) +
                                  ", expected all to face outwards; try a mesh tool that orients "
                                  "faces, or its hull (collide_as: hull)");
    triangles_[idx(x.triangle)].across[idx(x.k)] = y.triangle;
    triangles_[idx(y.triangle)].across[idx(y.k)] = x.triangle;
  }
}

/// Six times the volume that the triangles enclose, from a point nearby, so that nothing cancels.
double TriangleMesh::sixVolumes() const {
  double sum = 0.0;
  for (const SurfaceTriangle& t : triangles_) {
    const Vector3 a = vertex(t.corners[0]) - centre_, b = vertex(t.corners[1]) - centre_,
                  c = vertex(t.corners[2]) - centre_;
    sum += a.dot(b.cross(c));
  }
  return sum;
}

void TriangleMesh::findHollows() {
  for (SurfaceTriangle& t : triangles_)
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.across[k] < 0) continue;
      for (const int w : (*this)[t.across[k]].corners) {
        const Vector3 along = vertex(w) - vertex(t.corners[k]);
        t.isHollow[k] = t.isHollow[k] || t.normal.dot(along) > kFlat * along.norm();
      }
    }
}

bool TriangleMesh::isOnePiece() const {
  std::vector<bool> seen(triangles_.size(), false);
  std::vector<int> waiting{0};
  seen[0] = true;
  std::size_t count = 0;
  while (!waiting.empty()) {
    const SurfaceTriangle& t = (*this)[waiting.back()];
    waiting.pop_back();
    ++count;
    for (const int beyond : t.across) {
      if (beyond < 0) return false;
      if (!seen[idx(beyond)]) waiting.push_back(beyond);
      seen[idx(beyond)] = true;
    }
  }
  return count == triangles_.size();
}

Triangle TriangleMesh::triangle(int t) const {
  const SurfaceTriangle& s = (*this)[t];
  return {{vertex(s.corners[0]), vertex(s.corners[1]), vertex(s.corners[2])}, s.normal};
}

bool TriangleMesh::staysBelow(int t, int v, const Vector3& m, double tilt) const {
  const std::array<int, 3>& corners = (*this)[t].corners;
  return std::all_of(corners.begin(), corners.end(), [&](int w) {
    const Vector3 along = vertex(w) - vertex(v);
    return m.dot(along) <= tilt * along.norm();
  });
}

int TriangleMesh::owner(int t, const Vector3& m, double tilt) const {
  const SurfaceTriangle& own = (*this)[t];
  // The corners that are as high as the highest: those of the face, an edge, or one.
  int top = own.corners[0];
  for (const int v : own.corners)
    if (m.dot(vertex(v)) > m.dot(vertex(top))) top = v;
  std::array<bool, 3> isTop{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 down = vertex(top) - vertex(own.corners[k]);
    isTop[k] = m.dot(down) <= tilt * down.norm();
  }
  if (isTop[0] && isTop[1] && isTop[2]) return own.normal.dot(m) > 0.0 ? t : -1;

  int best = t;
  const auto compare = [&](int other) {
    const double gain = (*this)[other].normal.dot(m) - (*this)[best].normal.dot(m);
    if (gain > kFlat || (gain > -kFlat && other < best)) best = other;
  };
  const auto edge = static_cast<std::size_t>(isTop[0] && isTop[1]   ? 0
                                             : isTop[1] && isTop[2] ? 1
                                             : isTop[2] && isTop[0] ? 2
                                                                    : 3);
  if (edge < 3) {
    const int other = own.across[edge];
    if (other < 0) return t;
    if (!staysBelow(other, own.corners[edge], m, tilt)) return -1;
    compare(other);
  } else {
    for (const int other : around(top)) {
      if (!staysBelow(other, top, m, tilt)) return -1;
      compare(other);
    }
  }
  return best;
}

bool TriangleMesh::encloses(const Vector3& p, std::vector<int>& scratch) const {
  const Vector3 reach = centre_ + halfExtents_;
  const double aside = 1e-9 * (reach.norm() + halfExtents_.norm());  // above rounding
  tree_->within({Vector3(p.x() - aside, p.y() - aside, p.z() - aside),
                 Vector3(p.x() + aside, p.y() + aside, std::max(p.z(), reach.z()))},
                scratch);
  // Seen from above, p is on the same side of an edge whichever triangle asks.
  int crossings = 0;
  for (const int t : scratch) {
    const std::array<int, 3>& c = (*this)[t].corners;
    int left = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = c[k], to = c[(k + 1) % 3];
      const Vector3 &a = vertex(std::min(from, to)), &b = vertex(std::max(from, to));
      const Vector3 along = b - a;
      const double side = along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x());
      // On a line p counts as a little beside it, towards +x and far less towards +y.
      const bool isLeft =
          side != 0.0 ? side > 0.0 : along.y() < 0.0 || (along.y() == 0.0 && along.x() > 0.0);
      left += isLeft == (from < to) ? 1 : 0;
    }
    if (left != 0 && left != 3) continue;
    const Vector3& n = (*this)[t].normal;
    if (n.z() != 0.0 && n.dot(vertex(c[0]) - p) / n.z() >= 0.0) ++crossings;
  }
  return crossings % 2 == 1;
}

bool TriangleMesh::holds(const Transform& X_WG, const TriangleMesh& other, const Transform& X_WO,
                         std::vector<int>& scratch) const {
  if (!closed_) return false;
  const Vector3 x = X_WG.inverse() * (X_WO * other.vertex(other[0].corners[0]));
  return ((x - centre_).cwiseAbs() - halfExtents_).maxCoeff() <= 0.0 && encloses(x, scratch);
}

bool TriangleMesh::comesNear(const Vector3& p, double radius) const {
  const Vector3 half = Vector3::Constant(radius);
  return tree_->anyWithin({p - half, p + half});
}

std::size_t TriangleMesh::bytes() const {
  return sizeof(TriangleMesh) + triangles_.capacity() * sizeof(SurfaceTriangle) +
         (around_.start.capacity() + around_.indices.capacity()) * sizeof(int) + tree_->bytes();
}

}  // namespace softgauss::collision
