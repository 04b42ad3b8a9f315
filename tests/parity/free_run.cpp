// SPDX-License-Identifier: Apache-2.0
#include "tests/parity/free_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/parity/comparison.hpp"

namespace softgauss::test {

std::vector<double> runBeside(const ReferenceTrajectory& reference, Scene& scene, Random random,
                              double rounding) {
  const int stride = static_cast<int>(std::lround(reference.every / reference.timestep));
  scene.state.q = reference.q[0];
  scene.state.v = reference.v[0];
  scene.state.warmstart.valid = scene.state.hasAcceleration = false;
  scene.state.q += rounding * scene.state.q.cwiseProduct(random.vector(scene.model.nq, 1.0));
  scene.state.v += rounding * random.vector(scene.model.nv, 1.0);
  std::vector<double> differences;
  for (std::size_t i = 0; i < reference.q.size(); ++i) {
    differences.push_back(
        stateDifference(scene.model, scene.state.q, scene.state.v, reference.q[i], reference.v[i]));
    for (int k = 0; k < stride; ++k) EXPECT_EQ(scene.step(), SolveStatus::converged);
  }
  return differences;
}

double medianDifference(const ReferenceTrajectory& reference, Scene& scene) {
  std::array<double, 5> worst;
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const std::vector<double> run = runBeside(reference, scene, Random(i), 1e-15);
    worst[i] = *std::max_element(run.begin(), run.end());
  }
  std::sort(worst.begin(), worst.end());
  return worst[2];
}

}  // namespace softgauss::test
