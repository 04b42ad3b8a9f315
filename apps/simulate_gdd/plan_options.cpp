// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/plan_options.hpp"

#include <fmt/format.h>

#include "softgauss/io/inputs.hpp"

namespace softgauss::app {
namespace {

/// What a run by a plan cannot have beside it, and why.
constexpr std::pair<const char*, const char*> kNotBeside[] = {
    {"--reach", "the plan is the goal"},
    {"--hold", "the plan is the goal"},
    {"--posture", "the plan is the goal"},
    {"--goals", "the plan is the goal"},
    {"--torques", "the plan is the goal"},
    {"--passive", "the plan is the goal"},
    {"--control-cost", "the plan has its own, plan.effort"},
    {"--sleep", "a plan is of the whole scene"},
    {"--checkpoint", "a plan is no part of a checkpoint"},
    {"--resume", "a plan is no part of a checkpoint"},
    {"--accuracy", "its trials would plan again and again"}};

}  // namespace

void addPlanOptions(CLI::App& app, SimulateOptions& options) {
  const char* const group = "Goals";
  app.add_flag("--plan", options.plan,
               "plan the motion that the scene's key plan asks for, then act it out")
      ->group(group);
  app.add_flag("--mpc", options.mpc,
               "the same, planned anew from the present state 50 times a second, or as often as\n"
               "plan.mpc.rate says (receding horizon)")
      ->group(group);
  app.add_option("--threads", options.planThreads,
                 "over which --plan and --mpc plan, with the same result for any number; default 1")
      ->check(CLI::Range(1, 1024))
      ->group(group);
}

void finishPlanOptions(const CLI::App& app, SimulateOptions& options) {
  options.hasDuration = app.count("--duration") > 0;
  if (!options.plan && !options.mpc) {
    if (app.count("--threads") > 0)
      throw UsageError("--threads: nothing is planned, expected --plan or --mpc beside it");
    return;
  }
  const char* const asked = options.plan ? "--plan" : "--mpc";
  if (options.plan && options.mpc) throw UsageError("choose one of --plan and --mpc");
  for (const auto& [option, why] : kNotBeside)
    if (app.count(option) > 0)
      throw UsageError(fmt::format("{}: {}, expected no {}", asked, why, option));
  if (!options.isScene())
    throw UsageError(fmt::format(
        "{}: found '{}', expected a scene (.yaml) with a key plan, such as data/plans/acrobot.yaml",
        asked, options.model.string()));
  if (options.model == io::kStandardInput)
    throw UsageError(fmt::format("{}: found standard input, expected the name of a scene", asked));
}

}  // namespace softgauss::app
