// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/round_pairs.hpp"

#include <gtest/gtest.h>

#include "tests/collision/random_pairs.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

/// A capsule along x at height z, turned by `angle` about z and tilted by `tilt` about y.
Transform lying(double z, double angle, double tilt = 0.0, double x = 0.0) {
  return {axisRotation(Vector3::UnitZ(), angle) * axisRotation(Vector3::UnitY(), M_PI / 2 + tilt),
          Vector3(x, 0, z)};
}

/// Force and moment about the origin that springs of stiffness 1 at the contacts would exert on B:
/// what the dynamics feels of a set of contacts, however many there are.
Vector6 response(const PairContacts& c) {
  Vector6 wrench = Vector6::Zero();
  for (int i = 0; i < c.count; ++i) {
    const Vector3 f = -c[i].distance * c[i].n_W;
    wrench.head<3>() += f;
    wrench.tail<3>() += c[i].p_WC.cross(f);
  }
  return wrench;
}

}  // namespace

TEST(SphereSphere, TouchesOnTheLineOfCentres) {
  const PairContacts c =
      contactsOf(Shape::sphere(0.3), at(0, 0, 0), Shape::sphere(0.2), at(0.4, 0, 0));
  ASSERT_EQ(c.count, 1);
  EXPECT_NEAR(c[0].distance, -0.1, 1e-15);
  EXPECT_LT((c[0].p_WC - Vector3(0.25, 0, 0)).norm(), 1e-15);
  EXPECT_LT((c[0].n_W - Vector3(1, 0, 0)).norm(), 1e-15);
}

TEST(SphereCapsule, ClampsToTheEnds) {
  const Shape ball = Shape::sphere(0.2), rod = Shape::capsule(0.1, 0.5);
  const PairContacts side = contactsOf(ball, at(0.25, 0, 0.2), rod, at(0, 0, 0));
  ASSERT_EQ(side.count, 1);
  EXPECT_NEAR(side[0].distance, -0.05, 1e-15);
  const PairContacts end = contactsOf(ball, at(0, 0, 0.75), rod, at(0, 0, 0));
  ASSERT_EQ(end.count, 1);
  EXPECT_NEAR(end[0].distance, -0.05, 1e-15);
  EXPECT_LT((end[0].n_W - Vector3(0, 0, -1)).norm(), 1e-15);
}

TEST(SphereCylinder, CapSideRimAndInside) {
  const Shape can = Shape::cylinder(0.4, 0.5);
  const auto distance = [&](double r, double x, double z) {
    return deepest(contactsOf(Shape::sphere(r), at(x, 0, z), can, at(0, 0, 0), 1.0));
  };
  EXPECT_NEAR(distance(0.1, 0.2, 0.65), 0.05, 1e-15);
  EXPECT_NEAR(distance(0.1, 0.45, 0.1), -0.05, 1e-15);
  EXPECT_NEAR(distance(0.1, 0.7, 0.9), 0.4, 1e-15);
  EXPECT_NEAR(distance(0.1, 0.3, 0.0), -0.2, 1e-15);
  EXPECT_NEAR(distance(0.1, 0.0, -0.45), -0.15, 1e-15);
}

TEST(CapsuleCapsule, CrossingCapsulesTouchOnce) {
  const Shape rod = Shape::capsule(0.1, 0.5);
  for (double angle : {0.2, 0.5, 1.0, M_PI / 2, 2.5}) {
    const PairContacts c = contactsOf(rod, lying(0, 0), rod, lying(0.19, angle));
    ASSERT_EQ(c.count, 1);
    EXPECT_NEAR(c[0].distance, -0.01, 1e-12);
    EXPECT_LT((c[0].p_WC - Vector3(0, 0, 0.095)).norm(), 1e-12);
    EXPECT_LT((c[0].n_W - Vector3::UnitZ()).norm(), 1e-12);
  }
}

TEST(CapsuleCapsule, ParallelCapsulesTouchAtBothEndsOfTheirOverlap) {
  const Shape rod = Shape::capsule(0.1, 0.5), shorter = Shape::capsule(0.1, 0.2);
  for (double angle : {0.0, M_PI, 1e-12, 1e-6}) {
    const PairContacts c = contactsOf(rod, lying(0, 0), shorter, lying(0.199, angle, 0, 0.4));
    ASSERT_EQ(c.count, 2);
    EXPECT_NEAR(c[0].p_WC.x(), 0.5, 1e-6);  // A ends first here, B there
    EXPECT_NEAR(c[1].p_WC.x(), 0.2, 1e-6);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(c[i].distance, -0.001, 1e-9);
  }
}

TEST(CapsuleCapsule, EndToEndTouchesOnce) {
  const Shape rod = Shape::capsule(0.1, 0.5);
  const PairContacts c = contactsOf(rod, lying(0, 0), rod, lying(0, 0, 0, 1.15));
  ASSERT_EQ(c.count, 1);
  EXPECT_NEAR(c[0].distance, -0.05, 1e-12);
  EXPECT_LT((c[0].n_W - Vector3::UnitX()).norm(), 1e-12);
}

// Rolling through parallel, where a single nearest point leaps from end to end.
TEST(CapsuleCapsule, TinyRotationsChangeTheContactsLittle) {
  const Shape rod = Shape::capsule(0.1, 0.5);
  constexpr double kStep = 1e-5;
  for (double tilt : {0.0, 1e-4}) {
    Vector6 last = response(contactsOf(rod, lying(0, 0), rod, lying(0.199, -0.3, tilt)));
    for (double angle = -0.3; angle < 0.3; angle += kStep) {
      const Vector6 now = response(contactsOf(rod, lying(0, 0), rod, lying(0.199, angle, tilt)));
      EXPECT_LT((now - last).norm(), 2e-5) << "angle " << angle;
      last = now;
    }
  }
  // Through level: the nearest point leaps by a metre, the contacts do not.
  Vector6 last = response(contactsOf(rod, lying(0, 0), rod, lying(0.199, 0.0, -1e-3)));
  for (double tilt = -1e-3; tilt < 1e-3; tilt += 1e-6) {
    const Vector6 now = response(contactsOf(rod, lying(0, 0), rod, lying(0.199, 0.0, tilt)));
    EXPECT_LT((now - last).norm(), 2e-6) << "tilt " << tilt;
    last = now;
  }
}

TEST(CapsuleCapsule, SlidingOutOfOverlapIsContinuous) {
  const Shape rod = Shape::capsule(0.1, 0.5);
  Vector6 last = response(contactsOf(rod, lying(0, 0), rod, lying(0.199, 0, 0, 0.8)));
  for (double x = 0.8; x < 1.1; x += 1e-5) {
    const Vector6 now = response(contactsOf(rod, lying(0, 0), rod, lying(0.199, 0, 0, x)));
    EXPECT_LT((now - last).norm(), 1e-5) << "x " << x;
    last = now;
  }
}

TEST(CapsuleCapsule, OneContactAtLeastShowsMostOfTheDepth) {
  RandomPairs random(1);
  const Shape rod = Shape::capsule(0.1, 0.5);
  for (int i = 0; i < 2000; ++i) {
    const Transform X = lying(random.uniform(0.1, 0.2), random.uniform(-0.3, 0.3),
                              random.uniform(-0.1, 0.1), random.uniform(-1, 1));
    // Spheres along the second capsule measure the true distance.
    double nearest = 1.0;
    for (int k = 0; k <= 200; ++k) {
      const Vector3 x = X.p + X.R.col(2) * (0.5 * (k / 100.0 - 1.0));
      nearest = std::min(nearest, deepest(contactsOf(Shape::sphere(0.1), {Matrix3::Identity(), x},
                                                     rod, lying(0, 0), 1.0)));
    }
    const double found = deepest(contactsOf(rod, lying(0, 0), rod, X));
    if (nearest >= 0.0) continue;
    EXPECT_LE(found, 0.88 * nearest);
    EXPECT_GE(found, nearest - 1e-3 * 0.1);
  }
}
