// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What other studies report of their own scenes, by their own formulas.

#include "apps/rivals/judge/measures.hpp"

namespace rivals {

/// What SimBenchmark's bouncing reports: the mean square of what the energy is off, of a start at
/// rest [J²].
Measures measureElastic(const Scene& scene, const Trajectory& run);

/// What SimBenchmark's rolling reports: the mean square of what the velocities of box and first
/// ball are off [m²/s²]. The first body, a box, is pushed along the ground and carries n balls,
/// that roll on it at 2/7 of its acceleration: M a = F − μ (M + n m) g − 2/7 n m a.
Measures measurePushed(const Scene& scene, const Trajectory& run);

}  // namespace rivals
