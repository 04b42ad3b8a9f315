// SPDX-License-Identifier: Apache-2.0
/// A Simulation goes to bytes and back, and goes on to the same bits.

#include <gtest/gtest.h>

#include "softgauss/engine/model/state.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/simulation/data_file.hpp"

namespace softgauss::test {
namespace {

Simulation reachingArm(const SimulationOptions& options = {}) {
  Simulation sim = Simulation::load(robot("arm"), options);
  sim.goals.reach("hand", {0.4, 0.1, 0.5});
  return sim;
}

TEST(SavedSimulation, GoesOnToTheSameBitsAndTimes) {
  Simulation sim = reachingArm(), other = reachingArm();
  sim.run(0.1);
  other.restore(sim.save());
  for (int i = 0; i < 50; ++i) {
    ASSERT_FALSE(isRefused(sim.step()));
    ASSERT_FALSE(isRefused(other.step()));
    ASSERT_EQ(sim.time(), other.time());
    ASSERT_EQ(hash(sim.state()), hash(other.state()));
  }
}

TEST(SavedSimulation, RestoringLeavesTheMemoryOfTheStateWhereItIs) {
  // Views of it, as Python's, stay good.
  Simulation sim = reachingArm();
  const double *q = sim.state().q.data(), *v = sim.state().v.data();
  const std::string bytes = sim.save();
  sim.run(0.02);
  sim.restore(bytes);
  sim.run(0.02);
  sim.reset();
  sim.run(0.02);
  EXPECT_EQ(sim.state().q.data(), q);
  EXPECT_EQ(sim.state().v.data(), v);
}

TEST(SavedSimulation, ThatIsNoneLeavesTheStateAsItWas) {
  Simulation sim = reachingArm();
  sim.run(0.02);
  const std::string bytes = sim.save();
  SimulationOptions finer;
  finer.timestep = 0.001;
  Simulation other = reachingArm(finer);
  other.run(0.01);
  const std::uint64_t before = hash(other.state());
  for (const std::string& wrong : {bytes, bytes.substr(0, 100), std::string("text")})
    EXPECT_THROW(other.restore(wrong), ModelError);
  EXPECT_EQ(hash(other.state()), before);
}

}  // namespace
}  // namespace softgauss::test
