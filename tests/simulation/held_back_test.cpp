// SPDX-License-Identifier: Apache-2.0
/// What holds a goal back, asked in the middle of a run.

#include <gtest/gtest.h>

#include <numeric>

#include "softgauss/io/simulation/simulation.hpp"
#include "tests/simulation/data_file.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

using Causes = std::vector<io::GoalOutcome::Cause>;

double sumOf(const Causes& causes) {
  return std::accumulate(causes.begin(), causes.end(), 0.0,
                         [](double sum, const auto& cause) { return sum + cause.share; });
}

TEST(Simulation, SaysWhatHoldsAGoalBack) {
  Simulation sim = Simulation::load(robot("arm"));
  gdd::Goal& reach = sim.goals.reach("hand", {0.5, 0.3, 0.5}, Vector3::Zero(), 1.0);
  const gdd::Goal& posture = sim.goals.posture(1e4);
  sim.run(2.0);
  const State before = sim.state();
  const Causes causes = sim.heldBack(reach);
  ASSERT_FALSE(causes.empty());
  EXPECT_EQ(causes.front().what, posture.name());
  EXPECT_GT(causes.front().share, 0.5);
  EXPECT_SMALL(sumOf(causes) - 1.0, 1e-12);
  EXPECT_EQ(hash(sim.state()), hash(before));
  reach.endTime = 1.0;
  EXPECT_TRUE(sim.heldBack(reach).empty());
}

}  // namespace
}  // namespace softgauss::test
