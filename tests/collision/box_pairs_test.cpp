// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/box_pairs.hpp"

#include <gtest/gtest.h>

#include "tests/collision/random_pairs.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

const Shape kCube = Shape::box({0.5, 0.5, 0.5});

}  // namespace

TEST(BoxBox, RestingFaceGivesFourCorners) {
  for (double depth : {1e-12, 1e-6, 1e-3}) {
    const PairContacts c =
        contactsOf(Shape::box({2, 2, 0.5}), at(0, 0, 0), kCube, at(0.3, 0.2, 1.0 - depth));
    ASSERT_EQ(c.count, 4);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(c[i].distance, -depth, 1e-12);
      EXPECT_LT((c[i].n_W - Vector3::UnitZ()).norm(), 1e-15);
      EXPECT_NEAR(std::abs(c[i].p_WC.x() - 0.3), 0.5, 1e-12);
      EXPECT_NEAR(std::abs(c[i].p_WC.y() - 0.2), 0.5, 1e-12);
      EXPECT_NEAR(c[i].p_WC.z(), 0.5 - 0.5 * depth, 1e-12);
    }
  }
}

TEST(BoxBox, EqualFootprintsGiveFourCorners) {
  const PairContacts c = contactsOf(kCube, at(0, 0, 0), kCube, at(0, 0, 0.999));
  ASSERT_EQ(c.count, 4);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(c[i].p_WC.head<2>().cwiseAbs().sum(), 1.0, 1e-9);
}

TEST(BoxBox, TurnedByAnEighthFourOfEightCornersRemain) {
  const PairContacts c =
      contactsOf(kCube, at(0, 0, 0), kCube, turned({0, 0, 1}, M_PI / 4, {0, 0, 0.999}));
  ASSERT_EQ(c.count, 4);
  // Of a regular octagon: two by two opposite, so their mean is the centre.
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 4; ++i) sum += c[i].p_WC;
  EXPECT_LT(sum.head<2>().norm(), 0.3);
}

TEST(BoxBox, OverhangingBoxIsHeldAtTheEdge) {
  const PairContacts c = contactsOf(kCube, at(0, 0, 0), kCube, at(0.7, 0, 0.999));
  ASSERT_EQ(c.count, 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_GE(c[i].p_WC.x(), 0.2 - 1e-8);
    EXPECT_LE(c[i].p_WC.x(), 0.5 + 1e-8);
  }
}

TEST(BoxBox, TiltedBoxTouchesWithItsEdgeAlone) {
  const double reach = std::sqrt(0.5);
  const PairContacts c = contactsOf(Shape::box({2, 2, 0.5}), at(0, 0, 0), kCube,
                                    turned({1, 0, 0}, M_PI / 4, {0, 0, 0.5 + reach - 0.01}));
  ASSERT_GE(c.count, 2);
  int deep = 0;
  for (int i = 0; i < c.count; ++i) deep += c[i].distance < -0.009;
  EXPECT_EQ(deep, 2);
}

TEST(BoxBox, CrossedEdgesTouchOnce) {
  const double reach = std::sqrt(0.5);
  const Transform lower = turned({1, 0, 0}, M_PI / 4, {0, 0, 0});
  const Transform upper = turned({0, 1, 0}, M_PI / 4, {0, 0, 2 * reach - 0.01});
  const PairContacts c = contactsOf(kCube, lower, kCube, upper);
  ASSERT_EQ(c.count, 1);
  EXPECT_NEAR(c[0].distance, -0.01, 1e-12);
  EXPECT_LT((c[0].n_W - Vector3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((c[0].p_WC - Vector3(0, 0, reach - 0.005)).norm(), 1e-12);
}

TEST(BoxBox, RestingFaceDoesNotFlickerUnderTinyTilts) {
  RandomPairs random(1);
  for (int i = 0; i < 500; ++i) {
    Transform X = turned({0, 0, 1}, random.uniform(-3, 3), {0.1, 0.2, 0.9999});
    X.R = X.R * axisRotation(random.vector(1.0).normalized(), 1e-6);
    const PairContacts c = contactsOf(Shape::box({2, 2, 0.5}), at(0, 0, 0), kCube, X);
    ASSERT_EQ(c.count, 4);
    for (int k = 0; k < 4; ++k) EXPECT_GT(c[k].n_W.z(), 1.0 - 1e-10);
  }
}

TEST(SphereBox, FaceEdgeCornerAndInside) {
  const auto distance = [](double x, double y, double z) {
    return deepest(contactsOf(Shape::sphere(0.1), at(x, y, z), kCube, at(0, 0, 0), 1.0));
  };
  EXPECT_NEAR(distance(0.58, 0.1, 0), -0.02, 1e-15);
  EXPECT_NEAR(distance(0.8, 0.9, 0), 0.4, 1e-15);
  EXPECT_NEAR(distance(0.5 + 0.2, 0.5 + 0.1, 0.5 + 0.2), 0.2, 1e-15);
  EXPECT_NEAR(distance(0.4, 0.1, -0.2), -0.2, 1e-15);
}

TEST(CapsuleBox, LyingOnAFaceTouchesAtBothEnds) {
  const Shape rod = Shape::capsule(0.1, 0.3);
  for (double z : {0.599, 0.55, 0.501, 0.4999, 0.45}) {
    for (double tilt : {0.0, 1e-9, -1e-9}) {
      const PairContacts c =
          contactsOf(rod, turned({0, 1, 0}, M_PI / 2 + tilt, {0.05, 0, z}), kCube, at(0, 0, 0));
      ASSERT_EQ(c.count, 2) << "z " << z;
      EXPECT_NEAR(std::abs(c[0].p_WC.x() - c[1].p_WC.x()), 0.6, 1e-6);
      for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(c[i].distance, z - 0.6, 1e-8);
        EXPECT_NEAR(c[i].n_W.z(), -1.0, 1e-8);
      }
    }
  }
}

TEST(CapsuleBox, ReachesPastTheBoxAndRestsOnBothEdges) {
  const PairContacts c = contactsOf(Shape::capsule(0.1, 2.0),
                                    turned({0, 1, 0}, M_PI / 2, {0, 0, 0.599}), kCube, at(0, 0, 0));
  ASSERT_EQ(c.count, 2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(std::abs(c[i].p_WC.x()), 0.5, 1e-9);
}

TEST(CapsuleBox, LyingAlongAnEdgeTouchesTwice) {
  const double d = std::sqrt(0.5) * 0.099;
  const PairContacts c =
      contactsOf(Shape::capsule(0.1, 0.3), turned({1, 0, 0}, M_PI / 2, {0.5 + d, 0, 0.5 + d}),
                 kCube, at(0, 0, 0));
  ASSERT_EQ(c.count, 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(c[i].distance, -0.001, 1e-12);
    EXPECT_NEAR(std::abs(c[i].p_WC.y()), 0.3, 1e-9);
  }
}

TEST(CapsuleBox, StandingUprightTouchesOnce) {
  const PairContacts c =
      contactsOf(Shape::capsule(0.1, 0.3), at(0.2, 0.1, 0.89), kCube, at(0, 0, 0));
  ASSERT_EQ(c.count, 1);
  EXPECT_NEAR(c[0].distance, -0.01, 1e-12);
  EXPECT_LT((c[0].n_W - Vector3(0, 0, -1)).norm(), 1e-12);
}

TEST(CapsuleBox, AcrossACornerItLeavesSideways) {
  // The core cuts the edge x = z = ½ a little below it.
  const Transform X = turned({0, 1, 0}, M_PI * 3 / 4, {0.49, 0, 0.49});
  const PairContacts c = contactsOf(Shape::capsule(0.1, 0.3), X, kCube, at(0, 0, 0));
  ASSERT_EQ(c.count, 1);
  EXPECT_NEAR(c[0].distance, -0.1 - std::sqrt(2.0) * 0.01, 1e-9);
  EXPECT_LT((c[0].n_W + Vector3(1, 0, 1).normalized()).norm(), 1e-9);
}

TEST(CapsuleBox, DeepestDistanceIsTheSmallestAlongTheCore) {
  RandomPairs random(2);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const Shape rod = random.shape(ShapeKind::capsule), box = random.shape(ShapeKind::box);
    const Transform X_WA = random.pose(0.5), X_WB = random.pose(0.5);
    double nearest = 1.0;
    for (int k = 0; k <= 400; ++k) {
      const Vector3 x = X_WA.p + X_WA.R.col(2) * (rod.halfLength * (k / 200.0 - 1.0));
      nearest = std::min(nearest, deepest(contactsOf(Shape::sphere(rod.radius),
                                                     {Matrix3::Identity(), x}, box, X_WB, 1.0)));
    }
    const PairContacts c = contactsOf(rod, X_WA, box, X_WB);
    if (nearest >= 0.0 || deepest(c) < -rod.radius) continue;  // a pierced box is another matter
    ++touching;
    EXPECT_LE(deepest(c), 0.88 * nearest + 1e-6);
    EXPECT_GE(deepest(c), nearest - 1e-3);
  }
  EXPECT_GT(touching, 200);
}
