// SPDX-License-Identifier: Apache-2.0
/// Who looks twice in every time that is in sight sees whatever passes through something else.

#include <gtest/gtest.h>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/collision/random_pairs.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

using collision::SceneContacts;
using TimeDirection = ContactSource::TimeDirection;

/// A shape of each kind, some of them thin.
Shape randomShape(int kind, Random& random) {
  const auto size = [&] { return std::pow(10.0, random.uniform(-2.5, -0.5)); };
  switch (kind) {
    case 0:
      return Shape::sphere(size());
    case 1:
      return Shape::capsule(size(), size());
    case 2:
      return Shape::cylinder(size(), size());
    case 3:
      return Shape::box({size(), size(), size()});
    default:
      return Shape::hull(collision::boxMesh({size(), size(), size()}));
  }
}

ModelBuilder flying(const std::string& name, const Shape& shape) {
  ModelBuilder one(name);
  one.base = BaseKind::floating;
  one.X_WRoot = Transform{Matrix3::Identity(), Vector3(name == "a" ? 0.0 : 10.0, 0.0, 0.0)};
  one.link(sphereLink("body", 1.0, 0.1));
  one.geometry(geometrySpec("body", shape));
  return one;
}

Model pairOf(const Shape& a, const Shape& b) {
  ModelBuilder builder("pair");
  builder.add(flying("a", a), "a");
  builder.add(flying("b", b), "b");
  return builder.build();
}

/// Two bodies that keep their velocities and spins.
struct Encounter {
  Model model;
  SceneContacts source{model};
  State state{model};  ///< at time 0
  Kinematics kinematics{model};
  ContactSet contacts;

  Encounter(const Shape& a, const Shape& b) : model(pairOf(a, b)) {}

  void at(double time) {
    State now = state;
    integratePosition(model, state.v, time, now.q);
    computeKinematics(model, now, kinematics);
  }
  bool touchesAt(double time) {
    at(time);
    source.detect(model, kinematics, contacts);
    return contacts.size() > 0;
  }
  /// Looks from `begin` to `end`, no further on than what is in sight.
  struct Seen {
    bool touching = false;
    int looks = 0;
  };
  Seen follow(double begin, double end, double longest) {
    Seen seen;
    for (double time = begin; time < end && seen.looks < 100000;) {
      at(time);
      const double sight =
          source.tunnellingTimeBound(model, kinematics, longest, TimeDirection::forward);
      for (const double share : {0.5, 1.0}) {
        ++seen.looks;
        seen.touching = seen.touching || touchesAt(time + share * sight);
      }
      time += sight;
    }
    return seen;
  }
};

// Centres meet at time 0: the balls inside the two shapes touch for as long as they need to move by
// both their diameters.
TEST(Passing, IsSeen) {
  for (int kinds = 0; kinds < 25; ++kinds)
    for (int seed = 0; seed < 20; ++seed) {
      Random random(1000 * kinds + seed);
      Encounter e(randomShape(kinds / 5, random), randomShape(kinds % 5, random));
      for (int body = 0; body < 2; ++body) {
        const Quaternion r = random.quaternion();
        e.state.q.segment<3>(7 * body).setZero();
        e.state.q.segment<4>(7 * body + 3) << r.w(), r.x(), r.y(), r.z();
        e.state.v.segment<3>(6 * body) = random.direction() * random.uniform(1.0, 60.0);
        e.state.v.segment<3>(6 * body + 3) = random.direction() * random.uniform(0.0, 20.0);
      }
      ASSERT_TRUE(e.touchesAt(0.0));
      ASSERT_FALSE(e.touchesAt(-5.0)) << kinds << " " << seed;
      const double begin = -random.uniform(0.5, 1.5);
      const Encounter::Seen seen = e.follow(begin, 1.5, 0.032);
      EXPECT_TRUE(seen.touching) << kinds << " " << seed;
    }
}

// A rod that turns about its resting middle: its ends sweep over a resting ball.
TEST(Passing, OfTheEndsOfARodIsSeen) {
  for (int seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const double length = random.uniform(0.2, 1.0);
    Encounter e(Shape::capsule(0.005, length), Shape::sphere(0.01));
    const double angle = random.uniform(1.0, 2.0);
    const double speed = random.uniform(20.0, 60.0);  // [rad/s]
    e.state.q.segment<3>(0).setZero();
    e.state.q.segment<3>(7) = 0.9 * length * Vector3(std::sin(angle), 0.0, std::cos(angle));
    e.state.v[4] = speed;
    ASSERT_TRUE(e.touchesAt(angle / speed));
    EXPECT_TRUE(e.follow(0.0, 2.0 * angle / speed, 0.05).touching) << seed;
  }
}

TEST(Passing, NeedsNoLookWhereNothingIsFastOrNear) {
  Encounter e(Shape::sphere(0.02), Shape::box({0.01, 0.5, 0.5}));
  const auto sight = [&](double x, double v, TimeDirection way) {
    e.state.q[0] = x, e.state.q[7] = 0.0;
    e.state.v[0] = v;
    e.at(0.0);
    return e.source.tunnellingTimeBound(e.model, e.kinematics, 0.032, way);
  };
  EXPECT_EQ(sight(-0.05, 0.1, TimeDirection::forward), 0.032);    // slow
  EXPECT_EQ(sight(-2.0, 15.0, TimeDirection::forward), 0.032);    // far
  EXPECT_EQ(sight(-0.05, -15.0, TimeDirection::forward), 0.032);  // away
  EXPECT_EQ(sight(0.05, 15.0, TimeDirection::forward), 0.032);
  EXPECT_EQ(sight(-0.05, 15.0, TimeDirection::backward), 0.032);
  // Half of what 60 mm take at this speed, whether it comes or has passed.
  EXPECT_DOUBLE_EQ(sight(-0.05, 15.0, TimeDirection::forward), 0.5 * 0.06 / 15.0);
  EXPECT_DOUBLE_EQ(sight(0.05, 15.0, TimeDirection::backward), 0.5 * 0.06 / 15.0);
  // 0.18 m to go at that speed, then they touch.
  EXPECT_DOUBLE_EQ(sight(-0.21, 15.0, TimeDirection::forward), 0.18 / 15.0);
}

// A half-space has no other side.
TEST(Passing, IsNotThroughTheGround) {
  ModelBuilder builder = sphereOnPlane(0.01, 1.0, 0.5);
  const Model model = builder.build();
  SceneContacts source(model);
  State state(model);
  state.v[2] = -1000.0;
  Kinematics kinematics(model);
  computeKinematics(model, state, kinematics);
  EXPECT_EQ(source.tunnellingTimeBound(model, kinematics, 0.032, TimeDirection::forward), 0.032);
}

// Whatever was looked at before.
TEST(Passing, DependsOnTheStateAlone) {
  const Shape shapes[] = {Shape::capsule(0.01, 0.2), Shape::box({0.005, 0.2, 0.3})};
  Encounter used(shapes[0], shapes[1]);
  int cut = 0;
  for (int seed = 0; seed < 100; ++seed) {
    Random random(seed);
    used.state.q.segment<3>(0) = random.vector3(0.5);
    used.state.q.segment<3>(7) = random.vector3(0.5);
    used.state.v = random.vector(12, 30.0);
    used.at(0.0);
    const double first =
        used.source.tunnellingTimeBound(used.model, used.kinematics, 0.02, TimeDirection::forward);
    Encounter fresh(shapes[0], shapes[1]);
    fresh.state = used.state;
    fresh.at(0.0);
    EXPECT_EQ(first, fresh.source.tunnellingTimeBound(fresh.model, fresh.kinematics, 0.02,
                                                      TimeDirection::forward));
    cut += first < 0.02;
  }
  EXPECT_GT(cut, 20);
}

}  // namespace
}  // namespace softgauss::test
