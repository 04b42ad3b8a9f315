// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace softgauss::app {
namespace {

/// What the paper reports, 50 % (95 %); times are means of a step [µs] on a 4 GHz i7-6700K.
struct Paper {
  const char *constraints, *iterations, *dualUpdates, *violation, *gradient;
  double forward, goalDirected, both;
};
constexpr Paper kHumanoid = {"23 (38)",     "4 (9)", "1 (1)", "3e-11 (6e-7)",
                             "1e-7 (1e-6)", 49,      90,      99};
constexpr Paper kHand = {"19 (30)", "5 (9)", "1 (3)", "2e-8 (5e-7)", "1e-9 (8e-9)", 128, 182, 194};

/// Lines of a label, one column a solver, and the paper's.
class Table {
 public:
  void line(const std::string& label, const std::vector<std::string>& cells,
            const std::string& paper) {
    text_ += fmt::format("  {:<42}", label);
    for (const std::string& cell : cells) text_ += fmt::format("{:<22}", cell);
    text_ += paper + "\n";
  }
  void title(const std::string& text) { text_ += text + "\n"; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string counts(const Spread& s) { return fmt::format("{:.0f} ({:.0f})", s.p50, s.p95); }
std::string sizes(const Spread& s) { return fmt::format("{:.1e} ({:.1e})", s.p50, s.p95); }
std::string times(const Spread& s) { return fmt::format("{:.1f} ({:.1f})", s.mean, s.p50); }
std::string share(double x) { return fmt::format("{:.2f} %", 100.0 * x); }

std::vector<double> sum(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> total(a);
  for (std::size_t i = 0; i < a.size(); ++i) total[i] += b[i];
  return total;
}

/// Of a replay, whoever solved.
struct Common {
  Spread rows, stages, forwardSolve, forwardStep, forwardIterations;

  explicit Common(const Replay& r)
      : rows(Spread::of({r.rows.begin(), r.rows.end()})),
        stages(Spread::of(r.stagesUs)),
        forwardSolve(Spread::of(r.forwardUs)),
        forwardStep(Spread::of(sum(r.stagesUs, r.forwardUs))),
        forwardIterations(Spread::of({r.forwardIterations.begin(), r.forwardIterations.end()})) {}
};

double stepRatio(const SolverStatistics& s, const Common& c) {
  return s.stepUs.mean / c.forwardStep.mean;
}
double solveRatio(const SolverStatistics& s, const Common& c) {
  return (s.solveUs.mean + s.finishUs.mean) / c.forwardSolve.mean;
}

nlohmann::ordered_json json(const Spread& s) {
  return {{"mean", s.mean}, {"p50", s.p50}, {"p95", s.p95}, {"max", s.max}};
}

}  // namespace

std::string tables(const Robot& robot, const Dataset& dataset, const Replay& replay) {
  std::string text =
      fmt::format("{}: {} records of {:g} ms, goal weight {:.3g} kg, {} goals, recorded with {}\n",
                  robot.name, replay.rows.size(), 1e3 * robot.model.options.timestep,
                  dataset.weight, dataset.goals.size(), dataset.recorder);
  if (replay.rows.empty()) return text + "  nothing was replayed\n";
  const Paper& paper = robot.name == "humanoid" ? kHumanoid : kHand;
  const Common common(replay);
  std::vector<SolverStatistics> solvers;
  std::vector<std::string> names;
  for (const Replay::Solver& s : replay.solvers) {
    solvers.emplace_back(replay, s);
    names.push_back(s.name);
  }
  const auto cells = [&](auto&& cell) {
    std::vector<std::string> row;
    for (const SolverStatistics& s : solvers) row.push_back(cell(s));
    return row;
  };
  const std::string none = "-";

  Table t;
  t.line("50 % (95 %) of the records", names, "the paper");
  t.line("constraints", cells([&](auto&) { return counts(common.rows); }), paper.constraints);
  t.line("iterations", cells([](auto& s) { return counts(s.iterations); }), paper.iterations);
  t.line("dual updates", cells([](auto& s) { return counts(s.dualUpdates); }), paper.dualUpdates);
  t.line("physics violation [N, N m]", cells([](auto& s) { return sizes(s.violation); }),
         paper.violation);
  t.line("smooth minima: iterations", cells([](auto& s) { return counts(s.smoothIterations); }),
         paper.iterations);
  t.line("smooth minima: violation", cells([](auto& s) { return sizes(s.smoothViolation); }),
         paper.violation);
  t.line("smooth minima: residual gradient", cells([](auto& s) { return sizes(s.smoothGradient); }),
         paper.gradient);
  t.line("nonsmooth minima", cells([](auto& s) { return share(s.kinks); }), none);
  t.line("certified minima", cells([](auto& s) { return share(s.certified); }), none);
  t.line("at the iteration limit", cells([](auto& s) { return fmt::format("{}", s.atLimit); }),
         none);
  t.line("iterations of the forward step after it",
         cells([](auto& s) { return counts(s.forwardIterations); }), none);

  t.title(fmt::format("  step, mean (median) of {} records [µs]; {} passes", replay.rows.size(),
                      replay.passes));
  t.line("forward", cells([&](auto&) { return times(common.forwardStep); }),
         fmt::format("{}", paper.forward));
  t.line("goal directed", cells([](auto& s) { return times(s.solveStepUs); }),
         fmt::format("{}", paper.goalDirected));
  t.line("goal directed + forward", cells([](auto& s) { return times(s.stepUs); }),
         fmt::format("{}", paper.both));
  t.line("goal directed + forward, over forward",
         cells([&](auto& s) { return fmt::format("{:.2f}", stepRatio(s, common)); }),
         fmt::format("{:.2f}", paper.both / paper.forward));
  t.title("  of it");
  t.line("stages that every solve needs", cells([&](auto&) { return times(common.stages); }), none);
  t.line("forward solve", cells([&](auto&) { return times(common.forwardSolve); }), none);
  t.line("goal directed solve", cells([](auto& s) { return times(s.solveUs); }), none);
  t.line("forward solve after it", cells([](auto& s) { return times(s.finishUs); }), none);
  t.line("goal directed + forward, over forward",
         cells([&](auto& s) { return fmt::format("{:.2f}", solveRatio(s, common)); }), none);
  text += t.text();

  for (std::size_t i = 0; i < solvers.size(); ++i)
    for (std::size_t j = i + 1; j < solvers.size(); ++j) {
      const Comparison c(replay.solvers[i].records, replay.solvers[j].records);
      text += fmt::format(
          "  objective of what acts: equal within {:g} in {} records\n"
          "    {} lower in {}, by {} of it, {:.1e} at most\n"
          "    {} lower in {}, by {} of it, {:.1e} at most\n",
          Comparison::kEqual, c.equal, names[i], c.firstBetter, sizes(c.firstBetterBy),
          c.firstBetterBy.max, names[j], c.secondBetter, sizes(c.secondBetterBy),
          c.secondBetterBy.max);
    }
  return text;
}

nlohmann::ordered_json figures(const Robot& robot, const Dataset& dataset, const Replay& replay) {
  const Common common(replay);
  nlohmann::ordered_json out = {{"model", robot.name},
                                {"goal_weight_kg", dataset.weight},
                                {"recorder", dataset.recorder},
                                {"goals", dataset.goals.size()},
                                {"records", replay.rows.size()},
                                {"passes", replay.passes},
                                {"constraints", json(common.rows)},
                                {"forward_iterations", json(common.forwardIterations)},
                                {"stages_us", json(common.stages)},
                                {"forward_solve_us", json(common.forwardSolve)},
                                {"forward_step_us", json(common.forwardStep)}};
  for (const Replay::Solver& solver : replay.solvers) {
    const SolverStatistics s(replay, solver);
    out["solvers"].push_back({{"name", solver.name},
                              {"iterations", json(s.iterations)},
                              {"dual_updates", json(s.dualUpdates)},
                              {"gdd_violation", json(s.violation)},
                              {"smooth_stationarity", json(s.smoothGradient)},
                              {"smooth_iterations", json(s.smoothIterations)},
                              {"smooth_gdd_violation", json(s.smoothViolation)},
                              {"kinks", s.kinks},
                              {"certified", s.certified},
                              {"at_iteration_limit", s.atLimit},
                              {"controls_unlike_recorded", s.unlikeRecorded},
                              {"forward_iterations", json(s.forwardIterations)},
                              {"solve_us", json(s.solveUs)},
                              {"finish_us", json(s.finishUs)},
                              {"solve_step_us", json(s.solveStepUs)},
                              {"step_us", json(s.stepUs)},
                              {"step_over_forward_step_us", stepRatio(s, common)},
                              {"solve_over_forward_solve_us", solveRatio(s, common)}});
  }
  for (std::size_t i = 0; i < replay.solvers.size(); ++i)
    for (std::size_t j = i + 1; j < replay.solvers.size(); ++j) {
      const Comparison c(replay.solvers[i].records, replay.solvers[j].records);
      out["comparisons"].push_back({{"first", replay.solvers[i].name},
                                    {"second", replay.solvers[j].name},
                                    {"equal", c.equal},
                                    {"first_lower", c.firstBetter},
                                    {"second_lower", c.secondBetter},
                                    {"first_lower_by", json(c.firstBetterBy)},
                                    {"second_lower_by", json(c.secondBetterBy)}});
    }
  return out;
}

}  // namespace softgauss::app
