// SPDX-License-Identifier: Apache-2.0
/// What a step may depend on: its state and its input, to the last bit.

#include <cstring>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

bool sameBits(const VectorX& a, const VectorX& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

bool sameBits(const State& a, const State& b) {
  return sameBits(a.q, b.q) && sameBits(a.v, b.v) && sameBits(a.a, b.a) && a.time == b.time &&
         sameBits(a.warmstart.a, b.warmstart.a) && a.warmstart.valid == b.warmstart.valid;
}

Scene fallingHumanoid() {
  Scene s(humanoid().build(), std::make_shared<SampleContacts>());
  s.state.v = Random(1).vector(s.model.nv, 0.5);
  return s;
}

// ---- Determinism
// ---------------------------------------------------------------------------------

TEST(Step, SameInputSameBits) {
  Scene a = fallingHumanoid(), b = fallingHumanoid();
  for (int i = 0; i < 300; ++i) {
    a.step();
    b.step();
    ASSERT_TRUE(sameBits(a.state, b.state)) << "step " << i;
    ASSERT_EQ(hash(a.state), hash(b.state));
  }
  EXPECT_GT(a.data->stats.contacts, 0);
}

TEST(Step, SaveRestoreMidRunGivesSameBits) {
  Scene s = fallingHumanoid();
  s.steps(200);
  const State saved = s.state;
  s.steps(100);
  const State end = s.state;
  const std::uint64_t endHash = hash(end);

  // In the Data that has gone on meanwhile, and in a fresh one.
  s.state = saved;
  s.steps(100);
  EXPECT_TRUE(sameBits(s.state, end));
  EXPECT_EQ(hash(s.state), endHash);
  s.data = std::make_unique<Data>(s.model);
  s.state = saved;
  s.steps(100);
  EXPECT_TRUE(sameBits(s.state, end));
}

TEST(State, HashSeesEveryMember) {
  Scene s = fallingHumanoid();
  s.step();
  const std::uint64_t before = hash(s.state);
  const auto changed = [&](auto&& change) {
    State copy = s.state;
    change(copy);
    return hash(copy) != before;
  };
  EXPECT_FALSE(changed([](State&) {}));
  EXPECT_TRUE(changed([](State& x) { x.q[3] = std::nextafter(x.q[3], 2.0); }));
  EXPECT_TRUE(changed([](State& x) { x.v[9] = std::nextafter(x.v[9], 2.0); }));
  EXPECT_TRUE(changed([](State& x) { x.time += 1e-9; }));
  EXPECT_TRUE(changed([](State& x) { x.a[2] = std::nextafter(x.a[2], kInfinity); }));
  EXPECT_TRUE(changed([](State& x) { x.hasAcceleration = !x.hasAcceleration; }));
  EXPECT_TRUE(changed([](State& x) { x.connectionForces = VectorX::Ones(9); }));
  EXPECT_TRUE(changed([](State& x) { x.warmstart.a[0] += 1.0; }));
  EXPECT_TRUE(changed([](State& x) { x.warmstart.valid = !x.warmstart.valid; }));
  EXPECT_TRUE(changed([](State& x) { x.warmstart.gddA[0] += 1.0; }));
  EXPECT_TRUE(changed([](State& x) { x.warmstart.multipliers[0] += 1.0; }));
  EXPECT_TRUE(changed([](State& x) { x.warmstart.gddValid = !x.warmstart.gddValid; }));
}

// The warm start changes how long the solver takes, not what it finds.
TEST(Step, WarmStartChangesTheResultWithinTolerance) {
  Scene warm = fallingHumanoid(), cold = fallingHumanoid();
  for (int i = 0; i < 300; ++i) {
    cold.state = warm.state;
    cold.state.warmstart.valid = false;
    warm.step();
    cold.step();
    // The solver's 1e-12 over the smallest eigenvalue of the scaled mass matrix.
    ASSERT_SMALL((warm.state.v - cold.state.v).cwiseAbs().maxCoeff(), 1e-9) << "step " << i;
  }
}

// Nothing follows the solve: what it has found is what moves, and where the next one starts.
TEST(Step, MovesByTheSolversAcceleration) {
  Scene s = fallingHumanoid();
  const VectorX before = s.state.v;
  s.step();
  EXPECT_TRUE(s.state.warmstart.valid);
  EXPECT_EQ(s.state.warmstart.a, s.data->forward.a);
  EXPECT_EQ(s.data->acceleration, s.data->forward.a);
  EXPECT_EQ(s.state.a, s.data->forward.a);
  EXPECT_APPROX((s.state.v - before) / s.model.options.timestep, s.data->forward.a, 1e-9);
}

// ---- Effects
// -------------------------------------------------------------------------------------

TEST(EmptyEffect, ChangesNothing) {
  RandomTreeOptions options;
  options.damping = options.armature = options.ranges = false;
  for (int seed = 0; seed < 10; ++seed) {
    ModelBuilder all = randomForest(seed, options), few = all;
    for (const Effect e : {Effect::damping, Effect::armature, Effect::jointLimit,
                           Effect::selfCollision, Effect::groundContact, Effect::objectContact})
      few.options.effects.remove(e);
    Scene a(all.build(), std::make_shared<FixedContacts>()), b(few.build(), nullptr);
    Random random(seed);
    a.state = b.state = randomState(a.model, random);
    for (int i = 0; i < 20; ++i) {
      a.step();
      b.step();
      ASSERT_TRUE(sameBits(a.state, b.state)) << "seed " << seed << ", step " << i;
    }
  }
}

// Removing an effect equals a model without what it needs.
TEST(Effect, SwitchedOffIsAsIfAbsent) {
  RandomTreeOptions with;
  for (const Effect effect :
       {Effect::damping, Effect::armature, Effect::jointLimit, Effect::gravity}) {
    ModelBuilder off = randomForest(11, with);
    off.options.effects.remove(effect);
    Model absent = randomForest(11, with).build();
    for (Dof& dof : absent.dofs) {
      if (effect == Effect::damping) dof.damping = 0.0;
      if (effect == Effect::armature) dof.armature = 0.0;
    }
    if (effect == Effect::jointLimit) absent.ranges.clear();
    if (effect == Effect::gravity) absent.options.gravity.setZero();
    Scene a(off.build()), b(std::move(absent)), c(randomForest(11, with).build());
    Random random(1);
    a.state = randomState(c.model, random);
    for (const JointRange& range : c.model.ranges)
      a.state.q[c.model.bodies[range.body].q] = range.lower - 0.005;
    b.state = c.state = a.state;
    a.steps(5);
    b.steps(5);
    c.steps(5);
    EXPECT_TRUE(sameBits(a.state.q, b.state.q) && sameBits(a.state.v, b.state.v))
        << effectName(effect);
    EXPECT_FALSE(sameBits(a.state.v, c.state.v)) << effectName(effect) << " does nothing";
  }
}

TEST(Effect, WithoutCoriolisTheBiasIsThatAtRest) {
  ModelBuilder builder = randomForest(12);
  builder.options.effects.remove(Effect::coriolis);
  Scene moving(builder.build()), resting(builder.build());
  Random random(1);
  moving.state = resting.state = randomState(moving.model, random);
  resting.state.v.setZero();
  moving.stages();
  resting.stages();
  EXPECT_APPROX(moving.data->forces.bias, resting.data->forces.bias, 1e-13);
}

// ---- What is not finite
// --------------------------------------------------------------------------

void expectRefused(Scene& s, const char* what) {
  const State before = s.state;
  EXPECT_EQ(s.step(), SolveStatus::notFinite) << what;
  EXPECT_EQ(s.data->stats.status, SolveStatus::notFinite) << what;
  // NaN equals no number, so compare bits.
  EXPECT_TRUE(sameBits(s.state, before)) << what;
}

TEST(Step, NotFiniteInputLeavesStateIntact) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    Scene s = fallingHumanoid();
    s.steps(250);
    ASSERT_GT(s.data->stats.contacts, 0);
    const State good = s.state;
    for (const int i : {0, 4, 12}) {
      s.state = good;
      s.state.q[i] = bad;
      expectRefused(s, "q");
      s.state = good;
      s.state.v[i] = bad;
      expectRefused(s, "v");
      s.state = good;
      s.input.tau[i] = bad;
      expectRefused(s, "tau");
      s.input.tau[i] = 0.0;
    }
    s.input.wrenches = {{3, {Vector3(0, bad, 0), Vector3::Zero()}}};
    expectRefused(s, "moment");
    s.input.wrenches = {{3, {Vector3::Zero(), Vector3(0, 0, bad)}}};
    expectRefused(s, "force");
    s.input.wrenches.clear();

    // And the step recovers as soon as its input does.
    EXPECT_EQ(s.step(), SolveStatus::converged);
    Scene untouched = fallingHumanoid();
    untouched.state = good;
    untouched.step();
    EXPECT_TRUE(sameBits(s.state, untouched.state));
  }
}

TEST(Step, OverflowLeavesStateIntact) {
  Scene s = fallingHumanoid();
  s.state.v.setConstant(1e200);  // finite, its square is not
  expectRefused(s, "velocity of 1e200");
  EXPECT_GE(s.data->stats.badDof, 0);
}

/// A slider along x without any effect but its range.
Scene slider() {
  ModelBuilder builder("slider");
  builder.link(emptyLink("world")).link(boxLink("body", 1.0, {0.1, 0.1, 0.1}));
  JointSpec rail = jointSpec("rail", JointType::prismatic, "world", "body");
  rail.lower = 0.0;
  rail.upper = 1.0;
  builder.joint(rail);
  builder.options.effects = EffectSet::none();
  builder.options.effects.insert(Effect::jointLimit);
  return Scene(builder.build());
}

// The cost of the start is infinite and there is no warm start to prefer to it.
TEST(Step, InfiniteCostWithoutAWarmStartIsSolved) {
  Scene s = slider();
  s.model.options.integrator = Integrator::semiImplicitEuler;  // does not drift before the solve
  s.state.q[0] = -0.001;
  s.state.v[0] = -1e160;
  EXPECT_EQ(s.step(), SolveStatus::converged);
  EXPECT_TRUE(s.state.v.allFinite());
}

// Nothing that the solve computes depends on where a slider is.
TEST(Step, NotFinitePositionIsSeenEvenWhereForcesDoNotDependOnIt) {
  Scene s = slider();
  s.state.q[0] = kNaN;
  expectRefused(s, "q");
}

// v and a are finite, v + h a is not.
TEST(Step, OverflowOfTheResultLeavesStateIntact) {
  Scene s = slider();
  s.state.v[0] = 1.797e308;
  s.input.tau[0] = 1.7e308;
  expectRefused(s, "sum");
}

TEST(Step, NotFiniteContactLeavesStateIntact) {
  Scene s = fallingHumanoid();
  auto contacts = std::make_shared<FixedContacts>();
  s.contacts = contacts;
  Contact good;
  good.geometryB = 1;
  good.bodyB = s.model.geometries[1].body;
  good.distance = -0.001;
  contacts->points = {good};
  contacts->points[0].n_W.y() = kNaN;
  expectRefused(s, "normal");
  s.stages();
  EXPECT_EQ(s.forward(), SolveStatus::notFinite);  // by itself, although most dofs do not feel it
  contacts->points = {good};
  contacts->points[0].p_WC.x() = kNaN;
  expectRefused(s, "point");
  contacts->points = {good};
  contacts->points[0].distance = kNaN;
  expectRefused(s, "distance");
  contacts->points = {good};
  EXPECT_EQ(s.step(), SolveStatus::converged);
}

TEST(Step, WarmStartThatIsNotFiniteIsNotUsed) {
  Scene s = fallingHumanoid(), t = fallingHumanoid();
  s.steps(250);
  t.state = s.state;
  s.state.warmstart.a.setConstant(kNaN);
  t.state.warmstart.valid = false;
  EXPECT_EQ(s.step(), SolveStatus::converged);
  t.step();
  EXPECT_TRUE(sameBits(s.state, t.state));
}

TEST(Step, WithoutMovingBodiesDoesNothing) {
  ModelBuilder builder("stone");
  builder.link(boxLink("stone", 1.0, {1, 1, 1}));
  builder.base = BaseKind::fixed;
  Scene s(builder.build());
  ASSERT_EQ(s.model.nv, 0);
  EXPECT_EQ(s.step(), SolveStatus::converged);
  EXPECT_EQ(s.state.time, s.model.options.timestep);
}

}  // namespace
}  // namespace softgauss::test
