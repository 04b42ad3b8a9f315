// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Vectors in the recorded JSON.

#include <nlohmann/json.hpp>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::test {

using Json = nlohmann::json;

inline VectorX vectorOf(const Json& list) {
  VectorX x(static_cast<Eigen::Index>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) x[static_cast<Eigen::Index>(i)] = list[i];
  return x;
}

}  // namespace softgauss::test
