// SPDX-License-Identifier: Apache-2.0
#pragma once
/// The project counts with int, as Eigen and its users do; containers index with std::size_t.

#include <cstddef>

namespace softgauss {

/// `i` [≥ 0] as an index of a container.
constexpr std::size_t idx(int i) { return static_cast<std::size_t>(i); }

}  // namespace softgauss
