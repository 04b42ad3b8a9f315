// SPDX-License-Identifier: Apache-2.0
#include "apps/live/rewind.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::live {

Rewind::Rewind(const State& initial, double timestep)
    : initial_(initial), every_(std::max(1L, std::lround(kSpacing / timestep))), ring_(kMost) {}

void Rewind::observe(const State& state, long instant) {
  if (instant % every_ != 0) return;
  if (count_ == kMost) {
    first_ = (first_ + 1) % kMost;
    --count_;
  }
  Kept& kept = at(count_++);
  kept.state = state;
  kept.instant = instant;
}

Rewind::Place Rewind::back(const State& state, double seconds) {
  constexpr double kRounding = 1e-9;  // [s]
  const double sought = state.time - seconds + kRounding;
  while (count_ > 1 && at(count_ - 1).state.time > sought) --count_;
  if (count_ == 0) return {&initial_, 0};
  const Kept& found = at(count_ - 1);
  // Before the oldest there is the start, as long as nothing was dropped.
  if (found.state.time > sought && found.instant <= every_) return reset();
  return {&found.state, found.instant};
}

Rewind::Place Rewind::reset() {
  count_ = 0;
  return {&initial_, 0};
}

}  // namespace softgauss::live
