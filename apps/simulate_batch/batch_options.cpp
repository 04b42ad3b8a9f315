// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/batch_options.hpp"

#include <CLI/CLI.hpp>

#include "apps/simulate_gdd/command_line.hpp"

namespace softgauss::app {

std::optional<BatchOptions> parseBatchCommandLine(int argc, char** argv) {
  BatchOptions options;
  CLI::App app(
      "Runs a sweep: a scene or URDF many times with other parameters, starts, goals and seeds, "
      "on\n"
      "all cores, or on many machines under mpirun. The results are the same bits either way.");
  app.set_version_flag("--version", std::string("softgauss ") + SOFTGAUSS_VERSION);
  app.add_option("SWEEP", options.sweep, "a .yaml sweep, see docs/reference/batch.md")->required();
  app.add_option("--threads", options.threads,
                 "threads of each process; default: as many as the machine has, 1 under mpirun")
      ->check(CLI::Range(1, 4096));
  app.add_option("--out", options.out,
                 "folder of runs.csv, summary.json and histograms.svg; default: the sweep's name, "
                 "here");
  app.add_flag("--checkpoint", options.checkpoint,
               "keep what is done in the folder as it comes; the same command again goes on there");
  app.add_option("--only", options.only, "repeat this run alone, and write nothing but its --view")
      ->check(CLI::Range(0L, 10000000L));
  app.add_option("--view", options.view, "a page that replays the run of --only (.html)");
  app.add_flag("--quiet", options.quiet, "print errors only");
  if (!parses(app, argc, argv)) return std::nullopt;
  if (!options.view.empty() && !options.only)
    throw UsageError("--view is of one run, expected --only RUN beside it");
  if (options.out.empty()) options.out = options.sweep.stem();
  return options;
}

}  // namespace softgauss::app
