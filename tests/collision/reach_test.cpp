// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/reach.hpp"

#include <gtest/gtest.h>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

using collision::Ball;
using collision::leastDistance;

/// Balls on random hinges: two trees on the world's base and, at random, a slider.
Model randomArms(Random& random) {
  ModelBuilder builder("arms");
  builder.link(emptyLink("world"));
  for (const char* name : {"a", "b"}) {
    std::string parent = "world";
    for (int i = 0; i < 3; ++i) {
      const std::string link = name + std::to_string(i);
      builder.link(sphereLink(link, 1.0, 0.1));
      builder.joint(jointSpec(link + "_joint", JointType::continuous, parent, link,
                              {random.rotation(), random.vector3(0.5)},
                              random.vector3(1.0).normalized()));
      builder.geometry(
          geometrySpec(link, Shape::sphere(0.05), 1.0, {Matrix3::Identity(), random.vector3(0.3)}));
      parent = link;
    }
  }
  builder.geometry(groundSpec(1.0));
  return builder.build();
}

// (7.8) is a bound: no configuration comes nearer, and a random search comes close to it.
TEST(Reach, NoConfigurationComesNearer) {
  double closest = kInfinity;
  for (int seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const Model model = randomArms(random);
    Kinematics k(model);
    State state(model);
    const std::size_t count = model.geometries.size();
    const auto ball = [&](const Geometry& g) { return Ball{g.X_BG.p, g.shape.radius}; };
    for (int n = 0; n < 200; ++n) {
      for (double& q : state.q) q = random.uniform(-M_PI, M_PI);
      computeKinematics(model, state, k);
      for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const Geometry &a = model.geometries[i], &b = model.geometries[j];
          const double bound = leastDistance(model, a, ball(a), b, ball(b));
          const Vector3 p_WA = k.X_WB[a.body] * a.X_BG.p, p_WB = k.X_WB[b.body] * b.X_BG.p;
          const bool planeA = a.shape.kind == ShapeKind::plane;
          const double distance = planeA || b.shape.kind == ShapeKind::plane
                                      ? (planeA ? p_WB : p_WA).z() - 0.05
                                      : (p_WA - p_WB).norm() - 0.1;
          EXPECT_GE(distance, bound - 1e-12) << "seed " << seed;
          if (bound > 0.0) closest = std::min(closest, distance - bound);
        }
    }
  }
  EXPECT_LT(closest, 0.05);
}

// A ball at r from a vertical hinge never gets nearer than d − r to a ball at d from it.
TEST(Reach, OfOneHingeIsItsOrbit) {
  ModelBuilder builder("orbit");
  builder.link(emptyLink("world")).link(sphereLink("bob", 1.0, 0.1));
  builder.joint(jointSpec("hinge", JointType::continuous, "world", "bob"));
  builder.geometry(
      geometrySpec("bob", Shape::sphere(0.1), 1.0, {Matrix3::Identity(), {0.4, 0, 0}}));
  GeometrySpec post =
      geometrySpec("world", Shape::sphere(0.1), 1.0, {Matrix3::Identity(), {0, 1.0, 0}});
  builder.geometry(post);
  Model model = builder.build();
  const Geometry &bob = model.geometries[0], &fixed = model.geometries[1];
  const Ball a{bob.X_BG.p, 0.1}, b{fixed.X_BG.p, 0.1};
  EXPECT_SMALL(leastDistance(model, bob, a, fixed, b) - (1.0 - 0.4 - 0.2), 1e-15);
  // Such a pair is left out, and then nothing is ever looked for.
  const collision::SceneContacts contacts(model);
  EXPECT_EQ(contacts.filter().unreachablePairs, 1);
  EXPECT_FALSE(contacts.mayTouch());
  // On a slider there is no bound.
  for (Body& body : model.bodies)
    if (body.joint == JointKind::revolute) body.joint = JointKind::prismatic;
  EXPECT_EQ(leastDistance(model, bob, a, fixed, b), -kInfinity);
}

// Pairs in the margin's reach stay.
TEST(Reach, CountsTheMargin) {
  for (const double margin : {0.19, 0.21}) {
    ModelBuilder builder("orbit");
    builder.link(emptyLink("world")).link(sphereLink("bob", 1.0, 0.1));
    builder.joint(jointSpec("hinge", JointType::continuous, "world", "bob"));
    GeometrySpec bob =
        geometrySpec("bob", Shape::sphere(0.1), 1.0, {Matrix3::Identity(), {0.4, 0, 0}});
    GeometrySpec post =
        geometrySpec("world", Shape::sphere(0.1), 1.0, {Matrix3::Identity(), {0, 0.8, 0}});
    bob.material.margin = margin;
    builder.geometry(bob).geometry(post);
    const Model model = builder.build();
    EXPECT_EQ(collision::SceneContacts(model).mayTouch(), margin > 0.2);
  }
}

}  // namespace
}  // namespace softgauss::test
