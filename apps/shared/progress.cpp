// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace softgauss::app {

std::string progressBar(double share) {
  constexpr int kWidth = 32;
  const int filled = static_cast<int>(share * kWidth);
  std::string bar;
  for (int i = 0; i < kWidth; ++i) bar += i < filled ? "█" : "░";
  return bar;
}

Progress::Progress(std::string what) : what_(std::move(what)), visible_(isatty(fileno(stderr))) {}

void Progress::clear() {
  if (visible_ && percent_ >= 0) fmt::print(stderr, "\r\033[K");
  percent_ = -1;
}

void Progress::show(long done, long all) {
  const long percent = 100 * done / all;
  if (!visible_ || percent == percent_) return;
  percent_ = percent;
  fmt::print(stderr, "\r{}: {} %\033[K", what_, percent);
  std::fflush(stderr);
}

}  // namespace softgauss::app
