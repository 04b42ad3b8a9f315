// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which runs are still to be done, and which are in somebody's hands.

#include <mutex>
#include <vector>

#include "apps/simulate_batch/run_table.hpp"

namespace softgauss::app {

class HandOut {
 public:
  explicit HandOut(RunTable& table) : table_(table), waiting_(table.missing()) {}

  /// A share of what is waiting for one of `workers` threads, smaller towards the end, `threads` at
  /// least; when nothing waits, a share of what others have in hand. Empty when all is done.
  std::vector<long> take(int threads, int workers);
  /// Takes a row into the table.
  void add(RunRow row);
  bool isDone();
  long done();

 private:
  std::mutex mutex_;
  RunTable& table_;
  std::vector<long> waiting_;
  std::size_t next_ = 0;  ///< of waiting_
  std::size_t again_ = 0;
};

}  // namespace softgauss::app
