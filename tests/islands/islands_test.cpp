// SPDX-License-Identifier: Apache-2.0

/// Islands are solved apart, and nobody can tell.

#include "softgauss/engine/islands/islands.hpp"

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// q, v of a body's tree.
std::pair<VectorX, VectorX> stateOf(const Crowd& crowd, const std::string& name) {
  const Body& body = crowd.model.bodies[static_cast<std::size_t>(crowd.body(name))];
  const State& state = crowd.islands.state();
  return {state.q.segment(body.q, 7), state.v.segment(body.v, 6)};
}

TEST(Islands, AgreeWithTheJointSolve) {
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
    ModelBuilder builder = heap(24, 1);
    builder.options.cone = cone;
    builder.options.substepAngle = kInfinity;  // else each island goes in parts of its own
    Crowd crowd(builder.build());
    collision::SceneContacts jointContacts(crowd.model);
    Data data(crowd.model);
    double worst = 0.0;
    int most = 0, fewest = 1000;
    for (int i = 0; i < 600; ++i) {
      State joint = crowd.islands.state();
      ASSERT_EQ(step(crowd.model, {}, joint, data, &jointContacts), SolveStatus::converged);
      ASSERT_EQ(crowd.islands.step({}), SolveStatus::converged);
      ASSERT_EQ(crowd.islands.stats().contacts, data.stats.contacts) << "step " << i;
      ASSERT_EQ(crowd.islands.stats().rows, data.stats.rows);
      const VectorX& a = data.forward.a;
      worst = std::max(worst, (crowd.islands.acceleration() - a).cwiseAbs().maxCoeff() /
                                  std::max(1.0, a.cwiseAbs().maxCoeff()));
      most = std::max(most, crowd.islands.islandStats().islands);
      fewest = std::min(fewest, crowd.islands.islandStats().islands);
    }
    EXPECT_SMALL(worst, 1e-12);  // the joint solve goes by island too
    EXPECT_GT(most, 20);         // nearly all alone at the start
    EXPECT_LT(fewest, 16);       // and then in heaps
  }
}

// What is done in place of what was asked is counted in each, and summed.
TEST(Islands, SumTheirFallbacks) {
  ModelBuilder builder = heap(12, 1);
  builder.options.tolerance = 1e-17;  // below rounding
  builder.options.maxIterations = 2;
  Crowd crowd(builder.build());
  int rounded = 0, ended = 0;
  for (int i = 0; i < 400; ++i) {
    ASSERT_NE(crowd.islands.step({}), SolveStatus::notFinite);
    rounded = std::max(rounded, crowd.islands.stats().roundingLimitedSolves);
    ended = std::max(ended, crowd.islands.stats().unconvergedSolves);
  }
  EXPECT_GT(rounded, 1);  // of several islands in one step
  EXPECT_GT(ended, 0);
}

TEST(Islands, DoNotFeelWhoElseIsThere) {
  ModelBuilder few = ground(), many = ground();
  for (ModelBuilder* builder : {&few, &many}) {
    if (builder == &many)
      for (int i = 0; i < 5; ++i)
        addCube(*builder, "crowd" + std::to_string(i), Vector3(3.0 + 0.1 * i, 0.0, 0.2 + 0.3 * i));
    addCube(*builder, "lower", Vector3(0.0, 0.0, 0.15));
    addCube(*builder, "upper", Vector3(0.05, 0.0, 0.45));
    if (builder == &many) addCreature(*builder, "other", Vector3(-2.0, 0.0, 1.0));
  }
  Crowd alone(few.build()), together(many.build());
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(alone.steps(1) && together.steps(1));
    for (const char* name : {"lower", "upper"})
      ASSERT_EQ(stateOf(alone, name), stateOf(together, name));
  }
  EXPECT_EQ(alone.islands.islandStats().islands, 1);
}

TEST(Islands, AreFoundFromWhoTouches) {
  ModelBuilder builder = ground();
  addCube(builder, "a", Vector3(0.0, 0.0, 0.1));
  addCube(builder, "b", Vector3(0.0, 0.0, 0.29999));  // on a
  addCube(builder, "c", Vector3(0.3, 0.0, 0.1));      // beside them
  builder.options.gravity.setZero();
  Crowd crowd(builder.build());
  ASSERT_TRUE(crowd.steps(1));
  EXPECT_EQ(crowd.islands.islandStats().islands, 2);
  EXPECT_EQ(crowd.islands.islandStats().regroups, 1);

  // b flies off, c meets a.
  State state = crowd.islands.state();
  const auto velocity = [&](const char* name) {
    return state.v.segment<3>(crowd.model.bodies[static_cast<std::size_t>(crowd.body(name))].v);
  };
  velocity("b") = Vector3(0.0, 0.0, 1.0);
  velocity("c") = Vector3(-1.0, 0.0, 0.0);
  crowd.islands.setState(state);
  ASSERT_TRUE(crowd.steps(40));
  EXPECT_EQ(crowd.islands.islandStats().islands, 3);  // looked at after 32 steps
  ASSERT_TRUE(crowd.steps(20));
  const Units& units = crowd.islands.units();
  const auto island = [&](const char* name) {
    return &crowd.islands.islandOf(units.ofBody(crowd.model, crowd.body(name)));
  };
  EXPECT_EQ(island("a"), island("c"));
  EXPECT_NE(island("a"), island("b"));
}

TEST(Islands, OfTiedUnitsAreOne) {
  ModelBuilder builder = ground();
  for (int i = 0; i < 3; ++i)
    addCube(builder, "cube" + std::to_string(i), Vector3(0.5 * i, 0.0, 1.0));
  ConnectSpec tie;
  tie.linkA = "cube0";
  tie.linkB = "cube2";
  builder.connect(tie);
  const Units units(builder.build());
  ASSERT_EQ(units.size(), 2);
  EXPECT_EQ(units.trees[0], (std::vector<int>{0, 2}));
}

TEST(Islands, LeaveTheStateWhereTheInputIsNotFinite) {
  ModelBuilder builder = ground();
  addCube(builder, "a", Vector3(0.0, 0.0, 0.5));
  addCube(builder, "b", Vector3(1.0, 0.0, 0.5));
  Crowd crowd(builder.build());
  ASSERT_TRUE(crowd.steps(10));
  const std::uint64_t before = hash(crowd.islands.state());
  Input bad;
  bad.tau = VectorX::Zero(crowd.model.nv);
  bad.tau[8] = kNaN;
  EXPECT_EQ(crowd.islands.step(bad), SolveStatus::notFinite);
  EXPECT_EQ(crowd.islands.stats().badDof, 6);  // the first of the second cube
  EXPECT_EQ(hash(crowd.islands.state()), before);
  bad.tau.resize(3);
  EXPECT_EQ(crowd.islands.step(bad), SolveStatus::badInput);
  EXPECT_EQ(crowd.islands.stats().badInput.kind, BadInputKind::tau);
  bad.tau.resize(0);
  bad.wrenches = {{crowd.model.bodyCount(), {Vector3::Zero(), Vector3::Zero()}}};
  EXPECT_EQ(crowd.islands.step(bad), SolveStatus::badInput);
  EXPECT_EQ(crowd.islands.stats().badInput.kind, BadInputKind::wrench);
  EXPECT_EQ(hash(crowd.islands.state()), before);

  Crowd same(builder.build());
  ASSERT_TRUE(same.steps(20) && crowd.steps(10));
  EXPECT_EQ(hash(crowd.islands.state()), hash(same.islands.state()));
}

TEST(Islands, FeelForcesAndWrenches) {
  ModelBuilder builder = ground();
  builder.options.gravity.setZero();
  addCube(builder, "a", Vector3(0.0, 0.0, 1.0));
  addCube(builder, "b", Vector3(1.0, 0.0, 1.0));
  Crowd crowd(builder.build());
  Input input;
  input.tau = VectorX::Zero(12);
  input.tau[1] = 2.0;
  input.wrenches.push_back({crowd.body("b"), {Vector3::Zero(), Vector3(3.0, 0.0, 0.0)}});
  ASSERT_EQ(crowd.islands.step(input), SolveStatus::converged);
  VectorX expected = VectorX::Zero(12);
  expected[1] = 2.0;
  expected[6] = 3.0;
  EXPECT_APPROX(crowd.islands.acceleration(), expected, 1e-14);
}

TEST(Islands, AllocateOnlyWhereTheyRegroupOrLook) {
  if (!kAllocationHook) GTEST_SKIP() << "the sanitizer has its own allocator";
  Crowd crowd(heap(16, 2).build());
  int regrouped = 0, quiet = 0, allocating = 0;
  for (int i = 0; i < 4000; ++i) {
    const AllocationGuard guard;
    ASSERT_TRUE(crowd.steps(1));
    const std::int64_t count = guard.count();
    regrouped += crowd.islands.islandStats().regroups;
    // The lists of an island grow in its first steps, with its contacts; and now and then it is
    // looked at whether it has come apart.
    bool calm = crowd.islands.islandStats().regroups == 0;
    for (const Islands::Island* island : crowd.islands.awake()) {
      const bool looked = island->units.size() > 1 && island->age % Islands::kSplitAge == 1;
      calm = calm && island->age > 250 && !looked;
    }
    if (!calm) continue;
    ++quiet;
    allocating += count > 0;
  }
  EXPECT_GT(regrouped, 10);
  EXPECT_GT(quiet, 500);
  EXPECT_LE(allocating, quiet / 200);  // a list that is longer than it ever was; seen: 3
}

TEST(Islands, RefuseIntegratorsThatLookWithinTheStep) {
  ModelBuilder builder = ground();
  addCube(builder, "a", Vector3(0.0, 0.0, 1.0));
  builder.options.integrator = Integrator::rungeKutta4;
  const Model model = builder.build();
  EXPECT_THROW(Islands(model, nullptr), ModelError);
}

}  // namespace
}  // namespace softgauss::test
