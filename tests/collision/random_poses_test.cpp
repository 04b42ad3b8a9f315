// SPDX-License-Identifier: Apache-2.0
// Closed meshes at random, at random poses against each other and against every kind of shape. The
// referee counts crossings of rays: what lies deep in both must be found. In a child process with a
// time limit, so that an abort or a loop without an end fails one test.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "softgauss/collision/detail/geometry_set.hpp"
#include "softgauss/collision/filter.hpp"
#include "softgauss/collision/support.hpp"
#include "softgauss/engine/core/index.hpp"
#include "tests/collision/random_meshes.hpp"
#include "tests/collision/random_pairs.hpp"
#include "tests/support/in_child.hpp"

namespace softgauss::test {
namespace {

using collision::PairContact;
using collision::PreparedMeshes;
using collision::RandomPairs;

/// What lies so deep in both shapes must be found [m]; they are some decimetres wide.
constexpr double kDeep = 2e-3;

// ---- Shapes -------------------------------------------------------------------------------------

Shape anyShape(RandomPairs& random) {
  const int kind = int(random.uniform(0, 10));
  if (kind < 5)
    return random.shape(std::array{ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder,
                                   ShapeKind::box, ShapeKind::ellipsoid}[idx(kind)]);
  if (kind == 5) return Shape::hull(bumpyBall(random, 0.3));
  return Shape::surface(closedMesh(random));
}

// ---- The referee --------------------------------------------------------------------------------

/// Distance from x to a triangle, by its Voronoi regions (Ericson, Real-Time Collision Detection).
double distanceTo(const Vector3& x, const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto toSegment = [&](const Vector3& p, const Vector3& q) {
    const Vector3 u = q - p;
    const double s = std::clamp((x - p).dot(u) / u.squaredNorm(), 0.0, 1.0);
    return (x - p - s * u).norm();
  };
  const Vector3 n = (b - a).cross(c - a);
  const bool isOver = n.dot((b - a).cross(x - a)) >= 0 && n.dot((c - b).cross(x - b)) >= 0 &&
                      n.dot((a - c).cross(x - c)) >= 0;
  if (isOver && n.squaredNorm() > 0.0) return std::abs(n.dot(x - a)) / n.norm();
  return std::min({toSegment(a, b), toSegment(b, c), toSegment(c, a)});
}

/// How deep x lies in a shape, a lower bound: ≤ 0 outside.
double depthIn(const Shape& s, const collision::ConvexHull* hull, const Vector3& x,
               RandomPairs& random) {
  switch (s.kind) {
    case ShapeKind::sphere:
      return s.radius - x.norm();
    case ShapeKind::capsule:
      return s.radius -
             Vector3(x.x(), x.y(), x.z() - std::clamp(x.z(), -s.halfLength, s.halfLength)).norm();
    case ShapeKind::cylinder:
      return std::min(s.radius - x.head<2>().norm(), s.halfLength - std::abs(x.z()));
    case ShapeKind::ellipsoid:
      // The ellipsoid scaled to pass through x has the same shape.
      return s.halfExtents.minCoeff() * (1.0 - x.cwiseQuotient(s.halfExtents).norm());
    case ShapeKind::box:
      return (s.halfExtents - x.cwiseAbs()).minCoeff();
    case ShapeKind::mesh: {
      double depth = kInfinity;
      for (const collision::HullFace& face : hull->faces)
        depth = std::min(depth, face.normal.dot(hull->vertices[idx(face.vertices[0])] - x));
      return depth;
    }
    default:
      break;
  }
  // Three rays: one may graze an edge.
  int inside = 0;
  for (int i = 0; i < 3; ++i) inside += insideMesh(*s.mesh, x, random.vector(1.0));
  if (inside < 2) return 0.0;
  double depth = kInfinity;
  for (const auto& t : s.mesh->triangles)
    depth = std::min(depth, distanceTo(x, s.mesh->vertices[idx(t[0])], s.mesh->vertices[idx(t[1])],
                                       s.mesh->vertices[idx(t[2])]));
  return depth;
}

double radiusOf(const Shape& s) {
  double radius = std::max(s.radius + s.halfLength, s.halfExtents.norm());
  if (s.mesh)
    for (const Vector3& x : s.mesh->vertices) radius = std::max(radius, x.norm());
  return radius;
}

// ---- The trial ----------------------------------------------------------------------------------

struct Tally {
  int poses = 0, touching = 0, deep = 0;
  std::ostringstream wrong;
};

/// What lies deep in both has contacts; all contacts are of finite numbers and unit normals.
void tryPoses(unsigned seed, int poses, Tally& tally) {
  RandomPairs random(seed);
  const Model model = twoBodies(Shape::surface(closedMesh(random)), anyShape(random));
  PreparedMeshes meshes;
  const collision::detail::GeometrySet set(model, meshes);
  collision::detail::PairTest test;
  const auto [a, b] = collision::inOrder(model, 0, 1);
  const Shape &shapeA = set.geometry(a).shape, &shapeB = set.geometry(b).shape;
  const double radiusA = radiusOf(shapeA), reach = 0.6 * (radiusA + radiusOf(shapeB));
  for (int i = 0; i < poses; ++i, ++tally.poses) {
    const Transform X_WA = random.pose(reach / 2), X_WB = random.pose(reach / 2);
    const auto say = [&](const char* what) -> std::ostringstream& {
      tally.wrong << "seed " << seed << " pose " << i << " kind " << int(shapeA.kind) << " with "
                  << int(shapeB.kind) << ": " << what << '\n';
      return tally.wrong;
    };
    if (!set.test(a, X_WA, b, X_WB, 0.0, test)) say("nothing is known");
    const std::vector<PairContact> points = test.points ? *test.points : std::vector<PairContact>();
    double deepest = kInfinity;
    for (const PairContact& c : points) {
      deepest = std::min(deepest, c.distance);
      if (!c.p_WC.allFinite() || !std::isfinite(c.distance) ||
          !(std::abs(c.n_W.norm() - 1.0) < 1e-9) || (c.p_WC - X_WA.p).norm() > 2.0 * radiusA + 1.0)
        say("a contact is no contact");
    }
    tally.touching += deepest < 0.0;
    double common = 0.0;
    for (int k = 0; k < 12 && common < kDeep; ++k) {
      const Vector3 x = X_WA * random.vector(radiusA);
      const double inB = depthIn(shapeB, set.hull[idx(b)].get(), X_WB.inverse() * x, random);
      if (inB < kDeep) continue;
      common = std::max(common, std::min(inB, depthIn(shapeA, set.hull[idx(a)].get(),
                                                      X_WA.inverse() * x, random)));
    }
    if (common < kDeep) continue;
    ++tally.deep;
    if (!(deepest < 0.0)) say("missed, deep in both by ") << "  " << common << " m\n";
  }
}

/// Tries pairs of shapes, `poses` each; what is wrong with them.
std::string trial(unsigned first, int pairs, int poses) {
  Tally tally;
  for (int i = 0; i < pairs; ++i) tryPoses(first + static_cast<unsigned>(i), poses, tally);
  if (tally.deep < tally.poses / 20 || tally.touching < tally.poses / 5)
    tally.wrong << tally.deep << " deep, " << tally.touching << " touching of " << tally.poses;
  return tally.wrong.str();
}

}  // namespace

TEST(RandomPoses, OfClosedMeshesMissNoDeepOverlap) {
  EXPECT_EQ(inChild([] { return trial(1, 60, 20); }, 60.0), "");
}

// A hundred thousand.
TEST(RandomPosesLong, OfClosedMeshesMissNoDeepOverlap) {
  for (unsigned part = 0; part < 10; ++part)
    EXPECT_EQ(inChild([&] { return trial(1000 * (part + 1), 100, 100); }, 600.0), "") << part;
}

}  // namespace softgauss::test
