// SPDX-License-Identifier: Apache-2.0
/// What a run says of knees that were straight at its start.

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

// A place that it can but fall to. What has fallen of itself is told nothing of its knees.
TEST(Knees, ThatWereStraightAreToldWhereARobotThatWasToReachFell) {
  const std::string humanoid = dataFile("robots/humanoid.urdf");
  const Outcome fell = simulate(
      {humanoid, "--reach", "right_hand=1.2,-0.3,0.3@1e5", "--no-balance", "--duration", "5"});
  EXPECT_EQ(fell.exitCode, 0) << fell.err;
  ASSERT_NE(fell.out.find("fell:"), std::string::npos) << fell.out;
  const std::size_t knees = fell.out.find("knees:");
  ASSERT_NE(knees, std::string::npos) << fell.out;
  const std::string line = fell.out.substr(knees, fell.out.find('\n', knees) - knees);
  for (const char* word : {"straight at the start", "left_knee", "right_knee", "--q0"})
    EXPECT_NE(line.find(word), std::string::npos) << line;
  const Outcome passive = simulate({humanoid, "--passive", "--duration", "2"});
  EXPECT_NE(passive.out.find("fell:"), std::string::npos) << passive.out;
  EXPECT_EQ(passive.out.find("knees:"), std::string::npos) << passive.out;
}

}  // namespace
}  // namespace softgauss::test
