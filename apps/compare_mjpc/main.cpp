// SPDX-License-Identifier: Apache-2.0
/// compare_mjpc: tasks of planning from no guess, by AILQR as simulate_gdd --plan has it and by the
/// iLQG of MuJoCo MPC, on MuJoCo's model of the same robot with the same costs, each on one core.
///
/// Exit codes: 0 done; 2 bad usage or input; 130 interrupted, with the table of what was done.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/compare_mjpc/plan_race.hpp"
#include "apps/shared/interrupt.hpp"
#include "apps/shared/standard_streams.hpp"

namespace {

using namespace softgauss;

nlohmann::ordered_json json(const std::vector<app::PlanRace>& races) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const app::PlanRace& r : races)
    out.push_back({{"task", r.task},
                   {"dof", r.dofs},
                   {"knots", r.knots},
                   {"ours", r.ours.points},
                   {"ilqg", r.ilqg.points},
                   {"ilqg_ends", r.ends},
                   {"scale", r.settings.scale},
                   {"regularises_value", r.settings.ofValue},
                   {"planning_contacts_first", r.softFirst},
                   {"ilqg_from_ours", r.ilqgFromOurs},
                   {"ours_from_ilqg", r.oursFromIlqg},
                   {"cost_difference", r.difference}});
  return out;
}

int run(int argc, char** argv) {
  CLI::App parser{
      "Tasks of planning from no guess, by AILQR and by the iLQG of MuJoCo MPC, each on one core"};
  std::vector<std::string> tasks;
  app::PlanRaceChoice choice;
  std::string file;
  parser.add_option("TASK", tasks, "scene files with a plan, data/plans/*.yaml")
      ->required()
      ->check(CLI::ExistingFile);
  parser.add_option("--repeats", choice.repeats, "of either; the least times count; default 5")
      ->check(CLI::Range(1, 1000));
  parser
      .add_option("--iterations", choice.iterations,
                  "of iLQG at most, on each of the contacts; default 2000")
      ->check(CLI::Range(1, 100000));
  bool byDefault = false;
  parser.add_flag("--default-contacts", byDefault,
                  "MuJoCo's default softness in place of that which is nearest to ours");
  parser.add_option("--json", file, "write costs over time to this file too");
  CLI11_PARSE(parser, argc, argv);
  if (byDefault) choice.softness = app::UngivenSoftness::mujocoDefault;
  app::catchInterrupts();
  std::vector<app::PlanRace> races;
  for (const std::string& task : tasks)
    if (!app::interrupted()) races.push_back(app::racePlans(task, choice));
  app::print(stdout, "MuJoCo " + app::mujocoVersion() + "\n" + app::planRaceTable(races));
  if (!file.empty() && !(std::ofstream(file) << json(races).dump(1) << '\n')) {
    app::tell("compare_mjpc: " + file + " cannot be written");
    return 2;
  }
  return app::interrupted() ? 130 : app::finishStandardOutput("compare_mjpc");
}

}  // namespace

int main(int argc, char** argv) {
  softgauss::app::prepareStreams();
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    softgauss::app::tell(std::string("compare_mjpc: ") + e.what());
    return 2;
  }
}
