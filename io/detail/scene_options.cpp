// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/scene_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "softgauss/io/names.hpp"

namespace softgauss::io::detail {
namespace {

constexpr double kMostIterations = 1e6;

/// Calls f(name) for every item of a list, each one of `known`.
template <class Named, std::size_t n, class F>
void forNames(const YamlMap& map, const YamlMap::Entry& entry, const Named (&known)[n],
              const char* expected, F&& f) {
  if (entry.value.kind != YamlValue::Kind::list)
    map.fail(entry, fmt::format("found {}, expected {}", entry.value.described(), expected));
  std::vector<std::string> names;
  for (const Named& named : known) names.emplace_back(named.name);
  for (const YamlValue& item : entry.value.items)
    f(map.choice({entry.key, item, item.line}, names));
}

MechanismSet readWithout(const YamlMap& map, const YamlMap::Entry& entry) {
  MechanismSet kept = MechanismSet::all();
  forNames(map, entry, kMechanismNames, "a list of mechanisms",
           [&](const std::string& name) { kept.remove(*mechanismFromName(name)); });
  return kept;
}

EffectSet readEffects(const YamlMap& map, const YamlMap::Entry& entry) {
  if (entry.value.kind == YamlValue::Kind::text && entry.value.text == "auto")
    return EffectSet::all();
  EffectSet effects = EffectSet::none();
  forNames(map, entry, kEffectNames, "auto or a list of effects",
           [&](const std::string& name) { effects.insert(*effectFromName(name)); });
  return effects;
}

/// The integrator and the control of its error. A tolerance alone asks for dormand-prince; what
/// would change nothing is refused.
IntegrationKeys readIntegration(const YamlMap& map, Options& options) {
  const auto* integrator = map.find("integrator");
  const auto* tolerance = map.find("integration_tolerance");
  const auto* doubling = map.find("step_doubling");
  if (integrator)
    options.integrator = *integratorCalled(map.choice(*integrator, integratorNames()));
  map.read("integration_tolerance", options.integrationTolerance, Range::positive);
  if (doubling) options.stepDoubling = map.boolean(*doubling);
  if (!integrator && tolerance && !options.stepDoubling)
    options.integrator = Integrator::dormandPrince;
  const std::string_view name = integratorName(options.integrator);
  if (options.stepDoubling && !options.isSingleSolve())
    map.fail(*doubling, fmt::format("found true beside integrator {}, where it changes nothing, "
                                    "expected leapfrog, semi-implicit-euler or implicit",
                                    name));
  if (tolerance && !controlsError(options))
    map.fail(*tolerance, fmt::format("found {} beside integrator {}, which has no error control, "
                                     "expected dormand-prince or step_doubling: true",
                                     tolerance->value.described(), name));
  return {integrator != nullptr, tolerance != nullptr};
}

}  // namespace

IntegrationKeys readOptions(const YamlMap& map, Options& options,
                            std::optional<gdd::GddSolver>& solver) {
  map.expectOnly({"integrator", "integration_tolerance", "step_doubling", "cone", "sleep",
                  "exact_diagonal", "tolerance", "max_iterations", "impedance_ratio", "effects",
                  "without", "compatibility", "gdd_solver"});
  // First, for an integrator that is named counts.
  if (const auto* entry = map.find("compatibility"))
    options.useMujocoModel(map.choice(*entry, {"none", "mujoco"}) == "mujoco");
  const IntegrationKeys integration = readIntegration(map, options);
  if (const auto* entry = map.find("cone"))
    options.cone = map.choice(*entry, {"pyramidal", "elliptic"}) == "elliptic" ? Cone::elliptic
                                                                               : Cone::pyramidal;
  if (const auto* entry = map.find("sleep"))
    options.sleep = *sleepCalled(map.choice(*entry, {"none", "objects", "all"}));
  if (const auto* entry = map.find("gdd_solver"))
    solver = map.choice(*entry, {"active-set", "augmented-lagrangian"}) == "active-set"
                 ? gdd::GddSolver::activeSet
                 : gdd::GddSolver::augmentedLagrangian;
  if (const auto* entry = map.find("exact_diagonal")) options.exactDiagonal = map.boolean(*entry);
  map.read("tolerance", options.tolerance, Range::notNegative);
  if (const auto* entry = map.find("max_iterations")) {
    const double count = entry->value.finiteNumber().value_or(0.0);
    if (!(count >= 1.0) || count != std::floor(count) || count > kMostIterations)
      map.fail(*entry, fmt::format("found {}, expected a whole number from 1 to {:g}",
                                   entry->value.described(), kMostIterations));
    options.maxIterations = static_cast<int>(count);
  }
  map.read("impedance_ratio", options.impedanceRatio, Range::positive);
  if (const auto* entry = map.find("effects")) options.effects = readEffects(map, *entry);
  if (const auto* entry = map.find("without")) options.mechanisms = readWithout(map, *entry);
  return integration;
}

}  // namespace softgauss::io::detail
