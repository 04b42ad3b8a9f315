// SPDX-License-Identifier: Apache-2.0
/// plan_benchmark: tasks of planning from random starts, AILQR beside phase F alone and beside iLQR
/// over controls with a careful line search, all on the same engine with the same costs.
///
/// Costs and figures are the same for the same seed, but for the clock's. Exit codes: 0 done; 2 bad
/// usage or input; 130 interrupted, with the tables of what was done.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/plan_benchmark/trials.hpp"
#include "apps/shared/interrupt.hpp"
#include "apps/shared/standard_streams.hpp"
#include "softgauss/engine/core/check.hpp"

namespace {

using namespace softgauss;
using app::PlanMethod;

constexpr PlanMethod kMethods[] = {PlanMethod::ailqr, PlanMethod::feasible, PlanMethod::ilqr};

nlohmann::ordered_json json(const std::vector<app::PlanTrials>& all) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const app::PlanTrials& t : all) {
    nlohmann::ordered_json trials = nlohmann::ordered_json::array();
    for (const app::PlanTrial& trial : t.trials)
      trials.push_back({{"cost", trial.cost},
                        {"root_force", trial.rootForce},
                        {"gap", trial.gap},
                        {"iterations", trial.iterations},
                        {"seconds", trial.seconds},
                        {"status", trial.status}});
    out.push_back({{"task", t.task},
                   {"method", app::planMethodName(t.method)},
                   {"dof", t.dofs},
                   {"knots", t.knots},
                   {"phase_i_iteration_s", t.iteration},
                   {"trials", trials}});
  }
  return out;
}

int run(int argc, char** argv) {
  CLI::App parser{
      "Tasks of planning from random starts, by AILQR, by its phase F alone and by iLQR"};
  std::vector<std::string> tasks, methods;
  for (const PlanMethod method : kMethods) methods.push_back(app::planMethodName(method));
  const std::vector<std::string> known = methods;
  app::TrialChoice choice;
  std::string file;
  parser.add_option("TASK", tasks, "scene files with a plan, data/plans/*.yaml")
      ->required()
      ->check(CLI::ExistingFile);
  parser.add_option("--starts", choice.starts, "random starts of each")
      ->check(CLI::Range(1, 10000));
  parser.add_option("--seed", choice.seed, "of the first start");
  parser.add_option("--iterations", choice.iterations, "of phase F alone and of iLQR, at most")
      ->check(CLI::Range(1, 100000));
  parser.add_option("--methods", methods, "default all")
      ->check(CLI::IsMember(known))
      ->delimiter(',');
  parser.add_option("--json", file, "write every trial to this file too");
  CLI11_PARSE(parser, argc, argv);
  app::catchInterrupts();
  std::vector<app::PlanTrials> all;
  for (const std::string& task : tasks)
    for (const PlanMethod method : kMethods)
      if (std::find(methods.begin(), methods.end(), app::planMethodName(method)) != methods.end() &&
          !app::interrupted())
        all.push_back(app::runTrials(task, method, choice));
  app::print(stdout, app::planTables(all));
  if (!file.empty() && !(std::ofstream(file) << json(all).dump(1) << '\n')) {
    app::tell("plan_benchmark: " + file + " cannot be written");
    return 2;
  }
  return app::interrupted() ? 130 : app::finishStandardOutput("plan_benchmark");
}

}  // namespace

int main(int argc, char** argv) {
  softgauss::app::prepareStreams();
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    softgauss::app::tell(std::string("plan_benchmark: ") + e.what());
    return 2;
  }
}
