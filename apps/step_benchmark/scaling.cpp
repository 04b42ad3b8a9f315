// SPDX-License-Identifier: Apache-2.0
#include "apps/step_benchmark/scaling.hpp"

#include <fmt/format.h>

#include <regex>
#include <utility>

#include "apps/shared/fitted_power.hpp"
#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss::app {

ModelBuilder humanoidsOnGround(const std::string& robots, int count) {
  ModelBuilder one = io::readUrdf(robots + "/humanoid.urdf");
  const Model alone = one.build();
  Kinematics k(alone);
  computeKinematics(alone, State(alone), k);
  const double height = collision::lowestPoint(alone, k, 0);
  ModelBuilder builder("humanoids");
  for (int i = 0; i < count; ++i) {
    one.base = BaseKind::floating;
    one.X_WRoot.p = Vector3(2.5 * (i % 8), 2.5 * (i / 8), -height);
    builder.add(one, fmt::format("humanoid{}", i));
  }
  addGround(builder);
  return builder;
}

Model humanoids(const std::string& robots, int count) {
  return humanoidsOnGround(robots, count).build();
}

ModelBuilder boxesOnGround(int count, double spacing) {
  ModelBuilder builder = freeBoxes(count, 0.1 - 1e-4, spacing);
  addGround(builder);
  return builder;
}

std::unique_ptr<Scene> makeHumanoids(const std::string& robots, int count) {
  return makeScene(humanoids(robots, count));
}

namespace {

std::unique_ptr<Scene> makeBoxes(int count, bool ground) {
  return makeScene(ground ? boxesOnGround(count, 0.3) : freeBoxes(count, 10.0), false);
}

}  // namespace

std::vector<Rung> scaling(const std::string& robots) {
  std::vector<Rung> rungs;
  for (const int n : {10, 20, 40, 80, 160})
    rungs.push_back({fmt::format("links_{}", n), [=] { return makeChain(n); }});
  for (const int n : {4, 16, 64, 256})
    rungs.push_back({fmt::format("bodies_{}", n), [=] { return makeBoxes(n, false); }});
  for (const int n : {4, 16, 64, 256})
    rungs.push_back({fmt::format("resting_{}", n), [=] { return makeBoxes(n, true); }});
  for (const int n : {1, 2, 4, 8, 16})
    rungs.push_back({fmt::format("robots_{}", n), [=] { return makeHumanoids(robots, n); }});
  return rungs;
}

std::map<std::string, double> exponents(const std::map<std::string, double>& figures) {
  static const std::regex name("scaling_([a-z]+)_([0-9]+)[.]in_turn[.]us");
  std::map<std::string, std::vector<std::pair<double, double>>> points;
  for (const auto& [key, us] : figures) {
    std::smatch match;
    if (std::regex_match(key, match, name) && us > 0.0)
      points[match[1]].emplace_back(std::stod(match[2]), us);
  }
  std::map<std::string, double> result;
  for (const auto& [what, measured] : points)
    if (measured.size() > 1) result[what] = fittedPower(measured);
  return result;
}

}  // namespace softgauss::app
