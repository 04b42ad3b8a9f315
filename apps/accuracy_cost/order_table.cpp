// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/order_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace softgauss::app {
namespace {

constexpr double kRounding = 1e-13;                     // of poses within some metres [m]
constexpr double kTurn = 0.5;                           // of the error of a shorter step
constexpr std::size_t kFewest = 4;                      // step sizes
constexpr double kSolverStep = kPeriod / kSolverSteps;  // [s]

std::optional<double> slope(const std::vector<std::pair<double, double>>& points) {
  if (points.size() < kFewest) return std::nullopt;
  const auto n = static_cast<double>(points.size());
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const auto& [h, e] : points) {
    const double a = std::log(h), b = std::log(e);
    x += a / n, y += b / n, xx += a * a / n, xy += a * b / n;
  }
  return (xy - x * y) / (xx - x * x);
}

/// One whole solve a step, with all defaults but the integrator.
bool isPlain(const Method& m) {
  return m.integrationTolerance == 0.0 && !m.doubling && !m.variesSolver();
}

// Methods as they are, and with another solver, start or cone.
bool isLeapfrog(const Method& m) {
  return m.engine == "softgauss" && m.integrator == "leapfrog" && !m.doubling;
}
bool isMidpoint(const Method& m) { return m.integrator == "implicit-midpoint"; }
bool isDormandPrince(const Method& m) {
  return m.integrator == "dormand-prince" && m.integrationTolerance == 1e-8;
}
bool isMujocoEuler(const Method& m) { return m.engine == "mujoco" && m.integrator == "Euler"; }

std::vector<Result> curveOf(const std::vector<Result>& results, const std::string& problem,
                            const Method& method) {
  std::vector<Result> curve;
  for (const Result& r : results)
    if (r.problem == problem && r.method == method) curve.push_back(r);
  return curve;
}

std::vector<Method> methodsOf(const std::vector<Result>& results, bool (*wanted)(const Method&)) {
  std::vector<Method> methods;
  for (const Result& r : results)
    if (wanted(r.method) && std::find(methods.begin(), methods.end(), r.method) == methods.end())
      methods.push_back(r.method);
  return methods;
}

std::string heading(const std::string& first, const std::vector<Method>& methods) {
  std::string text = "| " + first + " |", line = "|---|";
  for (const Method& method : methods) {
    text += " " + method.label + " |";
    line += "---|";
  }
  return text + "\n" + line + "\n";
}

/// A row for each problem of a kind; empty where there is none.
std::string orders(const std::string& what, const std::vector<Problem>& problems, bool contact,
                   const std::vector<Result>& results,
                   std::optional<double> (*order)(const std::vector<Result>&)) {
  const std::vector<Method> methods = methodsOf(results, isPlain);
  std::string rows;
  for (const Problem& problem : problems) {
    if (problem.contact != contact) continue;
    std::string row;
    bool any = false;
    for (const Method& method : methods) {
      const std::vector<Result> curve = curveOf(results, problem.name, method);
      any = any || !curve.empty();
      const std::optional<double> p = order(curve);
      row += p ? fmt::format(" {:.1f} |", *p) : " – |";
    }
    if (any) rows += fmt::format("| {} |{}\n", problem.name, row);
  }
  return rows.empty() ? rows : heading(what, methods) + rows + "\n";
}

/// "2.7e-4 m, 0.75": the time is over that of the first column, which has its own.
std::string solverCell(const std::vector<Result>& curve, const Result* first) {
  for (const Result& r : curve) {
    if (std::abs(r.h - kSolverStep) > 1e-9 || !std::isfinite(r.error)) continue;
    return first ? fmt::format(" {:.1e} m, {:.2f} |", r.error, r.time / first->time)
                 : fmt::format(" {:.1e} m, {:.2g} s per s |", r.error, r.time);
  }
  return " – |";
}

std::string solverTable(const std::vector<Problem>& problems, const std::vector<Result>& results,
                        bool (*wanted)(const Method&)) {
  std::vector<Method> methods = methodsOf(results, wanted);
  std::stable_partition(methods.begin(), methods.end(),
                        [](const Method& m) { return !m.variesSolver(); });
  std::string rows;
  for (const Problem& problem : problems) {
    if (!problem.contact || methods.empty()) continue;
    const std::vector<Result> plain = curveOf(results, problem.name, methods.front());
    const auto first = std::find_if(plain.begin(), plain.end(), [](const Result& r) {
      return std::abs(r.h - kSolverStep) < 1e-9 && std::isfinite(r.error);
    });
    if (first == plain.end()) continue;
    rows += "| " + problem.name + " |";
    for (std::size_t k = 0; k < methods.size(); ++k)
      rows += solverCell(curveOf(results, problem.name, methods[k]), k == 0 ? nullptr : &*first);
    rows += "\n";
  }
  return rows.empty() ? rows : heading("at 2 ms", methods) + rows + "\n";
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  if (!(out << text << std::flush)) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

std::optional<double> orderOf(const std::vector<Result>& curve) {
  std::vector<std::pair<double, double>> points;
  for (const Result& r : curve)
    if (std::isfinite(r.error) && r.error > kRounding && tells(r.referenceError, r.error))
      points.emplace_back(r.h, r.error);
  return slope(points);
}

std::optional<double> orderBelowTheTurnOf(const std::vector<Result>& curve) {
  std::vector<Result> rising = curve;
  std::sort(rising.begin(), rising.end(),
            [](const Result& a, const Result& b) { return a.h < b.h; });
  const auto turn =
      std::adjacent_find(rising.begin(), rising.end(), [](const Result& a, const Result& b) {
        return tells(b.referenceError, b.error) && b.error < kTurn * a.error;
      });
  if (turn != rising.end()) rising.erase(turn + 1, rising.end());
  return orderOf(rising);
}

std::optional<double> oneStepOrderOf(const std::vector<Result>& curve) {
  std::vector<std::pair<double, double>> points;
  for (const Result& r : curve)
    if (std::isfinite(r.oneStep) && r.oneStep > kRounding) points.emplace_back(r.h, r.oneStep);
  return slope(points);
}

void writeOrderTables(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                      const std::vector<Result>& results) {
  write(folder / "accuracy_orders.md",
        orders("order of a whole motion", problems, false, results, orderBelowTheTurnOf) +
            orders("order within the windows", problems, true, results, orderOf) +
            orders("order of one step", problems, true, results, oneStepOrderOf));
  std::string solver;
  for (const auto wanted : {isLeapfrog, isMidpoint, isDormandPrince, isMujocoEuler})
    solver += solverTable(problems, results, wanted);
  write(folder / "accuracy_solver.md", solver);
}

}  // namespace softgauss::app
