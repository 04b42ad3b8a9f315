// SPDX-License-Identifier: Apache-2.0
// Laws that hold for every closed-form pair, over random poses.
#include <gtest/gtest.h>

#include <string>

#include "softgauss/collision/box_pairs.hpp"
#include "softgauss/collision/support.hpp"
#include "softgauss/engine/core/check.hpp"
#include "tests/collision/random_pairs.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

constexpr int kPoses = 1000;

struct KindPair {
  ShapeKind a, b;
};

std::vector<KindPair> closedForms() {
  using enum ShapeKind;
  std::vector<KindPair> all;
  for (ShapeKind a : {plane, sphere, capsule, cylinder, box})
    for (ShapeKind b : {sphere, capsule, cylinder, box})
      if (a <= b && hasClosedForm(a, b)) all.push_back({a, b});
  return all;
}

/// How far a contact is from the most similar one of a set.
double nearestTo(const PairContact& contact, const PairContacts& set) {
  double nearest = kInfinity;
  for (int j = 0; j < set.count; ++j)
    nearest =
        std::min(nearest, (set[j].p_WC - contact.p_WC).norm() + (set[j].n_W - contact.n_W).norm() +
                              std::abs(set[j].distance - contact.distance));
  return nearest;
}

/// Visits random pairs of every closed form that touch.
template <class Visit>
void forTouching(unsigned seed, double margin, Visit&& visit) {
  for (const KindPair& kinds : closedForms()) {
    SCOPED_TRACE("kinds " + std::to_string(static_cast<int>(kinds.a)) + " and " +
                 std::to_string(static_cast<int>(kinds.b)));
    RandomPairs random(seed);
    int touching = 0;
    for (int i = 0; i < kPoses; ++i) {
      const Shape a = random.shape(kinds.a), b = random.shape(kinds.b);
      const Transform X_WA = random.pose(0.5), X_WB = random.pose(0.5);
      const PairContacts contacts = contactsOf(a, X_WA, b, X_WB, margin);
      if (contacts.count == 0) continue;
      ++touching;
      visit(a, X_WA, b, X_WB, contacts);
      if (testing::Test::HasFailure()) return;
    }
    EXPECT_GT(touching, kPoses / 20);
  }
}

}  // namespace

TEST(Pairs, ContactsAreFiniteAndNormalsUnit) {
  forTouching(1, 0.05, [](auto&, auto&, auto&, auto&, const PairContacts& contacts) {
    for (int i = 0; i < contacts.count; ++i) {
      EXPECT_TRUE(contacts[i].p_WC.allFinite());
      EXPECT_NEAR(contacts[i].n_W.norm(), 1.0, 1e-12);
      EXPECT_LT(contacts[i].distance, 0.05);
    }
  });
}

TEST(Pairs, DeepestDistanceIsSeparationAlongItsNormal) {
  forTouching(2, 0.0,
              [](const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                 const PairContacts& contacts) {
                if (a.kind == ShapeKind::plane) return;
                for (int i = 0; i < contacts.count; ++i) {
                  if (contacts[i].distance != deepest(contacts)) continue;
                  const double sigma =
                      separationAlong({&a, nullptr}, X_WA, {&b, nullptr}, X_WB, contacts[i].n_W);
                  // Of a capsule lying along something, each end has a normal of its own; one that
                  // pierces a box leaves over the face that it is cut by.
                  if (a.kind == ShapeKind::capsule &&
                      (contacts.count > 1 || -contacts[i].distance > a.radius))
                    continue;
                  EXPECT_NEAR(contacts[i].distance, sigma, 1e-2);
                }
              });
}

TEST(Pairs, SwappingShapesFlipsTheNormal) {
  forTouching(3, 0.0,
              [](const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                 const PairContacts& contacts) {
                const PairContacts swapped = contactsOf(b, X_WB, a, X_WA);
                // The thinning of more than four points depends on their order, the deepest point
                // does not.
                if (contacts.count == 4) {
                  EXPECT_NEAR(deepest(swapped), deepest(contacts), 1e-9);
                  return;
                }
                ASSERT_EQ(swapped.count, contacts.count);
                for (int i = 0; i < contacts.count; ++i) {
                  PairContact mirrored = contacts[i];
                  mirrored.n_W *= -1.0;
                  EXPECT_LT(nearestTo(mirrored, swapped), 1e-6);
                }
              });
}

TEST(Pairs, RigidMotionMovesContactsAlong) {
  RandomPairs motions(40);
  forTouching(4, 0.0,
              [&](const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                  const PairContacts& contacts) {
                const Transform X = motions.pose(3.0);
                const PairContacts moved = contactsOf(a, X * X_WA, b, X * X_WB);
                ASSERT_EQ(moved.count, contacts.count);
                for (int i = 0; i < contacts.count; ++i) {
                  const PairContact carried{X * contacts[i].p_WC, X.R * contacts[i].n_W,
                                            contacts[i].distance};
                  EXPECT_LT(nearestTo(carried, moved), 1e-9);
                }
              });
}

TEST(Pairs, MovingApartAlongTheNormalOpensTheGap) {
  forTouching(5, 0.0,
              [](const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                 const PairContacts& contacts) {
                for (int i = 0; i < contacts.count; ++i) {
                  if (contacts[i].distance != deepest(contacts)) continue;
                  Transform away = X_WB;
                  away.p += contacts[i].n_W * (1e-9 - contacts[i].distance);
                  const double left = deepest(contactsOf(a, X_WA, b, away));
                  EXPECT_GT(left, a.kind == ShapeKind::capsule ? -5e-2 : -1e-8);
                  // Halfway there they still touch: the motion asked for is not longer than it must
                  // be.
                  Transform half = X_WB;
                  half.p -= contacts[i].n_W * (0.5 * contacts[i].distance);
                  EXPECT_LT(deepest(contactsOf(a, X_WA, b, half)), 0.0);
                }
              });
}

TEST(Pairs, NormalIsGradientOfDistance) {
  constexpr double kStep = 1e-6;
  RandomPairs directions(60);
  int differing = 0, total = 0;
  forTouching(6, 0.0,
              [&](const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                  const PairContacts& contacts) {
                const Vector3 d = directions.vector(1.0);
                Transform forth = X_WB, back = X_WB;
                forth.p += kStep * d;
                back.p -= kStep * d;
                const double slope = (deepest(contactsOf(a, X_WA, b, forth)) -
                                      deepest(contactsOf(a, X_WA, b, back))) /
                                     (2 * kStep);
                double nearest = kInfinity;
                for (int i = 0; i < contacts.count; ++i)
                  if (contacts[i].distance == deepest(contacts))
                    nearest = std::min(nearest, std::abs(slope - contacts[i].n_W.dot(d)));
                ++total;
                if (!(nearest < 1e-3)) ++differing;
              });
  // Exceptions are poses within a step of a kink and the fading of nearly parallel capsules.
  EXPECT_LT(differing, total / 50);
}

TEST(Pairs, PointsLieMidwayBetweenSurfaces) {
  forTouching(
      7, 0.0,
      [](const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
         const PairContacts& contacts) {
        // A sphere of radius zero measures how far a point is from a surface.
        const auto height = [](const Shape& shape, const Transform& X, const Vector3& x) {
          return deepest(contactsOf(Shape::sphere(0.0), {Matrix3::Identity(), x}, shape, X, 10.0));
        };
        for (int i = 0; i < contacts.count; ++i) {
          if (contacts[i].distance != deepest(contacts)) continue;
          const Vector3 half = contacts[i].n_W * (0.5 * contacts[i].distance);
          // Capsules blend two contacts into one, and leave a box that they pierce as a whole.
          if (a.kind == ShapeKind::capsule &&
              (contacts.count > 1 || -contacts[i].distance > a.radius))
            continue;
          EXPECT_NEAR(height(a, X_WA, contacts[i].p_WC - half), 0.0, 2e-3);
          EXPECT_NEAR(height(b, X_WB, contacts[i].p_WC + half), 0.0, 2e-3);
        }
      });
}

TEST(Pairs, MarginIsStrict) {
  const Shape ball = Shape::sphere(0.5);
  EXPECT_EQ(contactsOf(ball, at(0, 0, 0), ball, at(1, 0, 0)).count, 0);
  EXPECT_EQ(contactsOf(ball, at(0, 0, 0), ball, at(1, 0, 0), 0.125).count, 1);
  EXPECT_EQ(contactsOf(Shape::plane(), at(0, 0, 0), ball, at(0, 0, 0.5)).count, 0);
  const Shape cube = Shape::box({0.5, 0.5, 0.5});
  EXPECT_EQ(contactsOf(cube, at(0, 0, 0), cube, at(0, 0, 1)).count, 0);
}

TEST(Pairs, CoincidentCentresGiveUnitNormals) {
  using enum ShapeKind;
  RandomPairs random(8);
  for (const KindPair& kinds : closedForms()) {
    for (const Transform& X : {at(0, 0, 0), random.pose(1.0)}) {
      const PairContacts contacts = contactsOf(random.shape(kinds.a), X, random.shape(kinds.b), X);
      EXPECT_GT(contacts.count, 0);
      for (int i = 0; i < contacts.count; ++i) {
        EXPECT_TRUE(contacts[i].p_WC.allFinite());
        EXPECT_NEAR(contacts[i].n_W.norm(), 1.0, 1e-12);
        EXPECT_LT(contacts[i].distance, 0.0);
      }
    }
  }
}
