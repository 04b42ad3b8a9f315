// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a person at a terminal sees and may do while a benchmark runs.

#include <string>

#include "apps/shared/interrupt.hpp"

namespace softgauss::app {

/// "████░░░░" of a share from 0 to 1, 32 characters.
std::string progressBar(double share);

/// One line on stderr, on a terminal only.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// Redraws at each per cent.
  void show(long done, long all);
  void clear();

 private:
  std::string what_;
  bool visible_;
  long percent_ = -1;
};

}  // namespace softgauss::app
