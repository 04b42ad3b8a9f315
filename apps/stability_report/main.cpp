// SPDX-License-Identifier: Apache-2.0
/// stability_report: the hard cases of data/scenes/stability in softgauss and, where it was found,
/// in MuJoCo; a table of what both do, and pictures.
///
/// Both engines run the same scene from the same state, each with its own defaults. All figures are
/// computed from q and v by the same functions. It ends with exit code 1 where our engine misses a
/// bound that is not known to be missed, or holds one that is.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "apps/stability_report/cases.hpp"
#include "io/replay/gnuplot.hpp"
#include "io/scene.hpp"
#ifdef SOFTGAUSS_WITH_MUJOCO
#include "apps/compare_mujoco/mjcf.hpp"
#include "apps/compare_mujoco/mujoco.hpp"
#endif

namespace {

using namespace softgauss;
using app::Figure;
using app::HardCase;
using app::kSteps;
using app::Stage;

constexpr double kFastest = 1e6;  // [m/s or rad/s] beyond, a run counts as diverged
constexpr const char* kBegin = "<!-- table: stability_report -->";
constexpr const char* kEnd = "<!-- end of table -->";

/// What one engine did.
struct Outcome {
  bool ran = false;                          ///< it could load the scene
  std::optional<double> diverged;            ///< when [s]
  std::vector<double> figures;               ///< in their units
  std::vector<std::vector<double>> courses;  ///< of each figure, at every step
};

Model load(const std::filesystem::path& folder, const HardCase& hard, double timestep,
           State& state) {
  io::SceneFile file = io::readScene(folder / (hard.scene + ".yaml"));
  file.builder.options.timestep = timestep;
  Model model = file.builder.build();
  state = file.initialState(model);
  return model;
}

/// `advance` brings stage.state forward by one step; false: it cannot.
template <class Advance>
Outcome run(Stage& stage, const HardCase& hard, Advance&& advance) {
  Outcome outcome;
  outcome.ran = true;
  std::vector<double> starts;
  for (const Figure& f : hard.figures) starts.push_back(f.start ? f.start(stage) : 0.0);
  outcome.figures.assign(hard.figures.size(), 0.0);
  outcome.courses.resize(hard.figures.size());
  const double h = stage.model.options.timestep;
  const auto steps = static_cast<int>(std::round(hard.duration / h));
  for (int i = 1; i <= steps; ++i) {
    if (!advance() || !stage.state.q.allFinite() ||
        !(stage.state.v.cwiseAbs().maxCoeff() < kFastest)) {
      outcome.diverged = i * h;
      return outcome;
    }
    for (std::size_t f = 0; f < hard.figures.size(); ++f) {
      const Figure& figure = hard.figures[f];
      const double value = figure.scale * figure.value(stage, starts[f]);
      double& kept = outcome.figures[f];
      if (figure.of == Figure::last || std::abs(value) > std::abs(kept)) kept = value;
      outcome.courses[f].push_back(value);
    }
  }
  return outcome;
}

Outcome runOurs(const std::filesystem::path& folder, const HardCase& hard, double timestep) {
  State initial;
  Stage stage(load(folder, hard, timestep, initial));
  stage.state = initial;
  collision::SceneContacts contacts(stage.model);
  Data data(stage.model);
  const Input input;
  return run(stage, hard, [&] {
    return step(stage.model, input, stage.state, data, &contacts) != SolveStatus::notFinite;
  });
}

Outcome runMujoco([[maybe_unused]] const std::filesystem::path& folder,
                  [[maybe_unused]] const HardCase& hard, [[maybe_unused]] double timestep) {
#ifdef SOFTGAUSS_WITH_MUJOCO
  State initial;
  Stage stage(load(folder, hard, timestep, initial));
  stage.state = initial;
  std::optional<app::Mujoco> loaded;
  try {
    loaded.emplace(app::mjcfOf(stage.model, stage.contacts.filter()));
  } catch (const ModelError& error) {
    fmt::print(stderr, "{}: {}\n", hard.title, error.what());
    return {};
  }
  app::Mujoco& mujoco = *loaded;
  mujoco.set(initial, VectorX::Zero(stage.model.nv));
  mujoco.setWarmStart(VectorX::Zero(stage.model.nv));
  return run(stage, hard, [&] {
    mujoco.step();
    stage.state.q = mujoco.q();
    stage.state.v = mujoco.v();
    return mujoco.firstWarning().empty();
  });
#else
  return {};
#endif
}

std::string engineName() {
#ifdef SOFTGAUSS_WITH_MUJOCO
  return "MuJoCo " + app::Mujoco::version();
#else
  return "MuJoCo (not found)";
#endif
}

std::string cell(const Outcome& outcome, std::size_t figure) {
  if (!outcome.ran) return "not loaded";
  if (outcome.diverged) return fmt::format("**diverges at {:.2g} s**", *outcome.diverged);
  const double value = outcome.figures[figure];
  return std::abs(value) < 10.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

/// Whether our engine did as is known of it; else it is said.
bool asKnown(const HardCase& hard, std::size_t f, double timestep, const Outcome& ours) {
  const Figure& figure = hard.figures[f];
  const double bound = figure.boundAt(timestep);
  const bool held = !ours.diverged && std::abs(ours.figures[f]) <= bound;
  if (held != figure.isMissedAt(timestep)) return true;
  fmt::print(stderr, "{}, {} at {:g} ms: {} of {:g} {}\n", hard.title, figure.name, 1e3 * timestep,
             held ? "holds its bound, and is listed as known to miss it" : "misses its bound",
             bound, figure.unit);
  return false;
}

/// Replaces what stands between the two marks of a page.
void writeTable(const std::filesystem::path& page, const std::string& table) {
  std::ifstream in(page);
  std::stringstream text;
  text << in.rdbuf();
  std::string all = text.str();
  const std::size_t begin = all.find(kBegin), end = all.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos)
    throw ModelError({page.string(), 0}, "page",
                     fmt::format("found no table, expected '{}' and '{}'", kBegin, kEnd));
  all.replace(begin, end - begin, std::string(kBegin) + "\n\n" + table + "\n");
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
    script += fmt::format("$run{} << EOD\n", i);
    const std::vector<double>& course = outcome.courses[figure];
    const std::size_t stride = std::max<std::size_t>(1, course.size() / 1000);
    for (std::size_t k = 0; k < course.size(); k += stride)
      script += fmt::format("{:.6g} {:.6g}\n", static_cast<double>(k + 1) * kSteps[0], course[k]);
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
  std::filesystem::path scenes, page, pictures;
  std::vector<std::string> only;
  bool ours = false;
};

/// Whether our engine did as is known of it in every case.
bool report(const Request& request) {
  const std::string other = request.ours ? "no other engine" : engineName();
  std::string table = fmt::format(
      "| case | figure | bound | ours, 2 ms | {0}, 2 ms | ours, 10 ms | {0}, 10 ms |\n"
      "|---|---|---|---|---|---|---|\n",
      other);
  bool good = true;
  for (const HardCase& hard : app::hardCases()) {
    const auto& only = request.only;
    if (!only.empty() && std::find(only.begin(), only.end(), hard.scene) == only.end()) continue;
    std::vector<Outcome> outcomes;
    for (const double timestep : kSteps) {
      outcomes.push_back(runOurs(request.scenes, hard, timestep));
      outcomes.push_back(request.ours ? Outcome{} : runMujoco(request.scenes, hard, timestep));
    }
    for (std::size_t f = 0; f < hard.figures.size(); ++f) {
      const Figure& figure = hard.figures[f];
      std::string row = fmt::format("| {} | {} [{}] | {:g}", f == 0 ? hard.title : "", figure.name,
                                    figure.unit, figure.bound);
      if (figure.coarseBound) row += fmt::format("; {:g} at 10 ms", *figure.coarseBound);
      row += !figure.missed.empty()             ? ", missed |"
             : !figure.missedWhenCoarse.empty() ? ", missed at 10 ms |"
                                                : " |";
      for (const Outcome& outcome : outcomes) row += " " + cell(outcome, f) + " |";

      fmt::print("{}\n", row);
      table += row + "\n";
      for (std::size_t i = 0; i < std::size(kSteps); ++i)
        good &= asKnown(hard, f, kSteps[i], outcomes[2 * i]);
    }
    for (const Picture& picture : kPictures) {
      if (request.pictures.empty() || hard.scene != picture.scene) continue;
      std::vector<std::pair<std::string, Outcome>> runs = {{"softgauss", outcomes[0]}};
      if (outcomes[1].ran) runs.emplace_back(other, outcomes[1]);
      draw(request.pictures / fmt::format("stability_{}.svg", hard.scene), hard, picture.figure,
           picture.limits, runs);
    }
  }
  if (!request.page.empty()) writeTable(request.page, table);
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("The hard cases of data/scenes/stability in softgauss and in MuJoCo");
  app.add_option("SCENES", request.scenes, "the folder of the scenes")->required();
  app.add_option("--page", request.page, "write the table into this page, between its two marks");
  app.add_option("--pictures", request.pictures, "draw into this folder, with gnuplot");
  app.add_option("--only", request.only, "a scene that is run, by its file's name; default: all");
  app.add_flag("--ours", request.ours, "leave MuJoCo out");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return report(request) ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
