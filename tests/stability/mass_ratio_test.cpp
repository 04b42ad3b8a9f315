// SPDX-License-Identifier: Apache-2.0
/// Family 1: light bodies under heavy ones.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

// MuJoCo 3.12: 0.21 mm for 1 kg on 1 kg; 1,000 kg sinks through 10 cm and topples.
void carries(double load, double timestep, Cone cone) {
  Trial t(std::to_string(static_cast<int>(load)) + " kg on 1 kg",
          with(tower({1.0, load}), timestep, cone));
  t.mayGain = 1e-9 * load * 9.81;  // a nanometre of the load's height: rounding
  t.run(3.0);
  // 2 mm, and the depth goes with the square of the time constant, which is at least two steps.
  const double depth = 2e-3 * std::pow(std::max(1.0, 2.0 * timestep / 0.02), 2.0);
  // A body falls for a step before the one below stops it, and for another one on a moving support.
  t.expect("landing", t.deepest, depth + 3.0 * 9.81 * timestep * timestep, "m");
  t.expect("penetration at rest", t.data->stats.maxPenetration, depth, "m");
  t.expect("tilt", tilt(t, "box1"), 1e-3, "rad");
  t.expect("speed at rest", t.state.v.cwiseAbs().maxCoeff(), 1e-4, "m/s");
}

TEST(MassRatio, LightBoxCarriesHeavyBox) {
  for (const double load : {1.0, 10.0})
    for (const double timestep : kSteps)
      for (const Cone cone : kCones) carries(load, timestep, cone);
}

TEST(MassRatio, SameBits) {
  expectSameBits([] {
    Trial t("1000 kg on 1 kg", tower({1.0, 1000.0}));
    t.run(0.2);
    return hash(t.state);
  });
}

}  // namespace
}  // namespace softgauss::test
