// SPDX-License-Identifier: Apache-2.0
/// From a sweep to its runs. Draws are made here from 64 bits of our own, as the distributions of
/// the standard library differ from one library to the next.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/simulate_batch/sweep.hpp"
#include "softgauss/io/names.hpp"
#include "softgauss/io/simulation/simulation_goals.hpp"

namespace softgauss::app {
namespace {

/// SplitMix64 (Steele, Lea, Flood 2014): the next state, and its output.
std::uint64_t next(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// In [0, 1), a multiple of 2⁻⁵³.
double unit(std::uint64_t& state) { return static_cast<double>(next(state) >> 11) * 0x1p-53; }

double drawn(const Draw& draw, std::uint64_t& state) {
  const double u = unit(state);
  switch (draw.law) {
    case Draw::Law::uniform:
      return draw.a + (draw.b - draw.a) * u;
    case Draw::Law::logUniform:
      return draw.a * std::pow(draw.b / draw.a, u);
    case Draw::Law::normal:
      break;
  }
  // Box and Muller; 1 − u is above 0.
  return draw.a + draw.b * std::sqrt(-2.0 * std::log(1.0 - u)) *
                      std::cos(2.0 * std::numbers::pi * unit(state));
}

std::vector<Parameter> parametersOf(const Sweep& sweep, const Model& model) {
  std::vector<Parameter> parameters;
  for (const Sweep::Varied& varied : sweep.varied) {
    try {
      Parameter parameter(model, varied.name);
      for (const Parameter& other : parameters)
        if (parameter.isOfTheSame(other))
          throw NameError(
              fmt::format("parameter '{}': sets the same mass as '{}', for the two "
                          "links are fixed to each other; expected one of them",
                          varied.name, other.name()));
      parameters.push_back(std::move(parameter));
    } catch (const NameError& error) {
      throw ModelError(varied.where, "key 'vary'", error.what());
    }
  }
  for (const Measure& measure : sweep.measures)
    if (const std::string problem = io::linkProblem(model, measure.link); !problem.empty())
      throw ModelError(measure.where, "key 'measure'", problem);
  return parameters;
}

long pointsOf(const Sweep& sweep) {
  double points = sweep.listed.empty() ? 1.0 : static_cast<double>(sweep.listed.size());
  if (sweep.listed.empty())
    for (const Sweep::Varied& varied : sweep.varied)
      if (!varied.values.empty()) points *= static_cast<double>(varied.values.size());
  if (points * static_cast<double>(sweep.repeats) > kMostRuns)
    throw ModelError({sweep.file.string(), 0}, "sweep",
                     fmt::format("has {:.3g} runs, expected at most {:.0f}",
                                 points * static_cast<double>(sweep.repeats), kMostRuns));
  return static_cast<long>(points);
}

/// Values of the grid at a point, the last parameter changing fastest; 0 for what is drawn.
std::vector<double> gridAt(const Sweep& sweep, long point) {
  std::vector<double> values(sweep.varied.size(), 0.0);
  for (std::size_t p = sweep.varied.size(); p-- > 0;) {
    const std::vector<double>& axis = sweep.varied[p].values;
    if (axis.empty()) continue;
    const auto size = static_cast<long>(axis.size());
    values[p] = axis[static_cast<std::size_t>(point % size)];
    point /= size;
  }
  return values;
}

}  // namespace

SweepRuns planRuns(const Sweep& sweep, const Model& model) {
  const std::vector<Parameter> parameters = parametersOf(sweep, model);
  SweepRuns runs;
  for (const Parameter& parameter : parameters) runs.parameters.push_back(parameter.name());
  const long points = pointsOf(sweep);
  runs.count = points * sweep.repeats;
  std::uint64_t state = sweep.seed;
  for (long run = 0; run < runs.count; ++run) {
    const long point = run / sweep.repeats;
    std::vector<double> values = gridAt(sweep, point);
    if (!sweep.listed.empty()) {
      const std::vector<double>& row = sweep.listed[static_cast<std::size_t>(point)];
      std::copy(row.begin(), row.end(), values.begin());
    }
    const std::uint64_t seed = next(state);
    std::uint64_t own = seed;
    const auto expectNone = [&](std::size_t p, const std::string& problem) {
      if (!problem.empty())
        throw ModelError(sweep.varied[p].where, fmt::format("key '{}'", parameters[p].name()),
                         fmt::format("{}, in run {}", problem, run));
    };
    std::vector<JointRange> ranges = model.ranges;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      if (sweep.varied[p].values.empty()) values[p] = drawn(sweep.varied[p].draw, own);
      expectNone(p, parameters[p].problem(values[p]));
      parameters[p].setEnd(values[p], ranges);
    }
    for (std::size_t p = 0; p < parameters.size(); ++p)
      expectNone(p, parameters[p].startProblem(values[p], ranges));
    runs.values.insert(runs.values.end(), values.begin(), values.end());
    runs.seeds.push_back(seed);
  }
  return runs;
}

}  // namespace softgauss::app
