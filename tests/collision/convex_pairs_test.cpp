// SPDX-License-Identifier: Apache-2.0
// Pairs without closed form: their normals, distances and manifolds.
#include "softgauss/collision/detail/convex_pairs.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "softgauss/collision/box_pairs.hpp"
#include "softgauss/engine/core/check.hpp"
#include "tests/collision/random_pairs.hpp"

using namespace softgauss;
using namespace softgauss::collision;
using namespace softgauss::collision::detail;

namespace {

/// A collider that owns its shape and hull.
struct Owned {
  explicit Owned(const Shape& s) : shape(s) {
    if (s.kind == ShapeKind::mesh) hull = makeConvexHull(*s.mesh);
    collider = makeCollider(shape, s.kind == ShapeKind::mesh ? &hull : nullptr);
  }
  Owned(const Owned&) = delete;
  Shape shape;
  ConvexHull hull;
  Collider collider;
};

PairContacts contacts(const Owned& a, const Transform& X_WA, const Owned& b, const Transform& X_WB,
                      double margin = 0.0) {
  PairContacts out;
  EXPECT_TRUE(convexConvex(a.collider, X_WA, b.collider, X_WB, margin, out));
  return out;
}

/// The area spanned by the contacts projected on z, as twice the spread about their mean.
double spread(const PairContacts& c) {
  Vector3 mean = Vector3::Zero();
  for (int i = 0; i < c.count; ++i) mean += c[i].p_WC / c.count;
  double s = kInfinity;
  for (int i = 0; i < c.count; ++i) s = std::min(s, (c[i].p_WC - mean).head<2>().norm());
  return s;
}

Shape meshBox(const Vector3& h) { return Shape::hull(boxMesh(h)); }

/// A square of side 2 in the plane z = 0.
Shape flatSquare() {
  auto mesh = std::make_shared<Mesh>();
  mesh->vertices = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}};
  return Shape::hull(mesh);
}

}  // namespace

TEST(ConvexPairs, MeshBoxRestingOnBoxTouchesAtFourCorners) {
  const Owned floor(Shape::box({1, 1, 0.5})), block(meshBox({0.2, 0.3, 0.1}));
  for (double depth : {1e-9, 1e-7, 1e-5, 1e-3, 1e-2}) {
    for (double angle : {0.0, 0.3}) {
      const Transform X = turned({0, 0, 1}, angle, {0.1, 0.2, 0.6 - depth});
      const PairContacts c = contacts(floor, at(0, 0, 0), block, X);
      ASSERT_EQ(c.count, 4) << "depth " << depth;
      for (int i = 0; i < 4; ++i) {
        EXPECT_LT((c[i].n_W - Vector3::UnitZ()).norm(), 1e-12);
        EXPECT_NEAR(c[i].distance, -depth, 1e-12);
        EXPECT_NEAR(c[i].p_WC.z(), 0.5 - 0.5 * depth, 1e-12);
      }
      EXPECT_NEAR(spread(c), std::hypot(0.2, 0.3), 1e-9);
    }
  }
}

TEST(ConvexPairs, MeshBoxesAgreeWithBoxes) {
  RandomPairs random(1);
  int touching = 0;
  for (int i = 0; i < 300; ++i) {
    const Shape a = random.shape(ShapeKind::box), b = random.shape(ShapeKind::box);
    const Owned meshA(meshBox(a.halfExtents)), meshB(meshBox(b.halfExtents));
    const Transform X_WA = random.pose(0.5), X_WB = random.pose(0.5);
    const PairContacts exact = contactsOf(a, X_WA, b, X_WB);
    const PairContacts found = contacts(meshA, X_WA, meshB, X_WB);
    const double size = std::min(a.halfExtents.maxCoeff(), b.halfExtents.maxCoeff());
    EXPECT_TRUE(found.count > 0 || deepest(exact) > -1e-3 * size);
    if (found.count == 0 || exact.count == 0) continue;
    ++touching;
    // Boxes prefer a face to a slightly better edge.
    EXPECT_NEAR(deepest(found), deepest(exact), 2e-3 * size);
  }
  EXPECT_GT(touching, 100);
}

TEST(ConvexPairs, DistanceIsSeparationAlongTheNormal) {
  using enum ShapeKind;
  RandomPairs random(2);
  const Shape hull = meshBox({0.2, 0.3, 0.4});
  for (ShapeKind kind : {sphere, capsule, cylinder, box}) {
    for (int i = 0; i < 200; ++i) {
      const Owned a(random.shape(kind)), b(kind == box || i % 2 ? hull : random.shape(cylinder));
      const Transform X_WA = random.pose(0.4), X_WB = random.pose(0.4);
      const PairContacts c = contacts(a, X_WA, b, X_WB);
      if (c.count == 0) continue;
      const Vector3 n = c[0].n_W;
      const double sigma = separationAlong(a.collider.convex, X_WA, b.collider.convex, X_WB, n);
      EXPECT_GE(deepest(c), sigma - 1e-12);
      EXPECT_NEAR(deepest(c), sigma, 0.1 * std::abs(sigma) + 1e-12);
      // No other direction separates better.
      for (int k = 0; k < 50; ++k) {
        const Vector3 other = (n + random.vector(0.2)).normalized();
        EXPECT_LT(separationAlong(a.collider.convex, X_WA, b.collider.convex, X_WB, other),
                  sigma + 1e-7);
      }
    }
  }
}

TEST(ConvexPairs, CylinderStandsOnBoxAndLiesOnBox) {
  const Owned floor(Shape::box({1, 1, 0.5})), can(Shape::cylinder(0.2, 0.3));
  for (double depth : {1e-7, 1e-4, 1e-2}) {
    const PairContacts standing = contacts(can, at(0, 0, 0.8 - depth), floor, at(0, 0, 0));
    ASSERT_EQ(standing.count, 4);
    EXPECT_GT(spread(standing), 0.19);
    const PairContacts lying =
        contacts(can, turned({1, 0, 0}, M_PI / 2, {0, 0, 0.7 - depth}), floor, at(0, 0, 0));
    ASSERT_EQ(lying.count, 2);
    EXPECT_NEAR(std::abs(lying[0].p_WC.y() - lying[1].p_WC.y()), 0.6, 1e-6);
    for (const PairContacts& c : {standing, lying})
      for (int i = 0; i < c.count; ++i) {
        EXPECT_NEAR(c[i].distance, -depth, 1e-9);
        EXPECT_NEAR(c[i].n_W.z(), -1.0, 1e-9);
      }
  }
}

TEST(ConvexPairs, CylinderStandsOnCylinder) {
  const Owned column(Shape::cylinder(0.5, 0.5)), can(Shape::cylinder(0.2, 0.3));
  const PairContacts c = contacts(column, at(0, 0, 0), can, at(0.05, 0, 0.799));
  ASSERT_EQ(c.count, 4);
  EXPECT_GT(spread(c), 0.15);
}

TEST(ConvexPairs, CapsuleLiesOnMeshWithTwoEnds) {
  const Owned rod(Shape::capsule(0.1, 0.3)), block(meshBox({1, 1, 0.5}));
  const PairContacts c =
      contacts(rod, turned({0, 1, 0}, M_PI / 2, {0, 0, 0.599}), block, at(0, 0, 0));
  ASSERT_EQ(c.count, 2);
  EXPECT_NEAR(std::abs(c[0].p_WC.x() - c[1].p_WC.x()), 0.6, 1e-9);
  EXPECT_NEAR(c[0].distance, -0.001, 1e-9);
}

TEST(ConvexPairs, FlatMeshCollidesOnBothSides) {
  const Owned sheet(flatSquare()), ball(Shape::sphere(0.1)), cube(Shape::box({0.1, 0.1, 0.1})),
      rod(Shape::capsule(0.1, 0.2));
  for (double side : {1.0, -1.0}) {
    const Transform X = at(0.2, 0.3, side * 0.099);
    const PairContacts round = contacts(ball, X, sheet, at(0, 0, 0));
    ASSERT_EQ(round.count, 1);
    EXPECT_NEAR(round[0].distance, -0.001, 1e-9);
    EXPECT_NEAR(round[0].n_W.z(), -side, 1e-9);
    const PairContacts block = contacts(cube, X, sheet, at(0, 0, 0));
    ASSERT_EQ(block.count, 4);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(block[i].distance, -0.001, 1e-9);
      EXPECT_NEAR(block[i].n_W.z(), -side, 1e-9);
    }
    const PairContacts lying = contacts(rod, turned({1, 0, 0}, M_PI / 2, X.p), sheet, at(0, 0, 0));
    EXPECT_EQ(lying.count, 2);
  }
}

TEST(ConvexPairs, FlatMeshesThatCrossGiveFiniteContacts) {
  const Owned sheet(flatSquare());
  const PairContacts crossing =
      contacts(sheet, at(0, 0, 0), sheet, turned({1, 0, 0}, M_PI / 2, {0, 0, 0.9}));
  ASSERT_GT(crossing.count, 0);
  for (int i = 0; i < crossing.count; ++i) {
    EXPECT_TRUE(crossing[i].p_WC.allFinite());
    EXPECT_NEAR(crossing[i].n_W.norm(), 1.0, 1e-12);
  }
  EXPECT_NEAR(deepest(crossing), -0.1, 1e-6);
}

TEST(ConvexPairs, CoincidentCentresGiveUnitNormals) {
  using enum ShapeKind;
  RandomPairs random(3);
  for (ShapeKind kind : {sphere, capsule, cylinder, box}) {
    const Owned a(random.shape(kind)), b(meshBox({0.2, 0.3, 0.4}));
    const PairContacts out = contacts(a, at(1, 2, 3), b, at(1, 2, 3));
    EXPECT_GT(out.count, 0);
    for (int i = 0; i < out.count; ++i) {
      EXPECT_TRUE(out[i].p_WC.allFinite());
      EXPECT_NEAR(out[i].n_W.norm(), 1.0, 1e-12);
      EXPECT_LT(out[i].distance, 0.0);
    }
  }
}

TEST(ConvexPairs, PosesThatAreNotFiniteAreReported) {
  const Owned a(Shape::cylinder(0.1, 0.2)), b(meshBox({0.2, 0.3, 0.4}));
  PairContacts out;
  EXPECT_FALSE(convexConvex(a.collider, at(0, kNaN, 0), b.collider, at(0, 0, 0), 0.0, out));
  EXPECT_EQ(out.count, 0);
}

TEST(ConvexPairs, EdgeBelowTheRimOfACylinderTouchesThere) {
  // A long edge along y meets the cap near its rim, over a chord that is short against the edge.
  const double r = 0.045, depth = 5e-4;
  const Owned cylinder(Shape::cylinder(r, 0.012)), box(Shape::box({0.05, 0.1, 0.05}));
  const double toEdge = 0.05 * std::sqrt(2.0);
  // The octagon that stands for the cap has no corner towards the edge, and misses it.
  const Transform X_cylinder = turned({0, 0, 1}, std::numbers::pi / 8, {0, 0, 0});
  for (double inward : {6e-4, 2e-3})
    for (double turn : {0.0, 1e-3, -1e-3}) {
      Transform X =
          turned({0, 1, 0}, std::numbers::pi / 4, {r - inward, 0, -0.012 + depth - toEdge});
      X.R = turned({0, 0, 1}, turn, {0, 0, 0}).R * X.R;
      const PairContacts c = contacts(box, X, cylinder, X_cylinder);
      ASSERT_GE(c.count, 1);
      for (int i = 0; i < c.count; ++i) {
        EXPECT_LT((c[i].n_W - Vector3::UnitZ()).norm(), 1e-6);
        EXPECT_NEAR(c[i].distance, -depth, 1e-6);
        EXPECT_NEAR(c[i].p_WC.x(), r - inward, 2e-3);
        EXPECT_LT(c[i].p_WC.head<2>().norm(), 1.05 * r);
        EXPECT_NEAR(c[i].p_WC.z(), -0.012 + 0.5 * depth, 1e-6);
      }
    }
}
