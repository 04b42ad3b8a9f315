// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/surface_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/detail/fcl_triangle_tree.hpp"
#include "softgauss/collision/detail/triangle_pairs.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision::detail {
namespace {

/// Surfaces nearer than this, of their size, are looked at: those of equal boxes on each other.
constexpr double kTouch = 1e-9;
/// Faces across m show an edge or a corner (support.cpp).
constexpr double kFacing = 0.1;

Box boxAbout(const Triangle& t) {
  const auto& [x, y, z] = t.corners;
  return {x.cwiseMin(y).cwiseMin(z), x.cwiseMax(y).cwiseMax(z)};
}

Box enlarged(Box box, double by) {
  box.lower.array() -= by;
  box.upper.array() += by;
  return box;
}

Box turned(const Box& box, const Transform& X) {
  const Vector3 centre = X * Vector3(0.5 * (box.lower + box.upper));
  const Vector3 half = 0.5 * (X.R.cwiseAbs() * (box.upper - box.lower));
  return {centre - half, centre + half};
}

Box common(const Box& x, const Box& y) {
  return {x.lower.cwiseMax(y.lower), x.upper.cwiseMin(y.upper)};
}

Box boxOf(const TriangleMesh& surface) {
  return {surface.centre() - surface.halfExtents(), surface.centre() + surface.halfExtents()};
}

double highest(const Triangle& t, const Vector3& m) {
  return std::max({m.dot(t.corners[0]), m.dot(t.corners[1]), m.dot(t.corners[2])});
}

}  // namespace

Triangle SurfacePairs::Query::triangleA(int s) const {
  Triangle t = a.triangle(s);
  for (Vector3& x : t.corners) x = X_BA * x;
  t.normal = X_BA.R * t.normal;
  return t;
}

bool SurfacePairs::find(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                        const Transform& X_WB, double margin) {
  touching_.clear();
  open_.clear();
  meetings_.clear();
  points_.clear();
  reduced_ = 0;
  regionIsKnown_ = false;
  Query q{a,
          b,
          X_WB.inverse() * X_WA,
          margin,
          std::min(a.halfExtents().maxCoeff(), b.halfExtents().maxCoeff()),
          {}};
  if (!q.X_BA.R.allFinite() || !q.X_BA.p.allFinite()) return false;
  const double reach = std::max(margin, 0.0) + kTouch * q.size;
  q.region = enlarged(common(turned(boxOf(a), q.X_BA), boxOf(b)), reach);
  if ((q.region.lower.array() > q.region.upper.array()).any()) return true;

  findTouching(q);
  if (touching_.empty()) return true;
  meetEach(q);
  if (!open_.empty()) meetPatches(q);
  if (a.isClosed() && b.isClosed()) meetBetween(q);

  reduced_ = reduction_.reduce(points_, margin, q.size);
  for (PairContact& c : points_) {
    c.p_WC = X_WB * c.p_WC;
    c.n_W = X_WB.R * c.n_W;
  }
  return true;
}

void SurfacePairs::findTouching(const Query& q) {
  const double reach = std::max(q.margin, 0.0) + kTouch * q.size;
  q.b.tree().near(q.a.tree(), q.X_BA, reach, found_);
  for (const auto& [t, s] : found_) {
    const Separation found = separateTriangles(q.triangleA(s), q.b.triangle(t), reach);
    if (found.distance < reach) touching_.push_back({s, t, -found.n_W, found.distance});
  }
  // The least deep first.
  std::sort(touching_.begin(), touching_.end(), [](const Touching& x, const Touching& y) {
    return x.distance > y.distance ||
           (x.distance == y.distance && (x.t < y.t || (x.t == y.t && x.s < y.s)));
  });
}

/// Step 1. Leaves in open_ what no contact frees.
void SurfacePairs::meetEach(const Query& q) {
  for (const Touching& pair : touching_) {
    if (isMet(q, pair)) continue;
    const std::optional<Meeting> meeting = meetingOf(q, pair);
    if (!meeting) {
      open_.push_back(pair);
      continue;
    }
    const Triangle s = q.triangleA(pair.s), t = q.b.triangle(pair.t);
    meetAt(q, *meeting, colliderOf({&s, 1}), colliderOf({&t, 1}));
  }
  std::erase_if(open_, [&](const Touching& pair) { return isFreed(q, pair); });
}

/// Along the direction of least overlap, or, where it is nearly that of a face, along its normal;
/// none where that is no normal of both surfaces.
std::optional<SurfacePairs::Meeting> SurfacePairs::meetingOf(const Query& q,
                                                             const Touching& pair) const {
  const Vector3& n = q.b[pair.t].normal;
  const Vector3 into = -q.normalA(pair.s);
  for (const Vector3& m : {pair.m, n, into}) {
    if (m.dot(pair.m) < kNearlyFace) continue;
    const int ownerB = q.b.owner(pair.t, m, kExactTilt);
    const int ownerA = ownerB < 0 ? -1 : q.a.owner(pair.s, q.X_BA.R.transpose() * -m, kExactTilt);
    if (ownerA >= 0) return Meeting{m, pair.distance, ownerA, ownerB};
  }
  return std::nullopt;
}

/// Whether a pair is apart once A has moved out along some contact by its depth.
bool SurfacePairs::isFreed(const Query& q, const Touching& pair) const {
  const Triangle s = q.triangleA(pair.s), t = q.b.triangle(pair.t);
  return std::any_of(meetings_.begin(), meetings_.end(), [&](const Meeting& meeting) {
    Triangle moved = s;
    const double way = kSearchTilt * q.size + std::max(0.0, -meeting.distance);
    for (Vector3& x : moved.corners) x += way * meeting.m;
    return separateTriangles(moved, t, 0.0).distance >= 0.0;
  });
}

/// Whether both triangles are of faces that lie on each other.
bool SurfacePairs::isMet(const Query& q, const Touching& pair) const {
  return std::any_of(meetings_.begin(), meetings_.end(), [&](const Meeting& meeting) {
    return meeting.m.cross(q.b[meeting.ownerB].normal).norm() < kSearchTilt &&
           meeting.m.cross(q.normalA(meeting.ownerA)).norm() < kSearchTilt &&
           inOnePlane(q.b, meeting.ownerB, pair.t, q.size) &&
           inOnePlane(q.a, meeting.ownerA, pair.s, q.size);
  });
}

/// Step 2.
void SurfacePairs::meetPatches(const Query& q) {
  growPatches(q);
  patchPairs_.clear();
  for (const Touching& pair : open_) {
    const std::pair<int, int> patches(patchesA_.of(pair.s, nearA_), patchesB_.of(pair.t, nearB_));
    if (patches.first >= 0 && patches.second >= 0) patchPairs_.push_back(patches);
  }
  std::sort(patchPairs_.begin(), patchPairs_.end());
  patchPairs_.erase(std::unique(patchPairs_.begin(), patchPairs_.end()), patchPairs_.end());
  for (const auto& [p, r] : patchPairs_) {
    const SurfacePatch a = patchesA_[p], b = patchesB_[r];
    const Collider colliderA = colliderOf(a.triangles), colliderB = colliderOf(b.triangles);
    const Separation found = separate(colliderA, q.X_BA, colliderB, Transform(), q.margin);
    if (!(found.distance < q.margin)) continue;
    const Vector3 m = -found.n_W, into = q.X_BA.R.transpose() * found.n_W;
    const int ownerB = q.b.owner(b.highest(m), m, kSearchTilt);
    const int ownerA = ownerB < 0 ? -1 : q.a.owner(a.highest(into), into, kSearchTilt);
    if (ownerA < 0) continue;
    const Triangle s = q.triangleA(a.highest(into));
    meetAt(q, {m, found.distance, ownerA, ownerB}, colliderOf({&s, 1}), colliderB);
  }
  std::erase_if(open_, [&](const Touching& pair) { return isFreed(q, pair); });
}

/// Patches of both surfaces about what is open, as far again as that reaches: where it is a rim of
/// what is sunk in, all of that.
void SurfacePairs::growPatches(const Query& q) {
  Box open;
  for (const Touching& pair : open_) {
    const Box both = common(enlarged(boxAbout(q.triangleA(pair.s)), kTouch * q.size),
                            boxAbout(q.b.triangle(pair.t)));
    open.lower = open.lower.cwiseMin(both.lower);
    open.upper = open.upper.cwiseMax(both.upper);
  }
  const Box region = enlarged(open, 0.5 * (open.upper - open.lower).maxCoeff() + kTouch * q.size);
  const auto grow = [&](const TriangleMesh& surface, const Box& box, SurfacePatches& patches,
                        std::vector<NearTriangle>& near) {
    surface.tree().within(box, under_);
    near.clear();
    for (const int t : under_) near.push_back({t, 0.0});
    patches.grow(surface, near, q.size);
  };
  grow(q.a, turned(region, q.X_BA.inverse()), patchesA_, nearA_);
  grow(q.b, region, patchesB_, nearB_);
}

/// Step 3.
void SurfacePairs::meetBetween(const Query& q) {
  for (const Touching& pair : open_) {
    if (isFreed(q, pair)) continue;
    const Triangle s = q.triangleA(pair.s), t = q.b.triangle(pair.t);
    const Vector3 sum = t.normal - s.normal;
    const Vector3 m = sum.norm() > kFacing ? Vector3(sum.normalized()) : t.normal;
    const double distance = separationAlong(s, t, -m);
    if (!(distance < q.margin)) continue;
    meetings_.push_back({m, distance, pair.s, pair.t});
    const SupportFace faceA = supportFace(colliderOf({&s, 1}).convex, Transform(), -m);
    const SupportFace faceB = supportFace(colliderOf({&t, 1}).convex, Transform(), m);
    points_.push_back({deepestPoint(faceA, faceB, -m, distance), -m, distance});
  }
}

void SurfacePairs::meetAt(const Query& q, Meeting meeting, const Collider& colliderA,
                          const Collider& colliderB) {
  Vector3& m = meeting.m;
  const Triangle ownA = q.triangleA(meeting.ownerA), ownB = q.b.triangle(meeting.ownerB);
  // On a face the normal is known better.
  if (ownB.normal.cross(m).norm() < 2.0 * kSearchTilt)
    m = ownB.normal;
  else if (ownA.normal.cross(m).norm() < 2.0 * kSearchTilt)
    m = -ownA.normal;
  meeting.distance = -highest(ownA, -m) - highest(ownB, m);
  const bool isKnown = std::any_of(meetings_.begin(), meetings_.end(), [&](const Meeting& other) {
    return other.ownerA == meeting.ownerA && other.ownerB == meeting.ownerB &&
           other.m.cross(m).norm() < kSearchTilt;
  });
  if (isKnown || !(meeting.distance < q.margin)) return;
  meetings_.push_back(meeting);
  const double lowest = addPointsOver(q, meeting);
  if (!(lowest - meeting.distance > 0.1 * (q.margin - meeting.distance))) return;
  // Edges that cross.
  const SupportFace faceA = supportFace(colliderA.convex, Transform(), -m);
  const SupportFace faceB = supportFace(colliderB.convex, Transform(), m);
  points_.push_back({deepestPoint(faceA, faceB, -m, meeting.distance), -m, meeting.distance});
}

/// Adds the points of A's face over B's; returns the least distance.
double SurfacePairs::addPointsOver(const Query& q, const Meeting& meeting) {
  const Vector3& m = meeting.m;
  double lowest = kInfinity;
  if (q.b[meeting.ownerB].normal.dot(m) < kFacing) return lowest;
  if (!regionIsKnown_) {
    q.a.tree().within(turned(q.region, q.X_BA.inverse()), inRegion_);
    regionIsKnown_ = true;
  }
  const bool isFace = -q.normalA(meeting.ownerA).dot(m) >= kFacing;
  for (const int s : inRegion_) {
    if (s != meeting.ownerA && !(isFace && inOnePlane(q.a, meeting.ownerA, s, q.size))) continue;
    const Triangle triangleA = q.triangleA(s);
    const SupportFace face = supportFace(colliderOf({&triangleA, 1}).convex, Transform(), -m);
    const double reach = std::max(q.margin, -meeting.distance) + kTouch * q.size;
    q.b.tree().within(enlarged(boxAbout(triangleA), reach), under_);
    for (const int t : under_) {
      if (!inOnePlane(q.b, meeting.ownerB, t, q.size)) continue;
      const PlanePiece piece = pieceOf(q.b, meeting.ownerB, t, q.size);
      const ClippedFace over = clipToPrism(face, piece, m);
      for (int i = 0; i < over.count; ++i) {
        const double distance = std::max(heightAbove(piece.triangle, over[i], m), meeting.distance);
        if (!(distance < q.margin)) continue;
        points_.push_back({over[i] - 0.5 * distance * m, -m, distance});
        lowest = std::min(lowest, distance);
      }
    }
  }
  return lowest;
}

}  // namespace softgauss::collision::detail
