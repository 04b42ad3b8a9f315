// SPDX-License-Identifier: Apache-2.0
/// The passivity bound that every trial is asked for can be broken, and by how little.

#include "tests/stability/energy_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/stability/scenes.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

/// A scene that is stepped and watched.
struct Watched {
  explicit Watched(const ModelBuilder& builder) : model(builder.build()) {
    input.tau = VectorX::Zero(model.nv);
  }
  Model model;
  State state{model};
  Data data{model};
  collision::SceneContacts contacts{model};
  Input input;
  EnergyWatch watch{model};

  /// The most by which the law is broken in `seconds`.
  double run(double seconds) {
    double worst = -kInfinity;
    for (int i = static_cast<int>(std::round(seconds / model.options.timestep)); i > 0; --i) {
      EXPECT_EQ(step(model, input, state, data, &contacts), SolveStatus::converged);
      worst = std::max(worst, watch.check(state, input, data, 0.0));
    }
    return worst;
  }
};

// A sphere that rests on its depth r stores m g |r|; it rests within 0.1 % of its depth (5.7).
TEST(EnergyWatch, WhatRestsStoresItsWeightOverItsDepth) {
  Watched w(sphereOnPlane(0.1, 2.0, 0.5));
  w.watch.begin(w.state, w.input);
  w.run(3.0);
  const double depth = 0.1 - w.state.q[2];
  EXPECT_GT(depth, 1e-5);
  EXPECT_SMALL(w.watch.stored(w.state, w.input) / (2.0 * 9.81 * depth) - 1.0, 1e-3);
}

// A heap that has fallen by centimetres and rests: what it has lost, joules, does not come back,
// not even by the millijoule that its contacts store twice over.
TEST(EnergyWatch, WhatWasDissipatedDoesNotComeBack) {
  for (const Cone cone : kCones) {
    ModelBuilder builder = with(tower({1.0, 1.0, 1.0}), 0.002, cone);
    Watched w(builder);
    for (int i = 0; i < 3; ++i) w.state.q[7 * i + 2] += 0.02 * (i + 1);
    w.watch.begin(w.state, w.input);
    EXPECT_LE(w.run(3.0), 0.0);
    const double stored = w.watch.stored(w.state, w.input);
    EXPECT_GT(stored, 1e-4);
    EXPECT_LT(stored, 0.03);
    w.state.v[2 * 6 + 2] = std::sqrt(2.0 * 0.9 * stored);
    EXPECT_LE(w.watch.check(w.state, w.input, w.data, 0.0), 0.0);
    w.state.v[2 * 6 + 2] = std::sqrt(2.0 * 2.0 * stored);
    EXPECT_GT(w.watch.check(w.state, w.input, w.data, 0.0), 0.5 * stored);
  }
}

// A pendulum whose positions go by the velocity of the step's start, as explicit Euler's do, swings
// wider by ½ (h ω)² a step; to second order a leapfrog's do not.
TEST(EnergyWatch, ExplicitEulerIsFound) {
  for (const bool explicitly : {false, true}) {
    Watched w(pendulum(0.5, 1.0, 0.05));
    w.state.q[0] = 0.5;
    w.watch.begin(w.state, w.input);
    double worst = -kInfinity;
    for (int i = 0; i < 1000; ++i) {
      const State before = w.state;
      step(w.model, w.input, w.state, w.data, &w.contacts);
      if (explicitly) w.state.q[0] = before.q[0] + w.model.options.timestep * before.v[0];
      worst = std::max(worst, w.watch.check(w.state, w.input, w.data, 0.0));
    }
    if (explicitly)
      EXPECT_GT(worst, 0.01);
    else
      EXPECT_LE(worst, 0.0);
  }
}

// Work that is applied is no gain, and what it does not account for is one.
TEST(EnergyWatch, WorkIsNoGain) {
  Watched w(freeBody(sphereLink("ball", 1.0, 0.1)));
  w.watch.begin(w.state, w.input);
  w.input.tau[0] = 3.0;
  double work = 0.0;
  for (int i = 0; i < 100; ++i) {
    const VectorX v = w.state.v;
    step(w.model, w.input, w.state, w.data, nullptr);
    work += 0.5 * w.model.options.timestep * w.input.tau.dot(v + w.state.v);
    EXPECT_LE(w.watch.check(w.state, w.input, w.data, work), 0.0);
  }
  EXPECT_GT(w.watch.check(w.state, w.input, w.data, 0.5 * work), 0.0);
}

}  // namespace
}  // namespace softgauss::test
