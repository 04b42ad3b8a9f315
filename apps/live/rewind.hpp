// SPDX-License-Identifier: Apache-2.0
#pragma once

/// States of the last half minute, to go back to. A ring: its memory is fetched once.

#include <vector>

#include "softgauss/engine/model/state.hpp"

namespace softgauss::live {

class Rewind {
 public:
  /// `initial` is there for ever.
  Rewind(const State& initial, double timestep);

  /// The state after so many steps since the start, counted without what was undone.
  void observe(const State& state, long instant);

  struct Place {
    const State* state;
    long instant;
  };
  /// The newest place that lies at least `seconds` before `state`, or the oldest that is kept. What
  /// comes later is forgotten.
  Place back(const State& state, double seconds);
  /// The start; all is forgotten.
  Place reset();

  static constexpr double kSpacing = 0.1;  ///< from place to place [s]
  static constexpr int kMost = 300;

 private:
  struct Kept {
    State state;
    long instant = 0;
  };
  Kept& at(int k) { return ring_[static_cast<std::size_t>((first_ + k) % kMost)]; }

  State initial_;
  long every_;  ///< steps
  std::vector<Kept> ring_;
  int first_ = 0, count_ = 0;
};

}  // namespace softgauss::live
