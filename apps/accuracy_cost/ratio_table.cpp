// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/ratio_table.hpp"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

namespace softgauss::app {
namespace {

const Result* best(const std::vector<Result>& results, const std::string& problem, double error,
                   const std::string& engine) {
  const Result* found = nullptr;
  for (const Result& r : results)
    if (r.problem == problem && r.method.engine == engine && r.error <= error &&
        (!found || r.time < found->time))
      found = &r;
  return found;
}

std::string cells(const Result* r) {
  if (!r) return "not reached | ";
  return fmt::format("{}, {:.3g} ms | {:.2g}", r->method.label, 1e3 * r->h, r->time);
}

}  // namespace

void writeRatioTable(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                     const std::vector<Result>& results) {
  std::string text =
      "| scene | error at most | ours | s per s | MuJoCo's | s per s | ours over MuJoCo's |\n"
      "|---|---|---|---|---|---|---|\n";
  int rows = 0, slower = 0;
  for (const Problem& problem : problems)
    for (const double error : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
      const Result* ours = best(results, problem.name, error, "softgauss");
      const Result* theirs = best(results, problem.name, error, "mujoco");
      if (!ours && !theirs) continue;
      std::string ratio;
      if (ours && theirs) {
        const double r = ours->time / theirs->time;
        ratio = r > 1.0 ? fmt::format("🔴 **{:.2f}**: MuJoCo's is {:.2f} times as fast", r, r)
                        : fmt::format("{:.2f}", r);
      } else if (theirs) {
        ratio = "🔴 MuJoCo's alone";
      }
      ++rows;
      slower += ratio.find("🔴") != std::string::npos;
      text += fmt::format("| {} | {:g} m | {} | {} | {} |\n", problem.name, error, cells(ours),
                          cells(theirs), ratio);
    }
  text += fmt::format("\n{} of {} rows are red.\n", slower, rows);
  std::ofstream out(folder / "accuracy_table.md");
  if (!(out << text << std::flush))
    throw std::runtime_error("cannot write " + (folder / "accuracy_table.md").string());
}

}  // namespace softgauss::app
