// SPDX-License-Identifier: Apache-2.0
/// gdd_benchmark: the paper's two tables (section VI), made as the paper made them.
///
/// A scripted operator drags segments of the humanoid and of the hand about; the run is recorded
/// (dataset.hpp), then replayed offline by every solver (replay.hpp). Same seed, same figures, but
/// for the clock's. Exit codes: 0 done; 1 a state became non-finite; 2 bad usage or input;
/// 130 interrupted, with the tables of what was done.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/gdd_benchmark/kink_picture.hpp"
#include "apps/gdd_benchmark/report.hpp"
#include "apps/gdd_benchmark/states.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace {

using namespace softgauss;

struct BenchmarkOptions {
  int records = 20000, passes = 5;
  std::uint64_t seed = 1;
  std::vector<double> weights = {100.0};
  std::vector<std::string> models = app::robotNames();
  std::vector<std::string> solvers = app::solverNames();
  std::string recorder = app::solverNames().front();
  std::string file, states, kink, robots = "data/robots";
  int stateCount = 70;
};

void addOptions(CLI::App& parser, BenchmarkOptions& options) {
  parser.add_option("--records", options.records, "steps recorded of each model")
      ->check(CLI::Range(1, 10000000));
  parser
      .add_option("--weight", options.weights,
                  "weight of the reach goals [kg], default 100; repeatable. For the humanoid; the "
                  "hand's is less by the ratio of their masses")
      ->check(CLI::NonNegativeNumber & CLI::Number);
  parser.add_option("--seed", options.seed, "of the operator");
  parser.add_option("--passes", options.passes, "replays; times are medians over them")
      ->check(CLI::Range(1, 1000));
  parser.add_option("--models", options.models, "those that are dragged about, default all")
      ->check(CLI::IsMember(app::robotNames()))
      ->delimiter(',');
  parser.add_option("--solvers", options.solvers, "those that replay the records, default all")
      ->check(CLI::IsMember(app::solverNames()))
      ->delimiter(',');
  parser.add_option("--record-with", options.recorder, "the solver of the recorded run")
      ->check(CLI::IsMember(app::solverNames()));
  parser.add_option("--json", options.file, "write the figures to this file too");
  CLI::Option* states =
      parser
          .add_option("--states", options.states,
                      "write recorded states with contacts to this folder, <model>_<weight>.json")
          ->check(CLI::ExistingDirectory);
  parser.add_option("--state-count", options.stateCount, "how many states a file, default 70")
      ->check(CLI::Range(1, 1000000))
      ->needs(states);
  parser
      .add_option("--kink", options.kink,
                  "draw the sharpest kink of the run to this .svg file with gnuplot "
                  "(docs/benchmarks/gdd_evidence.md) "
                  "and replay nothing; of one model and one weight")
      ->excludes("--json");
  parser.add_option("--robots", options.robots, "folder of humanoid.urdf and hand.urdf")
      ->check(CLI::ExistingDirectory);
  parser.set_version_flag("--version", std::string("softgauss ") + SOFTGAUSS_VERSION);
}

/// All solvers solve one problem: with solver 1 among them, that of its soft contacts.
std::uint8_t markFor(const BenchmarkOptions& options) {
  std::vector<std::string> used = options.solvers;
  used.push_back(options.recorder);
  const bool squares = std::find(used.begin(), used.end(), app::kAugmentedLagrangian) != used.end();
  return squares ? kControlledSoft : kControlled;
}

nlohmann::ordered_json runAll(const BenchmarkOptions& options) {
  nlohmann::ordered_json json = {{"version", SOFTGAUSS_VERSION},
                                 {"seed", options.seed},
                                 {"datasets", nlohmann::ordered_json::array()}};
  for (const std::string& name : options.models)
    for (const double weight : options.weights) {
      if (app::interrupted()) return json;
      const auto robot = app::loadRobot(options.robots, name, markFor(options));
      const auto recorder = app::makeSolver(options.recorder, robot->model);
      app::Dataset dataset;
      {
        app::Progress progress(fmt::format("{}, weight {:g}: recording", name, weight));
        dataset =
            app::recordRun(*robot, *recorder, options.records, weight, options.seed, progress);
      }
      if (!options.states.empty())
        app::writeStates(*robot, dataset, weight, options.stateCount, options.states);
      if (!options.kink.empty()) {
        app::drawKink(*robot, dataset, options.kink);
        continue;
      }
      app::Progress progress(fmt::format("{}, weight {:g}: replaying", name, weight));
      const app::Replay replay =
          app::replay(*robot, dataset, options.solvers, options.passes, progress);
      progress.clear();
      fmt::print("{}\n", app::tables(*robot, dataset, replay));
      std::fflush(stdout);
      json["datasets"].push_back(app::figures(*robot, dataset, replay));
    }
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App parser("The tables of the paper on goal directed dynamics, measured here.");
  BenchmarkOptions options;
  addOptions(parser, options);
  try {
    parser.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return parser.exit(success);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "gdd_benchmark: {}\ngdd_benchmark --help lists the options\n", error.what());
    return 2;
  }
  if (!options.kink.empty() && options.models.size() * options.weights.size() != 1) {
    fmt::print(stderr,
               "gdd_benchmark: --kink draws one run; choose one of --models, one --weight\n");
    return 2;
  }
  if (!options.kink.empty() && !io::hasGnuplot()) {
    fmt::print(stderr, "gdd_benchmark: --kink: {}\n", io::kNoGnuplot);
    return 2;
  }
  try {
    std::ofstream file;
    if (!options.file.empty()) {
      file.open(options.file);
      if (!file) {
        fmt::print(stderr, "gdd_benchmark: --json {}: cannot be written\n", options.file);
        return 2;
      }
    }
    app::catchInterrupts();
    const nlohmann::ordered_json json = runAll(options);
    if (file.is_open() && !(file << json.dump(2) << std::endl)) {
      fmt::print(stderr, "gdd_benchmark: --json {}: cannot be written\n", options.file);
      return 2;
    }
  } catch (const ModelError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "gdd_benchmark: {}\n", error.what());
    return 1;
  }
  return app::interrupted() ? 130 : 0;
}
