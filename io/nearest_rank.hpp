// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Percentiles by the nearest rank: a value that is there, none in between.

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace softgauss::io {

/// Where the percentile `share`, from 0 to 1, stands among `count` ≥ 1 ascending values, from 0.
inline std::size_t nearestRank(double share, std::size_t count) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
  return std::clamp<std::size_t>(rank, 1, count) - 1;
}

}  // namespace softgauss::io
