// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How much fuzz tests do.

#include <cstdlib>

namespace softgauss::io {

/// SOFTGAUSS_FUZZ, which `./dev test --fuzz` sets: so many times as many mutated files. 1 without
/// it.
inline int fuzzScale() {
  const char* text = std::getenv("SOFTGAUSS_FUZZ");
  return text ? std::atoi(text) : 1;
}

}  // namespace softgauss::io
