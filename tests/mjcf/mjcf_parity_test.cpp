// SPDX-License-Identifier: Apache-2.0
/// Files of our own, each with a feature of MJCF, beside what MuJoCo 3.12.1 makes of them.
///
/// compare_mjcf tests/mjcf/files --record tests/mjcf/recorded has recorded the numbers: masses, and
/// in ten states of which some are beyond limits M, bias, passive forces, accelerations without
/// contacts, and what each actuator can do.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "apps/compare_mjcf/record.hpp"

namespace softgauss::test {
namespace {

const std::filesystem::path kFolder = std::filesystem::path(SOFTGAUSS_SOURCE_DIR) / "tests/mjcf";

/// Rounding of two solvers that have converged; the largest seen is 7e-13.
constexpr double kSame = 1e-10;

std::vector<std::string> names() {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder / "files"))
    if (entry.path().extension() == ".xml") found.push_back(entry.path().stem().string());
  std::sort(found.begin(), found.end());
  return found;
}

class MjcfParity : public testing::TestWithParam<std::string> {};

TEST_P(MjcfParity, NumbersAreMujocos) {
  const app::MjcfNumbers recorded = app::readRecord(kFolder / "recorded" / (GetParam() + ".json"));
  ASSERT_EQ(recorded.states.size(), 10u);
  const app::MjcfNumbers own =
      app::ownNumbers(kFolder / "files" / (GetParam() + ".xml"), recorded.states);
  for (const app::MjcfDifference& d : app::differences(own, recorded))
    EXPECT_LE(d.size, kSame) << d.what;
}

INSTANTIATE_TEST_SUITE_P(Files, MjcfParity, testing::ValuesIn(names()),
                         [](const auto& test) { return test.param; });

// The comparison sees what differs.
TEST(MjcfParity, OfAnotherMassIsSeen) {
  const app::MjcfNumbers recorded = app::readRecord(kFolder / "recorded/geom_masses.json");
  app::MjcfNumbers other = app::ownNumbers(kFolder / "files/geom_masses.xml", recorded.states);
  other.states[3].M(0, 0) *= 1.0 + 1e-8;
  other.bodyMasses[1] += 1e-8;
  int seen = 0;
  for (const app::MjcfDifference& d : app::differences(other, recorded)) seen += d.size > kSame;
  EXPECT_EQ(seen, 2);
}

}  // namespace
}  // namespace softgauss::test
