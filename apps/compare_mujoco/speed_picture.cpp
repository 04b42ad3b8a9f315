// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

#include "apps/compare_mujoco/speed_table.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace softgauss::app {
namespace {

using Json = nlohmann::ordered_json;

/// `ours`, `theirs`: where the names stand, in characters from the ends of the curves, clear of
/// others.
struct Line {
  const char *curve, *colour, *ours = "0.8,0", *theirs = "0.8,0";
};
constexpr Line kLines[] = {{kLying, "#3465a4"},
                           {kPile, "#c17d11"},
                           {kBoxes, "#4e8a16", "8,-1.5"},
                           {kHumanoids, "#a40000", "0.8,-0.8", "0.8,-0.8"}};

/// Ours is drawn whole, MuJoCo's dashed, and each has its name at its end.
std::string script(const Json& speeds) {
  std::string data, plots;
  for (const auto& [name, colour, offset, theirOffset] : kLines)
    for (const Json& curve : speeds["curves"]) {
      if (curve["name"] != name) continue;
      for (const bool ours : {true, false}) {
        const std::string block = fmt::format("$data{}", plots.empty() ? 0 : data.size());
        data += block + " << END\n";
        const Json& us = curve[ours ? "ours_us" : "mujoco_us"];
        for (std::size_t i = 0; i < us.size(); ++i)
          data += fmt::format("{} {:.6g}\n", curve["sizes"][i].get<int>(), us[i].get<double>());
        data += "END\n";
        plots += fmt::format(
            "{0}{1} using 1:2 with linespoints pt 7 ps 0.5 lw 2 dt {2} lc rgb '{3}' notitle, "
            "{1} using ($0 == {4} ? $1 : NaN):2:('{5}, {6}') with labels left offset {7} "
            "tc rgb '{3}' notitle",
            plots.empty() ? "" : ", ", block, ours ? 1 : 2, colour, us.size() - 1, name,
            ours ? "softgauss" : "MuJoCo", ours ? offset : theirOffset);
      }
    }
  if (plots.empty()) throw std::runtime_error("no scene of the picture has a figure");
  return fmt::format(
      "set encoding utf8\nset terminal svg enhanced size 760,520 font 'sans-serif,12' "
      "background 'white'\nset output '{}'\n{}set logscale xy\nset format y '10^{{%T}}'\n"
      "set border 3\nset tics nomirror\nset grid lc rgb '#e2e2e2'\nset xrange [8:12000]\n"
      "set xtics (10, 30, 100, 300, 1000)\n"
      "set xlabel 'links or bodies'\nset ylabel 'µs a step'\nplot {}\nunset output\n",
      io::kGnuplotDrawing, data, plots);
}

}  // namespace

void drawSpeeds(const Json& speeds, const std::filesystem::path& file) {
  if (!io::hasGnuplot()) throw std::runtime_error(io::kNoGnuplot);
  std::ofstream out(file, std::ios::binary);
  if (!(out << io::gnuplotDrawing(script(speeds)) << std::flush))
    throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace softgauss::app
