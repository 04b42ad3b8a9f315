// SPDX-License-Identifier: Apache-2.0
/// The leapfrog: what it keeps, what it predicts, and when a step goes in parts.

#include <cmath>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

const Vector3 kCorner(0.05, 0.1, 0.15);

ModelBuilder links(int count, double h) {
  ModelBuilder builder = chain(count);
  builder.options.integrator = Integrator::leapfrog;
  builder.options.timestep = h;
  return builder;
}

Model notFollowed(ModelBuilder builder) {
  builder.options.mechanisms.remove(Mechanism::treeSubstepping);
  return builder.build();
}

double energyAt(const Model& model, const State& state) {
  Kinematics k(model);
  computeKinematics(model, state, k);
  return computeEnergy(model, k, state.q, state.v).total();
}

// A pendulum let go at a right angle, h ω₀ = 0.1: the energy of a symplectic method of order 2
// swings by some (h ω)²/8 of what moves, and comes back.
TEST(Leapfrog, KeepsTheEnergyOfAPendulum) {
  const Model model = notFollowed(links(1, 0.01));
  State state(model);
  state.q[0] = 0.5 * M_PI;
  Data data(model);
  const double before = energyAt(model, state);
  double worst = 0.0, late = 0.0, moves = 0.0;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
    const double off = energyAt(model, state) - before;
    worst = std::max(worst, std::abs(off));
    if (i >= 2000) late = std::max(late, std::abs(off));
    moves = std::max(moves, 0.5 * data.inertia.M.row(0)[0] * state.v[0] * state.v[0]);
  }
  EXPECT_LT(worst / moves, 3e-3);
  EXPECT_LT(late, 1.01 * worst);  // without a drift
}

// Where nothing is lost to damping or rows, a step back undoes a step. Coriolis forces at a
// predicted velocity are the exception, to the order of the prediction: one joint has none.
TEST(Leapfrog, AStepBackUndoesAStep) {
  const Model model = notFollowed(links(1, 0.01));
  State state(model);
  state.q[0] = 0.7;
  state.v[0] = 2.0;
  const State start = state;
  Data data(model);
  for (int i = 0; i < 100; ++i) step(model, {}, state, data, nullptr);
  state.v = -state.v;
  for (int i = 0; i < 100; ++i) step(model, {}, state, data, nullptr);
  EXPECT_NEAR(state.q[0], start.q[0], 1e-12);
  EXPECT_NEAR(-state.v[0], start.v[0], 1e-12);
}

// (v⁺ − v)/h is the solution of the problem that was solved, Coriolis forces, damping and springs
// included.
TEST(Leapfrog, MovesAsWasSolved) {
  for (int seed = 0; seed < 10; ++seed) {
    RandomTreeOptions options;
    options.springs = true;
    Model model = randomForest(static_cast<std::uint64_t>(seed), options).build();
    model.options.integrator = Integrator::leapfrog;
    model.options.substepAngle = kInfinity;
    Random random(static_cast<std::uint64_t>(seed));
    State state = randomState(model, random, 2.0);
    Data data(model);
    for (int i = 0; i < 20; ++i) {
      const VectorX before = state.v;
      ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
      const VectorX moved = (state.v - before) / model.options.timestep;
      const double scale = std::max(1.0, data.forward.a.cwiseAbs().maxCoeff());
      EXPECT_SMALL((moved - data.forward.a).cwiseAbs().maxCoeff() / scale, 1e-10);
      EXPECT_SMALL(data.stats.realised, 1e-13);  // rounding of v over h
    }
  }
}

// A chain that swings freely is followed, slow or fast; one that is driven takes one step while it
// is slow, and goes in parts when it is fast.
TEST(Leapfrog, DividesWhatTurnsFar) {
  const Model model = links(3, 0.01).build();
  State state(model);
  state.q.setConstant(0.4);
  Data data(model);
  Input driven;
  driven.tau = VectorX::Constant(model.nv, 5.0);
  step(model, driven, state, data, nullptr);
  EXPECT_EQ(data.stats.parts, 1);
  EXPECT_EQ(data.stats.substeppedTrees, 0);
  EXPECT_EQ(data.stats.repeats, 1);  // the first: its acceleration is not known

  for (const double fast : {0.0, 1.0}) {
    state.v = fast * Vector3(10.0, -20.0, 30.0);
    step(model, {}, state, data, nullptr);
    EXPECT_EQ(data.stats.parts, 1) << fast;
    EXPECT_EQ(data.stats.substeppedTrees, 1) << fast;
    EXPECT_EQ(data.stats.repeats, 0) << fast;
  }

  step(model, driven, state, data, nullptr);
  EXPECT_GT(data.stats.parts, 5);
  EXPECT_EQ(data.stats.substeppedTrees, 0);
  EXPECT_NEAR(state.time, 0.04, 1e-15);
}

// What divides a step, and all else that the next one depends on, is in the state.
TEST(Leapfrog, DependsOnTheStateAlone) {
  const Model model = links(3, 0.01).build();
  State state(model);
  state.q.setConstant(0.4);
  state.v << 5.0, -9.0, 14.0;
  Input driven;
  driven.tau = VectorX::Constant(model.nv, 2.0);
  Data data(model);
  for (int i = 0; i < 20; ++i) {
    State copy = state;
    Data fresh(model);
    step(model, driven, copy, fresh, nullptr);
    step(model, driven, state, data, nullptr);
    EXPECT_EQ(hash(copy), hash(state)) << i;
  }
}

/// A box of 1 kg that turns about its corner, which is tied to the world.
Model turningOnATie(double h) {
  ModelBuilder builder = freeBody(boxLink("body", 1.0, kCorner));
  ConnectSpec tie;
  tie.linkA = "body", tie.linkB = "world";
  tie.p_LAP = tie.p_LBP = kCorner;
  builder.connect(tie);
  builder.options.gravity.setZero();
  builder.options.timestep = h;
  builder.options.integrator = Integrator::leapfrog;
  return builder.build();
}

State turning(const Model& model, double rate) {
  State state(model);
  const Vector3 omega = rate * Vector3(0.6, 0.64, -0.48);
  state.v << -omega.cross(kCorner), omega;
  return state;
}

// However far the body turns in a step, the equality constraint gives it no energy, and keeps hold
// of it.
TEST(Leapfrog, ATieGivesNoEnergyHoweverFarTheBodyTurns) {
  for (const double h : {0.002, 0.01})
    for (const double turn : {0.1, 0.5, 1.5, 4.0}) {
      const Model model = turningOnATie(h);
      State state = turning(model, turn / h);
      Data data(model);
      const double begun = energyAt(model, state);
      int parts = 0;
      for (int i = 0; i < 500; ++i) {
        ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
        parts = std::max(parts, data.stats.parts);
        ASSERT_LE(energyAt(model, state), begun * (1.0 + 1e-6)) << h << ", " << turn << ", " << i;
      }
      EXPECT_GE(parts, 4.0 * 0.9 * turn / model.options.substepAngle) << turn;
    }
}

// Slow or fast, the equality constraint takes as much as in short steps.
TEST(Leapfrog, ATieTakesWhatItShould) {
  constexpr int kShorter = 16;
  for (const double h : {0.002, 0.01})
    for (const double turn : {0.005, 0.02, 0.04, 0.06, 0.09}) {
      const Model model = turningOnATie(h), shorter = turningOnATie(h / kShorter);
      State state = turning(model, turn / h), converged = state;
      Data data(model), ofShorter(shorter);
      const double begun = energyAt(model, state);
      for (int i = 0; i < std::lround(1.0 / h); ++i) {
        ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
        for (int k = 0; k < kShorter; ++k) step(shorter, {}, converged, ofShorter, nullptr);
        ASSERT_LE(energyAt(model, state), begun * (1.0 + 2.0 * turn * turn));
      }
      EXPECT_SMALL((energyAt(model, state) - energyAt(model, converged)) / begun, 0.01)
          << h << ", " << turn;
    }
}

// Two cubes that are tied in the face that they share turn about their common centre of mass. What
// the equality constraint holds at the step's end is where the bodies are then, so that nothing is
// gained: r and J̇ v of mid-step alone would gain (h ω)²/16.
TEST(Leapfrog, WhatSpinsTogetherGainsNothing) {
  for (const double h : {0.002, 0.01})
    for (const double turn : {0.01, 0.08, 0.4}) {
      ModelBuilder builder("pair");
      builder.base = BaseKind::floating;
      builder.link(boxLink("a", 1.0, Vector3::Constant(0.1)));
      builder.link(boxLink("b", 10.0, Vector3::Constant(0.1)));
      WeldSpec held;
      held.linkA = "a", held.linkB = "b";
      held.X_LAF.p = Vector3(0.1, 0, 0), held.X_LBF.p = Vector3(-0.1, 0, 0);
      builder.weld(held);
      builder.options.gravity.setZero();
      builder.options.timestep = h;
      builder.options.integrator = Integrator::leapfrog;
      const Model model = builder.build();
      State state(model);
      const Vector3 omega = turn / h * Vector3::UnitZ(), com(0.2 * 10.0 / 11.0, 0, 0);
      state.q[7] = 0.2;
      state.v << omega.cross(-com), omega, omega.cross(Vector3(0.2, 0, 0) - com), omega;
      Data data(model);
      const double begun = energyAt(model, state);
      for (int i = 0; i < std::lround(2.0 / h); ++i)
        ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
      EXPECT_LE(energyAt(model, state), begun * (1.0 + 1e-6)) << h << ", " << turn;
    }
}

// A part that comes to turn farther than it was made for has the step begin again in shorter ones:
// an arm that an equality constraint pulls from a metre beyond its reach is never faster than the
// equality constraint takes its end home, 1.15 m in a time constant of 0.02 s, at a lever of a
// link.
TEST(Leapfrog, BeginsAgainInShorterParts) {
  ModelBuilder builder = links(3, 0.01);
  ConnectSpec tie;
  tie.linkA = "link2", tie.linkB = "world";
  tie.p_LAP = Vector3(0, 0, -0.2), tie.p_LBP = Vector3(0, 0, -1.6);
  builder.connect(tie);
  builder.options.gravity.setZero();
  const Model model = builder.build();
  State state(model);
  state.q << 0.1, -0.2, 0.15;
  Data data(model);
  int parts = 0;
  double fastest = 0.0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_FALSE(isRefused(step(model, {}, state, data, nullptr))) << i;
    parts = std::max(parts, data.stats.parts);
    fastest = std::max(fastest, state.v.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(parts, 10);
  EXPECT_LT(fastest, 1.15 / 0.02 / 0.2);
}

}  // namespace
}  // namespace softgauss::test
