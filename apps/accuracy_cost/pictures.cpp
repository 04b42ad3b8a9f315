// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/accuracy_cost/best.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace softgauss::app {
namespace {

constexpr const char* kDataPlace = "/*RESULTS*/null";

/// Curves by their labels. A method of MuJoCo has the colour of ours that it is the counterpart of.
struct Colour {
  const char* label;
  const char* colour;
  const char* theirs = nullptr;
};
constexpr Colour kColours[] = {
    {"leapfrog", "#0072b2"},
    {"semi-implicit Euler", "#c0b000"},
    {"semi-implicit Euler as MuJoCo's", "#d55e00", "MuJoCo Euler"},
    {"implicit in velocity", "#009e73", "MuJoCo implicit"},
    {"implicit midpoint", "#cc79a7"},
    {"Runge-Kutta 4", "#e69f00", "MuJoCo RK4"},
    {"Dormand-Prince to 1e-05", "#56b4e9"},
    {"Dormand-Prince to 1e-08", "#7b3294"},
    {"Dormand-Prince to 1e-11", "#000000"},
    {"leapfrog with step doubling to 1e-04", "#8c6d31"},
    {"leapfrog with step doubling to 1e-06", "#999999"},
    {"leapfrog with solver to 1e-06", "#a6d854"},
    {"leapfrog with solver to 1e-03", "#4d7c0f"},
    {"leapfrog without warm start", "#e7298a"},
    {"leapfrog with elliptic cones", "#8b0000"},
};

/// The same in every picture.
const char* colourOf(const Method& method) {
  for (const Colour& c : kColours)
    if (method.label == c.label || (c.theirs && method.label == c.theirs)) return c.colour;
  throw std::logic_error("no colour for '" + method.label + "'");
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file);
  if (!(out << text << std::flush)) throw std::runtime_error("cannot write " + file.string());
}

/// Results of a problem, by method, in the order in which methods appear.
std::vector<std::vector<Result>> curvesOf(const std::string& problem,
                                          const std::vector<Result>& results) {
  std::vector<std::vector<Result>> curves;
  for (const Result& r : results) {
    if (r.problem != problem || !std::isfinite(r.error) || !std::isfinite(r.time)) continue;
    // One set of such curves is enough for a picture; the others are in a table.
    if (r.method.variesSolver() && r.method.integrator != "semi-implicit-euler") continue;
    const auto same = [&](const std::vector<Result>& c) { return c.front().method == r.method; };
    const auto curve = std::find_if(curves.begin(), curves.end(), same);
    if (curve == curves.end())
      curves.push_back({r});
    else
      curve->push_back(r);
  }
  for (std::vector<Result>& curve : curves)
    std::sort(curve.begin(), curve.end(),
              [](const Result& a, const Result& b) { return a.h < b.h; });
  return curves;
}

/// Below this error the references of an engine tell nothing [m]; 0: they tell all.
double toldFrom(const std::vector<std::vector<Result>>& curves, const std::string& engine) {
  double reference = 0.0;
  for (const std::vector<Result>& curve : curves)
    if (curve.front().method.engine == engine && sameModel(curve.front().method))
      reference = std::max(reference, curve.front().referenceError);
  return reference / kReferenceTells;
}

std::string script(const Problem& problem, const std::vector<std::vector<Result>>& curves) {
  std::string text;
  const auto add = [&](const std::string& line) { text += line + "\n"; };
  for (std::size_t k = 0; k < curves.size(); ++k) {
    add(fmt::format("$curve{} << END", k));
    for (const Result& r : curves[k])
      add(fmt::format("{:.6g} {:.6g} {}", r.time, std::max(r.error, 1e-17),
                      tells(r.referenceError, r.error) ? 1 : 0));
    add("END");
  }
  add("set terminal svg noenhanced size 760,560 font 'Helvetica,12' background '#ffffff'");
  add(fmt::format("set output '{}'", io::kGnuplotDrawing));
  add(fmt::format("set title '{}' font 'Helvetica-Bold,13'", problem.title));
  add("set logscale xy; set format x '%g'");
  add("set format y '%.0e'");
  add("set border 3 linecolor '#666666'; set tics nomirror scale 0.5 textcolor '#333333'");
  add("set grid linecolor '#e2e2e2' linetype 1 linewidth 0.5");
  add("set xlabel \"CPU seconds per simulated second\\n\" offset 0,0.6");  // a line more for the
                                                                           // key
  add(problem.contact ? fmt::format("set ylabel 'error within {:g} ms [m]'",
                                    1e3 * kPeriod * problem.windowPeriods)
                      : "set ylabel 'error [m]'");
  add("set key below");
  std::string plot = "plot ";
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const Method& method = curves[k].front().method;
    const char* const colour = colourOf(method);
    const int dash = method.engine == "mujoco" ? 2 : 1;
    // Full markers where the error is told, hollow ones where it is not.
    plot += fmt::format(
        "{0}$curve{1} using 1:2 with lines linewidth 1.8 dashtype {2} linecolor '{3}' notitle, "
        "$curve{1} using 1:($3 == 1 ? $2 : NaN) with points pointtype 7 pointsize 0.5 "
        "linecolor '{3}' notitle, "
        "$curve{1} using 1:($3 == 0 ? $2 : NaN) with points pointtype 7 pointsize 0.6 "
        "linecolor '#ffffff' notitle, "
        "$curve{1} using 1:($3 == 0 ? $2 : NaN) with points pointtype 6 pointsize 0.6 "
        "linecolor '{3}' notitle, "
        "keyentry with linespoints pointtype 7 pointsize 0.5 linewidth 1.8 dashtype {2} "
        "linecolor '{3}' title \"{4}\"",
        k == 0 ? "" : ", ", k, dash, colour, method.label);
  }
  const double ours = toldFrom(curves, "softgauss"), theirs = toldFrom(curves, "mujoco");
  const auto level = [&](double error, int dash, const char* title) {
    plot += fmt::format(", {:.6g} linecolor '#666666' dashtype {} title '{}'", error, dash, title);
  };
  if (ours > 0.0) level(ours, 1, "below (hollow): not resolved");
  if (theirs > 0.0 && theirs != ours) level(theirs, 2, "the same of MuJoCo");
  add(plot);
  add("unset output");
  return text;
}

nlohmann::ordered_json json(const Problem& problem,
                            const std::vector<std::vector<Result>>& curves) {
  nlohmann::ordered_json out{{"name", problem.name},
                             {"title", problem.title},
                             {"contact", problem.contact},
                             {"passive", problem.passive},
                             {"exact", bool(problem.exact)},
                             {"window", kPeriod * problem.windowPeriods},
                             {"curves", nlohmann::json::array()}};
  for (const std::vector<Result>& curve : curves) {
    const Method& m = curve.front().method;
    nlohmann::ordered_json points = nlohmann::json::array();
    for (const Result& r : curve)
      points.push_back({{"h", r.h},
                        {"error", r.error},
                        {"orientation", r.orientation},
                        {"time", r.time},
                        {"drift", r.energyDrift},
                        {"momentum", r.momentumDrift},
                        {"penetration", r.penetration},
                        {"overshoot", r.overshoot},
                        {"reference", r.referenceError},
                        {"oneStep", r.oneStep}});
    out["curves"].push_back({{"engine", m.engine},
                             {"label", m.label},
                             {"colour", colourOf(m)},
                             {"sameModel", sameModel(m)},
                             {"points", points}});
  }
  return out;
}

}  // namespace

void writePictures(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                   const std::vector<Result>& results) {
  const bool draw = io::hasGnuplot();
  if (!draw) fmt::print(stderr, "accuracy_cost: no pictures: {}\n", io::kNoGnuplot);
  nlohmann::ordered_json data = nlohmann::json::array();
  for (const Problem& problem : problems) {
    const std::vector<std::vector<Result>> curves = curvesOf(problem.name, results);
    if (curves.empty()) continue;
    if (draw) write(folder / (problem.name + ".svg"), io::gnuplotDrawing(script(problem, curves)));
    data.push_back(json(problem, curves));
  }
  std::string page = pageTemplate();
  const std::size_t place = page.find(kDataPlace);
  if (place == std::string::npos) throw std::logic_error("the page has no place for its data");
  page.replace(place, std::string(kDataPlace).size(), data.dump());
  write(folder / "accuracy_cost.html", page);
}

}  // namespace softgauss::app
