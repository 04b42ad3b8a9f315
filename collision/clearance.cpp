// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "softgauss/collision/detail/geometry_set.hpp"
#include "softgauss/collision/detail/nearest_points.hpp"
#include "softgauss/collision/detail/nearest_triangle.hpp"
#include "softgauss/collision/filter.hpp"
#include "softgauss/collision/manifold.hpp"

namespace softgauss::collision {
namespace {

/// Corners of faces count that are no farther than the nearest points and this share of the smaller
/// shape; overlaps are looked for where shapes touch to this share.
constexpr double kBand = 0.5, kTouching = 1e-6;
/// n is the normal of a face up to this, one minus the cosine.
constexpr double kFlat = 1e-11;

/// Any surface, of which the triangles are told beside it.
const Shape kTriangles = Shape::surface(nullptr);

/// One triangle, in the frame of its mesh. It must outlive the result.
detail::Collider colliderOf(const Triangle& triangle) {
  detail::Collider collider;
  collider.convex = {&kTriangles, nullptr, {&triangle, 1}};
  const auto& [x, y, z] = triangle.corners;
  const Vector3 lower = x.cwiseMin(y).cwiseMin(z), upper = x.cwiseMax(y).cwiseMax(z);
  collider.boxCentre = 0.5 * (lower + upper);
  collider.boxHalfExtents = 0.5 * (upper - lower);
  return collider;
}

/// As of NearPoints.
using Straight = std::array<Vector3, 2>;

/// Of a flat face with the normal n.
Straight across(const Vector3& n) {
  const Vector3 u = n.unitOrthogonal();
  return {u, n.cross(u)};
}

}  // namespace

struct Clearance::Scene {
  Scene(const Model& model, PreparedMeshes& meshes) : set(model, meshes) {}

  const detail::GeometrySet set;
  detail::PairTest test;
  std::array<NearPoints, PairContacts::kCapacity + 1> points;
  std::size_t count = 0;
  std::vector<int> scratch;

  void add(const PairContact& c, const Straight& alongA, const Straight& alongB) {
    if (count == points.size()) return;
    const Vector3 half = 0.5 * c.distance * c.n_W;
    points[count++] = {c.p_WC - half, c.p_WC + half, c.n_W, c.distance, alongA, alongB};
  }
  void addNearest(const detail::Collider& a, const Transform& X_WA, const detail::Collider& b,
                  const Transform& X_WB, const NearPoints& nearest);
  void addContacts(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin);
  void underPlane(int a, const Transform& X_WA, int b, const Transform& X_WB);
  bool apart(int a, const Transform& X_WA, int b, const Transform& X_WB);
  bool apartFromSurface(int a, const Transform& X_WA, int b, const Transform& X_WB);
  bool surfacesApart(int a, const Transform& X_WA, int b, const Transform& X_WB);
};

/// The nearest points, and the corners of the faces that lie opposite each other there.
void Clearance::Scene::addNearest(const detail::Collider& a, const Transform& X_WA,
                                  const detail::Collider& b, const Transform& X_WB,
                                  const NearPoints& nearest) {
  const auto straighten = [](const detail::Collider& of, const Transform& X, const Vector3& n,
                             Straight& along) {
    if (supportFaceNormal(of.convex, X, n).dot(n) > 1.0 - kFlat) along = across(n);
  };
  NearPoints& first = points[count++] = nearest;
  straighten(a, X_WA, first.n_W, first.alongA);
  straighten(b, X_WB, -first.n_W, first.alongB);
  const double size = std::min(a.boxHalfExtents.maxCoeff(), b.boxHalfExtents.maxCoeff());
  const PairContact deepest{0.5 * (nearest.p_WA + nearest.p_WB), nearest.n_W, nearest.distance};
  PairContacts corners;
  addFaceContacts(supportFace(a.convex, X_WA, nearest.n_W),
                  supportFace(b.convex, X_WB, -nearest.n_W), deepest,
                  nearest.distance + kBand * size, corners);
  if (corners.count < 2) return;
  for (int i = 0; i < corners.count; ++i) add(corners[i], first.alongA, first.alongB);
}

/// What overlaps, or nearly, as contacts see it.
void Clearance::Scene::addContacts(int a, const Transform& X_WA, int b, const Transform& X_WB,
                                   double margin) {
  if (!set.test(a, X_WA, b, X_WB, margin, test)) return;
  const Straight along = set.isPlane(a) ? across(X_WA.R.col(2)) : NearPoints().alongA;
  if (const bool isSurface = set.surface[static_cast<std::size_t>(b)] != nullptr) {
    if (const PairContact* deepest = isSurface ? test.deepest() : nullptr)
      add(*deepest, along, NearPoints().alongB);
    return;
  }
  for (int i = 0; i < test.found.count; ++i) add(test.found[i], along, NearPoints().alongB);
}

void Clearance::Scene::underPlane(int a, const Transform& X_WA, int b, const Transform& X_WB) {
  if (set.isPlane(b)) return;
  const auto j = static_cast<std::size_t>(b);
  const Vector3 n = X_WA.R.col(2);
  double lowest = kInfinity;
  if (const TriangleMesh* surface = set.surface[j].get()) {
    Vector3 point = Vector3::Zero();
    for (int v = 0; v < surface->vertices(); ++v) {
      const Vector3 x = X_WB * surface->vertex(v);
      if (const double height = n.dot(x - X_WA.p); height < lowest) lowest = height, point = x;
    }
    if (std::isfinite(lowest))
      add({point - 0.5 * lowest * n, n, lowest}, across(n), NearPoints().alongB);
    return;
  }
  lowest = n.dot(supportPoint(set.colliders[j].convex, X_WB, -n) - X_WA.p);
  if (std::isfinite(lowest)) addContacts(a, X_WA, b, X_WB, lowest + kBand * set.radius[j]);
}

bool Clearance::Scene::apartFromSurface(int a, const Transform& X_WA, int b,
                                        const Transform& X_WB) {
  const detail::Collider& shape = set.colliders[static_cast<std::size_t>(a)];
  const TriangleMesh& surface = *set.surface[static_cast<std::size_t>(b)];
  const Transform X_GA = X_WB.inverse() * X_WA;
  const Vector3 centre = X_GA * shape.boxCentre;
  if (!centre.allFinite() || !X_GA.R.allFinite()) return false;
  const Vector3 half = X_GA.R.cwiseAbs() * shape.boxHalfExtents;
  int nearest = -1;
  const double best = detail::nearestTriangle(
      surface.tree(), {centre - half, centre + half}, kInfinity, [&](int t, double nearer) {
        const Triangle triangle = surface.triangle(t);
        NearPoints found;
        const bool isApart =
            detail::nearestPoints(shape, X_GA, colliderOf(triangle), {}, nearer, found);
        const double distance = isApart ? std::max(found.distance, 0.0) : 0.0;
        if (distance < nearer) nearest = t;
        return distance;
      });
  const Vector3 aside = (centre - surface.centre()).cwiseAbs() - surface.halfExtents();
  if (nearest < 0 || !(best > 0.0)) return false;
  if (surface.isClosed() && aside.maxCoeff() <= 0.0 && surface.encloses(centre, scratch))
    return false;
  const Triangle triangle = surface.triangle(nearest);
  const detail::Collider other = colliderOf(triangle);
  NearPoints found;
  if (!detail::nearestPoints(shape, X_WA, other, X_WB, kInfinity, found)) return false;
  addNearest(shape, X_WA, other, X_WB, found);
  return true;
}

bool Clearance::Scene::surfacesApart(int a, const Transform& X_WA, int b, const Transform& X_WB) {
  const TriangleMesh &first = *set.surface[static_cast<std::size_t>(a)],
                     &second = *set.surface[static_cast<std::size_t>(b)];
  const Transform X_AB = X_WA.inverse() * X_WB;
  if (!X_AB.R.allFinite() || !X_AB.p.allFinite()) return false;
  std::pair<int, int> nearest{-1, -1};
  const double best = detail::nearestTriangles(
      first.tree(), second.tree(), X_AB, kInfinity, [&](int s, int t, double nearer) {
        const Triangle one = first.triangle(s), two = second.triangle(t);
        NearPoints found;
        const bool isApart =
            detail::nearestPoints(colliderOf(one), {}, colliderOf(two), X_AB, nearer, found);
        const double distance = isApart ? found.distance : 0.0;
        if (distance < nearer) nearest = {s, t};
        return distance;
      });
  if (nearest.first < 0 || !(best > 0.0) || first.holds(X_WA, second, X_WB, scratch) ||
      second.holds(X_WB, first, X_WA, scratch))
    return false;
  const Triangle one = first.triangle(nearest.first), two = second.triangle(nearest.second);
  const detail::Collider colliderA = colliderOf(one), colliderB = colliderOf(two);
  NearPoints found;
  if (!detail::nearestPoints(colliderA, X_WA, colliderB, X_WB, kInfinity, found)) return false;
  addNearest(colliderA, X_WA, colliderB, X_WB, found);
  return true;
}

/// Whether the two are apart; then their points are there.
bool Clearance::Scene::apart(int a, const Transform& X_WA, int b, const Transform& X_WB) {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  if (set.surface[i]) return surfacesApart(a, X_WA, b, X_WB);
  if (set.surface[j]) return apartFromSurface(a, X_WA, b, X_WB);
  NearPoints found;
  if (!detail::nearestPoints(set.colliders[i], X_WA, set.colliders[j], X_WB, kInfinity, found) ||
      !(found.distance > 0.0))
    return false;
  addNearest(set.colliders[i], X_WA, set.colliders[j], X_WB, found);
  return true;
}

Clearance::Clearance(const Model& model, PreparedMeshes meshes)
    : scene_(std::make_unique<Scene>(model, meshes)) {}
Clearance::~Clearance() = default;

std::span<const NearPoints> Clearance::between(int a, const Transform& X_WA, int b,
                                               const Transform& X_WB) noexcept {
  Scene& s = *scene_;
  s.count = 0;
  const bool isTurned = !(inOrder(s.set.model, a, b) == GeometryPair{a, b});
  const auto& [i, X_WI, j, X_WJ] =
      isTurned ? std::tie(b, X_WB, a, X_WA) : std::tie(a, X_WA, b, X_WB);
  if (s.set.isPlane(i)) {
    s.underPlane(i, X_WI, j, X_WJ);
  } else if (!s.apart(i, X_WI, j, X_WJ)) {
    const double size = std::min(s.set.radius[static_cast<std::size_t>(i)],
                                 s.set.radius[static_cast<std::size_t>(j)]);
    s.addContacts(i, X_WI, j, X_WJ, kTouching * size);
  }
  const auto end = s.points.begin() + static_cast<std::ptrdiff_t>(s.count);
  const auto nearest = std::min_element(
      s.points.begin(), end,
      [](const NearPoints& x, const NearPoints& y) { return x.distance < y.distance; });
  if (nearest != end) std::iter_swap(s.points.begin(), nearest);
  if (isTurned)
    for (auto point = s.points.begin(); point != end; ++point) {
      std::swap(point->p_WA, point->p_WB);
      std::swap(point->alongA, point->alongB);
      point->n_W = -point->n_W;
    }
  return {s.points.data(), s.count};
}

std::vector<LinkClearance> clearances(const Model& model, const Kinematics& kinematics,
                                      Clearance& distances) {
  // What is joined never is apart, and is not told.
  const PairFilter joined = makePairFilter(model, [](const GeometryPair&) { return 0.0; });
  std::map<std::pair<std::string, std::string>, double> least;
  for (const GeometryPair& pair : joined.pairs) {
    const Geometry& a = model.geometries[static_cast<std::size_t>(pair.a)];
    const Geometry& b = model.geometries[static_cast<std::size_t>(pair.b)];
    const auto points =
        distances.between(pair.a, kinematics.X_WB[static_cast<std::size_t>(a.body)] * a.X_BG,
                          pair.b, kinematics.X_WB[static_cast<std::size_t>(b.body)] * b.X_BG);
    if (points.empty()) continue;
    double& distance = least.try_emplace(std::minmax(a.link, b.link), kInfinity).first->second;
    distance = std::min(distance, std::max(points.front().distance, 0.0));
  }
  std::vector<LinkClearance> result;
  for (const auto& [links, distance] : least)
    result.push_back({links.first, links.second, distance});
  std::stable_sort(
      result.begin(), result.end(),
      [](const LinkClearance& x, const LinkClearance& y) { return x.distance < y.distance; });
  return result;
}

}  // namespace softgauss::collision
