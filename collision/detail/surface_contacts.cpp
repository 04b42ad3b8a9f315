// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/surface_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/detail/fcl_triangle_tree.hpp"
#include "softgauss/collision/detail/minkowski.hpp"
#include "softgauss/collision/detail/prism_clip.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision::detail {
namespace {

/// A is sunk so deep, of its size, that it may have the plane of a triangle within it and the
/// triangle beside it.
constexpr double kShallow = 0.02;

bool isBall(const Collider& a) { return a.convex.shape->kind == ShapeKind::sphere; }

/// Which of two triangles the shape lies less deep behind.
bool isLessDeep(const NearTriangle& x, const NearTriangle& y) {
  return x.low > y.low || (x.low == y.low && x.t < y.t);
}

/// Whether a ball about c is clearly off the triangle: beyond its plane or, within that, an edge.
bool isClearOf(const Triangle& triangle, const Vector3& c, double radius) {
  // For rounding, of the normal of a sliver too. More costs time and changes no contact.
  constexpr double kRounding = 1.0 + 1e-6;
  const Vector3& n = triangle.normal;
  const double height = n.dot(c - triangle.corners[0]);
  const double within = kRounding * (radius * radius - height * height);
  if (within < 0.0) return true;
  for (int i = 0; i < 3; ++i) {
    const Vector3 edge = triangle.corners[(i + 1) % 3] - triangle.corners[i];
    const double out = edge.cross(n).dot(c - triangle.corners[i]);
    if (out > 0.0 && out * out > within * edge.squaredNorm()) return true;
  }
  return false;
}

/// From c to the nearest point of the triangle; `onFace` where that is inside it.
Vector3 toNearest(const Triangle& triangle, const Vector3& c, bool& onFace) {
  Simplex simplex;
  for (const Vector3& corner : triangle.corners) simplex.add(corner - c);
  const Vector3 v = nearestToOrigin(simplex);
  onFace = simplex.count == 3;
  return v;
}

}  // namespace

bool SurfaceContacts::find(const Collider& a, const Transform& X_WA, const TriangleMesh& surface,
                           const Transform& X_WB, double margin, SurfaceReach* memory) {
  near_.clear();
  waiting_.clear();
  meetings_.clear();
  points_.clear();
  reduced_ = 0;
  const Query q{a, X_WB.inverse() * X_WA, surface, margin, a.boxHalfExtents.minCoeff()};
  if (!q.X_GA.R.allFinite() || !q.X_GA.p.allFinite()) return false;
  const Vector3 centre = q.X_GA * a.boxCentre;
  const Vector3 reach = (q.X_GA.R.cwiseAbs() * a.boxHalfExtents).array() +
                        (std::max(margin, 0.0) + kExactTilt * q.size);
  const Vector3 apart = (centre - surface.centre()).cwiseAbs() - surface.halfExtents() - reach;
  if (apart.maxCoeff() > 0.0) return true;

  findTriangles(q, {centre - reach, centre + reach}, memory);
  for (const int t : found_)
    if (!lookAt(q, t)) return false;
  if (isBall(a)) {
    if (!meetBall(q)) return false;
  } else {
    if (!meetEach(q)) return false;
    patches_.grow(surface, open_, q.size);
    for (int p = 0; p < patches_.size(); ++p)
      if (!meetPatch(q, patches_[p])) return false;
  }
  meetWaiting(q);
  if (points_.empty()) meetDeepest(q);
  if (points_.empty() && surface.isClosed()) leaveInside(q);

  reduced_ = reduction_.reduce(points_, margin, q.size);
  for (PairContact& c : points_) {
    c.p_WC = X_WB * c.p_WC;
    c.n_W = X_WB.R * c.n_W;
  }
  return true;
}

/// Those whose own boxes overlap `box`, into found_, in rising order.
void SurfaceContacts::findTriangles(const Query& q, const Box& box, SurfaceReach* reach) {
  if (!reach) return q.surface.tree().within(box, found_);
  if (!reach->fat.contains(box)) {
    const Vector3 slack = Vector3::Constant(0.5 * q.size);
    reach->fat = {box.lower - slack, box.upper + slack};
    q.surface.tree().within(reach->fat, reach->triangles);
  }
  found_.clear();
  for (const int t : reach->triangles) {
    const std::array<int, 3>& c = q.surface[t].corners;
    const Vector3 &x = q.surface.vertex(c[0]), &y = q.surface.vertex(c[1]),
                  &z = q.surface.vertex(c[2]);
    if (box.overlaps({x.cwiseMin(y).cwiseMin(z), x.cwiseMax(y).cwiseMax(z)})) found_.push_back(t);
  }
}

bool SurfaceContacts::findOnPlane(const Transform& X_WA, const TriangleMesh& surface,
                                  const Transform& X_WB, double margin) {
  points_.clear();
  reduced_ = 0;
  const Vector3 n = X_WA.R.col(2);
  if (!X_WA.p.allFinite() || !n.allFinite()) return false;
  for (int v = 0; v < surface.vertices(); ++v) {
    const Vector3 x = X_WB * surface.vertex(v);
    const double distance = n.dot(x - X_WA.p);
    if (distance < margin) points_.push_back({x - 0.5 * distance * n, n, distance});
  }
  reduced_ = reduction_.reduce(points_, margin, surface.halfExtents().maxCoeff());
  return true;
}

void SurfaceContacts::flip() {
  for (PairContact& c : points_) c.n_W = -c.n_W;
}

/// Whether triangle t is in reach. False where a number is not finite.
bool SurfaceContacts::lookAt(const Query& q, int t) {
  const Vector3& n = q.surface[t].normal;
  const double plane = n.dot(q.surface.vertex(q.surface[t].corners[0]));
  const double low = n.dot(supportPoint(q.a.convex, q.X_GA, -n)) - plane;
  if (!(low < q.margin)) return std::isfinite(low);
  if (n.dot(supportPoint(q.a.convex, q.X_GA, n)) < plane) return true;
  // What is behind an open surface is not in it.
  if (!q.surface.isClosed() && n.dot(q.X_GA * q.a.boxCentre) < plane) return true;
  near_.push_back({t, low});
  return true;
}

bool SurfaceContacts::meetBall(const Query& q) {
  const double radius = q.a.convex.shape->radius;
  std::size_t touched = 0;
  for (const NearTriangle near : near_) {
    const Triangle triangle = q.surface.triangle(near.t);
    if (isClearOf(triangle, q.X_GA.p, radius + std::max(q.margin, 0.0))) continue;
    bool onFace = false;
    const Vector3 v = toNearest(triangle, q.X_GA.p, onFace);
    const double length = v.norm();
    if (!std::isfinite(length)) return false;
    if (!(length - radius < q.margin)) continue;
    near_[touched++] = near;
    const bool exact = length == 0.0 || (onFace && triangle.normal.dot(v) < 0.0);
    const Vector3 m = exact ? triangle.normal : Vector3(-v / length);
    const int owner = q.surface.owner(near.t, m, kExactTilt);
    if (owner < 0) {
      waiting_.push_back(near);
      continue;
    }
    const double distance = exact ? near.low : length - radius;
    meetings_.push_back({m, distance, owner});
    points_.push_back({q.X_GA.p - (radius + 0.5 * distance) * m, -m, distance});
  }
  near_.resize(touched, NearTriangle{});
  return true;
}

/// Step 1. Leaves in open_ what A overlaps and none of the meetings frees it of.
bool SurfaceContacts::meetEach(const Query& q) {
  open_ = near_;
  if (q.surface.isConvex()) return true;
  std::sort(open_.begin(), open_.end(), isLessDeep);
  std::size_t left = 0;
  for (const NearTriangle near : open_) {
    if (isMet(q, near.t)) continue;
    const Triangle triangle = q.surface.triangle(near.t);
    const Collider collider = colliderOf({&triangle, 1});
    const Separation found = separate(q.a, q.X_GA, collider, Transform(), q.margin);
    if (std::isnan(found.distance)) return false;
    if (found.distance >= q.margin) continue;
    // On a face nearly along m there is no other normal.
    const bool isFace = triangle.normal.dot(-found.n_W) > kNearlyFace;
    const Vector3 m = isFace ? triangle.normal : Vector3(-found.n_W);
    const int owner = isFace ? near.t : q.surface.owner(near.t, m, kSearchTilt);
    if (owner < 0)
      open_[left++] = near;
    else
      meetAt(q, collider, owner, m, found.distance);
  }
  open_.resize(left, NearTriangle{});
  std::erase_if(open_, [&](const NearTriangle& near) {
    return std::any_of(meetings_.begin(), meetings_.end(),
                       [&](const Meeting& m) { return frees(q, m, near.t); });
  });
  std::sort(open_.begin(), open_.end(),
            [](const NearTriangle& x, const NearTriangle& y) { return x.t < y.t; });
  return true;
}

/// Whether A, moved out along a meeting by its depth, leaves a triangle.
bool SurfaceContacts::frees(const Query& q, const Meeting& meeting, int t) const {
  const Triangle triangle = q.surface.triangle(t);
  Transform X = q.X_GA;
  X.p += (kSearchTilt * q.size + std::max(0.0, -meeting.distance)) * meeting.m;
  return separate(q.a, X, colliderOf({&triangle, 1}), Transform(), 0.0).distance >= 0.0;
}

/// Step 2; where the direction is no normal, the triangles wait for step 3.
bool SurfaceContacts::meetPatch(const Query& q, const SurfacePatch& patch) {
  const NearTriangle& first = patch.near[0];
  if (patch.isPlain && -first.low <= kShallow * q.size) {
    waiting_.push_back(first);
    return true;
  }
  const Collider collider = colliderOf(patch.triangles);
  const Separation found = separate(q.a, q.X_GA, collider, Transform(), q.margin);
  if (std::isnan(found.distance)) return false;
  if (found.distance >= q.margin) return true;
  const Vector3 m = -found.n_W;
  const int owner = q.surface.owner(patch.highest(m), m, kSearchTilt);
  if (owner < 0) {
    waiting_.insert(waiting_.end(), patch.near.begin(), patch.near.end());
    return true;
  }
  meetAt(q, collider, owner, m, found.distance);
  return true;
}

/// A contact along m, at the triangle `owner`; `collider` is what was found to be at the distance.
void SurfaceContacts::meetAt(const Query& q, const Collider& collider, int owner, Vector3 m,
                             double distance) {
  // On a face the normal is known better.
  if (const Vector3& n = q.surface[owner].normal; n.cross(m).norm() < 2.0 * kSearchTilt) {
    if (isMet(q, owner)) return;
    m = n;
    distance =
        n.dot(supportPoint(q.a.convex, q.X_GA, -n) - q.surface.vertex(q.surface[owner].corners[0]));
  }
  const auto isSame = [&](const Meeting& other) {
    return other.owner == owner && other.m.cross(m).norm() < kSearchTilt;
  };
  if (std::any_of(meetings_.begin(), meetings_.end(), isSame)) return;
  meetings_.push_back({m, distance, owner});
  const double lowest = addPointsOver(q, owner, m);
  if (!(lowest - distance > 0.1 * (q.margin - distance))) return;
  // Edges that cross, and what is round.
  const SupportFace faceA = supportFace(q.a.convex, q.X_GA, -m);
  const SupportFace faceB = supportFace(collider.convex, Transform(), m);
  points_.push_back({deepestPoint(faceA, faceB, -m, distance), -m, distance});
}

/// Whether the plane of a triangle is met along its normal.
bool SurfaceContacts::isMet(const Query& q, int t) const {
  return std::any_of(meetings_.begin(), meetings_.end(), [&](const Meeting& other) {
    return other.m.cross(q.surface[other.owner].normal).norm() < kSearchTilt &&
           inOnePlane(q.surface, other.owner, t, q.size);
  });
}

double SurfaceContacts::addPointsOver(const Query& q, int owner, const Vector3& m) {
  double lowest = kInfinity;
  const SupportFace face = supportFace(q.a.convex, q.X_GA, -m);
  for (const NearTriangle& near : near_) {
    if (!inOnePlane(q.surface, owner, near.t, q.size)) continue;
    const Triangle triangle = q.surface.triangle(near.t);
    if (!(triangle.normal.dot(m) > 0.1)) continue;
    // What is far below the plane of a triangle need not have come through the triangle.
    if (-near.low > kShallow * q.size && !isBall(q.a) &&
        separate(q.a, q.X_GA, colliderOf({&triangle, 1}), Transform(), q.margin).distance >=
            q.margin)
      continue;
    const PlanePiece piece = pieceOf(q.surface, owner, near.t, q.size);
    const ClippedFace over = clipToPrism(face, piece, m);
    for (int i = 0; i < over.count; ++i) {
      const double distance = heightAbove(triangle, over[i], m);
      if (!(distance < q.margin)) continue;
      points_.push_back({over[i] - 0.5 * distance * m, -m, distance});
      lowest = std::min(lowest, distance);
    }
  }
  return lowest;
}

void SurfaceContacts::meetWaiting(const Query& q) {
  // The least deep first, so that deeper ones may be left to them.
  std::sort(waiting_.begin(), waiting_.end(), isLessDeep);
  for (const NearTriangle& near : waiting_) {
    const Vector3& n = q.surface[near.t].normal;
    if (isMet(q, near.t)) continue;
    const std::size_t before = points_.size();
    const double lowest = addPointsOver(q, near.t, n);
    if (lowest < kInfinity && isLeftToOthers(q, near, -lowest)) {
      points_.resize(before, PairContact{});
      continue;
    }
    // A plane over which there is nothing is met too.
    meetings_.push_back({n, lowest, near.t});
  }
}

bool SurfaceContacts::isLeftToOthers(const Query& q, const NearTriangle& near, double depth) const {
  const Triangle triangle = q.surface.triangle(near.t);
  const double tolerance = kSearchTilt * q.a.boxHalfExtents.norm();
  for (const Meeting& other : meetings_) {
    double top = -kInfinity;
    for (const Vector3& corner : triangle.corners) top = std::max(top, other.m.dot(corner));
    const double way = top - other.m.dot(supportPoint(q.a.convex, q.X_GA, -other.m));
    if (!(way <= tolerance - other.distance && way < depth)) continue;
    return isBall(q.a) ||
           separate(q.a, q.X_GA, colliderOf({&triangle, 1}), Transform(), q.margin).distance >
               near.low + kExactTilt * q.size;
  }
  return false;
}

void SurfaceContacts::meetDeepest(const Query& q) {
  std::sort(near_.begin(), near_.end(), isLessDeep);
  for (const NearTriangle& near : near_) {
    const Triangle triangle = q.surface.triangle(near.t);
    if (!(near.low < 0.0)) continue;
    if (!(separate(q.a, q.X_GA, colliderOf({&triangle, 1}), Transform(), 0.0).distance < 0.0))
      continue;
    const Vector3& n = triangle.normal;
    const Vector3 x = supportPoint(q.a.convex, q.X_GA, -n);
    points_.push_back({x - 0.5 * near.low * n, -n, near.low});
    return;
  }
}

void SurfaceContacts::leaveInside(const Query& q) {
  const Vector3 centre = q.X_GA * q.a.boxCentre;
  const Vector3 beyond = (centre - q.surface.centre()).cwiseAbs() - q.surface.halfExtents();
  if (beyond.maxCoeff() > 0.0 || !q.surface.encloses(centre, found_)) return;
  // A box about the centre grows until the nearest point is within it.
  Vector3 nearest = Vector3::Zero();
  double length = kInfinity;
  for (double reach = q.size; !(length <= reach); reach *= 2.0) {
    const Vector3 half = Vector3::Constant(reach);
    q.surface.tree().within({centre - half, centre + half}, found_);
    for (const int t : found_) {
      bool onFace = false;
      const Vector3 v = toNearest(q.surface.triangle(t), centre, onFace);
      if (v.norm() < length) length = v.norm(), nearest = v;
    }
    if (reach > 4.0 * q.surface.boundingRadius() + q.size) break;
  }
  if (!(length < kInfinity) || length == 0.0) return;
  const Vector3 m = nearest / length;
  const Vector3 x = supportPoint(q.a.convex, q.X_GA, -m);
  const double distance = m.dot(x - centre) - length;
  points_.push_back({x - 0.5 * distance * m, -m, distance});
}

}  // namespace softgauss::collision::detail
