// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/surface_patches.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision::detail {
namespace {

/// From the outline's side u–v of triangle t, around v through the plane of `owner`, to the other
/// side of the outline at v: its far end. u again where the plane has no other.
int alongOutline(const TriangleMesh& surface, int owner, int t, int v, int u, double size) {
  int across = u;  // the end of the side that was crossed last
  const int most = surface.size();
  for (int turn = 0; turn < most; ++turn) {
    const SurfaceTriangle& here = surface[t];
    // Of the two sides at v the one that was not crossed.
    std::size_t side = 0;
    int end = u;
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = here.corners[k], to = here.corners[(k + 1) % 3];
      const int other = from == v ? to : to == v ? from : across;
      if (other != across) side = k, end = other;
    }
    const int beyond = here.across[side];
    if (beyond < 0 || !inOnePlane(surface, owner, beyond, size)) return end;
    t = beyond;
    across = end;
    if (end == u) break;
  }
  return u;
}

const Shape kTriangleShape = Shape::surface(nullptr);

}  // namespace

Collider colliderOf(std::span<const Triangle> triangles) {
  Collider c;
  c.convex = {&kTriangleShape, nullptr, triangles};
  Vector3 lower = triangles[0].corners[0], upper = lower;
  for (const Triangle& t : triangles)
    for (const Vector3& corner : t.corners) {
      lower = lower.cwiseMin(corner);
      upper = upper.cwiseMax(corner);
    }
  c.boxCentre = 0.5 * (lower + upper);
  c.boxHalfExtents = 0.5 * (upper - lower);
  return c;
}

int SurfacePatch::highest(const Vector3& m) const {
  std::size_t best = 0;
  double height = -kInfinity, facing = -kInfinity;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    double top = -kInfinity;
    for (const Vector3& corner : t.corners) top = std::max(top, m.dot(corner));
    const double faces = t.normal.dot(m);
    if (top > height || (top == height && faces > facing)) best = i, height = top, facing = faces;
  }
  return near[best].t;
}

bool inOnePlane(const TriangleMesh& surface, int s, int t, double size) {
  /// Directions that differ by less are one [rad]: small triangles in single precision.
  constexpr double kOnePlane = 1e-4;
  if (s == t) return true;
  const Vector3 &n = surface[s].normal, &other = surface[t].normal;
  if (n.dot(other) < 0.0 || n.cross(other).squaredNorm() > kOnePlane * kOnePlane) return false;
  const Vector3& o = surface.vertex(surface[s].corners[0]);
  const std::array<int, 3>& corners = surface[t].corners;
  return std::all_of(corners.begin(), corners.end(), [&](int v) {
    const Vector3 x = surface.vertex(v) - o;
    return std::abs(n.dot(x)) <= kOnePlane * std::min(x.norm(), size);
  });
}

PlanePiece pieceOf(const TriangleMesh& surface, int owner, int t, double size) {
  PlanePiece piece{surface.triangle(t), {}, {}};
  const SurfaceTriangle& here = surface[t];
  for (std::size_t k = 0; k < 3; ++k)
    piece.isInner[k] = here.across[k] >= 0 && inOnePlane(surface, owner, here.across[k], size);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t before = (k + 2) % 3;
    if (piece.isInner[k] == piece.isInner[before]) {
      piece.turns[k] = !piece.isInner[k];
      continue;
    }
    const int v = here.corners[k], u = here.corners[piece.isInner[k] ? before : (k + 1) % 3];
    const int w = alongOutline(surface, owner, t, v, u, size);
    const Vector3 to = surface.vertex(v) - surface.vertex(u),
                  on = surface.vertex(w) - surface.vertex(v);
    constexpr double kStraight = 1e-6;
    piece.turns[k] = !(to.dot(on) > 0.0 && to.cross(on).norm() <= kStraight * to.dot(on));
  }
  return piece;
}

int SurfacePatches::placeOf(std::span<const NearTriangle> near, int t) {
  const auto at = std::lower_bound(near.begin(), near.end(), t,
                                   [](const NearTriangle& n, int value) { return n.t < value; });
  return at == near.end() || at->t != t ? -1 : static_cast<int>(at - near.begin());
}

void SurfacePatches::growFrom(const TriangleMesh& surface, std::span<const NearTriangle> near,
                              int seed) {
  const int patch = size();
  const auto take = [&](int place) {
    patchOf_[idx(place)] = patch;
    order_.push_back(place);
  };
  // A hollow edge to what is in the patch already keeps a triangle out.
  const auto fits = [&](const SurfaceTriangle& t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!t.isHollow[k]) continue;
      const int beyond = placeOf(near, t.across[k]);
      if (beyond >= 0 && patchOf_[idx(beyond)] == patch) return false;
    }
    return true;
  };
  take(seed);
  for (std::size_t next = idx(begin_.back()); next < order_.size(); ++next) {
    const SurfaceTriangle& t = surface[near[idx(order_[next])].t];
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.across[k] < 0 || t.isHollow[k]) continue;
      const int place = placeOf(near, t.across[k]);
      if (place >= 0 && patchOf_[idx(place)] < 0 && fits(surface[t.across[k]])) take(place);
    }
  }
}

void SurfacePatches::grow(const TriangleMesh& surface, std::span<const NearTriangle> near,
                          double shapeSize) {
  patchOf_.assign(near.size(), -1);
  order_.clear();
  near_.clear();
  triangles_.clear();
  isPlain_.clear();
  begin_.assign(1, 0);
  for (int place = 0; place < static_cast<int>(near.size()); ++place) {
    if (patchOf_[idx(place)] >= 0) continue;
    growFrom(surface, near, place);
    bool isPlain = true;
    for (std::size_t i = idx(begin_.back()); i < order_.size(); ++i) {
      const NearTriangle& n = near[idx(order_[i])];
      near_.push_back(n);
      triangles_.push_back(surface.triangle(n.t));
      const SurfaceTriangle& t = surface[n.t];
      isPlain = isPlain && inOnePlane(surface, near[idx(place)].t, n.t, shapeSize);
      for (std::size_t k = 0; k < 3; ++k)
        isPlain = isPlain && t.across[k] >= 0 &&
                  (t.isHollow[k] || inOnePlane(surface, n.t, t.across[k], shapeSize));
    }
    isPlain_.push_back(isPlain ? 1 : 0);
    begin_.push_back(static_cast<int>(order_.size()));
  }
}

int SurfacePatches::of(int t, std::span<const NearTriangle> near) const {
  const int place = placeOf(near, t);
  return place < 0 ? -1 : patchOf_[idx(place)];
}

SurfacePatch SurfacePatches::operator[](int p) const {
  const std::size_t first = idx(begin_[idx(p)]), count = idx(begin_[idx(p + 1)]) - first;
  return {{near_.data() + first, count}, {triangles_.data() + first, count}, isPlain_[idx(p)] != 0};
}

}  // namespace softgauss::collision::detail
