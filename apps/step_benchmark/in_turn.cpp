// SPDX-License-Identifier: Apache-2.0
#include "apps/step_benchmark/in_turn.hpp"

#include <fmt/format.h>

#include <memory>
#include <regex>
#include <utility>

#include "apps/shared/cpu_time.hpp"
#include "apps/shared/median.hpp"
#include "apps/step_benchmark/ladder.hpp"
#include "apps/step_benchmark/scaling.hpp"

namespace softgauss::app {
namespace {

using Figures = std::map<std::string, double>;

constexpr int kPieces = 41;
constexpr int kStepsOfPiece = 50;

/// A scene that takes the same steps in every piece.
Timed repeated(std::shared_ptr<Scene> scene, int warmUp, int steps = kStepsOfPiece) {
  for (int i = 0; i < warmUp; ++i) scene->step();
  return {[scene, saved = scene->state] { scene->state = saved; }, [scene] { scene->step(); },
          steps};
}

/// What a step of the arm cannot do without, as long as many times as a piece has steps.
struct BareArm {
  std::unique_ptr<Scene> scene;
  TreeFactor factor;
  VectorX bias, a;

  explicit BareArm(const std::string& robots) : scene(makeRung(robots, "arm_nothing")) {
    for (int i = 0; i < kStepsOfPiece; ++i) scene->step();  // sines of zero are cheap
    bias = a = scene->data->forces.bias;
  }
  void dynamics() {
    const Model& model = scene->model;
    Data& data = *scene->data;
    computeKinematics(model, scene->state, data.kinematics);
    computeMassMatrix(model, data.kinematics, data.inertia);
    computeBias(model, data.kinematics, data.inertia, data.forces.work, bias);
    factor.compute(data.inertia.M);
    a = -bias;
    factor.solve(a);
  }
  void midpoint() {
    const Model& model = scene->model;
    Data& data = *scene->data;
    a = scene->state.v + 0.5 * model.options.timestep * a;
    computeBiasAt(model, data.kinematics, data.inertia, a, data.forces.work, bias);
    a = -bias;
    factor.solve(a);
  }
};

}  // namespace

std::vector<double> timeInTurn(const std::vector<Timed>& all) {
  std::vector<std::vector<double>> times(all.size());
  for (int piece = 0; piece < kPieces; ++piece)
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].begin) all[k].begin();
      const double start = cpuSeconds();
      for (int i = 0; i < all[k].steps; ++i) all[k].step();
      times[k].push_back(1e6 * (cpuSeconds() - start) / all[k].steps);
    }
  std::vector<double> medians;
  for (std::vector<double>& column : times) medians.push_back(median(column));
  return medians;
}

Figures ladderInTurn(const std::string& robots, const std::string& filter) {
  const std::regex wanted(filter);
  Figures figures;
  for (const std::string base : {"arm", "humanoid", "boxes"}) {
    std::vector<std::string> names;
    std::vector<Timed> timed;
    for (const Rung& rung : ladder(robots)) {
      const std::string of = rung.name.substr(0, rung.name.find('_'));
      const bool needed = rung.name == base + "_nothing";
      if (of != base && of != "plain" + base) continue;
      if (!needed && !std::regex_search("ladder_" + rung.name, wanted)) continue;
      names.push_back("ladder_" + rung.name);
      timed.push_back(repeated(rung.make(), 0));
    }
    const bool asked = names.size() > 1 || std::regex_search("ladder_" + base + "_nothing", wanted);
    if (!asked) continue;
    if (base == "arm") {
      const auto bare = std::make_shared<BareArm>(robots);
      names.push_back("ladder_arm_bare");
      timed.push_back({nullptr, [bare] { bare->dynamics(); }, kStepsOfPiece});
      names.push_back("ladder_arm_bare_midpoint");
      timed.push_back({nullptr, [bare] { bare->dynamics(), bare->midpoint(); }, kStepsOfPiece});
    }
    const std::vector<double> times = timeInTurn(timed);
    Figures us;
    for (std::size_t k = 0; k < names.size(); ++k) us[names[k]] = times[k];
    for (const auto& [name, time] : us) {
      figures[name + ".in_turn.us"] = time;
      const std::string nothing = name.substr(0, name.find('_', 7)) + "_nothing";
      if (us.count(nothing) && name != nothing && name.find("_bare") == std::string::npos)
        figures[name + ".added.us"] = time - us[nothing];
    }
    if (base != "arm") continue;
    for (const auto& [arm, bare] :
         {std::pair{"plainarm", "ladder_arm_bare"}, std::pair{"arm", "ladder_arm_bare_midpoint"}})
      for (const char* effect : {"nothing", "self_collision_idle"}) {
        const std::string rung = fmt::format("ladder_{}_{}", arm, effect);
        if (us.count(rung)) figures[rung + ".over_bare"] = us[rung] / us[bare];
      }
  }
  return figures;
}

Figures scalingInTurn(const std::string& robots, const std::string& filter) {
  const std::regex wanted(filter);
  std::map<std::string, std::vector<Rung>> kinds;
  for (const Rung& rung : scaling(robots))
    if (std::regex_search("scaling_" + rung.name, wanted))
      kinds[rung.name.substr(0, rung.name.find('_'))].push_back(rung);
  Figures figures;
  for (const auto& [kind, rungs] : kinds) {
    std::vector<Timed> timed;
    for (const Rung& rung : rungs) timed.push_back(repeated(rung.make(), 10, 10));
    const std::vector<double> times = timeInTurn(timed);
    for (std::size_t k = 0; k < rungs.size(); ++k)
      figures[fmt::format("scaling_{}.in_turn.us", rungs[k].name)] = times[k];
  }
  return figures;
}

}  // namespace softgauss::app
