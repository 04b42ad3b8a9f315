// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

#include "apps/plan_benchmark/trials.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace softgauss::app {
namespace {

const char* colourOf(PlanMethod method) {
  switch (method) {
    case PlanMethod::ailqr:
      return "#3465a4";
    case PlanMethod::feasible:
      return "#4e8a16";
    case PlanMethod::ilqr:
      return "#c17d11";
  }
  return "";
}

/// One panel a task, in the order in which they come.
std::string script(const std::vector<PlanTrials>& all) {
  std::vector<std::string> tasks;
  for (const PlanTrials& t : all)
    if (tasks.empty() || tasks.back() != t.task) tasks.push_back(t.task);
  constexpr int kColumns = 3;
  const int rows = (static_cast<int>(tasks.size()) + kColumns - 1) / kColumns;
  std::string data, panels;
  for (const std::string& task : tasks) {
    std::string plots;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].task != task || all[i].trials.empty()) continue;
      const std::string block = fmt::format("$data{}", i);
      data += block + " << END\n";
      for (const auto& [iteration, cost] : all[i].trials[0].curve)
        if (iteration > 0) data += fmt::format("{} {:.6g}\n", iteration, cost);
      data += "END\n";
      plots += fmt::format("{}{} using 1:2 with lines lw 2 lc rgb '{}' title '{}'",
                           plots.empty() ? "" : ", ", block, colourOf(all[i].method),
                           planMethodName(all[i].method));
    }
    std::string title = task;
    for (char& c : title)
      if (c == '_') c = ' ';
    panels += fmt::format("set title '{}'\nplot {}\nunset key\n", title, plots);
  }
  return fmt::format(
      "set encoding utf8\nset terminal svg size 900,{} font 'sans-serif,12' background 'white'\n"
      "set output '{}'\n{}set multiplot layout {},{}\nset logscale xy\nset border 3\n"
      "set tics nomirror\nset grid lc rgb '#e2e2e2'\nset xlabel 'iterations'\n"
      "set ylabel 'cost'\nset key top right\n{}unset multiplot\nunset output\n",
      300 * rows, io::kGnuplotDrawing, data, rows, kColumns, panels);
}

}  // namespace

void drawCurves(const std::vector<PlanTrials>& all, const std::filesystem::path& file) {
  if (!io::hasGnuplot()) throw std::runtime_error(io::kNoGnuplot);
  std::ofstream out(file, std::ios::binary);
  if (!(out << io::gnuplotDrawing(script(all)) << std::flush))
    throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace softgauss::app
