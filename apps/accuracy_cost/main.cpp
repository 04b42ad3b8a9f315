// SPDX-License-Identifier: Apache-2.0
/// accuracy_cost: what accuracy costs in time.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "apps/accuracy_cost/divergence.hpp"
#include "apps/accuracy_cost/drift.hpp"
#include "apps/accuracy_cost/order_table.hpp"
#include "apps/accuracy_cost/own_model.hpp"
#include "apps/accuracy_cost/pictures.hpp"
#include "apps/accuracy_cost/ratio_table.hpp"
#include "apps/accuracy_cost/study.hpp"
#include "apps/accuracy_cost/table.hpp"
#include "apps/accuracy_cost/verify_accuracy.hpp"
#include "apps/shared/progress.hpp"
#include "apps/shared/run_choice.hpp"

namespace softgauss::app {
namespace {

struct Arguments {
  std::vector<std::string> scenes;
  std::string out = "accuracy", robots = "data/robots";
  int mostSteps = kMostSteps;  ///< in a period
  bool runs = false;           ///< as users run them, beside a finer search
  StudyOptions study;
  OwnModel own;
};

std::string figure(double x) {
  if (std::isnan(x)) return "given up";
  return std::isfinite(x) ? fmt::format("{:.3g}", x) : "not finite";
}

void print(const Problem& problem, const std::vector<Result>& results) {
  fmt::print("\n{}: {}\n{:<40} {:>10} {:>10} {:>11} {:>10} {:>10} {:>10} {:>12}\n", problem.name,
             problem.title, "", "step [ms]", "error [m]", "angle [rad]", "energy", "momentum",
             "s per s", "one step [m]");
  for (const Result& r : results) {
    if (r.problem != problem.name) continue;
    fmt::print("{:<40} {:>10.4g} {:>10} {:>11} {:>10} {:>10} {:>10} {:>12}\n", r.method.label,
               1e3 * r.h, figure(r.error), figure(r.orientation),
               problem.passive ? figure(r.energyDrift) : "-", figure(r.momentumDrift),
               figure(r.time), problem.contact ? figure(r.oneStep) : "-");
  }
}

/// How many steps a period takes, the most first: halved, or by 4/3 and 3/2 in turn.
std::vector<int> stepCounts(int most, int fewest, bool fine) {
  std::vector<int> counts;
  for (int steps = most; steps >= fewest; steps /= 2) {
    counts.push_back(steps);
    if (fine && steps >= 4 && 3 * steps / 4 >= fewest) counts.push_back(3 * steps / 4);
  }
  return counts;
}

/// All step sizes of all methods of a problem that the table does not have yet.
void run(const Problem& problem, const Arguments& arguments, ResultTable& table) {
  Study study(problem, arguments.study);
  const std::vector<Method> methods = arguments.runs ? fineMethods() : methodsFor(problem);
  Progress progress(problem.name);
  long done = 0;
  const double most = mostTime(problem, arguments.study);
  const int fewest = problem.contact ? kFewestContactSteps : kFewestSteps;
  const std::vector<int> counts = stepCounts(arguments.mostSteps, fewest, arguments.runs);
  const auto all = static_cast<long>(counts.size() * methods.size());
  const std::vector<Method> variants =
      arguments.runs ? std::vector<Method>() : solverVariants(problem);
  for (const int steps : counts) {
    const double h = kPeriod / steps;
    std::vector<Result> results;
    std::vector<Method> here = methods;
    if (steps == kSolverSteps) here.insert(here.end(), variants.begin(), variants.end());
    for (const Method& method : here) {
      progress.show(done++, all);
      if (interrupted()) return;
      if (table.has(problem.name, method, h, most)) continue;
      const bool prepared = study.prepare(method);
      if (interrupted()) return;
      if (!prepared) {
        progress.clear();
        fmt::print("{}: the reference of '{}' is not finite\n", problem.name, method.label);
        continue;
      }
      results.push_back(study.measure(method, h));
    }
    study.measureTimes(results);
    if (interrupted()) return;  // the last of them is cut
    for (const Result& result : results) table.add(result);
  }
}

/// The problems that are named, or all. Throws std::runtime_error.
std::vector<Problem> builtIn(const Arguments& arguments) {
  std::vector<Problem> all = allProblems(arguments.robots);
  if (arguments.scenes.empty()) return all;
  const auto isNamed = [&](const Problem& p) {
    return std::find(arguments.scenes.begin(), arguments.scenes.end(), p.name) !=
           arguments.scenes.end();
  };
  for (const std::string& name : arguments.scenes)
    if (std::none_of(all.begin(), all.end(), [&](const Problem& p) { return p.name == name; }))
      throw std::runtime_error(fmt::format("no problem '{}'; --list names them", name));
  std::erase_if(all, [&](const Problem& p) { return !isNamed(p); });
  return all;
}

/// The user's model, and prints what is left out of it. Throws ModelError.
std::vector<Problem> ownModel(const OwnModel& own, bool drift) {
  const OwnProblem made = ownProblem(own);
  for (const std::string& note : made.notes) fmt::print("{}: {}\n", own.file.string(), note);
  if (drift && !made.problem.lossless)
    throw ModelError({own.file.string(), 0}, "--drift",
                     "the model has joint damping, dry friction, joint limits or shapes that may "
                     "touch, expected one that nothing brakes");
  return {made.problem};
}

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("What accuracy costs in time: error against CPU time per simulated second.");
  app.set_version_flag("--version", SOFTGAUSS_VERSION);
  CLI::Option* const own =
      app.add_option("MODEL", arguments.own.file,
                     "a .urdf file or a .yaml scene (docs/reference/scenes.md): it is the problem, "
                     "passive, in the place\n"
                     "of the built-in ones; begins anew where it was interrupted");
  std::string base;
  app.add_option("--base", base,
                 "of a URDF: fixed or floating; default: floating, or fixed when the root link is "
                 "'world'")
      ->check(CLI::IsMember({"fixed", "floating"}));
  app.add_option(
         "--ground", arguments.own.ground,
         "of a URDF: height of the ground plane [m] or none; default: 0 for a floating base")
      ->check(CLI::Range(-1e6, 1e6) | CLI::IsMember({"none"}));
  app.add_option("--package-path", arguments.own.packagePaths,
                 "where package://NAME/… is looked for first; repeatable")
      ->type_name("DIR");
  for (const char* option : {"--base", "--ground", "--package-path"})
    app.get_option(option)->needs(own);
  app.add_option("--scene", arguments.scenes, "problems to run, default all; repeatable")
      ->type_name("NAME");
  app.add_option("--out", arguments.out,
                 "folder of the table, the pictures and the page; a run that was interrupted goes "
                 "on there")
      ->type_name("DIR");
  app.add_option("--robots", arguments.robots, "folder of arm.urdf, hand.urdf, humanoid.urdf")
      ->type_name("DIR");
  app.add_option("--repeats", arguments.study.repeats,
                 "how often each time is measured anew, the least counts; 0: the first run counts")
      ->check(CLI::Range(0, 100));
  app.add_option("--min-time", arguments.study.minTime,
                 "CPU time that each measurement takes at least [s]")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--most-steps", arguments.mostSteps,
                 "the shortest step is 32 ms over this, a power of two")
      ->check(CLI::IsMember({1, 2, 4, 8, 16, 32, 64, 128, 256}))
      ->capture_default_str();
  app.add_option(
         "--most-seconds", arguments.study.mostSeconds,
         "CPU time that a setting may take for one run of a problem, else it is given up [s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  bool list = false, drift = false, divergence = false, verifying = false;
  app.add_flag("--drift", drift,
               "instead: energy and momentum over 10 s at 2 ms, every integrator;\n"
               "begins anew where it was interrupted");
  app.add_flag("--divergence", divergence,
               "instead: growth of a small difference, a measure of chaos;\n"
               "begins anew where it was interrupted");
  CLI::Option* const verifyFlag = app.add_flag(
      "--verify-accuracy", verifying,
      "and then: choose a setting for accuracies of 1e-2 … 1e-6 m on each problem, as\n"
      "simulate_gdd --accuracy does, and check its true error and its time; exit code 1\n"
      "where less than 95 % of them are within the accuracy and 1.5 times the best time;\n"
      "these cases begin anew where they were interrupted");
  std::optional<double> seconds;
  app.add_option("--seconds", seconds,
                 "whole motions of so long, those with contact too, instead of windows of 1 s [s]")
      ->check(CLI::Range(0.032, 1000.0));
  double wholeSeconds = kTrialCpuSeconds;
  app.add_option("--trial-seconds", wholeSeconds,
                 "with --verify-accuracy: CPU time that a trial of a whole motion may take; 0: "
                 "each is tried\n"
                 "on its first 2 s [s]")
      ->check(CLI::NonNegativeNumber)
      ->needs(verifyFlag)
      ->capture_default_str();
  CLI::Option* const runsFlag =
      app.add_flag(
             "--runs", arguments.runs,
             "with --verify-accuracy: simulate_gdd --accuracy itself, on whole motions, those "
             "with\n"
             "contact of 1 s; ours alone, and the search is finer: tolerances by half decades,\n"
             "steps by 4/3 and 3/2 in turn. The table is runs.csv")
          ->needs(verifyFlag)
          ->excludes(own);
  app.add_flag("--list", list, "name the problems and end");
  // What they would not look at.
  for (const char* other :
       {"--repeats", "--min-time", "--most-steps", "--most-seconds", "--verify-accuracy"})
    for (const char* instead : {"--drift", "--divergence"})
      app.get_option(instead)->excludes(app.get_option(other));
  runsFlag->excludes(app.get_option("--trial-seconds"));
  for (const char* other : {"--scene", "--robots", "--list"}) own->excludes(app.get_option(other));
  app.get_option("--drift")->excludes(app.get_option("--divergence"));
  app.get_option("--drift")->excludes(app.get_option("--seconds"));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "accuracy_cost: {}\naccuracy_cost --help lists the options\n", error.what());
    return 2;
  }
  arguments.own.base = base == "fixed"      ? BaseKind::fixed
                       : base == "floating" ? BaseKind::floating
                                            : BaseKind::automatic;

  try {
    std::vector<Problem> problems =
        own->empty() ? builtIn(arguments) : ownModel(arguments.own, drift);
    if (list) {
      for (const Problem& p : problems) fmt::print("{:<22} {}\n", p.name, p.title);
      return 0;
    }
    if (arguments.runs) std::erase_if(problems, [](const Problem& p) { return p.chaotic; });
    for (Problem& problem : problems) {
      if (seconds || (arguments.runs && problem.contact))
        problem = lasting(std::move(problem), seconds.value_or(1.0));
      problem.softFriction = !arguments.runs;
    }
    catchInterrupts();
    std::filesystem::create_directories(arguments.out);
    if (drift) {
      measureDrifts(arguments.out, problems);
      return interrupted() ? 130 : 0;
    }
    if (divergence) {
      writeDivergences(arguments.out, problems);
      return interrupted() ? 130 : 0;
    }
    // The file of a model may have changed since, or be another one of that name.
    ResultTable table(
        std::filesystem::path(arguments.out) / (arguments.runs ? "runs.csv" : "accuracy_cost.csv"),
        own->empty() ? "" : problems.front().name);
    for (const Problem& problem : problems) {
      run(problem, arguments, table);
      if (!arguments.runs) print(problem, table.results());
      if (interrupted()) break;
    }
    if (!arguments.runs) {
      writePictures(arguments.out, problems, table.results());
      writeRatioTable(arguments.out, problems, table.results());
      writeOrderTables(arguments.out, problems, table.results());
    }
    const bool kept = !verifying || interrupted() ||
                      verifyAccuracy(arguments.out, problems, table.results(), arguments.study,
                                     wholeSeconds, arguments.runs);
    return interrupted() ? 130 : kept ? 0 : 1;
  } catch (const ModelError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const std::exception& e) {
    fmt::print(stderr, "accuracy_cost: {}\n", e.what());
    return 2;
  }
}

}  // namespace
}  // namespace softgauss::app

int main(int argc, char** argv) { return softgauss::app::main(argc, argv); }
