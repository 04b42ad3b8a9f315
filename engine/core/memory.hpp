// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Heap memory that containers hold, for reports.

#include <cstddef>
#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss {

/// [bytes], whether in use or kept for later.
template <class T>
std::size_t bytesOf(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}
inline std::size_t bytesOf(const std::vector<bool>& v) { return v.capacity() / 8; }
inline std::size_t bytesOf(const VectorX& x) {
  return static_cast<std::size_t>(x.size()) * sizeof(double);
}

/// The sum over several.
template <class... Containers>
std::size_t bytesOfAll(const Containers&... containers) {
  return (std::size_t{0} + ... + bytesOf(containers));
}

}  // namespace softgauss
