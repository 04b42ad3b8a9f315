// SPDX-License-Identifier: Apache-2.0
/// simulate_gdd: moves a URDF robot to its goals. Options and exit codes: simulate_gdd --help-all
/// and docs/reference/command_line.md.

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "apps/shared/standard_streams.hpp"
#include "apps/simulate_gdd/accuracy.hpp"
#include "apps/simulate_gdd/plan_run.hpp"
#include "apps/simulate_gdd/run.hpp"

namespace softgauss::app {
namespace {

/// Loads the scene and does with it what is asked for.
int runOnce(SimulateOptions& options) {
  const auto scene = loadScene(options);
  std::FILE* const report = options.writesToStandardOutput() ? stderr : stdout;
  if (!options.quiet)
    for (const std::string& note : scene->notes) print(report, note + "\n");
  if (options.plan || options.mpc) readPlan(options, *scene);
  if (options.explain) {
    print(report, explainScene(*scene));
    if (options.planControl) print(report, explainPlan(*options.planControl));
    return kDone;
  }
  if (options.accuracy) {
    const std::string choice = chooseAccuracy(options, *scene);
    if (!options.quiet) print(report, choice + "\n");
  }
  if (options.planControl) {
    if (!makePlan(options)) {
      tell("simulate_gdd: interrupted while it planned: nothing was run");
      return kInterrupted;
    }
    if (!options.quiet) print(report, planText(*options.planControl));
  }
  return run(options, *scene);
}

int runProgram(int argc, char** argv) {
  try {
    auto options = parseCommandLine(argc, argv);
    if (!options) return kDone;
    int code = runOnce(*options);
    while (options->live && std::exchange(options->live->reload, false)) code = runOnce(*options);
    return code;
  } catch (const UsageError& error) {
    tell(fmt::format(
        "simulate_gdd: {}\nsimulate_gdd --help shows how to begin, --help-all all options",
        error.what()));
    return kBadInput;
  } catch (const OutputError& error) {
    tell(fmt::format("simulate_gdd: {}", error.what()));
    return kBadInput;
  } catch (const AccuracyError& error) {
    tell(fmt::format("simulate_gdd: {}", error.what()));
    return kBadInput;
  } catch (const ModelError& error) {
    tell(error.what());
    return kBadInput;
  } catch (const PlanError& error) {
    tell(fmt::format("simulate_gdd: {}", error.what()));
    return kCannotContinue;
  } catch (const std::exception& error) {
    tell(fmt::format("simulate_gdd: internal error: {}", error.what()));
    return kInternalError;
  }
}

}  // namespace
}  // namespace softgauss::app

int main(int argc, char** argv) {
  using namespace softgauss;
  app::prepareStreams();
  const int code = app::runProgram(argc, argv);
  const int output = app::finishStandardOutput("simulate_gdd");
  return code != app::kDone ? code : output;
}
