// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which of its rows a kind walks: all, or those of one island (tree_islands.hpp).

#include <vector>

#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/core/segment.hpp"

namespace softgauss {

class RowSelection {
 public:
  /// All of `rows` rows.
  void reset(std::size_t rows) {
    all_ = {0, static_cast<int>(rows)};
    island_ = -1;
    runs_.reserve(rows);
    sorted_.reserve(rows);
  }
  /// Finds which rows are whose: islandOf(row) is the island of each, of `islands`, which are never
  /// more than `most`.
  template <class IslandOf>
  void divide(int islands, std::size_t most, IslandOf&& islandOf) {
    runs_.clear();
    end_.reserve(most);
    end_.assign(idx(islands), 0);
    for (int row = 0; row < all_.end; ++row) {
      const int island = islandOf(row);
      if (runs_.empty() || runs_.back().island != island) {
        runs_.push_back({island, {row, row}});
        ++end_[idx(island)];
      }
      ++runs_.back().rows.end;
    }
    // Where each island's runs begin, which becomes where they end as they are put there.
    int before = 0;
    for (int& end : end_) {
      const int count = end;
      end = before;
      before += count;
    }
    sorted_.resize(runs_.size());
    for (const Run& run : runs_) sorted_[idx(end_[idx(run.island)]++)] = run.rows;
  }
  void selectAll() { island_ = -1; }
  /// Of those that divide() has found.
  void select(int island) { island_ = island; }

  /// The rows that are walked, ascending.
  Segments segments() const {
    if (island_ < 0) return {&all_, 1};
    const int begin = island_ == 0 ? 0 : end_[idx(island_ - 1)];
    return Segments(sorted_).subspan(idx(begin), idx(end_[idx(island_)] - begin));
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
  std::size_t bytes() const { return bytesOfAll(runs_, sorted_, end_); }

 private:
  struct Run {
    int island = 0;
    Segment rows;
  };
  Segment all_;
  int island_ = -1;
  std::vector<Run> runs_;        ///< neighbours of one island, ascending
  std::vector<Segment> sorted_;  ///< the same, by island
  std::vector<int> end_;         ///< (islands) where those of each end in sorted_
};

}  // namespace softgauss
