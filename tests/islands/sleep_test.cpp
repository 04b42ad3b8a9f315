// SPDX-License-Identifier: Apache-2.0

/// What is at rest sleeps, and wakes when it is touched.

#include "softgauss/engine/islands/islands.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

constexpr Sleep kSleep{.enabled = true};

/// Four stacks of two cubes 1 m apart, and a ball above the first.
ModelBuilder stacks() {
  ModelBuilder builder = ground();
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 2; ++k)
      addCube(builder, "cube" + std::to_string(i) + std::to_string(k),
              Vector3(1.0 * i, 0.0, 0.1 + 0.2 * k));
  return builder;
}

TEST(Sleep, ComesToWhatRests) {
  for (const double speed : {1e-6, 1e-4, kSleep.speed}) {
    Sleep sleep = kSleep;
    sleep.speed = speed;
    Crowd crowd(stacks().build(), sleep), awake(stacks().build());
    ASSERT_TRUE(crowd.steps(1000) && awake.steps(1000));
    EXPECT_EQ(crowd.islands.islandStats().islands, 4);
    EXPECT_EQ(crowd.islands.islandStats().awake, 0);
    EXPECT_EQ(crowd.islands.state().v, VectorX::Zero(crowd.model.nv));
    EXPECT_DOUBLE_EQ(crowd.islands.state().time, awake.islands.state().time);
    // What is left out is slower than that; here it is a decay, with 20 ms to go.
    EXPECT_SMALL((crowd.islands.state().q - awake.islands.state().q).cwiseAbs().maxCoeff(),
                 0.02 * speed);
  }
}

TEST(Sleep, EndsForWhatIsTouchedAlone) {
  ModelBuilder builder = stacks();
  addCube(builder, "falling", Vector3(1.02, 0.0, 5.0));
  Crowd crowd(builder.build(), kSleep);
  int wakeups = 0;
  bool slept = false;
  for (int i = 0; i < 600; ++i) {
    ASSERT_TRUE(crowd.steps(1));
    wakeups += crowd.islands.islandStats().wakeups;
    if (wakeups == 0 && crowd.islands.islandStats().awake == 1) slept = true;
    if (wakeups > 0) break;
  }
  EXPECT_TRUE(slept);
  EXPECT_EQ(wakeups, 1);
  EXPECT_FALSE(crowd.islands.asleep(crowd.body("cube10")));
  EXPECT_FALSE(crowd.islands.asleep(crowd.body("cube11")));
  for (const char* name : {"cube00", "cube01", "cube20", "cube21", "cube30", "cube31"})
    EXPECT_TRUE(crowd.islands.asleep(crowd.body(name))) << name;
  // It carries what fell on it, and all sleep again.
  ASSERT_TRUE(crowd.steps(5000));
  EXPECT_EQ(crowd.islands.islandStats().awake, 0);
}

TEST(Sleep, DoesNotChangeWhoWasNeverNearIt) {
  ModelBuilder sleepers = stacks(), alone = ground();
  addCreature(sleepers, "creature", Vector3(0.0, 3.0, 1.0));
  addCreature(alone, "creature", Vector3(0.0, 3.0, 1.0));
  Crowd crowd(sleepers.build(), kSleep), one(alone.build(), kSleep);
  bool sleptAlone = false;
  for (int i = 0; i < 1500; ++i) {
    ASSERT_TRUE(crowd.steps(1) && one.steps(1));
    const IslandStats &all = crowd.islands.islandStats(), &own = one.islands.islandStats();
    sleptAlone = sleptAlone || (all.awake == own.awake && own.awake == 1);
    ASSERT_EQ(crowd.islands.state().q.tail(one.model.nq), one.islands.state().q);
    ASSERT_EQ(crowd.islands.state().v.tail(one.model.nv), one.islands.state().v);
  }
  EXPECT_TRUE(sleptAlone);
}

TEST(Sleep, EndsByForceWrenchAndCall) {
  Crowd crowd(stacks().build(), kSleep);
  const auto sleepers = [&] {
    int count = 0;
    for (int i = 0; i < 4; ++i)
      count += crowd.islands.asleep(crowd.body("cube" + std::to_string(i) + "0"));
    return count;
  };
  ASSERT_TRUE(crowd.steps(1000));
  ASSERT_EQ(sleepers(), 4);

  Input input;
  input.tau = VectorX::Zero(crowd.model.nv);
  ASSERT_EQ(crowd.islands.step(input), SolveStatus::converged);
  EXPECT_EQ(sleepers(), 4);  // no force is no reason
  input.tau[crowd.model.bodies[static_cast<std::size_t>(crowd.body("cube01"))].v] = 1e-3;
  ASSERT_EQ(crowd.islands.step(input), SolveStatus::converged);
  EXPECT_EQ(sleepers(), 3);
  EXPECT_FALSE(crowd.islands.asleep(crowd.body("cube00")));

  ASSERT_TRUE(crowd.steps(1000));
  ASSERT_EQ(sleepers(), 4);
  input.tau.resize(0);
  input.wrenches.push_back({crowd.body("cube10"), {Vector3::Zero(), Vector3(1e-3, 0.0, 0.0)}});
  ASSERT_EQ(crowd.islands.step(input), SolveStatus::converged);
  EXPECT_EQ(sleepers(), 3);

  crowd.islands.wake(crowd.body("cube30"));
  EXPECT_EQ(sleepers(), 2);
  crowd.islands.setState(crowd.islands.state());
  EXPECT_EQ(sleepers(), 0);
}

TEST(Sleep, IsNotForWhatMovesSlowlyAndSteadily) {
  // Twice the speed of sleep, without gravity: it goes on for ever.
  ModelBuilder builder = ground();
  builder.options.gravity.setZero();
  addCube(builder, "drifting", Vector3(0.0, 0.0, 1.0));
  addCube(builder, "turning", Vector3(1.0, 0.0, 1.0));
  addCube(builder, "resting", Vector3(2.0, 0.0, 1.0));
  Crowd crowd(builder.build(), kSleep);
  State state = crowd.islands.state();
  state.v[0] = 2.0 * kSleep.speed;
  state.v[6 + 5] = 2.0 * kSleep.speed / (0.1 * std::sqrt(2.0 / 3.0));  // at its radius of gyration
  crowd.islands.setState(state);
  ASSERT_TRUE(crowd.steps(1000));
  EXPECT_FALSE(crowd.islands.asleep(crowd.body("drifting")));
  EXPECT_FALSE(crowd.islands.asleep(crowd.body("turning")));
  EXPECT_TRUE(crowd.islands.asleep(crowd.body("resting")));
}

/// A link of 1 kg on one joint, without contacts; its state after 20 s, with and without sleep.
double gapOf(ModelBuilder builder, double q, double v, double seconds) {
  const Model model = builder.build();
  VectorX ends[2];
  for (const bool sleeps : {false, true}) {
    Islands islands(model, nullptr, Sleep{.enabled = sleeps});
    State state(model);
    state.q[0] = q, state.v[0] = v;
    islands.setState(state);
    for (int i = 0; i < static_cast<int>(seconds / 0.002); ++i)
      EXPECT_EQ(islands.step({}), SolveStatus::converged);
    ends[sleeps] = islands.state().q;
  }
  return (ends[1] - ends[0]).cwiseAbs().maxCoeff();
}

/// One joint along or about x, its link's centre of mass `height` above the axis.
ModelBuilder oneJoint(JointType type, double height, double stiffness, double armature) {
  ModelBuilder builder("one");
  builder.link(emptyLink("world"));
  LinkSpec rod = boxLink("rod", 1.0, Vector3::Constant(0.01));
  rod.com.z() = height;
  builder.link(rod);
  JointSpec joint = jointSpec("joint", type, "world", "rod", {}, Vector3::UnitX());
  joint.stiffness = stiffness, joint.armature = armature;
  builder.joint(joint);
  return builder;
}

// Slow is not at rest: what speeds up is not held, nor what turns back.
TEST(Sleep, IsNotForWhatSpeedsUp) {
  for (const double tilt : {1e-3, 1e-4, 1e-6})
    EXPECT_EQ(gapOf(oneJoint(JointType::revolute, 1.0, 0.0, 0.0), tilt, 0.0, 3.0), 0.0) << tilt;
  // 9 mm/s² pull it back; it is slow for a second where it turns.
  EXPECT_EQ(gapOf(oneJoint(JointType::prismatic, 1.0, 0.009, 0.0), 1.0, 0.0, 30.0), 0.0);
  // The rotor of a motor turns, and its link hardly moves.
  EXPECT_EQ(gapOf(oneJoint(JointType::revolute, 0.0, 0.0, 1.0), 0.0, 0.1, 5.0), 0.0);
}

TEST(Sleep, IsOffUnlessAskedFor) {
  Crowd crowd(stacks().build());
  ASSERT_TRUE(crowd.steps(1000));
  EXPECT_EQ(crowd.islands.islandStats().awake, 4);
}

// A servo holds its load asleep, and wakes when it is told another place to go.
TEST(Sleep, EndsForServosThatAreToldSomethingNew) {
  ModelBuilder builder = ground();
  addCube(builder, "cube", Vector3(3.0, 0.0, 0.1));
  builder.link(emptyLink("world")).link(boxLink("arm", 1.0, {0.1, 0.1, 0.1}, {0.5, 0.0, 0.0}));
  JointSpec joint = jointSpec("hinge", JointType::revolute, "world", "arm",
                              {Matrix3::Identity(), Vector3(0.0, 0.0, 1.0)}, Vector3::UnitY());
  joint.servo = {.kp = 500.0, .kd = 50.0};
  builder.joint(joint);
  Crowd crowd(builder.build(), kSleep);
  const int dof = crowd.model.bodies[idx(crowd.body("arm"))].v;
  ASSERT_TRUE(crowd.steps(3000));
  EXPECT_EQ(crowd.islands.islandStats().awake, 0);
  const double before = crowd.islands.state().q[crowd.model.bodies[idx(crowd.body("arm"))].q];
  Input input;
  input.setPoint = VectorX::Zero(crowd.model.nv);
  ASSERT_EQ(crowd.islands.step(input), SolveStatus::converged);
  EXPECT_TRUE(crowd.islands.asleep(crowd.body("arm")));
  input.setPoint[dof] = 0.3;
  ASSERT_EQ(crowd.islands.step(input), SolveStatus::converged);
  EXPECT_TRUE(crowd.islands.asleep(crowd.body("cube")));
  EXPECT_FALSE(crowd.islands.asleep(crowd.body("arm")));
  for (int i = 0; i < 3000; ++i) crowd.islands.step(input);
  EXPECT_EQ(crowd.islands.islandStats().awake, 0);
  // It turns by 0.3, but for what the lever of its weight changes by its spring: 9.81 N × 0.5 m.
  const double after = crowd.islands.state().q[crowd.model.bodies[idx(crowd.body("arm"))].q];
  EXPECT_SMALL(after - before - 0.3, 9.81 * 0.5 / 500.0);
}

}  // namespace
}  // namespace softgauss::test
