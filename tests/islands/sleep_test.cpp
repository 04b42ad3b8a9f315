// SPDX-License-Identifier: Apache-2.0

/// What is at rest sleeps, and wakes when it is touched.

#include "softgauss/engine/step/sleep.hpp"

#include "tests/islands/crowd.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

TEST(Sleep, ComesToWhatRests) {
  for (const double speed : {1e-6, 1e-4, kSleep.speed}) {
    Sleep sleep = kSleep;
    sleep.speed = speed;
    Crowd crowd(stacks(), sleep), awake(stacks());
    ASSERT_TRUE(crowd.steps(1000) && awake.steps(1000));
    EXPECT_EQ(crowd.awake(), 0);
    EXPECT_EQ(crowd.state.v, VectorX::Zero(crowd.model.nv));
    EXPECT_DOUBLE_EQ(crowd.state.time, awake.state.time);
    // What is left out is slower than that; here it is a decay, with 20 ms to go.
    EXPECT_SMALL((crowd.state.q - awake.state.q).cwiseAbs().maxCoeff(), 0.02 * speed);
  }
}

TEST(Sleep, EndsForWhatIsTouchedAlone) {
  ModelBuilder builder = stacks();
  addCube(builder, "falling", Vector3(1.02, 0.0, 5.0));
  Crowd crowd(builder, kSleep);
  int woken = 0;
  bool slept = false;
  for (int i = 0; i < 600 && woken == 0; ++i) {
    ASSERT_TRUE(crowd.steps(1));
    woken = crowd.data.stats.wokenTrees;
    slept = slept || crowd.awake() == 1;
  }
  EXPECT_TRUE(slept);
  EXPECT_EQ(woken, 2);  // both of its stack, at once
  EXPECT_FALSE(crowd.asleep("cube10"));
  EXPECT_FALSE(crowd.asleep("cube11"));
  for (const char* name : {"cube00", "cube01", "cube20", "cube21", "cube30", "cube31"})
    EXPECT_TRUE(crowd.asleep(name)) << name;
  // It carries what fell on it, and all sleep again.
  ASSERT_TRUE(crowd.steps(5000));
  EXPECT_EQ(crowd.awake(), 0);
}

// Who never touches a sleeper does not feel, to the bit, that it is there.
TEST(Sleep, DoesNotChangeWhoWasNeverNearIt) {
  ModelBuilder sleepers = stacks(), alone = ground();
  addCreature(sleepers, "creature", Vector3(0.0, 3.0, 1.0));
  addCreature(alone, "creature", Vector3(0.0, 3.0, 1.0));
  Crowd crowd(sleepers, kSleep), one(alone, kSleep);
  bool sleptAlone = false;
  for (int i = 0; i < 1500; ++i) {
    ASSERT_TRUE(crowd.steps(1) && one.steps(1));
    sleptAlone = sleptAlone || (crowd.awake() == 1 && one.awake() == 1);
    ASSERT_EQ(crowd.state.q.tail(one.model.nq), one.state.q) << i;
    ASSERT_EQ(crowd.state.v.tail(one.model.nv), one.state.v);
  }
  EXPECT_TRUE(sleptAlone);
}

TEST(Sleep, EndsByForceWrenchVelocityAndCall) {
  Crowd crowd(stacks(), kSleep);
  const auto sleepers = [&] {
    int count = 0;
    for (int i = 0; i < 4; ++i) count += crowd.asleep("cube" + std::to_string(i) + "0");
    return count;
  };
  ASSERT_TRUE(crowd.steps(1000));
  ASSERT_EQ(sleepers(), 4);

  Input input;
  input.tau = VectorX::Zero(crowd.model.nv);
  ASSERT_EQ(crowd.step(input), SolveStatus::converged);
  EXPECT_EQ(sleepers(), 4);  // no force is no reason
  input.tau[crowd.body("cube01").v] = 1e-3;
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(crowd.step(input), SolveStatus::converged);
  EXPECT_EQ(sleepers(), 3);  // and it stays awake as long as it is pushed
  EXPECT_FALSE(crowd.asleep("cube00"));

  ASSERT_TRUE(crowd.steps(1000));
  ASSERT_EQ(sleepers(), 4);
  input.tau.resize(0);
  input.wrenches.push_back(
      {crowd.body("cube10").subtreeEnd - 1, {Vector3::Zero(), Vector3(1e-3, 0.0, 0.0)}});
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(crowd.step(input), SolveStatus::converged);
  EXPECT_EQ(sleepers(), 3);

  crowd.state.v[crowd.body("cube20").v + 2] = 0.01;
  ASSERT_TRUE(crowd.steps(1));
  EXPECT_FALSE(crowd.asleep("cube20"));
  wake(crowd.state.sleep, crowd.body("cube31").tree);
  EXPECT_FALSE(crowd.asleep("cube30"));
  ASSERT_TRUE(crowd.steps(1));
  wakeAll(crowd.state.sleep);
  EXPECT_EQ(sleepers(), 0);
}

TEST(Sleep, IsNotForWhatMovesSlowlyAndSteadily) {
  // Twice the speed of sleep, without gravity: it goes on for ever.
  ModelBuilder builder = ground();
  builder.options.gravity.setZero();
  addCube(builder, "drifting", Vector3(0.0, 0.0, 1.0));
  addCube(builder, "turning", Vector3(1.0, 0.0, 1.0));
  addCube(builder, "resting", Vector3(2.0, 0.0, 1.0));
  Crowd crowd(builder, kSleep);
  crowd.state.v[0] = 2.0 * kSleep.speed;
  crowd.state.v[6 + 5] =
      2.0 * kSleep.speed / (0.1 * std::sqrt(2.0 / 3.0));  // at its radius of gyration
  ASSERT_TRUE(crowd.steps(1000));
  EXPECT_FALSE(crowd.asleep("drifting"));
  EXPECT_FALSE(crowd.asleep("turning"));
  EXPECT_TRUE(crowd.asleep("resting"));
}

/// A link of 1 kg on one joint, without contacts: by how much its place after so long differs with
/// sleep from that without.
double gapOf(const ModelBuilder& builder, double q, double v, double seconds) {
  VectorX ends[2];
  for (const bool sleeps : {false, true}) {
    Crowd crowd(builder, Sleep{.enabled = sleeps});
    crowd.state.q[0] = q, crowd.state.v[0] = v;
    EXPECT_TRUE(crowd.steps(static_cast<int>(seconds / 0.002)));
    ends[sleeps] = crowd.state.q;
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
  Crowd crowd(stacks());
  ASSERT_TRUE(crowd.steps(1000));
  EXPECT_EQ(crowd.awake(), 8);
  EXPECT_EQ(crowd.data.sleepers, nullptr);
  EXPECT_TRUE(crowd.state.sleep.island.empty());
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
  Crowd crowd(builder, kSleep);
  const Body& arm = crowd.body("arm");
  ASSERT_TRUE(crowd.steps(3000));
  EXPECT_EQ(crowd.awake(), 0);
  // What holds it is told still: the weight of 1 kg at 0.5 m.
  VectorX tau;
  appliedForces(crowd.data, tau);
  EXPECT_NEAR(tau[arm.v], -9.81 * 0.5, 1e-2);
  const double before = crowd.state.q[arm.q];
  Input input;
  input.setPoint = VectorX::Zero(crowd.model.nv);
  ASSERT_EQ(crowd.step(input), SolveStatus::converged);
  EXPECT_TRUE(crowd.asleep("arm"));
  input.setPoint[arm.v] = 0.3;
  ASSERT_EQ(crowd.step(input), SolveStatus::converged);
  EXPECT_TRUE(crowd.asleep("cube"));
  EXPECT_FALSE(crowd.asleep("arm"));
  for (int i = 0; i < 3000; ++i) crowd.step(input);
  EXPECT_EQ(crowd.awake(), 0);
  // It turns by 0.3, but for what the lever of its weight changes by its spring: 9.81 N × 0.5 m.
  EXPECT_SMALL(crowd.state.q[arm.q] - before - 0.3, 9.81 * 0.5 / 500.0);
}

// A servo that is told to turn, however slowly, does.
TEST(Sleep, IsNotForServosThatAreToldToMove) {
  ModelBuilder builder = oneJoint(JointType::revolute, 0.0, 0.0, 0.0);
  builder.options.sleep = kSleep;
  Model model = builder.build();
  model.dofs[0].servo = {.kp = 0.0, .kd = 1.0, .setPointRate = 1e-3};
  State state(model);
  Data data(model);
  for (int i = 0; i < 1000; ++i)
    ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
  EXPECT_EQ(data.stats.asleepTrees, 0);
  EXPECT_NEAR(state.q[0], 2e-3, 1e-4);
}

// Contacts of who sleeps are told with the forces of their last solve: together the weight.
TEST(Sleep, KeepsContactsAndTheirForces) {
  Crowd crowd(stacks(), kSleep);
  ASSERT_TRUE(crowd.steps(1000));
  std::vector<Snapshot::ContactForce> contacts;
  contactForces(crowd.data, contacts);
  double load = 0.0;
  int onGround = 0;
  for (const Snapshot::ContactForce& c : contacts)
    if (crowd.model.geometries[idx(c.geometryA)].body == 0) load += c.force.z(), ++onGround;
  EXPECT_EQ(onGround, 16);
  EXPECT_EQ(contacts.size(), 32u);
  EXPECT_NEAR(load, 8 * 9.81, 1e-3);
  wake(crowd.state.sleep, crowd.body("cube00").tree);
  ASSERT_TRUE(crowd.steps(1));
  contactForces(crowd.data, contacts);
  EXPECT_EQ(contacts.size(), 32u);  // none twice, none lost
}

// Stages of all trees, or contacts elsewhere, may be asked for between two steps.
TEST(Sleep, DoesNotMindWhoLooksBetweenSteps) {
  ModelBuilder builder = stacks();
  addCube(builder, "falling", Vector3(1.02, 0.0, 5.0));
  Crowd undisturbed(builder, kSleep), crowd(builder, kSleep);
  Kinematics elsewhere(crowd.model);
  ContactSet found;
  int slept = 0, woken = 0;
  for (int i = 0; i < 700; ++i) {
    ASSERT_TRUE(undisturbed.steps(1) && crowd.steps(1));
    ASSERT_EQ(hash(crowd.state), hash(undisturbed.state)) << i;
    slept += crowd.data.stats.asleepTrees > 0, woken += crowd.data.stats.wokenTrees;
    if (i % 3 == 0) computeStages(crowd.model, {}, crowd.state, crowd.data, &crowd.contacts);
    if (i % 5 != 0) continue;
    State other = crowd.state;
    for (const Tree& tree : crowd.model.trees)
      other.q[crowd.model.bodies[idx(tree.rootBody)].q] += 0.3;
    computeKinematics(crowd.model, other, elsewhere);
    crowd.contacts.detect(crowd.model, elsewhere, found);
  }
  EXPECT_GT(slept, 100);
  EXPECT_EQ(woken, 2);
}

// Who puts a sleeper elsewhere without waking it has it sleep there, where others meet it.
TEST(Sleep, IsWhereTheStateSays) {
  ModelBuilder builder = stacks();
  addCube(builder, "falling", Vector3(0.0, 2.0, 5.0));
  Crowd crowd(builder, kSleep);
  ASSERT_TRUE(crowd.steps(400));
  ASSERT_TRUE(crowd.asleep("cube00"));
  for (const char* name : {"cube00", "cube01"}) crowd.state.q[crowd.body(name).q + 1] = 2.0;
  int woken = 0;
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(crowd.steps(1));
    woken += crowd.data.stats.wokenTrees;
  }
  EXPECT_EQ(woken, 2);
  EXPECT_GT(crowd.state.q[crowd.body("falling").q + 2], 0.45);  // on the stack
}

// A cube that turns so fast that its steps go in parts is met by sleepers as by who is awake.
TEST(Sleep, EndsWithinAStepInParts) {
  ModelBuilder builder = stacks();
  addCube(builder, "turning", Vector3(1.0, 0.5, 0.9));
  int metAt[2] = {-1, -1};
  double height[2] = {};
  for (const bool sleeps : {false, true}) {
    Crowd crowd(builder, Sleep{.enabled = sleeps, .speed = 1e-6});
    // The stacks come to rest while it waits above them.
    const Body& turning = crowd.body("turning");
    const VectorX pose = crowd.state.q.segment<7>(turning.q);
    for (int i = 0; i < 900; ++i) {
      crowd.state.q.segment<7>(turning.q) = pose;
      crowd.state.v.segment<6>(turning.v).setZero();
      ASSERT_TRUE(crowd.steps(1));
    }
    EXPECT_EQ(crowd.awake(), sleeps ? 1 : 9);
    crowd.state.v.segment<6>(turning.v) << 0.0, -1.0, 0.0, 150.0, 90.0, 30.0;
    int divided = 0;
    for (int i = 0; i < 250; ++i) {
      ASSERT_TRUE(crowd.steps(1));
      const bool moves = crowd.state.v.segment<6>(crowd.body("cube11").v).norm() > 0.01;
      if (moves && metAt[sleeps] < 0) metAt[sleeps] = i;
      divided += crowd.data.stats.parts > 1;
    }
    height[sleeps] = crowd.state.q[turning.q + 2];
    EXPECT_GT(divided, 0);
  }
  EXPECT_GT(metAt[0], 0);
  EXPECT_EQ(metAt[1], metAt[0]);
  EXPECT_SMALL(height[1] - height[0], 1e-6);
}

TEST(Sleep, AllocatesNothingWhereNobodyWakesOrFallsAsleep) {
  if (!kAllocationHook) GTEST_SKIP() << "the sanitizer has its own allocator";
  ModelBuilder builder = stacks();
  addCube(builder, "hopping", Vector3(0.0, 3.0, 2.0));
  Crowd crowd(builder, kSleep);
  int quiet = 0, asleepBefore = 0;
  for (int i = 0; i < 900; ++i) {
    crowd.state.v[crowd.body("hopping").v] += i % 50 == 0 ? 0.3 : 0.0;
    const AllocationGuard guard;
    ASSERT_TRUE(crowd.steps(1));
    const auto count = guard.count();
    const int asleep = crowd.data.stats.asleepTrees;
    const bool calm = i > 500 && asleep == 8 && asleepBefore == asleep;
    asleepBefore = asleep;
    if (!calm) continue;
    ++quiet;
    EXPECT_EQ(count, 0) << i;
  }
  EXPECT_GT(quiet, 200);
}

TEST(Sleep, IsRefusedForIntegratorsThatLookWithinTheStep) {
  for (const Integrator integrator :
       {Integrator::implicit, Integrator::rungeKutta4, Integrator::dormandPrince}) {
    ModelBuilder builder = stacks();
    builder.options.integrator = integrator;
    EXPECT_THROW(Crowd(builder, kSleep), ModelError);
  }
  ModelBuilder builder = stacks();
  builder.options.stepDoubling = true;
  EXPECT_THROW(Crowd(builder, kSleep), ModelError);
}

}  // namespace
}  // namespace softgauss::test
