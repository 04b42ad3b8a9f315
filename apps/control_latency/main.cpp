// SPDX-License-Identifier: Apache-2.0
/// control_latency: how long a control takes at most, not on average.
///
/// Closed loops: Simulation::solve(q, v) is timed, then the simulation steps. Prints median, 99,
/// 99.9 and 100 %, page faults and a histogram by powers of two. A run that begins anew starts from
/// another place, so that what meets what varies.

#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/control_latency/loops.hpp"
#include "softgauss/io/nearest_rank.hpp"
#include "softgauss/io/simulation/named_options.hpp"

namespace softgauss::app {
namespace {

struct Choice {
  std::vector<std::string> loops;
  int cycles = 20000;
  std::string budget;
  bool fifo = false, lock = false, histogram = false;
};

long pageFaults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

/// As a controller's process asks of Linux; says what it does not get.
void askForRealTime(const Choice& choice) {
  const sched_param priority{.sched_priority = 80};
  if (choice.fifo && sched_setscheduler(0, SCHED_FIFO, &priority) != 0)
    std::fputs("--fifo: SCHED_FIFO was not given (needs CAP_SYS_NICE)\n", stderr);
  if (choice.lock && mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    std::fputs("--lock: memory was not locked (needs CAP_IPC_LOCK)\n", stderr);
}

std::string histogramOf(const std::vector<double>& sorted) {
  constexpr int kWidth = 50;
  std::string out;
  for (double low = std::exp2(std::floor(std::log2(sorted.front()))); low <= sorted.back();
       low *= 2.0) {
    const auto below = [&](double x) {
      return std::lower_bound(sorted.begin(), sorted.end(), x) - sorted.begin();
    };
    const auto count = below(2.0 * low) - below(low);
    // By the logarithm, lest the few that matter are not seen.
    const double share =
        std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(sorted.size()));
    out += fmt::format("  {:>6.4g} us {:>8}  {}\n", low, count,
                       std::string(static_cast<std::size_t>(std::lround(kWidth * share)), '#'));
  }
  return out;
}

void run(const Choice& choice) {
  SimulationOptions options;
  if (!choice.budget.empty() && !setBudget(choice.budget, options))
    throw OptionError(
        fmt::format("budget {}: expected iterations, as 20, or a time, as 200us", choice.budget));
  fmt::print("{:<18}{:>8}{:>9}{:>9}{:>9}{:>9}{:>12}{:>13}{:>8}\n", "loop, times in us", "cycles",
             "50 %", "99 %", "99.9 %", "most", "budget met", "uncertified", "faults");
  askForRealTime(choice);
  for (const std::string& name : choice.loops) {
    LoopTimes times = runLoop(name, ".", options, choice.cycles, pageFaults);
    std::sort(times.us.begin(), times.us.end());
    const auto at = [&](double share) { return times.us[io::nearestRank(share, times.us.size())]; };
    fmt::print("{:<18}{:>8}{:>9.1f}{:>9.1f}{:>9.1f}{:>9.1f}{:>12}{:>13}{:>8}\n", name,
               times.us.size(), at(0.5), at(0.99), at(0.999), at(1.0), times.budgetMet,
               times.uncertified, times.counted);
    if (choice.histogram) fmt::print("{}", histogramOf(times.us));
  }
}

}  // namespace
}  // namespace softgauss::app

int main(int argc, char** argv) {
  using namespace softgauss::app;
  Choice choice;
  CLI::App app{"How long a control takes: median, 99, 99.9 and 100 % of closed loops"};
  app.add_option("LOOP", choice.loops, "which, default all")->check(CLI::IsMember(loopNames()));
  app.add_option("--cycles", choice.cycles, "of each loop, default 20000")
      ->check(CLI::Range(100, 100000000));
  app.add_option("--budget", choice.budget, "of a control: iterations, as 20, or a time, as 200us");
  app.add_flag("--fifo", choice.fifo, "asks for SCHED_FIFO");
  app.add_flag("--lock", choice.lock, "locks all memory (mlockall)");
  app.add_flag("--histogram", choice.histogram, "by powers of two, bars by the logarithm");
  CLI11_PARSE(app, argc, argv);
  if (choice.loops.empty()) choice.loops = loopNames();
  try {
    run(choice);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  return 0;
}
