// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/plane_pairs.hpp"

#include <gtest/gtest.h>

#include "tests/collision/random_pairs.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

PairContacts onPlane(const Shape& shape, const Transform& X) {
  return contactsOf(Shape::plane(), Transform{}, shape, X);
}

}  // namespace

TEST(SpherePlane, TouchesAtItsLowestPoint) {
  const PairContacts c = onPlane(Shape::sphere(0.1), at(1, 2, 0.0995));
  ASSERT_EQ(c.count, 1);
  EXPECT_NEAR(c[0].distance, -0.0005, 1e-15);
  EXPECT_LT((c[0].p_WC - Vector3(1, 2, -0.00025)).norm(), 1e-15);
  EXPECT_EQ(c[0].n_W, Vector3(0, 0, 1));
}

TEST(CapsulePlane, TwoPointsTouchAtBothEnds) {
  const PairContacts c =
      onPlane(Shape::capsule(0.1, 0.3), turned({0, 1, 0}, M_PI / 2, {0, 0, 0.09}));
  ASSERT_EQ(c.count, 2);
  EXPECT_NEAR(c[0].p_WC.x(), 0.3, 1e-12);  // the +z end first
  EXPECT_NEAR(c[1].p_WC.x(), -0.3, 1e-12);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(c[i].distance, -0.01, 1e-12);
}

TEST(CapsulePlane, FirstTangentRunsAlongTheCapsule) {
  const Transform X = turned({0.3, 1, 0}, 1.4, {0, 0, 0.1});
  const PairContacts c = onPlane(Shape::capsule(0.1, 0.3), X);
  ASSERT_GT(c.count, 0);
  EXPECT_LT((c.tangent_W - X.R.col(2)).norm(), 1e-15);
}

TEST(BoxPlane, RestsOnFourCornersInSignOrder) {
  const PairContacts c = onPlane(Shape::box({0.1, 0.2, 0.3}), at(0, 0, 0.299));
  ASSERT_EQ(c.count, 4);
  const double x[] = {-0.1, 0.1, -0.1, 0.1}, y[] = {-0.2, -0.2, 0.2, 0.2};
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT((c[i].p_WC - Vector3(x[i], y[i], -0.0005)).norm(), 1e-12);
    EXPECT_NEAR(c[i].distance, -0.001, 1e-12);
  }
}

TEST(BoxPlane, NeverMoreThanFourCornersHoweverDeep) {
  RandomPairs random(1);
  for (int i = 0; i < 200; ++i) {
    Transform X = random.pose(0.1);
    X.p.z() = -2.0;
    EXPECT_EQ(onPlane(Shape::box({0.1, 0.2, 0.3}), X).count, 4);
  }
  EXPECT_EQ(onPlane(Shape::box({1, 1, 1}), turned({1, 0, 0}, M_PI / 4, {0, 0, -3})).count, 4);
}

TEST(CylinderPlane, StandsOnARegularTriangle) {
  const PairContacts c = onPlane(Shape::cylinder(0.2, 0.5), at(0, 0, 0.499));
  ASSERT_EQ(c.count, 3);
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(c[i].distance, -0.001, 1e-12);
    EXPECT_NEAR(c[i].p_WC.head<2>().norm(), 0.2, 1e-12);
    sum += c[i].p_WC;
  }
  EXPECT_LT(sum.head<2>().norm(), 1e-12);
}

TEST(CylinderPlane, LiesOnBothRims) {
  for (double sign : {1.0, -1.0}) {
    const PairContacts c =
        onPlane(Shape::cylinder(0.2, 0.5), turned({0, 1, 0}, sign * M_PI / 2, {0, 0, 0.199}));
    ASSERT_EQ(c.count, 2);
    EXPECT_NEAR(std::abs(c[0].p_WC.x() - c[1].p_WC.x()), 1.0, 1e-12);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(c[i].distance, -0.001, 1e-12);
  }
}

TEST(CylinderPlane, DeepestPointIsTheLowestPointOfTheRim) {
  RandomPairs random(2);
  for (int i = 0; i < 200; ++i) {
    const Transform X = random.pose(0.1);
    const Shape can = Shape::cylinder(0.2, 0.5);
    const double sine = X.R.col(2).head<2>().norm();
    const double lowest = X.p.z() - 0.5 * std::abs(X.R(2, 2)) - 0.2 * sine;
    EXPECT_NEAR(deepest(onPlane(can, X)), lowest, 1e-12);
  }
}
