// SPDX-License-Identifier: Apache-2.0
#include "apps/step_benchmark/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <vector>

#include "apps/step_benchmark/ladder.hpp"
#include "apps/step_benchmark/scaling.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace softgauss::app {
namespace {

using Figures = std::map<std::string, double>;

std::optional<double> find(const Figures& figures, const std::string& name) {
  const auto place = figures.find(name);
  if (place == figures.end()) return std::nullopt;
  return place->second;
}

std::string inWords(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

void write(const std::filesystem::path& file, const std::string& script) {
  if (!(std::ofstream(file, std::ios::binary) << io::gnuplotDrawing(script) << std::flush))
    throw std::runtime_error(file.string() + ": cannot be written");
}

/// 1, 2 or 5 times a power of ten, near x.
double roundStep(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  const double digit = x / power;
  return power * (digit < 1.5 ? 1.0 : digit < 3.5 ? 2.0 : digit < 7.5 ? 5.0 : 10.0);
}

/// One panel a base: bars of the time of a step, that of `nothing` in grey, what is added in blue.
std::string ladderScript(const Figures& figures) {
  static constexpr const char* kEffects[] = {
      "nothing",          "damping",      "limits_idle",         "limits_active", "dry_friction",
      "equality",         "gdd",          "self_collision_idle", "ground_idle",   "contact",
      "rolling_friction", "elliptic_cone"};
  constexpr const char* kBases[] = {"arm", "humanoid", "boxes"};
  constexpr const char* kTitles[] = {"arm, 7 hinges", "humanoid, 27 dofs", "20 free boxes"};
  std::string data, plots;
  for (std::size_t b = 0; b < std::size(kBases); ++b) {
    const auto nothing = find(figures, fmt::format("ladder_{}_nothing.in_turn.us", kBases[b]));
    if (!nothing) return {};
    data += fmt::format("${} << EOD\n", kBases[b]);
    std::string tics;
    int row = 0;
    double longest = 0.0;
    for (const char* effect : kEffects) {
      const auto step = find(figures, fmt::format("ladder_{}_{}.in_turn.us", kBases[b], effect));
      if (!step) continue;
      data += fmt::format("{} {:.6g} {:.6g} {}\n", -row, std::min(*step, *nothing),
                          std::max(*step, *nothing),
                          row == 0 ? fmt::format("\"{:.2g} µs\"", *step)
                                   : fmt::format("\"{:.2f} x\"", *step / *nothing));
      tics += fmt::format("{}'{}' {}", row ? ", " : "", inWords(effect), -row);
      longest = std::max(longest, *step);
      ++row;
    }
    data += "EOD\n";
    plots += fmt::format(
        "set title '{}'\nset xtics 0,{:.6g}\nset ytics ({}) nomirror\nset xrange [0:{:.6g}]\nset "
        "yrange [{}:0.6]\n"
        "plot ${} using (0.5*$2):1:(0.5*$2):(0.36) with boxxyerror lc rgb '#b8c0c8', "
        "'' using (0.5*($2+$3)):1:(0.5*($3-$2)):(0.36) with boxxyerror lc rgb '#3465a4', "
        "'' using 3:1:4 with labels left offset 0.5,0\n",
        kTitles[b], roundStep(0.3 * longest), tics, 1.25 * longest, 0.4 - row, kBases[b]);
  }
  return fmt::format(
      "set encoding utf8\nset terminal svg size 1080,420 font 'sans-serif,12' background "
      "'white'\nset output '{}'\n"
      "{}set style fill solid\nunset key\nset xtics nomirror\nset border 3\nset xlabel 'µs per "
      "step'\nset multiplot layout 1,3\n{}unset multiplot\n",
      io::kGnuplotDrawing, data, plots);
}

/// Time against count, both logarithmic, with the fitted powers.
std::string scalingScript(const Figures& figures) {
  struct Line {
    const char *what, *title;
  };
  constexpr Line kLines[] = {{"links", "links of a chain"},
                             {"bodies", "free boxes in the air"},
                             {"resting", "boxes at rest, 4 contacts each"},
                             {"robots", "humanoids on the ground"}};
  constexpr const char* kColours[] = {"#3465a4", "#73a839", "#c17d11", "#a40000"};
  const std::map<std::string, double> powers = exponents(figures);
  std::string data, plots;
  for (std::size_t n = 0; n < std::size(kLines); ++n) {
    const std::string prefix = fmt::format("scaling_{}_", kLines[n].what);
    std::map<int, double> points;
    for (auto place = figures.lower_bound(prefix);
         place != figures.end() && place->first.rfind(prefix, 0) == 0; ++place)
      if (place->first.find(".in_turn.us") != std::string::npos)
        points[std::stoi(place->first.substr(prefix.size()))] = place->second;
    if (points.size() < 2) continue;
    data += fmt::format("${} << EOD\n", kLines[n].what);
    for (const auto& [count, us] : points) data += fmt::format("{} {:.6g}\n", count, us);
    data += "EOD\n";
    plots += fmt::format(
        "{}${} using 1:2 with linespoints pt 7 ps 0.6 lw 2 lc rgb '{}' title "
        "'{}: n^{{{:.2f}}}'",
        plots.empty() ? "" : ", ", kLines[n].what, kColours[n], kLines[n].title,
        powers.at(kLines[n].what));
  }
  if (plots.empty()) return {};
  return fmt::format(
      "set terminal svg enhanced size 720,480 font 'sans-serif,12' background 'white'\n"
      "set output '{}'\n{}set logscale xy\nset encoding utf8\nset key top left reverse "
      "Left\nset xrange [1:600]\nset grid\n"
      "set xlabel 'count'\nset ylabel 'µs per step'\nplot {}\n",
      io::kGnuplotDrawing, data, plots);
}

}  // namespace

void drawPictures(const Figures& figures, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, script] : {std::pair{"ladder.svg", ladderScript(figures)},
                                     std::pair{"scaling.svg", scalingScript(figures)}})
    if (!script.empty()) write(folder / name, script);
}

}  // namespace softgauss::app
