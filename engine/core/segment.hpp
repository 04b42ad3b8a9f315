// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Half-open ranges of indices, and several sets of such.

#include <cstdint>
#include <span>
#include <vector>

#include "softgauss/engine/core/index.hpp"

namespace softgauss {

/// [begin, end), of columns, dofs, bodies or rows.
struct Segment {
  int begin = 0;
  int end = 0;
  bool operator==(const Segment&) const = default;
};

using Segments = std::span<const Segment>;

/// The segments of each of several sets, in one array.
class SegmentSets {
 public:
  /// Begins anew; keeps the memory.
  void clear() {
    segments_.clear();
    first_.assign(1, 0);
  }
  void reserve(int sets, int segments) {
    first_.reserve(idx(sets) + 1);
    segments_.reserve(idx(segments));
  }
  /// Adds a segment to the set that is open; one that begins where the last ends goes on with it.
  void add(Segment segment) {
    if (static_cast<int>(segments_.size()) > first_.back() && segments_.back().end == segment.begin)
      segments_.back().end = segment.end;
    else
      segments_.push_back(segment);
  }
  /// Ends the set that is open.
  void close() { first_.push_back(static_cast<int>(segments_.size())); }
  int size() const { return static_cast<int>(first_.size()) - 1; }
  Segments operator[](int set) const {
    return Segments(segments_).subspan(idx(first_[idx(set)]),
                                       idx(first_[idx(set + 1)] - first_[idx(set)]));
  }

 private:
  std::vector<Segment> segments_;
  std::vector<int> first_{0};
};

}  // namespace softgauss
