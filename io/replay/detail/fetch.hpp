// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace softgauss::io::detail {

/// Reserves room for `count` more values and touches it, so that the system hands out the pages now
/// and not one by one while a simulation runs.
template <class T>
void fetch(std::vector<T>& values, std::size_t count) {
  const std::size_t size = values.size();
  values.resize(size + count);
  values.resize(size);
}

}  // namespace softgauss::io::detail
