// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/ratio_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "apps/accuracy_cost/best.hpp"

namespace softgauss::app {
namespace {

std::string cells(const Best& best, double error) {
  if (best.result)
    return fmt::format("{}, {:.3g} ms | {:.2g}", best.result->method.label, 1e3 * best.result->h,
                       best.result->time);
  if (std::isinf(best.referenceError)) return "not there | ";
  if (tells(best.referenceError, error)) return "not reached | ";
  return fmt::format("not resolved: its references differ by {:.1g} m | ", best.referenceError);
}

}  // namespace

void writeRatioTable(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                     const std::vector<Result>& results) {
  std::string text =
      "| scene | error at most | ours | s per s | MuJoCo's | s per s | ours over MuJoCo's |\n"
      "|---|---|---|---|---|---|---|\n";
  int rows = 0, slower = 0, compared = 0;
  for (const Problem& problem : problems) {
    if (std::none_of(results.begin(), results.end(),
                     [&](const Result& r) { return r.problem == problem.name; }))
      continue;
    for (const double error : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      const Best ours = bestOf(results, problem.name, error, "softgauss");
      const Best theirs = bestOf(results, problem.name, error, "mujoco");
      std::string ratio;
      if (ours.result && theirs.result) {
        ++compared;
        const double r = ours.result->time / theirs.result->time;
        ratio = r > 1.0 ? fmt::format("🔴 **{:.2f}**: MuJoCo's is {:.2f} times as fast", r, r)
                        : fmt::format("{:.2f}", r);
      } else if (theirs.result && tells(ours.referenceError, error)) {
        ratio = "🔴 MuJoCo's alone";
      }
      ++rows;
      slower += ratio.find("🔴") != std::string::npos;
      text += fmt::format("| {} | {:g} m | {} | {} | {} |\n", problem.name, error,
                          cells(ours, error), cells(theirs, error), ratio);
    }
  }
  text += fmt::format("\n{} of {} rows are red; {} compare two times.\n", slower, rows, compared);
  for (const Result& r : results)
    if (std::isnan(r.error))
      text += fmt::format("\nGiven up, for it takes too long: {}, {}, {:.3g} ms.\n", r.problem,
                          r.method.label, 1e3 * r.h);
  std::ofstream out(folder / "accuracy_table.md");
  if (!(out << text << std::flush))
    throw std::runtime_error("cannot write " + (folder / "accuracy_table.md").string());
}

}  // namespace softgauss::app
