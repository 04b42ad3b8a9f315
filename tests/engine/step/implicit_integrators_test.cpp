// SPDX-License-Identifier: Apache-2.0
/// What the implicit integrators are for: stiff damping, fast rotation, energy over long times.

#include <cmath>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

double energyOf(const Model& model, const State& state) {
  Kinematics k(model);
  computeKinematics(model, state, k);
  return computeEnergy(model, k, state.q, state.v).total();
}

/// Largest change of energy over the run, relative to `scale` [J].
double worstDrift(const Model& model, State state, int steps, double scale) {
  Data data(model);
  const double before = energyOf(model, state);
  double worst = 0.0;
  for (int i = 0; i < steps; ++i) {
    EXPECT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged) << "step " << i;
    worst = std::max(worst, std::abs(energyOf(model, state) - before));
  }
  return worst / scale;
}

Model spinningBody(Integrator integrator, double h) {
  ModelBuilder builder = freeBody(boxLink("body", 1.0, {0.05, 0.1, 0.2}, {0.01, 0.02, 0.03}));
  builder.options.effects.remove(Effect::gravity);
  builder.options.integrator = integrator;
  builder.options.timestep = h;
  return builder.build();
}

State spun(const Model& model, double speed) {
  State state(model);
  state.v << 0.3, -0.2, 0.1, 0.02 * speed, speed, 0.01 * speed;
  return state;
}

// 10 s at 2 ms. In each step the energy is closed to 1e-12 of what moves; 5,000 of them.
TEST(ImplicitMidpoint, KeepsTheEnergyOfATorqueFreeBody) {
  const Model model = spinningBody(Integrator::implicitMidpoint, 0.002);
  const State state = spun(model, 10.0);
  EXPECT_SMALL(worstDrift(model, state, 5000, energyOf(model, state)), 1e-10);
}

TEST(ImplicitMidpoint, KeepsTheEnergyOfAnUndampedChain) {
  ModelBuilder builder = chain(5);
  builder.options.integrator = Integrator::implicitMidpoint;
  const Model model = builder.build();
  State state(model);
  state.q.setConstant(0.3);
  state.q[0] = 1.2;
  // A hanging chain of 5 links of 0.2 m and 1 kg, lifted: m g l n²/2.
  EXPECT_SMALL(worstDrift(model, state, 5000, 25.0), 1e-10);
}

/// A chain of six that swings, over `duration` [s].
double driftOfSix(double h, double duration) {
  ModelBuilder builder = chain(6);
  builder.options.integrator = Integrator::implicitMidpoint;
  builder.options.timestep = h;
  const Model model = builder.build();
  State state(model);
  state.q.setConstant(0.3);
  state.q[0] = 1.2;
  // m g l n²/2, as above.
  return worstDrift(model, state, static_cast<int>(std::lround(duration / h)), 35.0);
}

// Long steps need more sweeps than ten; the energy is closed with the last of them, or the step is
// divided: 500 steps, each to 1e-12 of the speeds.
TEST(ImplicitMidpoint, ClosesItsBalanceInLongSteps) { EXPECT_SMALL(driftOfSix(0.02, 10.0), 1e-9); }

TEST(ImplicitMidpointLong, KeepsTheEnergyOfAChainForAMinute) {
  for (const double h : {0.01, 0.02}) EXPECT_SMALL(driftOfSix(h, 60.0), 1e-9);
}

// A step on with h, the velocity turned round, and a step on again: the same place.
TEST(ImplicitMidpoint, IsReversible) {
  ModelBuilder builder = chain(5);
  builder.options.integrator = Integrator::implicitMidpoint;
  builder.options.timestep = 0.01;
  const Model model = builder.build();
  Data data(model);
  State state(model);
  state.q.setConstant(0.3);
  state.v.setConstant(2.0);
  const VectorX q = state.q, v = state.v;
  for (int i = 0; i < 10; ++i) step(model, {}, state, data, nullptr);
  EXPECT_GT((state.q - q).norm(), 0.05);
  state.v = -state.v;
  for (int i = 0; i < 10; ++i) step(model, {}, state, data, nullptr);
  // Ten steps, each closed to 1e-12, of a chain that spreads errors.
  EXPECT_APPROX(state.q, q, 1e-9);
  EXPECT_APPROX(-state.v, v, 1e-9);
}

// The work of a constant torque, of damping, and of a spring: E⁺ − E = h v̄ (τ − d v̄).
TEST(ImplicitMidpoint, ChangesTheEnergyByTheWorkDone) {
  ModelBuilder builder = pendulum(0.5, 1.0, 0.05, 0.01, 0.3);
  builder.options.integrator = Integrator::implicitMidpoint;
  builder.options.timestep = 0.01;
  const Model model = builder.build();
  Data data(model);
  State state(model);
  state.q[0] = 1.0;
  Input input;
  input.tau = VectorX::Constant(1, 0.7);
  double work = 0.0;
  const double before = energyOf(model, state);
  for (int i = 0; i < 200; ++i) {
    const double v = state.v[0];
    step(model, input, state, data, nullptr);
    const double middle = 0.5 * (v + state.v[0]);
    work += 0.01 * middle * (0.7 - 0.3 * middle);
  }
  EXPECT_GT(std::abs(work), 0.1);
  // The pendulum turns round: there γ is not sought while there is no motion (1e-10 of it).
  EXPECT_SMALL((energyOf(model, state) - before) - work, 1e-9);
}

// h d/M is 1000: explicit damping diverges at 2. The midpoint rule rings, and does not grow.
TEST(ImplicitIntegrators, StandStiffDamping) {
  for (const Integrator integrator : {Integrator::implicit, Integrator::implicitMidpoint}) {
    ModelBuilder builder = pendulum(0.5, 1.0, 0.05, 0.0, 1.3e5);
    builder.options.integrator = integrator;
    const Model model = builder.build();
    Data data(model);
    State state(model);
    state.q[0] = 1.0;
    state.v[0] = 1.0;
    for (int i = 0; i < 500; ++i)
      ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
    EXPECT_LT(std::abs(state.v[0]), 1.0);
    EXPECT_NEAR(state.q[0], 1.0, 0.01);
  }
}

// A body that turns by up to two radians in a step loses energy, and does not gain it.
TEST(ImplicitIntegrators, ImplicitLosesEnergyOfFastRotation) {
  for (const double speed : {50.0, 200.0, 1000.0}) {
    const Model model = spinningBody(Integrator::implicit, 0.002);
    State state = spun(model, speed);
    Data data(model);
    const double before = energyOf(model, state);
    for (int i = 0; i < 1000; ++i)
      ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
    EXPECT_LT(energyOf(model, state), before);
    EXPECT_GT(energyOf(model, state), 0.0);
  }
}

// Without Coriolis forces it is the default: both have the same implicit damping.
TEST(ImplicitIntegrators, ImplicitIsTheDefaultWithoutCoriolisForces) {
  ModelBuilder builder = pendulum(0.5, 1.0, 0.05, 0.01, 0.3);
  builder.options.effects.remove(Effect::coriolis);
  State states[2];
  int k = 0;
  for (const Integrator integrator : {Integrator::semiImplicitEuler, Integrator::implicit}) {
    builder.options.integrator = integrator;
    const Model model = builder.build();
    Data data(model);
    State state(model);
    state.q[0] = 1.0;
    for (int i = 0; i < 100; ++i) step(model, {}, state, data, nullptr);
    states[k++] = state;
  }
  EXPECT_EQ(states[0].q[0], states[1].q[0]);
}

// A sphere falls, touches down, and comes to rest, with each of them; the state is never refused.
TEST(ImplicitIntegrators, LandAndRest) {
  for (const IntegratorName& name : kIntegratorNames) {
    ModelBuilder builder = sphereOnPlane(0.1, 1.0, 0.5);
    builder.options.integrator = name.integrator;
    const Model model = builder.build();
    collision::SceneContacts contacts(model);
    Data data(model);
    State state(model);
    state.q[2] = 0.3;
    state.v[0] = 1.0;
    int evaluations = 0;
    for (int i = 0; i < 1000; ++i) {
      ASSERT_FALSE(isRefused(step(model, {}, state, data, &contacts))) << name.name << " at " << i;
      evaluations += data.stats.evaluations;
    }
    EXPECT_NEAR(state.q[2], 0.1, 0.002) << name.name;
    EXPECT_LT(std::abs(state.v[2]), 1e-3) << name.name;
    if (name.integrator == Integrator::implicitMidpoint) {
      EXPECT_LT(evaluations, 12000);
    }
  }
}

// A step whose equations cannot be closed is refused as such, with the state as it was: gravity of
// 1e12 m/s² on a chain that is released across it asks for turns of thousands in h/64.
TEST(ImplicitMidpoint, RefusesWhatDoesNotCloseAndLeavesTheState) {
  ModelBuilder builder = chain(5);
  builder.options.integrator = Integrator::implicitMidpoint;
  builder.options.gravity = Vector3(1e12, 0, 0);
  const Model model = builder.build();
  Data data(model);
  State state(model);
  state.q.setConstant(0.3);
  const std::uint64_t before = hash(state);
  EXPECT_EQ(step(model, {}, state, data, nullptr), SolveStatus::integratorDiverged);
  EXPECT_EQ(hash(state), before);
  EXPECT_STREQ(statusName(data.stats.status), "integrator diverged");
}

}  // namespace
}  // namespace softgauss::test
