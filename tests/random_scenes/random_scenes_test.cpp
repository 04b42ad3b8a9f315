// SPDX-License-Identifier: Apache-2.0
/// Small random scenes, with numbers that no user means among them, against the laws of the step:
/// those of tests/fuzz/fuzz_step.cpp, here from seeds and at full speed.

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/random_scenes/finding.hpp"
#include "tests/random_scenes/hold_scene.hpp"

namespace softgauss::fuzz {
namespace {

struct Count {
  int held = 0, passive = 0, singular = 0, refused = 0;
};

/// The scenes of these seeds.
Count hold(std::uint32_t first, std::uint32_t count) {
  Count found;
  for (std::uint32_t seed = first; seed < first + count; ++seed) {
    std::array<std::uint8_t, 4> bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<std::uint8_t>(seed >> (8 * i));
    // Two bytes decide whether there are odd numbers, and a generator that the bytes seed the rest.
    std::swap(bytes[0], bytes[1]);
    try {
      const auto scene = decodeScene(bytes.data(), bytes.size());
      if (!scene) {
        ++found.singular;
        continue;
      }
      ++found.held;
      found.passive += scene->passive;
      holdScene(*scene);
    } catch (const ModelError&) {
      ++found.refused;
    } catch (const Finding& finding) {
      ADD_FAILURE() << "seed " << seed << ": " << finding.what();
    }
  }
  return found;
}

void expectMany(const Count& found, int count) {
  EXPECT_GT(found.held, count / 2);
  EXPECT_GT(found.passive, count / 10);
  EXPECT_GT(found.refused, count / 50);
}

TEST(RandomScenes, KeepTheLawsOfTheStep) { expectMany(hold(0, 100), 100); }

class RandomScenesLong : public testing::TestWithParam<std::uint32_t> {};

TEST_P(RandomScenesLong, KeepTheLawsOfTheStep) { expectMany(hold(GetParam(), 10000), 10000); }

INSTANTIATE_TEST_SUITE_P(Seeds, RandomScenesLong,
                         testing::Range(std::uint32_t{100}, std::uint32_t{100100},
                                        std::uint32_t{10000}));

}  // namespace
}  // namespace softgauss::fuzz
