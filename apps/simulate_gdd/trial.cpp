// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/trial.hpp"

#include <algorithm>

#include "apps/shared/median.hpp"
#include "apps/shared/wall_clock.hpp"
#include "softgauss/engine/engine.hpp"

namespace softgauss::app {
namespace {

constexpr int kStates = 100;
constexpr double kSeconds = 0.5;
/// Steps at one state; the least time counts, as anything else that runs only adds to it.
constexpr int kRepetitions = 3;

/// The scene with some of its effects.
struct Variant {
  Variant(Model m, collision::PreparedMeshes meshes)
      : model(std::move(m)),
        contacts(model, collision::SceneContacts::kBroadphasePairs, true, &meshes),
        data(model) {}

  /// Least wall time of a step from `state` [s], which is left alone.
  double time(const State& state) {
    double least = kInfinity;
    for (int i = 0; i < kRepetitions; ++i) {
      after = state;
      const Clock::time_point start = Clock::now();
      step(model, {}, after, data, &contacts);
      least = std::min(least, secondsSince(start));
    }
    return least;
  }

  Model model;
  collision::SceneContacts contacts;
  Data data;
  State after;
};

Model without(Model model, Effect effect) {
  model.options.effects.remove(effect);
  return model;
}

}  // namespace

std::map<std::string, io::EffectCost> tryEffects(const Scene& scene) {
  const collision::PreparedMeshes meshes = scene.contacts->meshes();
  Variant all(scene.model, meshes);
  std::map<std::string, io::EffectCost> costs;
  std::map<Effect, std::unique_ptr<Variant>> variants;
  for (const EffectName& e : kEffectNames)
    if (all.data.plan.effects.has(e.effect))
      variants[e.effect] = std::make_unique<Variant>(without(scene.model, e.effect), meshes);

  const Clock::time_point start = Clock::now();
  std::map<Effect, std::vector<double>> differences;
  State state = scene.initial;
  for (int i = 0; i < kStates && (i == 0 || secondsSince(start) < kSeconds); ++i) {
    const double whole = all.time(state);
    const std::array<EffectUse, kEffects> use = effectUse(all.model, all.data, &all.contacts);
    for (const auto& [effect, variant] : variants) {
      differences[effect].push_back(whole - variant->time(state));
      io::EffectCost& cost = costs[std::string(effectName(effect))];
      cost.rows = std::max(cost.rows, use[static_cast<std::size_t>(effect)].rows);
      cost.bytes = use[static_cast<std::size_t>(effect)].bytes;
    }
    if (isRefused(all.data.stats.status)) break;
    state = all.after;
  }
  for (auto& [effect, list] : differences)
    costs[std::string(effectName(effect))].us = 1e6 * median(list);
  return costs;
}

}  // namespace softgauss::app
