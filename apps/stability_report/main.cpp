// SPDX-License-Identifier: Apache-2.0
/// stability_report: the hard cases of data/scenes/stability in softgauss and, as recorded, in
/// MuJoCo; a table of what both do, and pictures; and a table of what each mechanism is for.
///
/// Both engines run the same scene from the same state, each with its own defaults. All figures are
/// computed from q and v by the same functions. It ends with exit code 1 where our engine misses a
/// bound.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "apps/stability_report/ablation.hpp"
#include "apps/stability_report/rival.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace {

using namespace softgauss;
using app::Figure;
using app::HardCase;
using app::kSteps;
using app::Outcome;

constexpr const char* kBegin = "<!-- table: stability_report -->";
constexpr const char* kAblationBegin = "<!-- table: stability_report --ablate -->";
constexpr const char* kEnd = "<!-- end of table -->";

std::string cell(const Outcome& outcome, std::size_t figure) {
  if (!outcome.ran) return "not loaded";
  if (outcome.diverged) return fmt::format("**diverges at {:.2g} s**", *outcome.diverged);
  const double value = outcome.figures[figure];
  return std::abs(value) < 10.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

/// Whether our engine holds a bound; else it is said.
bool holds(const HardCase& hard, std::size_t f, double timestep, const Outcome& ours) {
  if (ours.holds(hard, f)) return true;
  const Figure& figure = hard.figures[f];
  fmt::print(stderr, "{}, {} at {:g} ms: misses its bound of {:g} {}\n", hard.title, figure.name,
             1e3 * timestep, figure.bound, figure.unit);
  return false;
}

/// Replaces what stands between the two marks of a page.
void writeTable(const std::filesystem::path& page, const std::string& mark,
                const std::string& table) {
  std::ifstream in(page);
  std::stringstream text;
  text << in.rdbuf();
  std::string all = text.str();
  const std::size_t begin = all.find(mark), end = all.find(kEnd, begin);
  if (begin == std::string::npos || end == std::string::npos)
    throw ModelError({page.string(), 0}, "page",
                     fmt::format("found no table, expected '{}' and '{}'", mark, kEnd));
  all.replace(begin, end - begin, mark + "\n\n" + table + "\n");
  if (!(std::ofstream(page) << all))
    throw ModelError({page.string(), 0}, "page", "cannot be written");
}

/// The course of one figure in both engines at the first of the steps.
void draw(const std::filesystem::path& file, const HardCase& hard, std::size_t figure,
          const std::string& limits, const std::vector<std::pair<std::string, Outcome>>& runs) {
  const Figure& f = hard.figures[figure];
  std::string script = fmt::format(
      "set terminal svg size 640,360 font 'sans-serif,13' background 'white'\n"
      "set output '{}'\nset title \"{}\"\nset xlabel \"time [s]\"\nset ylabel \"{} [{}]\"\n"
      "set grid lc rgb '#dddddd'\nset key top left\n{}\n",
      io::kGnuplotDrawing, hard.title, f.name.substr(0, f.name.find(" at rest")), f.unit, limits);
  std::string plot;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& [name, outcome] = runs[i];
    const std::vector<double>& course = outcome.courses[figure];
    if (course.empty()) continue;
    script += fmt::format("$run{} << EOD\n", i);
    const std::size_t stride = std::max<std::size_t>(1, course.size() / 1000);
    const double spacing =
        outcome.diverged.value_or(hard.duration) / static_cast<double>(course.size());
    for (std::size_t k = 0; k < course.size(); k += stride)
      script += fmt::format("{:.6g} {:.6g}\n", static_cast<double>(k + 1) * spacing, course[k]);
    script += "EOD\n";
    plot += fmt::format("{} $run{} with lines lw 2 lc rgb '{}' title \"{}\"", i == 0 ? "plot" : ",",
                        i, i == 0 ? "#0060ad" : "#dd5511", name);
  }
  if (!(std::ofstream(file) << io::gnuplotDrawing(script + plot + "\n")))
    throw ModelError({file.string(), 0}, "picture", "cannot be written");
}

struct Picture {
  const char* scene;
  std::size_t figure;
  const char* limits;
};
constexpr Picture kPictures[] = {{"boxes_1000_on_1", 0, "set xrange [0:1]; set yrange [-5:160]"},
                                 {"tower_20", 1, "set yrange [0:60]"},
                                 {"top", 0, "set yrange [-20:40]"},
                                 {"rope", 0, "set yrange [0:60]; set key right center"}};

struct Request {
  std::filesystem::path scenes, page, pictures, reference, exported, measured;
  std::vector<std::string> only;
  bool ours = false, ablate = false;

  bool takes(const HardCase& hard) const {
    return only.empty() || std::find(only.begin(), only.end(), hard.scene) != only.end();
  }
};

/// The two rows of a table's head.
std::string head(const std::string& engine) {
  std::string first = "| case | figure | bound |", second = "|---|---|---|";
  for (const double timestep : kSteps) {
    first += fmt::format(" ours, {:g} ms |", 1e3 * timestep);
    second += "---|";
    for (const char* integrator : app::kRivalIntegrators) {
      if (engine.empty()) continue;
      first += fmt::format(" {}, {}, {:g} ms |", engine, integrator, 1e3 * timestep);
      second += "---|";
    }
  }
  return first + "\n" + second + "\n";
}

/// Whether our engine holds every bound.
bool report(const Request& request) {
  std::optional<app::Rival> rival;
  if (!request.ours) rival.emplace(request.reference);
  const std::string engine = rival ? "MuJoCo " + rival->version() : "";
  std::string table = head(engine);
  fmt::print("{}", table);
  bool good = true;
  for (const HardCase& hard : app::hardCases()) {
    if (!request.takes(hard)) continue;
    std::vector<Outcome> ours, all;  // by step; and with MuJoCo's after each
    for (const double timestep : kSteps) {
      ours.push_back(app::runOurs(request.scenes, hard, timestep));
      all.push_back(ours.back());
      for (const char* integrator : app::kRivalIntegrators)
        if (rival) all.push_back(rival->outcome(hard, timestep, integrator));
    }
    for (std::size_t f = 0; f < hard.figures.size(); ++f) {
      const Figure& figure = hard.figures[f];
      std::string row = fmt::format("| {} | {} [{}] | {:g} |", f == 0 ? hard.title : "",
                                    figure.name, figure.unit, figure.bound);
      for (const Outcome& outcome : all) row += " " + cell(outcome, f) + " |";
      fmt::print("{}\n", row);
      table += row + "\n";
      for (std::size_t i = 0; i < std::size(kSteps); ++i)
        good &= holds(hard, f, kSteps[i], ours[i]);
    }
    for (const Picture& picture : kPictures) {
      if (request.pictures.empty() || hard.scene != picture.scene) continue;
      std::vector<std::pair<std::string, Outcome>> runs = {{"softgauss", ours[0]}};
      if (rival && all[1].ran && !all[1].courses.empty()) runs.emplace_back(engine, all[1]);
      draw(request.pictures / fmt::format("stability_{}.svg", hard.scene), hard, picture.figure,
           picture.limits, runs);
    }
  }
  if (!request.page.empty()) writeTable(request.page, kBegin, table);
  return good;
}

/// What is asked for; the exit code.
int carryOut(const Request& request) {
  if (!request.exported.empty()) {
    app::exportCases(request.scenes, request.exported);
  } else if (!request.measured.empty()) {
    app::measureRival(request.scenes, request.measured, request.reference);
  } else if (request.ablate) {
    const std::string table = app::ablate(
        request.scenes, [&](const HardCase& hard) { return request.takes(hard); },
        [](const std::string& row) { fmt::print("{}\n", row), std::fflush(stdout); });
    if (!request.page.empty()) writeTable(request.page, kAblationBegin, table);
  } else {
    return report(request) ? 0 : 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("The hard cases of data/scenes/stability in softgauss and in MuJoCo");
  app.add_option("SCENES", request.scenes, "the folder of the scenes")->required();
  app.add_option("--page", request.page, "write the table into this page, between its two marks");
  app.add_option("--pictures", request.pictures, "draw into this folder, with gnuplot");
  app.add_option("--only", request.only, "a scene that is run, by its file's name; default: all");
  app.add_option("--reference", request.reference,
                 "what MuJoCo does (default: mujoco.json in the folder of scenes)");
  app.add_option("--export", request.exported,
                 "write the cases into this folder, as MuJoCo's own descriptions");
  app.add_option("--measure", request.measured,
                 "write --reference from MuJoCo's runs of such a folder");
  app.add_flag("--ours", request.ours, "leave MuJoCo out");
  app.add_flag("--ablate", request.ablate,
               "leave out each mechanism of the step alone, and tell which bounds are missed then");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (request.reference.empty()) request.reference = request.scenes / "mujoco.json";
  try {
    return carryOut(request);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
