// SPDX-License-Identifier: Apache-2.0

/// Who sleeps is part of the state: saved, restored, or left as it was.

#include "softgauss/engine/model/saved_state.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

// The state says all: saved on the way, while some sleep and some come to rest, it goes on to the
// same bits, in Data that have been elsewhere.
TEST(Sleep, GoesOnFromASavedState) {
  ModelBuilder builder = heap(12, 5);
  addCube(builder, "lower", Vector3(5.0, 0.0, 0.1));
  addCube(builder, "late", Vector3(5.05, 0.0, 12.0));
  Crowd unbroken(builder, kSleep);
  int slept = 0, woken = 0;
  for (int part = 0; part < 12; ++part) {
    Crowd resumed(builder, kSleep);
    ASSERT_TRUE(resumed.steps(part));
    resumed.state = restore(resumed.model, save(unbroken.model, unbroken.state));
    for (int i = 0; i < 97; ++i) {
      ASSERT_TRUE(unbroken.steps(1) && resumed.steps(1));
      ASSERT_EQ(hash(unbroken.state), hash(resumed.state)) << part << " " << i;
      ASSERT_EQ(unbroken.data.stats.asleepTrees, resumed.data.stats.asleepTrees);
      slept += unbroken.data.stats.asleepTrees, woken += unbroken.data.stats.wokenTrees;
    }
  }
  EXPECT_GT(slept, 100);
  EXPECT_GT(woken, 0);
}

TEST(Sleep, OfAnotherRunIsRefused) {
  Crowd crowd(stacks(), kSleep);
  ASSERT_TRUE(crowd.steps(1000));
  const auto refused = [&](auto&& change) {
    State state = crowd.state;
    change(state.sleep);
    EXPECT_THROW(restore(crowd.model, save(crowd.model, state)), ModelError);
  };
  refused([](SleepState& sleep) { sleep.island[3] = 7; });
  refused([](SleepState& sleep) { sleep.island[0] = -2; });
  refused([](SleepState& sleep) { sleep.island.pop_back(); });
  refused([](SleepState& sleep) { sleep.restTime[1] = -1.0; });
  refused([](SleepState& sleep) { sleep.restVelocity.resize(3); });
}

// A rope that sleeps keeps the forces of its ties, by which (6.8) holds it when it wakes.
TEST(Sleep, KeepsForcesOfConnections) {
  ModelBuilder builder = ground();
  addCube(builder, "hanging", Vector3(0.0, 0.0, 1.0));
  addCube(builder, "beside", Vector3(1.0, 0.0, 0.1));
  addCube(builder, "late", Vector3(2.0, 0.0, 9.0));
  ConnectSpec tie;
  tie.linkA = "hanging", tie.p_LAP = Vector3(0.0, 0.0, 0.1);
  tie.linkB = "world", tie.p_LBP = Vector3(0.0, 0.0, 1.1);
  builder.connect(tie);
  Crowd crowd(builder, kSleep);
  ASSERT_TRUE(crowd.steps(600));
  ASSERT_TRUE(crowd.asleep("hanging"));
  ASSERT_FALSE(crowd.asleep("late"));
  EXPECT_NEAR(crowd.state.connectionForces[2], 9.81, 1e-3);
}

TEST(Sleep, IsAsItWasWhereAStepIsRefused) {
  Crowd crowd(stacks(), kSleep), same(stacks(), kSleep);
  ASSERT_TRUE(crowd.steps(1000) && same.steps(1000));
  const std::uint64_t before = hash(crowd.state);
  Input bad;
  bad.tau = VectorX::Zero(crowd.model.nv);
  bad.tau[8] = kNaN;  // of the second cube, which it wakes
  EXPECT_EQ(crowd.step(bad), SolveStatus::notFinite);
  EXPECT_EQ(crowd.data.stats.badDof, 6);
  EXPECT_EQ(hash(crowd.state), before);
  bad.tau.resize(3);
  EXPECT_EQ(crowd.step(bad), SolveStatus::badInput);
  EXPECT_EQ(hash(crowd.state), before);
  const int w = crowd.body("cube20").q + 3;
  const VectorX q = crowd.state.q;
  crowd.state.q.segment<4>(w).setZero();
  EXPECT_EQ(crowd.step(), SolveStatus::badInput);
  EXPECT_EQ(crowd.data.stats.badInput.kind, BadInputKind::quaternion);
  crowd.state.q[w] = kNaN;
  EXPECT_EQ(crowd.step(), SolveStatus::notFinite);
  crowd.state.q = q;
  EXPECT_EQ(hash(crowd.state), before);
  ASSERT_TRUE(crowd.steps(10) && same.steps(10));
  EXPECT_EQ(hash(crowd.state), hash(same.state));
}

}  // namespace
}  // namespace softgauss::test
