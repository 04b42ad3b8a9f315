// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/hand_out.hpp"

#include <algorithm>

namespace softgauss::app {

std::vector<long> HandOut::take(int threads, int workers) {
  const std::lock_guard lock(mutex_);
  const std::size_t left = waiting_.size() - next_;
  const auto least = static_cast<std::size_t>(threads);
  std::size_t size = std::max(least, left * least / (4 * static_cast<std::size_t>(workers)));
  std::vector<long> share;
  for (; size > 0 && next_ < waiting_.size(); --size, ++next_)
    if (!table_.has(waiting_[next_])) share.push_back(waiting_[next_]);
  // Nothing waits: what somebody has in hand, each time beginning elsewhere.
  for (std::size_t seen = 0; share.empty() && seen < waiting_.size(); ++seen) {
    const long run = waiting_[again_++ % waiting_.size()];
    if (!table_.has(run)) share.push_back(run);
  }
  return share;
}

void HandOut::add(RunRow row) {
  const std::lock_guard lock(mutex_);
  table_.add(std::move(row));
}

bool HandOut::isDone() {
  const std::lock_guard lock(mutex_);
  return table_.done() == table_.runs();
}

long HandOut::done() {
  const std::lock_guard lock(mutex_);
  return table_.done();
}

}  // namespace softgauss::app
