// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a person at a terminal sees and may do while the benchmark runs.

#include <string>

namespace softgauss::app {

/// From here on a first SIGINT or SIGTERM asks the run to end in order; a second one ends it.
void catchInterrupts();
bool interrupted();

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
