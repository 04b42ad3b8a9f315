// SPDX-License-Identifier: Apache-2.0
// Two independent answers to the same question: closed forms against FCL for disjoint shapes, and
// against the iterative search (GJK, EPA) for overlapping ones.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>

#include <memory>

#include "softgauss/collision/detail/convex_pairs.hpp"
#include "softgauss/collision/detail/separating_direction.hpp"
#include "tests/collision/random_pairs.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

using enum ShapeKind;

struct Kinds {
  ShapeKind a, b;
};

constexpr Kinds kClosedForms[] = {{sphere, sphere}, {sphere, capsule},  {sphere, cylinder},
                                  {sphere, box},    {capsule, capsule}, {capsule, box},
                                  {box, box}};

std::shared_ptr<fcl::CollisionGeometryd> toFcl(const Shape& s) {
  switch (s.kind) {
    case sphere:
      return std::make_shared<fcl::Sphered>(s.radius);
    case capsule:
      return std::make_shared<fcl::Capsuled>(s.radius, 2 * s.halfLength);
    case cylinder:
      return std::make_shared<fcl::Cylinderd>(s.radius, 2 * s.halfLength);
    default:
      return std::make_shared<fcl::Boxd>(Vector3(2 * s.halfExtents));
  }
}

fcl::Transform3d toFcl(const Transform& X) {
  fcl::Transform3d T = fcl::Transform3d::Identity();
  T.linear() = X.R;
  T.translation() = X.p;
  return T;
}

}  // namespace

TEST(Oracle, ClosedFormsAgreeWithFclApart) {
  for (const Kinds& kinds : kClosedForms) {
    if (kinds.a == box) continue;  // between disjoint boxes only the separation is told
    RandomPairs random(1);
    int apart = 0;
    for (int i = 0; i < 200; ++i) {
      const Shape a = random.shape(kinds.a), b = random.shape(kinds.b);
      const Transform X_WA = random.pose(0.7), X_WB = random.pose(0.7);
      const fcl::DistanceRequestd request(true);
      fcl::DistanceResultd result;
      const double expected =
          fcl::distance(toFcl(a).get(), toFcl(X_WA), toFcl(b).get(), toFcl(X_WB), request, result);
      if (expected <= 1e-3) continue;
      ++apart;
      const PairContacts found = contactsOf(a, X_WA, b, X_WB, 10.0);
      double nearest = 10.0;
      for (int k = 0; k < found.count; ++k) nearest = std::min(nearest, found[k].distance);
      // Within a margin of 10 m the fading of nearly parallel capsules is far from its purpose.
      if (found.count == 1) {
        EXPECT_NEAR(nearest, expected, 1e-4);
      }
    }
    EXPECT_GT(apart, 40);
  }
}

TEST(Oracle, ClosedFormsAgreeWithSearchOverlapping) {
  for (const Kinds& kinds : kClosedForms) {
    SCOPED_TRACE(static_cast<int>(kinds.a) * 10 + static_cast<int>(kinds.b));
    RandomPairs random(2);
    int touching = 0;
    for (int i = 0; i < 300; ++i) {
      const Shape a = random.shape(kinds.a), b = random.shape(kinds.b);
      const Transform X_WA = random.pose(0.5), X_WB = random.pose(0.5);
      const PairContacts exact = contactsOf(a, X_WA, b, X_WB);
      PairContacts found;
      ASSERT_TRUE(collision::detail::convexConvex(collision::detail::makeCollider(a, nullptr), X_WA,
                                                  collision::detail::makeCollider(b, nullptr), X_WB,
                                                  0.0, found));
      // Blended contacts and pierced boxes have no single depth.
      const bool blended = kinds.a == capsule && (exact.count > 1 || deepest(exact) < -a.radius);
      if (blended) continue;
      ASSERT_EQ(exact.count > 0, found.count > 0);
      if (exact.count == 0) continue;
      ++touching;
      EXPECT_NEAR(deepest(exact), deepest(found), 1e-3);
    }
    EXPECT_GT(touching, 40);
  }
}
