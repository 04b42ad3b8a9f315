// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Disjoint sets (Tarjan 1975). The name of a set is its smallest member, so that names do not
/// depend on the order of the unions.

#include <numeric>
#include <utility>
#include <vector>

namespace softgauss {

class UnionFind {
 public:
  explicit UnionFind(int count = 0) { reset(count); }
  /// Every member alone.
  void reset(int count) {
    parent_.resize(static_cast<std::size_t>(count));
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent(i) != i) i = parent(i) = parent(parent(i));
    return i;
  }
  void unite(int i, int j) {
    i = find(i), j = find(j);
    if (j < i) std::swap(i, j);
    parent(j) = i;
  }

 private:
  int& parent(int i) { return parent_[static_cast<std::size_t>(i)]; }
  std::vector<int> parent_;
};

}  // namespace softgauss
