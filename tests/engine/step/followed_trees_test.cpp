// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/followed_trees.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "collision/scene_contacts.hpp"
#include "engine/core/rotation.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

// The articulated-body recursion against M, its factor and the Newton–Euler recursion, which share
// nothing with it but the poses' formulas.
TEST(TreeMotion, AcceleratesLikeTheMassMatrix) {
  int floating = 0, springs = 0, damped = 0;
  for (int seed = 0; seed < 20; ++seed) {
    RandomTreeOptions options;
    options.springs = true;
    Scene s = randomScene(seed, 0, options);
    Random random(seed + 100);
    VectorX held(s.model.nv);
    for (double& x : held) x = random.uniform(-5.0, 5.0);
    TreeMotion motion(s.model);
    VectorX vdot(s.model.nv);
    for (const Tree& tree : s.model.trees) {
      motion.acceleration(s.model, s.data->plan, tree, s.state, held, vdot);
      floating += s.model.bodies[tree.rootBody].joint == JointKind::floating;
    }
    VectorX force = held - s.data->forces.bias;
    for (const Plan::Spring& spring : s.data->plan.springs) {
      force[spring.dof] -= spring.stiffness * (s.state.q[spring.q] - spring.reference);
      ++springs;
    }
    for (int i = 0; i < s.model.nv; ++i) {
      force[i] -= s.model.dofs[i].damping * s.state.v[i];
      damped += s.model.dofs[i].damping > 0.0;
    }
    const VectorX expected = s.data->inertia.M.dense().llt().solve(force);
    EXPECT_SMALL((vdot - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff(), 1e-10)
        << "seed " << seed;
  }
  EXPECT_GT(floating, 10);
  EXPECT_GT(springs, 10);
  EXPECT_GT(damped, 10);
}

// φ̇ moves exp(φ) as ω in its own axes does: central difference of R₀ exp(φ).
TEST(RotationRate, TurnsTheRotationWithOmega) {
  Random random(3);
  for (const double angle : {0.0, 1e-9, 0.0199, 0.0201, 0.7, M_PI, 5.0}) {
    const Vector3 phi = angle * random.direction(), omega = random.vector3(1.0);
    const Vector3 rate = rotationRate(phi, omega);
    const double step = 1e-5;
    const Quaternion before = quaternionExp(phi - step * rate);
    const Quaternion after = quaternionExp(phi + step * rate);
    // A central difference leaves an error of step² times a third derivative of size 1/(2π − θ)³.
    EXPECT_APPROX(Vector3(quaternionLog(before.conjugate() * after) / (2.0 * step)), omega, 1e-9)
        << angle;
  }
}

Scene tumbling(double h, double rate) {
  LinkSpec link = emptyLink("body");
  link.mass = 1.0;
  link.I_Lcm = Vector3(0.01, 0.02, 0.025).asDiagonal();
  ModelBuilder builder = freeBody(link);
  builder.options.gravity.setZero();
  builder.options.timestep = h;
  Scene s(builder.build());
  s.state.v.tail<3>() = rate * Vector3(0.1, 1.0, 0.1).normalized();
  return s;
}

// From the same instant, whatever the step: what is followed does not depend on it.
TEST(FollowedTrees, TumblingDoesNotDependOnTheStep) {
  const auto after = [](double h) {
    Scene s = tumbling(h, 200.0);
    s.state.v.tail<3>() = Vector3(120.0, 150.0, 80.0);  // State::followed: as given
    for (int i = 0; i < std::lround(0.2 / h); ++i) {
      s.step();
      EXPECT_EQ(s.data->stats.followedTrees, 1) << h;
    }
    return s;
  };
  const Scene fine = after(0.001);
  for (const double h : {0.002, 0.004, 0.01, 0.02}) {
    const Scene s = after(h);
    // The tolerance of each sub-step, 5e-8, over some hundred of them.
    EXPECT_SMALL(positionDifference(s.model, fine.state.q, s.state.q).norm(), 2e-5) << h;
    EXPECT_SMALL((s.state.v - fine.state.v).norm() / 200.0, 2e-5) << h;
  }
}

// What is slow takes (T.16) alone, and its velocity stays that of half a step earlier.
TEST(FollowedTrees, SlowTreesAreNotFollowed) {
  Scene s = tumbling(0.002, 5.0);
  for (int i = 0; i < 500; ++i) {
    s.step();
    ASSERT_EQ(s.data->stats.followedTrees, 0);
    ASSERT_EQ(s.state.followed[0], 0);
  }
}

// Only the tree that turns is followed; the other's bits are those it has alone.
TEST(FollowedTrees, EachTreeDecidesForItself) {
  const auto builder = [](bool both) {
    ModelBuilder b("pair");
    b.base = BaseKind::floating;
    LinkSpec slow = boxLink("slow", 1.0, {0.1, 0.2, 0.3}),
             fast = boxLink("fast", 1.0, {0.1, 0.2, 0.3});
    b.link(slow);
    if (both) b.link(fast);
    return b;
  };
  Scene alone(builder(false).build()), pair(builder(true).build());
  alone.state.v << 1, 2, 3, 1, 2, 3;
  pair.state.v << 1, 2, 3, 1, 2, 3, 0, 0, 0, 100, 200, 30;
  for (int i = 0; i < 100; ++i) {
    alone.step();
    pair.step();
    ASSERT_EQ(pair.data->stats.followedTrees, 1);
    ASSERT_EQ(alone.data->stats.followedTrees, 0);
    ASSERT_TRUE((pair.state.q.head<7>().array() == alone.state.q.array()).all()) << i;
    ASSERT_TRUE((pair.state.v.head<6>().array() == alone.state.v.array()).all()) << i;
  }
}

// 10⁴ turns in a step are more than the sub-steps can follow: said, and the state is moved by
// (T.16) or left, never silently wrong.
TEST(FollowedTrees, WhatCannotBeFollowedIsCounted) {
  Scene s = tumbling(0.02, 5e6);
  s.step();
  EXPECT_EQ(s.data->stats.followedTrees, 0);
  EXPECT_EQ(s.data->stats.abandonedTrees, 1);
}

// MuJoCo's Euler is left as it is.
TEST(FollowedTrees, WithoutCoriolisForcesOfMidStepNothingIsFollowed) {
  Scene s = tumbling(0.002, 100.0);
  s.model.options.midpointCoriolis = false;
  s.step();
  EXPECT_EQ(s.data->stats.followedTrees, 0);
  EXPECT_EQ(s.data->followed.bytes(), 0u);
}

// Bodies that tumble fast enough to be followed, some of the time, hit each other in empty space.
// What one gets the other loses, whoever is followed in that step: to rounding of a few steps'
// work.
TEST(FollowedTrees, CollisionsKeepLinearMomentum) {
  int hits = 0, followed = 0, changes = 0;
  for (int seed = 0; seed < 20; ++seed) {
    Random random(seed);
    ModelBuilder builder("two");
    for (const double side : {-1.0, 1.0}) {
      ModelBuilder one = freeBody(boxLink("body", 1.0, {0.05, 0.1, 0.15}));
      one.X_WRoot.p = Vector3(0.2 * side, 0.02 * side, 0.0);
      one.geometry(geometrySpec("body", Shape::box({0.05, 0.1, 0.15}), 0.5, {}));
      builder.add(one, side < 0.0 ? "left" : "right");
    }
    builder.options.effects.remove(Effect::gravity);
    const Model model = builder.build();
    collision::SceneContacts contacts(model);
    Data data(model);
    State state(model);
    const double rate = random.uniform(10.0, 25.0);
    state.v.segment<3>(0) = Vector3(1.0, 0.0, 0.1);
    state.v.segment<3>(6) = Vector3(-1.5, 0.1, 0.0);
    state.v.segment<3>(3) = rate * random.direction();
    state.v.segment<3>(9) = rate * random.direction();
    const Vector3 before = state.v.segment<3>(0) + state.v.segment<3>(6);
    int last = -1;
    for (int i = 0; i < 300; ++i) {
      ASSERT_NE(step(model, {}, state, data, &contacts), SolveStatus::notFinite);
      hits += data.stats.contacts > 0;
      followed += data.stats.followedTrees;
      changes += data.stats.contacts > 0 && last >= 0 && last != data.stats.followedTrees;
      last = data.stats.followedTrees;
      const Vector3 now = state.v.segment<3>(0) + state.v.segment<3>(6);
      ASSERT_SMALL((now - before).norm(), 1e-9) << "seed " << seed << ", step " << i;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(followed, 100);
  EXPECT_GT(changes, 5) << "in a step with contact";
}

}  // namespace
}  // namespace softgauss::test
