// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/checkpoint_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

namespace softgauss::app {
namespace {

/// They may differ where a run is gone on with: it is the same run, longer or told otherwise.
constexpr const char* kFree[] = {"--duration", "--checkpoint", "--checkpoint-every", "--resume",
                                 "--quiet",    "--details",    "--summary"};
/// Files: what is in inputs is looked at elsewhere, and an output may have moved.
constexpr const char* kFiles[] = {"MODEL",      "--goals", "--torques", "--log",
                                  "--contacts", "--view",  "--plot",    "--view-with"};

template <std::size_t N>
bool isAmong(const char* const (&names)[N], const std::string& name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

}  // namespace

void addCheckpointOptions(CLI::App& app, SimulateOptions& options) {
  const char* const group = "Checkpoints";
  app.add_option(
         "--checkpoint", options.checkpoint,
         "write checkpoints to this file, replaced as a whole, from which --resume continues")
      ->group(group);
  app.add_option("--checkpoint-every", options.checkpointEvery,
                 "simulated time between two checkpoints [s], default 1; one more at the end")
      ->group(group);
  app.add_option("--resume", options.resume,
                 "continue from a checkpoint, bit for bit as a run without a break; give the "
                 "other\noptions as before, --duration may be longer")
      ->group(group);
}

void finishCheckpointOptions(const CLI::App& app, SimulateOptions& options) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || isAmong(kFree, name)) continue;
    options.settings.emplace_back(
        name, isAmong(kFiles, name) ? "" : fmt::format("{}", fmt::join(option->results(), " ")));
  }
  if (app.count("--checkpoint-every") > 0 && options.checkpoint.empty())
    throw UsageError("--checkpoint-every is for --checkpoint FILE, expected both");
  if (!(options.checkpointEvery > 0.0) || !std::isfinite(options.checkpointEvery))
    throw UsageError(fmt::format("--checkpoint-every {}: expected a number of seconds above 0",
                                 options.checkpointEvery));
  if (options.checkpoint.empty() && options.resume.empty()) return;
  const char* const asked = options.checkpoint.empty() ? "--resume" : "--checkpoint";
  if (options.acted())
    throw UsageError(fmt::format(
        "{}: what is done to a live run is no part of a checkpoint, expected no --live and no "
        "--play; --record keeps it, and --play does it again",
        asked));
  if (options.explain)
    throw UsageError(fmt::format("{} is for a run, expected no --explain", asked));
}

}  // namespace softgauss::app
