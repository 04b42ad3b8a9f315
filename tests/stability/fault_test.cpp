// SPDX-License-Identifier: Apache-2.0
/// Family 9: what is not finite is reported, leaves the state as it was, and is forgotten.

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "softgauss/gdd/gdd.hpp"
#include "tests/gdd/solvers.hpp"
#include "tests/stability/energy_watch.hpp"
#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

constexpr double kFaults[] = {std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};

/// A humanoid that falls, pulled by a steady force, watched by a copy that knows of no fault. By
/// the default integrator it gains no energy around any.
struct Pair {
  Model model;
  collision::SceneContacts contacts{model}, otherContacts{model};
  Data data{model}, otherData{model};
  State state{model}, other{model};
  Input input;
  EnergyWatch watch{model};
  double work = 0.0;  ///< of the force, on the pelvis [J]

  explicit Pair(const Options& options = {}) : model(humanoidWith(options)) {
    input.tau = VectorX::Zero(model.nv);
    input.wrenches.push_back({1, {Vector3::Zero(), Vector3(10, 20, 30)}});
    watch.begin(state, input);
  }
  SolveStatus faulty(const Input& in, State& s) { return step(model, in, s, data, &contacts); }
  /// Both go on, to the same bits.
  void goOn() {
    const Vector3 v = state.v.head<3>();
    EXPECT_NE(step(model, input, state, data, &contacts), SolveStatus::notFinite);
    work +=
        0.5 * model.options.timestep * input.wrenches[0].F_Bo_W.force.dot(v + state.v.head<3>());
    if (!model.options.isMultiStage() && model.options.integrator != Integrator::implicit) {
      EXPECT_LE(watch.check(state, input, data, work), 1e-9) << state.time;
    }
    EXPECT_NE(step(model, input, other, otherData, &otherContacts), SolveStatus::notFinite);
    EXPECT_EQ(hash(state), hash(other));
  }

 private:
  static Model humanoidWith(const Options& options) {
    ModelBuilder builder = humanoid();
    builder.options = options;
    return builder.build();
  }
};

TEST(Fault, InputsAreRefusedAndForgotten) {
  Pair pair;
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    Input bad = pair.input;
    const double fault = kFaults[i % 3];
    if (i % 2 == 0)
      bad.tau[(7 * i) % pair.model.nv] = fault;
    else
      (i % 4 == 1 ? bad.wrenches[0].F_Bo_W.force : bad.wrenches[0].F_Bo_W.moment)[i % 3] = fault;
    const std::uint64_t before = hash(pair.state);
    refused += pair.faulty(bad, pair.state) == SolveStatus::notFinite;
    EXPECT_EQ(hash(pair.state), before);
    pair.goOn();
  }
  EXPECT_EQ(refused, 300);
}

TEST(Fault, StatesAreRefusedAndForgotten) {
  Pair pair;
  for (int i = 0; i < 300; ++i) {
    State bad = pair.state;
    (i % 2 == 0 ? bad.q : bad.v)[(5 * i) % pair.model.nv] = kFaults[i % 3];
    const std::uint64_t before = hash(bad);
    EXPECT_EQ(pair.faulty(pair.input, bad), SolveStatus::notFinite);
    EXPECT_EQ(hash(bad), before);
    EXPECT_GE(pair.data.stats.badDof, 0);
    pair.goOn();
  }
}

// So does every integrator, which looks at the state at several places of the step.
TEST(Fault, EveryIntegratorRefusesAndForgets) {
  using enum Integrator;
  for (const Integrator integrator :
       {semiImplicitEuler, implicit, implicitMidpoint, rungeKutta4, dormandPrince})
    for (const bool doubled : {false, true}) {
      Options options;
      options.integrator = integrator;
      options.stepDoubling = doubled;
      if (doubled && !options.isSingleSolve()) continue;
      Pair pair(options);
      for (int i = 0; i < 30; ++i) {
        State bad = pair.state;
        Input in = pair.input;
        const double fault = kFaults[i % 3];
        if (i % 4 == 0) bad.q[(5 * i) % pair.model.nq] = fault;
        if (i % 4 == 1) bad.v[(5 * i) % pair.model.nv] = fault;
        if (i % 4 == 2) in.tau[(5 * i) % pair.model.nv] = fault;
        if (i % 4 == 3) in.wrenches[0].F_Bo_W.force[i % 3] = fault;
        const std::uint64_t before = hash(bad);
        EXPECT_EQ(pair.faulty(in, bad), SolveStatus::notFinite);
        EXPECT_EQ(hash(bad), before);
        EXPECT_EQ(pair.data.stats.badDof >= 0, i % 4 != 3);  // a wrench is of no dof
        pair.goOn();
      }
    }
}

// A speed whose square is no number turns a body by no angle.
TEST(Fault, SpeedsThatOverflowAreRefused) {
  ModelBuilder builder = freeBody(sphereLink("ball", 1.0, 0.1));
  Model model = builder.build();
  model.options.effects.remove(Effect::coriolis);
  Data data(model);
  for (const double speed : {1e151, 1e200, 1e300}) {
    State state(model);
    state.v[4] = speed;
    const std::uint64_t before = hash(state);
    EXPECT_EQ(step(model, {}, state, data, nullptr), SolveStatus::notFinite);
    EXPECT_EQ(hash(state), before);
  }
}

// A warm start is a guess: one that is not finite costs iterations and nothing else.
TEST(Fault, WarmStartsAreGuesses) {
  Pair pair;
  for (int i = 0; i < 300; ++i) {
    pair.goOn();
    if (i % 10 != 9) continue;
    State bad = pair.state;
    bad.warmstart.a[(3 * i) % pair.model.nv] = kFaults[(i / 10) % 3];
    ASSERT_EQ(pair.faulty(pair.input, bad), SolveStatus::converged);
    EXPECT_EQ(pair.data.stats.invalidWarmStarts, 1);
    State good = pair.state;
    ASSERT_EQ(pair.faulty(pair.input, good), SolveStatus::converged);
    EXPECT_EQ(pair.data.stats.invalidWarmStarts, 0);
    EXPECT_SMALL((bad.v - good.v).cwiseAbs().maxCoeff(), 1e-9);
  }
}

/// A humanoid that reaches, pulled by a steady force, by one of the two solvers.
struct Reaching {
  Model model = humanoid().build();
  collision::SceneContacts contacts{model};
  Data data{model};
  State state{model};
  Input input;
  gdd::GoalDirectedController controller{model};
  gdd::Reach* reach = nullptr;
  const Vector3 target{0.3, 0.2, 1.2};

  explicit Reaching(gdd::GddSolver solver) {
    controller.solver = solver;
    auto goal = std::make_unique<gdd::Reach>(model, model.frames.back().name, target);
    reach = goal.get();
    controller.goals.push_back(std::move(goal));
    controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
    input.wrenches.push_back({1, {Vector3::Zero(), Vector3(10, 20, 30)}});
  }
  SolveStatus step(const Input& in, State& s) {
    return controller.step(model, in, s, data, &contacts);
  }
};

// A goal whose target is not finite.
TEST(Fault, GoalsAreRefusedAndForgotten) {
  for (const gdd::GddSolver solver : kSolvers) {
    Reaching r(solver);
    for (int i = 0; i < 60; ++i) {
      if (i % 3 == 0) {
        r.reach->p_WTarget[i % 2] = kFaults[(i / 3) % 3];
        const std::uint64_t before = hash(r.state);
        EXPECT_EQ(r.step(r.input, r.state), SolveStatus::notFinite);
        EXPECT_EQ(hash(r.state), before);
        r.reach->p_WTarget = r.target;
      }
      EXPECT_NE(r.step(r.input, r.state), SolveStatus::notFinite);
    }
  }
}

// Under goals too a state and a force that are not finite are refused; the run goes on to the bits
// of one that knew of none.
TEST(Fault, StatesAndForcesUnderGoalsAreRefusedAndForgotten) {
  for (const gdd::GddSolver solver : kSolvers) {
    Reaching faulty(solver), other(solver);
    for (int i = 0; i < 60; ++i) {
      const double fault = kFaults[(i / 3) % 3];
      State bad = faulty.state;
      Input in = faulty.input;
      if (i % 3 == 0)
        bad.q[(5 * i) % faulty.model.nq] = fault;
      else if (i % 3 == 1)
        bad.v[(5 * i) % faulty.model.nv] = fault;
      else
        in.wrenches[0].F_Bo_W.force[i % 2] = fault;
      const std::uint64_t before = hash(bad);
      EXPECT_EQ(faulty.step(in, bad), SolveStatus::notFinite);
      EXPECT_EQ(hash(bad), before);
      EXPECT_NE(faulty.step(faulty.input, faulty.state), SolveStatus::notFinite);
      EXPECT_NE(other.step(other.input, other.state), SolveStatus::notFinite);
      ASSERT_EQ(hash(faulty.state), hash(other.state)) << i;
    }
  }
}

}  // namespace
}  // namespace softgauss::test
