// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Half-open ranges of indices, and several sets of such.

#include <cstddef>
#include <span>
#include <vector>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/core/memory.hpp"

namespace softgauss {

/// [begin, end), of columns, dofs, bodies or rows.
struct Segment {
  int begin = 0;
  int end = 0;
  bool operator==(const Segment&) const = default;
};

using Segments = std::span<const Segment>;

/// A range of indices that is divided into sets, of each its segments, ascending.
class SegmentSets {
 public:
  void reserve(std::size_t sets, std::size_t segments) {
    end_.reserve(sets);
    runs_.reserve(segments);
    segments_.reserve(segments);
  }
  /// Divides it into so many sets: setOf(i) is that of each index, −1: it is of none.
  template <class SetOf>
  void divide(Segment range, int sets, SetOf&& setOf) {
    runs_.clear();
    end_.assign(idx(sets), 0);
    for (int i = range.begin; i < range.end; ++i) {
      const int set = setOf(i);
      if (set < 0) continue;
      if (runs_.empty() || runs_.back().set != set || runs_.back().segment.end != i) {
        runs_.push_back({set, {i, i}});
        ++end_[idx(set)];
      }
      ++runs_.back().segment.end;
    }
    // Where the segments of each begin, which becomes where they end as they are put there.
    int before = 0;
    for (int& end : end_) {
      const int count = end;
      end = before;
      before += count;
    }
    segments_.resize(runs_.size());
    for (const Run& run : runs_) segments_[idx(end_[idx(run.set)]++)] = run.segment;
  }
  int size() const { return static_cast<int>(end_.size()); }
  Segments operator[](int set) const {
    const int begin = set == 0 ? 0 : end_[idx(set - 1)];
    return Segments(segments_).subspan(idx(begin), idx(end_[idx(set)] - begin));
  }
  bool has(int set, int index) const {
    for (const Segment s : (*this)[set])
      if (s.begin <= index && index < s.end) return true;
    return false;
  }
  std::size_t bytes() const { return bytesOfAll(runs_, segments_, end_); }

 private:
  struct Run {
    int set = 0;
    Segment segment;
  };
  std::vector<Run> runs_;          ///< neighbours of one set, ascending
  std::vector<Segment> segments_;  ///< the same, by set
  std::vector<int> end_;           ///< (sets) where those of each end in segments_
};

}  // namespace softgauss
