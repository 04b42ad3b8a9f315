// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which of its rows a kind walks: all, or those of one island (tree_islands.hpp).

#include "softgauss/engine/core/segment.hpp"

namespace softgauss {

class RowSelection {
 public:
  /// All of `rows` rows.
  void reset(std::size_t rows) {
    all_ = {0, static_cast<int>(rows)};
    island_ = -1;
    islands_.reserve(0, rows);
  }
  /// Finds which rows are whose: islandOf(row) is the island of each, of `islands`, which are never
  /// more than `most`.
  template <class IslandOf>
  void divide(int islands, std::size_t most, IslandOf&& islandOf) {
    islands_.reserve(most, 0);
    islands_.divide(all_, islands, islandOf);
  }
  /// Of those that divide() has found; −1: all.
  void select(int island) { island_ = island; }

  /// The rows that are walked, ascending.
  Segments segments() const { return island_ < 0 ? Segments(&all_, 1) : islands_[island_]; }
  bool has(int row) const {
    for (const Segment s : segments())
      if (s.begin <= row && row < s.end) return true;
    return false;
  }
  int count() const {
    int rows = 0;
    for (const Segment s : segments()) rows += s.end - s.begin;
    return rows;
  }
  /// f(row), a std::size_t.
  template <class F>
  void forEach(F&& f) const {
    for (const Segment s : segments())
      for (std::size_t row = idx(s.begin); row < idx(s.end); ++row) f(row);
  }
  std::size_t bytes() const { return islands_.bytes(); }

 private:
  Segment all_;
  int island_ = -1;
  SegmentSets islands_;
};

}  // namespace softgauss
