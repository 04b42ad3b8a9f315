// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/tree_substepping.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"
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
TEST(TreeSubstepping, TumblingDoesNotDependOnTheStep) {
  const auto after = [](double h) {
    Scene s = tumbling(h, 200.0);
    s.state.v.tail<3>() = Vector3(120.0, 150.0, 80.0);  // as given
    for (int i = 0; i < std::lround(0.2 / h); ++i) {
      s.step();
      EXPECT_EQ(s.data->stats.substeppedTrees, 1) << h;
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

// A ball, and what flies without turning, moves as exactly without.
TEST(TreeSubstepping, WhatMovesEvenlyIsNotFollowed) {
  for (const bool ball : {true, false}) {
    Scene s(freeBody(ball ? sphereLink("body", 1.0, 0.1) : boxLink("body", 1.0, {0.1, 0.2, 0.3}))
                .build());
    s.state.v << 1, 2, 3, 0, 0, 0;
    if (ball) s.state.v.tail<3>() = Vector3(20.0, -30.0, 50.0);
    const State start = s.state;
    s.steps(500);
    EXPECT_EQ(s.data->stats.substeppedTrees, 0);
    const double t = s.state.time;
    const Vector3 place =
        start.q.head<3>() + t * start.v.head<3>() + 0.5 * t * t * s.model.options.gravity;
    EXPECT_APPROX(s.state.q.head<3>(), place, 1e-12);
    EXPECT_APPROX(s.state.v.tail<3>(), start.v.tail<3>(), 1e-13);
  }
}

// Each goes by sub-steps of its own: the slow one's bits are those it has alone.
TEST(TreeSubstepping, EachTreeDecidesForItself) {
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
    ASSERT_EQ(pair.data->stats.substeppedTrees, 2);
    ASSERT_EQ(alone.data->stats.substeppedTrees, 1);
    ASSERT_EQ(alone.data->stats.substeps, 1);
    ASSERT_TRUE((pair.state.q.head<7>().array() == alone.state.q.array()).all()) << i;
    ASSERT_TRUE((pair.state.v.head<6>().array() == alone.state.v.array()).all()) << i;
  }
}

// 10⁴ turns in a step are more than the sub-steps can follow: said, and the state is moved by
// (6.2) or left, never silently wrong.
TEST(TreeSubstepping, WhatCannotBeFollowedIsCounted) {
  Scene s = tumbling(0.02, 5e6);
  s.step();
  EXPECT_EQ(s.data->stats.substeppedTrees, 0);
  EXPECT_EQ(s.data->stats.abandonedTrees, 1);
}

// Other integrators follow nothing.
TEST(TreeSubstepping, AreOfTheLeapfrog) {
  Scene s = tumbling(0.002, 100.0);
  s.model.options.integrator = Integrator::semiImplicitEuler;
  s.step();
  EXPECT_EQ(s.data->stats.substeppedTrees, 0);
  EXPECT_EQ(s.data->parts, nullptr);
}

/// Whether an infinite substepAngle leaves the leapfrog's step as it is.
TEST(TreeSubstepping, AnInfinitePartAngleFollowsNothing) {
  Scene s = tumbling(0.002, 100.0);
  s.model.options.substepAngle = kInfinity;
  s.step();
  EXPECT_EQ(s.data->stats.substeppedTrees, 0);
  EXPECT_EQ(s.data->stats.parts, 1);
}

// A cylinder that wobbles on its rim, as a coin does before it lies: 3.9 degrees, 6.3 rad/s, the
// point of contact an eighth of a turn further in each step. In a pile it was found to go on for
// ever. Steps of 1 ms have it lie after 0.1 s.
TEST(TreeSubstepping, AWobbleOnARimDiesOut) {
  const double r = 0.0306372, mass = 4000.0 * r * r * r, half = 0.7 * r;
  LinkSpec link = emptyLink("body");
  link.mass = mass;
  link.I_Lcm = (mass * half * half * Vector3(7.0 / 12.0, 7.0 / 12.0, 0.5)).asDiagonal();
  ModelBuilder builder = freeBody(link);
  builder.geometry(groundSpec(0.7));
  builder.geometry(geometrySpec("body", Shape::cylinder(half, half), 0.7));
  builder.options.timestep = 0.01;
  Model model = builder.build();
  for (Geometry& g : model.geometries) {
    g.material.condim = 6;
    g.material.rollingFriction = 0.01;
  }
  Scene s(std::move(model));
  s.contacts = std::make_shared<collision::SceneContacts>(s.model);
  s.state.q << 0.29599, 0.40173, 0.0215873, 0.0066091, -0.4243283, 0.9048622, -0.0335609;
  s.state.v << 0.0244458, 0.0244458, 0.00020758, -0.770629, 5.809943, 2.267628;
  s.state.q.tail<4>().normalize();
  int parts = 0;
  for (int i = 0; i < 200; ++i) {
    s.step();
    parts = std::max(parts, s.data->stats.parts);
  }
  EXPECT_GT(parts, 1);
  // It begins with 6.7e-4 J.
  computeKinematics(s.model, s.state, s.data->kinematics);
  EXPECT_SMALL(computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).kinetic, 1e-9);
}

/// A free body that turns about one of its points, which is tied to the world: `turn` is how far in
/// a step.
Scene turningAbout(const Vector3& point, const LinkSpec& body, const Vector3& axis, double h,
                   double turn) {
  ModelBuilder builder = freeBody(body);
  ConnectSpec tie;
  tie.linkA = body.name;
  tie.p_LAP = tie.p_LBP = point;
  tie.linkB = "world";
  builder.connect(tie);
  builder.options.gravity.setZero();
  builder.options.timestep = h;
  Scene s(builder.build());
  const Vector3 omega = turn / h * axis;
  s.state.v << -omega.cross(point), omega;
  return s;
}

/// A box that turns about its corner.
Scene turningOnATie(double h, double turn) {
  const Vector3 corner(0.05, 0.1, 0.15);
  return turningAbout(corner, boxLink("body", 1.0, corner), Vector3(0.6, 0.64, -0.48), h, turn);
}

double energyOf(Scene& s) {
  computeKinematics(s.model, s.state, s.data->kinematics);
  return computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).total();
}

// However far the body turns in a step, the equality constraint gives it no energy, and keeps hold
// of it. Energy of soft rows is off by what they are stretched by, (turn²)² of the motion at most.
TEST(TreeSubstepping, ATieGivesNoEnergyHoweverFarTheBodyTurns) {
  for (const double h : {0.002, 0.01})
    for (const double turn : {0.1, 0.5, 1.5, 4.0}) {
      Scene s = turningOnATie(h, turn);
      const double begun = energyOf(s);
      int parts = 0;
      for (int i = 0; i < 500; ++i) {
        ASSERT_EQ(s.step(), SolveStatus::converged);
        parts = std::max(parts, s.data->stats.parts);
        ASSERT_LE(energyOf(s), begun * (1.0 + 1e-6)) << h << ", " << turn << ", step " << i;
        // The equality constraint holds back ω² r by its spring alone, 1/t_c², and by half a step
        // more.
        const Vector3 corner(0.05, 0.1, 0.15);
        const double off = (s.data->kinematics.X_WB[1] * corner - corner).norm();
        const double pulled = std::pow(turn / h * 0.02, 2.0) * corner.norm();
        ASSERT_LE(off, 1.5 * pulled) << h << ", " << turn << ", step " << i;
      }
      EXPECT_GE(parts, std::ceil(0.9 * turn / 0.1)) << turn;
    }
}

// Slow or fast, the equality constraint gives no energy, and takes as much as in short steps.
TEST(TreeSubstepping, ATieTakesWhatItShould) {
  constexpr int kShorter = 16;
  for (const double h : {0.002, 0.01})
    for (const double turn : {0.005, 0.02, 0.03, 0.04, 0.05, 0.06, 0.09}) {
      Scene s = turningOnATie(h, turn), converged = turningOnATie(h / kShorter, turn / kShorter);
      const double begun = energyOf(s);
      for (double t = 0.0; t < 1.0 - 0.5 * h; t += h) {
        ASSERT_EQ(s.step(), SolveStatus::converged);
        converged.steps(kShorter);
        ASSERT_LE(energyOf(s), begun * (1.0 + 2.0 * turn * turn)) << h << ", " << turn << ", " << t;
      }
      EXPECT_SMALL((energyOf(s) - energyOf(converged)) / begun, 0.01) << h << ", " << turn;
    }
}

// A ball has no Coriolis forces that would tell how far it turns; what its equality constraint
// holds is turned all the same.
TEST(TreeSubstepping, ATieOfABallGivesNoEnergy) {
  for (const double h : {0.0005, 0.002, 0.01})
    for (const double turn : {0.04, 0.15, 0.4, 1.5, 3.0}) {
      Scene s = turningAbout(Vector3(0, 0, 0.2), sphereLink("ball", 1.0, 0.1),
                             Vector3(0.6, 0.48, 0.64), h, turn);
      const double begun = energyOf(s), behind = turn < 0.1 ? 2.0 * turn * turn : 1e-6;
      for (int i = 0; i < 500; ++i) {
        ASSERT_NE(s.step(), SolveStatus::notFinite);
        // At 6000 rad/s J̇ v is 7·10⁶ m/s², and its rounding is left of the solve.
        ASSERT_LE(s.data->stats.residual, 1e-8) << h << ", " << turn << ", step " << i;
        ASSERT_LE(energyOf(s), begun * (1.0 + behind)) << h << ", " << turn << ", step " << i;
      }
    }
}

// A step that is refused leaves the state as it was, its last acceleration too.
TEST(TreeSubstepping, ARefusedStepLeavesTheAcceleration) {
  Scene s(freeBody(boxLink("body", 1.0, {0.05, 0.1, 0.15})).build());
  s.state.v.tail<3>() = Vector3(0.8, 1.2, 0.6);
  const std::uint64_t before = hash(s.state);
  s.input.tau[3] = 1e160;
  ASSERT_EQ(s.step(), SolveStatus::notFinite);
  EXPECT_EQ(hash(s.state), before);
  s.input.tau.setZero();
  ASSERT_EQ(s.step(), SolveStatus::converged);
}

// Bodies that tumble fast enough to be followed, some of the time, hit each other in empty space.
// What one gets the other loses, whoever is followed in that step: to rounding of a few steps'
// work.
TEST(TreeSubstepping, CollisionsKeepLinearMomentum) {
  int hits = 0, followed = 0, changes = 0;
  for (int seed = 0; seed < 80; ++seed) {
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
    const double rate = random.uniform(20.0, 80.0);
    state.v.segment<3>(0) = Vector3(1.0, 0.0, 0.1);
    state.v.segment<3>(6) = Vector3(-1.5, 0.1, 0.0);
    state.v.segment<3>(3) = rate * random.direction();
    state.v.segment<3>(9) = rate * random.direction();
    const Vector3 before = state.v.segment<3>(0) + state.v.segment<3>(6);
    int last = -1;
    for (int i = 0; i < 300; ++i) {
      ASSERT_NE(step(model, {}, state, data, &contacts), SolveStatus::notFinite);
      hits += data.stats.contacts > 0;
      followed += data.stats.substeppedTrees;
      changes += data.stats.contacts > 0 && last >= 0 && last != data.stats.substeppedTrees;
      last = data.stats.substeppedTrees;
      const Vector3 now = state.v.segment<3>(0) + state.v.segment<3>(6);
      ASSERT_SMALL((now - before).norm(), 1e-9) << "seed " << seed << ", step " << i;
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(followed, 100);
  EXPECT_GT(changes, 5) << "in a step with contact";
}

// A double pendulum that swings fast; its shoulder has dry friction and one end of its range.
// Turned about and its joints with it, so that the upper end is the lower one, it is the same.
TEST(TreeSubstepping, ARangeHoldsWhereDryFrictionActs) {
  for (const double friction : {0.0, 0.2, 1.0}) {
    double largest[2] = {};
    for (const bool mirrored : {false, true}) {
      const Vector3 axis(0.0, mirrored ? -1.0 : 1.0, 0.0);
      ModelBuilder builder("pendulum");
      builder.base = BaseKind::fixed;
      builder.link(emptyLink("base"));
      for (const char* link : {"upper", "lower"})
        builder.link(boxLink(link, 1.0, Vector3(0.02, 0.02, 0.2), Vector3(0.0, 0.0, -0.2)));
      JointSpec shoulder = jointSpec("shoulder", JointType::revolute, "base", "upper", {}, axis);
      JointSpec elbow = jointSpec("elbow", JointType::revolute, "upper", "lower",
                                  {Matrix3::Identity(), Vector3(0.0, 0.0, -0.4)}, axis);
      shoulder.actuated = elbow.actuated = false;
      shoulder.dryFriction = friction;
      shoulder.lower = mirrored ? -0.5 : -3.0;
      shoulder.upper = mirrored ? 3.0 : 0.5;
      builder.joint(shoulder), builder.joint(elbow);
      Scene s(builder.build());
      const double sign = mirrored ? -1.0 : 1.0;
      s.state.v << 6.0 * sign, 30.0 * sign;
      for (int i = 0; i < 500; ++i) {
        s.steps(1);
        largest[mirrored] = std::max(largest[mirrored], sign * s.state.q[0]);
      }
    }
    // 2.5 mrad in the fastest blow that there is.
    EXPECT_LT(largest[0], 0.51) << "friction " << friction;
    EXPECT_GT(largest[0], 0.5);
    EXPECT_NEAR(largest[0], largest[1], 1e-9);
  }
}

}  // namespace
}  // namespace softgauss::test
