// SPDX-License-Identifier: Apache-2.0
/// Bodies on a surface of triangles: the same bits on repeated runs and on every thread.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "softgauss/engine/engine.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/simulation/data_file.hpp"

namespace softgauss::test {
namespace {

std::uint64_t afterASecond(bool throughFcl) {
  SimulationOptions options;
  options.throughFcl = throughFcl;
  Simulation sim = Simulation::load(sceneFile("landscape"), options);
  sim.run(1.0);
  return hash(sim.state());
}

}  // namespace

TEST(SurfaceBits, AreTheSameOnRepeatedRunsAndThreads) {
  for (const bool throughFcl : {false, true}) {
    const std::uint64_t alone = afterASecond(throughFcl);
    EXPECT_EQ(afterASecond(throughFcl), alone);
    std::vector<std::uint64_t> found(4);
    std::vector<std::thread> threads;
    for (std::uint64_t& bits : found)
      threads.emplace_back([&bits, throughFcl] { bits = afterASecond(throughFcl); });
    for (std::thread& thread : threads) thread.join();
    for (const std::uint64_t bits : found) EXPECT_EQ(bits, alone);
  }
}

}  // namespace softgauss::test
