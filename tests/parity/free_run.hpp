// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Free runs beside those of a log.

#include <vector>

#include "tests/parity/reference_log.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {

/// How far a run from where MuJoCo's began is from it, at the times of the log. `rounding`: of its
/// start, relative.
std::vector<double> runBeside(const ReferenceTrajectory& reference, Scene& scene, Random random,
                              double rounding);

/// Which corners of what lands flat touch first is decided by rounding: the largest difference of
/// the median of five starts that differ by some.
double medianDifference(const ReferenceTrajectory& reference, Scene& scene);

}  // namespace softgauss::test
