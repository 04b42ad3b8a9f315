// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/progress.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace softgauss::app {
namespace {

volatile sig_atomic_t interruptRequested = 0;

}  // namespace

void catchInterrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { interruptRequested = 1; };
  action.sa_flags = SA_RESETHAND;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return interruptRequested != 0; }

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
