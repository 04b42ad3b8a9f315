// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How fast motions part: what becomes of a small difference, d(t₂)/d(t₁).
///
/// Two motions of a problem, their velocities 1e-9 apart at the start, by our default with steps of
/// 0.25 ms; d is the root mean square over links of how far their poses are apart. The numerical
/// error of a run grows like d. Where d grows a thousandfold in the whole motion, whole motions can
/// not be compared, and where it does in a window, windows neither.

#include <filesystem>

#include "apps/accuracy_cost/problem.hpp"

namespace softgauss::app {

struct Divergence {
  double whole = 0.0;   ///< largest d(t)/d(kPeriod), t up to the end of the motion
  double window = 0.0;  ///< largest d(t + window)/d(t)
};

Divergence measureDivergence(const Problem& problem);

/// Prints that of each problem, and writes divergence.csv.
void writeDivergences(const std::filesystem::path& folder, const std::vector<Problem>& problems);

}  // namespace softgauss::app
