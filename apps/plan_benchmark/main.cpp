// SPDX-License-Identifier: Apache-2.0
/// plan_benchmark: tasks of planning from random starts, AILQR beside phase F alone and beside iLQR
/// over controls with a careful line search, all on the same engine with the same costs; with
/// --mpc, plans that are made anew while the robot is pushed; with --act, plans acted out by three
/// laws of control.
///
/// Costs and figures are the same for the same seed, but for the clock's. Exit codes: 0 done; 2 bad
/// usage or input; 130 interrupted, with the tables of what was done.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/plan_benchmark/acting.hpp"
#include "apps/plan_benchmark/receding.hpp"
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
                        {"status", trial.status},
                        {"curve", trial.curve}});
    out.push_back({{"task", t.task},
                   {"method", app::planMethodName(t.method)},
                   {"dof", t.dofs},
                   {"knots", t.knots},
                   {"phase_i_iteration_s", t.iteration},
                   {"trials", trials}});
  }
  return out;
}

nlohmann::ordered_json json(const std::vector<app::RecedingRuns>& all) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const app::RecedingRuns& r : all) {
    nlohmann::ordered_json runs = nlohmann::ordered_json::array();
    for (const app::RecedingRun& run : r.runs)
      runs.push_back({{"carried_out", run.carriedOut},
                      {"final_planned", run.planned},
                      {"final", run.final},
                      {"failed_ticks", run.failedTicks}});
    out.push_back({{"task", r.task}, {"dof", r.dofs}, {"runs", runs}});
  }
  return out;
}

nlohmann::ordered_json json(const std::vector<app::ActingRuns>& all) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const app::ActingRuns& r : all)
    out.push_back({{"task", r.task},
                   {"law", app::actingLawName(r.law)},
                   {"planned", r.planned},
                   {"undisturbed", r.undisturbed},
                   {"carried_out", r.carriedOut},
                   {"costs", r.costs}});
  return out;
}

struct Choice {
  std::vector<std::string> tasks, methods;
  app::TrialChoice trials;
  app::RecedingChoice receding;
  app::ActingChoice acting;
  std::string file, picture;
};

nlohmann::ordered_json plan(const Choice& choice) {
  const auto chosen = [&](PlanMethod method) {
    return std::find(choice.methods.begin(), choice.methods.end(), app::planMethodName(method)) !=
           choice.methods.end();
  };
  std::vector<app::PlanTrials> all;
  for (const std::string& task : choice.tasks)
    for (const PlanMethod method : kMethods)
      if (chosen(method) && !app::interrupted())
        all.push_back(app::runTrials(task, method, choice.trials));
  app::print(stdout, app::planTables(all));
  if (!choice.picture.empty()) app::drawCurves(all, choice.picture);
  return json(all);
}

nlohmann::ordered_json recede(const Choice& choice) {
  std::vector<app::RecedingRuns> all;
  for (const std::string& task : choice.tasks)
    if (!app::interrupted()) all.push_back(app::runReceding(task, choice.receding));
  app::print(stdout, app::recedingTable(all, choice.receding));
  return json(all);
}

nlohmann::ordered_json act(const Choice& choice) {
  std::vector<app::ActingRuns> all;
  for (const std::string& task : choice.tasks)
    for (app::ActingRuns& runs : app::runActing(task, choice.acting)) all.push_back(runs);
  app::print(stdout, app::actingTable(all));
  return json(all);
}

int run(int argc, char** argv) {
  CLI::App parser{
      "Tasks of planning from random starts, by AILQR, by its phase F alone and by iLQR; or, with "
      "--mpc, planned anew while the robot is disturbed; or, with --act, acted out by goal "
      "directed "
      "dynamics, by the plan's feedback and by springs"};
  Choice choice;
  for (const PlanMethod method : kMethods) choice.methods.push_back(app::planMethodName(method));
  const std::vector<std::string> known = choice.methods;
  bool recedes = false, acts = false;
  parser.add_option("TASK", choice.tasks, "scene files with a plan, data/plans/*.yaml")
      ->required()
      ->check(CLI::ExistingFile);
  parser.add_option("--starts", choice.trials.starts, "random starts of each")
      ->check(CLI::Range(1, 10000));
  parser.add_option("--seed", choice.trials.seed, "of the first start, or run");
  parser
      .add_option("--iterations", choice.trials.iterations, "of phase F alone and of iLQR, at most")
      ->check(CLI::Range(1, 100000));
  parser.add_option("--methods", choice.methods, "default all")
      ->check(CLI::IsMember(known))
      ->delimiter(',');
  int threads = 1;
  CLI::Option* over = parser.add_option("--threads", threads, "over which the knots of a plan go")
                          ->check(CLI::Range(1, 1024));
  CLI::Option* mpc =
      parser.add_flag("--mpc", recedes, "plans that recede while something disturbs");
  CLI::Option* acting = parser.add_flag("--act", acts, "plans acted out by three laws of control")
                            ->excludes(mpc)
                            ->excludes(over);
  int runs = 0;
  parser.add_option("--runs", runs, "of each task: by --mpc 20, by --act 8 with each law")
      ->check(CLI::Range(1, 10000));
  parser.add_option("--push", choice.receding.push, "of what floats, in 0.1 s [m/s]")
      ->needs(mpc)
      ->check(CLI::Range(0.0, 100.0));
  parser.add_option("--timestep", choice.receding.timestep, "of the simulator [s]")
      ->needs(mpc)
      ->check(CLI::Range(1e-5, 0.1));
  parser.add_option("--picture", choice.picture, "draw cost over iterations, as SVG")
      ->excludes(mpc)
      ->excludes(acting);
  parser.add_option("--json", choice.file, "write every trial to this file too");
  CLI11_PARSE(parser, argc, argv);
  app::catchInterrupts();
  choice.receding.threads = choice.trials.threads = threads;
  choice.receding.seed = choice.acting.seed = choice.trials.seed;
  if (runs > 0 && !recedes && !acts) {
    app::tell("plan_benchmark: --runs is of --mpc or --act, expected one of them");
    return 2;
  }
  if (runs > 0) choice.receding.runs = choice.acting.runs = runs;
  const nlohmann::ordered_json all = recedes ? recede(choice) : acts ? act(choice) : plan(choice);
  if (!choice.file.empty() && !(std::ofstream(choice.file) << all.dump(1) << '\n')) {
    app::tell("plan_benchmark: " + choice.file + " cannot be written");
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
