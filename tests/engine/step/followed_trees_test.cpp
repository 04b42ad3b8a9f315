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
    s.state.v.tail<3>() = Vector3(120.0, 150.0, 80.0);  // as given
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
    ASSERT_EQ(s.state.velocityOf[0], VelocityOf::halfAStepAgo);
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

/// A load of 1 kg that slides on a vertical rail and rests on the rail's end, `depth` beyond it. On
/// hinges about two axes it carries a body, by its centre, that turns at `rate`: what that does is
/// no force on the rail.
Scene tumblingOnRail(double h, double depth, double rate) {
  ModelBuilder builder("rail");
  builder.link(emptyLink("world")).link(boxLink("slider", 1.0, {0.1, 0.1, 0.1}));
  builder.link(emptyLink("fork")).link(boxLink("body", 1.0, {0.05, 0.1, 0.2}));
  JointSpec rail = jointSpec("rail", JointType::prismatic, "world", "slider", {}, Vector3::UnitZ());
  rail.lower = 0.0, rail.upper = 10.0;
  builder.joint(rail);
  builder.joint(jointSpec("first", JointType::continuous, "slider", "fork", {}, Vector3::UnitX()));
  builder.joint(jointSpec("second", JointType::continuous, "fork", "body", {}, Vector3::UnitY()));
  builder.options.timestep = h;
  Scene s(builder.build());
  s.state.q << -depth, 0.3, 0.4;
  s.state.v << 0.0, rate, 0.8 * rate;
  return s;
}

// The rows of a tree that is followed act as they do in (T.16): what does not turn goes the same
// way beside what does. It rests as deep, is thrown as high, and flies as far.
TEST(FollowedTrees, RowsActAsInStepsThatAreNotFollowed) {
  for (const double h : {0.002, 0.01})
    for (const double depth : {1e-4, 0.005, 0.2}) {
      Scene still = tumblingOnRail(h, depth, 0.0), turning = tumblingOnRail(h, depth, 0.3 / h);
      int pushed = 0, flying = 0, followed = 0;
      for (int i = 0; i < std::lround(0.2 / h); ++i) {
        still.step();
        turning.step();
        ASSERT_EQ(still.data->stats.followedTrees, 0);
        followed += turning.data->stats.followedTrees;
        (turning.data->stats.rows > 0 ? pushed : flying) += 1;
        // Rounding, and the tolerance of the sub-steps against the body's speed.
        ASSERT_SMALL(turning.state.q[0] - still.state.q[0], 1e-6) << h << ", " << depth;
      }
      EXPECT_GT(pushed, 3);
      EXPECT_GT(followed, 0.9 * (pushed + flying));
      EXPECT_EQ(flying > 0, depth > 0.1);
    }
}

// A cylinder that wobbles on its rim, as a coin does before it lies: 3.9 degrees, 6.3 rad/s, the
// point of contact an eighth of a turn further in each step. In a pile it was found to go on for
// ever. Steps of 1 ms have it lie after 0.1 s.
TEST(FollowedTrees, AWobbleOnARimDiesOut) {
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
  int far = 0;  // where a tree would be followed, if no rows pushed it
  for (int i = 0; i < 50; ++i) {
    s.step();
    far += s.data->followed.turn[0] > FollowedTrees::kFollowedTurn && s.data->stats.contacts > 0;
  }
  EXPECT_GT(far, 2);
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

// However far the body turns in a step, the tie gives it no energy, and keeps hold of it.
TEST(FollowedTrees, ATieGivesNoEnergyHoweverFarTheBodyTurns) {
  for (const double h : {0.002, 0.01})
    for (const double turn : {0.1, 0.5, 1.5, 4.0}) {
      Scene s = turningOnATie(h, turn);
      const double begun = energyOf(s), behind = turn > 0.1 ? 1e-6 : 2.0 * turn * turn;
      int kicks = 0;
      for (int i = 0; i < 500; ++i) {
        ASSERT_EQ(s.step(), SolveStatus::converged);
        kicks += s.data->stats.kicks;
        ASSERT_LE(energyOf(s), begun * (1.0 + behind)) << h << ", " << turn << ", step " << i;
        // The tie holds back ω² r by its spring alone, 1/t_c², and by half a step more.
        const Vector3 corner(0.05, 0.1, 0.15);
        const double off = (s.data->kinematics.X_WB[1] * corner - corner).norm();
        const double pulled = std::pow(turn / h * 0.02, 2.0) * corner.norm();
        ASSERT_LE(off, 1.5 * pulled) << h << ", " << turn << ", step " << i;
      }
      EXPECT_GT(kicks, 0);
    }
}

// (T.116): slow or fast, the tie gives no energy, and takes as much as in the converged motion,
// also where the body is followed and a kick does what the tie does. Energy of a v that is half a
// step behind is off by turn²/4, and by some of that again for a start whose tie is slack.
TEST(FollowedTrees, ATieOfWhatIsNotFollowedTakesWhatItShould) {
  for (const double h : {0.002, 0.01})
    for (const double turn : {0.005, 0.02, 0.03, 0.04, 0.05, 0.06, 0.09}) {
      Scene s = turningOnATie(h, turn), converged = turningOnATie(h, turn);
      converged.model.options.integrator = Integrator::dormandPrince;
      const double begun = energyOf(s);
      int followed = 0;
      for (double t = 0.0; t < 1.0 - 0.5 * h; t += h) {
        ASSERT_EQ(s.step(), SolveStatus::converged);
        ASSERT_EQ(converged.step(), SolveStatus::converged);
        followed += s.data->stats.followedTrees;
        ASSERT_LE(energyOf(s), begun * (1.0 + 2.0 * turn * turn)) << h << ", " << turn << ", " << t;
      }
      EXPECT_SMALL((energyOf(s) - energyOf(converged)) / begun, followed > 0 ? 0.05 : 0.01)
          << h << ", " << turn;
      EXPECT_EQ(followed > 0, turn > 0.05) << h << ", " << turn;
    }
}

// A ball has no Coriolis forces that would tell how far it turns; what its tie holds is turned all
// the same.
TEST(FollowedTrees, ATieOfABallGivesNoEnergy) {
  for (const double h : {0.0005, 0.002, 0.01})
    for (const double turn : {0.04, 0.15, 0.4, 1.5, 3.0}) {
      Scene s = turningAbout(Vector3(0, 0, 0.2), sphereLink("ball", 1.0, 0.1),
                             Vector3(0.6, 0.48, 0.64), h, turn);
      const double begun = energyOf(s), behind = turn < 0.1 ? 2.0 * turn * turn : 1e-6;
      int followed = 0;
      for (int i = 0; i < 500; ++i) {
        ASSERT_NE(s.step(), SolveStatus::notFinite);
        // At 6000 rad/s J̇ v is 7·10⁶ m/s², and its rounding is left of the solve.
        ASSERT_LE(s.data->stats.residual, 1e-8) << h << ", " << turn << ", step " << i;
        followed += s.data->stats.followedTrees;
        ASSERT_LE(energyOf(s), begun * (1.0 + behind)) << h << ", " << turn << ", step " << i;
      }
      EXPECT_EQ(followed > 0, turn > 0.1) << h << ", " << turn;
    }
}

// A step that is refused leaves the state as it was, the marks of its velocities too.
TEST(FollowedTrees, ARefusedStepLeavesTheMarks) {
  Scene s(freeBody(boxLink("body", 1.0, {0.05, 0.1, 0.15})).build());
  s.state.v.tail<3>() = Vector3(0.8, 1.2, 0.6);
  const std::uint64_t before = hash(s.state);
  s.input.tau[3] = 1e160;
  ASSERT_EQ(s.step(), SolveStatus::notFinite);
  EXPECT_EQ(hash(s.state), before);
  s.input.tau.setZero();
  ASSERT_EQ(s.step(), SolveStatus::converged);
}

// What a step leaves in Data is (T.1) with all forces, also where it has solved again.
TEST(FollowedTrees, AKickPutsTheSolutionBack) {
  Scene s = turningOnATie(0.002, 0.5);
  for (int i = 0; i < 20; ++i) {
    Scene plain = turningOnATie(0.002, 0.5);
    plain.state = s.state;
    plain.stages();
    ASSERT_EQ(plain.forward(), SolveStatus::converged);
    s.step();
    ASSERT_EQ(s.data->stats.kicks, 1);
    const VectorX &a = s.data->forward.a, &expected = plain.data->forward.a;
    EXPECT_SMALL((a - expected).norm() / expected.norm(), 1e-10);
    EXPECT_EQ((s.data->forces.net - plain.data->forces.net).norm(), 0.0);
    const std::vector<double>&f = s.data->constraints.connection.f,
          &g = plain.data->constraints.connection.f;
    for (std::size_t k = 0; k < g.size(); ++k) EXPECT_SMALL(f[k] - g[k], 1e-9 * expected.norm());
  }
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
