// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/named_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <string_view>

#include "softgauss/io/names.hpp"

namespace softgauss {
namespace {

using O = SimulationOptions;
using V = OptionValue;

template <bool O::*member>
bool setFlag(const V& value, O& o) {
  const bool* given = std::get_if<bool>(&value);
  if (given) o.*member = *given;
  return given != nullptr;
}

template <auto member>
bool setText(const V& value, O& o) {
  const auto* given = std::get_if<std::string>(&value);
  if (!given || given->empty()) return false;
  o.*member = *given;
  return true;
}

template <std::optional<double> O::*member>
bool setNumber(const V& value, O& o) {
  const double* given = std::get_if<double>(&value);
  if (!given || !std::isfinite(*given)) return false;
  o.*member = *given;
  return true;
}

/// One of two words, each of which gives the member a value.
template <class T>
bool setWord(const V& value, const std::vector<std::pair<const char*, T>>& words,
             const std::function<void(T)>& set) {
  const auto* given = std::get_if<std::string>(&value);
  for (const auto& [word, meaning] : words)
    if (given && *given == word) return set(meaning), true;
  return false;
}

bool setBase(const V& value, O& o) {
  return setWord<int>(value, {{"fixed", 0}, {"floating", 1}, {"auto", 2}}, [&](int which) {
    o.base = which == 0 ? BaseKind::fixed : which == 1 ? BaseKind::floating : BaseKind::automatic;
    o.guessBase = which == 2;
  });
}

bool setGround(const V& value, O& o) {
  const double* height = std::get_if<double>(&value);
  const auto* word = std::get_if<std::string>(&value);
  if (height ? !std::isfinite(*height) : !word || *word != "none") return false;
  o.groundIsDefault = false;
  o.ground.reset();
  if (height) o.ground = *height;
  return true;
}

bool setTimestep(const V& value, O& o) {
  const double* given = std::get_if<double>(&value);
  if (!given || !(*given > 0.0 && std::isfinite(*given))) return false;
  o.timestep = *given;
  return true;
}

bool setTolerance(const V& value, O& o) {
  const double* given = std::get_if<double>(&value);
  if (!given || !(*given > 0.0 && std::isfinite(*given))) return false;
  o.integrationTolerance = *given;
  return true;
}

bool setStart(const V& value, O& o) {
  const auto* given = std::get_if<std::map<std::string, double>>(&value);
  if (!given) return false;
  for (const auto& [joint, position] : *given)
    if (!std::isfinite(position)) return false;
  o.q0.assign(given->begin(), given->end());
  return true;
}

bool setIntegrator(const V& value, O& o) {
  const auto* word = std::get_if<std::string>(&value);
  const std::optional<Integrator> named = word ? io::integratorCalled(*word) : std::nullopt;
  if (named) o.integrator = *named;
  return named.has_value();
}

bool setEffects(const V& value, O& o) {
  if (const auto* word = std::get_if<std::string>(&value)) {
    if (*word != "auto" && *word != "none") return false;
    o.effects = *word == "auto" ? EffectSet::all() : EffectSet::none();
    return true;
  }
  const auto* names = std::get_if<std::vector<std::string>>(&value);
  if (!names) return false;
  EffectSet effects = EffectSet::none();
  for (const std::string& name : *names) {
    const std::optional<Effect> effect = effectFromName(name);
    if (!effect) return false;
    effects.insert(*effect);
  }
  o.effects = effects;
  return true;
}

bool setWithout(const V& value, O& o) {
  const auto* names = std::get_if<std::vector<std::string>>(&value);
  if (!names) return false;
  MechanismSet kept = MechanismSet::all();
  for (const std::string& name : *names) {
    const std::optional<Mechanism> mechanism = mechanismFromName(name);
    if (!mechanism) return false;
    kept.remove(*mechanism);
  }
  o.mechanisms = kept;
  return true;
}

bool setZeroEffort(const V& value, O& o) {
  return setWord<bool>(value, {{"passive", false}, {"unlimited", true}},
                       [&](bool unlimited) { o.zeroEffortIsUnlimited = unlimited; });
}

bool setCone(const V& value, O& o) {
  return setWord<Cone>(value, {{"pyramidal", Cone::pyramidal}, {"elliptic", Cone::elliptic}},
                       [&](Cone cone) { o.cone = cone; });
}

bool setSleep(const V& value, O& o) {
  const auto* word = std::get_if<std::string>(&value);
  const std::optional<Sleep> named = word ? io::sleepCalled(*word) : std::nullopt;
  if (named) o.sleep = named;
  return named.has_value();
}

bool setSolver(const V& value, O& o) {
  using gdd::GddSolver;
  return setWord<GddSolver>(value,
                            {{"active-set", GddSolver::activeSet},
                             {"augmented-lagrangian", GddSolver::augmentedLagrangian}},
                            [&](GddSolver solver) { o.gddSolver = solver; });
}

bool setControlCost(const V& value, O& o) {
  using gdd::ControlCost;
  return setWord<ControlCost>(
      value, {{"about-gravity", ControlCost::aboutGravity}, {"total", ControlCost::total}},
      [&](ControlCost cost) { o.controlCost = cost; });
}

bool setMeshes(const V& value, O& o) {
  using io::MeshUse;
  return setWord<MeshUse>(
      value,
      {{"auto", MeshUse::automatic}, {"hull", MeshUse::hull}, {"triangles", MeshUse::triangles}},
      [&](MeshUse use) { o.meshes = use; });
}

bool setCollision(const V& value, O& o) {
  return setWord<bool>(value, {{"own", false}, {"fcl", true}},
                       [&](bool fcl) { o.throughFcl = fcl; });
}

bool setCompatibility(const V& value, O& o) {
  return setWord<bool>(value, {{"none", false}, {"mujoco", true}},
                       [&](bool mujoco) { o.likeMujoco = mujoco; });
}

bool setPackagePaths(const V& value, O& o) {
  const auto* folders = std::get_if<std::vector<std::string>>(&value);
  if (folders) o.packagePaths.assign(folders->begin(), folders->end());
  return folders != nullptr;
}

bool setBudgetValue(const V& value, O& o) {
  const auto* text = std::get_if<std::string>(&value);
  const double* number = std::get_if<double>(&value);
  return (text || number) && setBudget(text ? *text : fmt::format("{}", *number), o);
}

bool setMostDofs(const V& value, O& o) {
  const double* given = std::get_if<double>(&value);
  if (!given || !(*given >= 1.0 && *given <= 1e9 && *given == std::floor(*given))) return false;
  o.mostDofs = static_cast<int>(*given);
  return true;
}

}  // namespace

const std::vector<NamedOption>& NamedOption::all() {
  static const std::string integrators = [] {
    std::string words = "one of ";
    for (const std::string& name : io::integratorNames())
      words += (words.size() > 7 ? ", " : "") + name;
    return words;
  }();
  static const std::vector<NamedOption> options = {
      {"base", "one of fixed, floating, auto", true, false, setBase},
      {"base_height", "a number", true, false, setNumber<&O::baseHeight>},
      {"ground", "a height [m] or none", true, false, setGround},
      {"q0", "joints and their positions", false, false, setStart},
      {"srdf", "a file, or none", true, false, setText<&O::srdf>},
      {"state", "the name of a state of the SRDF", true, false, setText<&O::state>},
      {"timestep", "a number above 0", false, false, setTimestep},
      {"integrator", integrators.c_str(), false, true, setIntegrator},
      {"integration_tolerance", "a number above 0", false, true, setTolerance},
      {"step_doubling", "true or false", false, true, setFlag<&O::stepDoubling>},
      {"cone", "one of pyramidal, elliptic", false, true, setCone},
      {"sleep", "one of none, objects, all", false, true, setSleep},
      {"exact_diagonal", "true or false", false, true, setFlag<&O::exactDiagonal>},
      {"effects", "auto, none or a list of effects", false, true, setEffects},
      {"without", "a list of mechanisms", false, true, setWithout},
      {"zero_effort", "one of passive, unlimited", false, false, setZeroEffort},
      {"infer_inertia", "true or false", false, false, setFlag<&O::inferInertia>},
      {"no_balance", "true or false", false, false, setFlag<&O::noBalance>},
      {"ignore_velocity_limits", "true or false", false, false, setFlag<&O::ignoreVelocityLimits>},
      {"gdd_solver", "one of active-set, augmented-lagrangian", false, true, setSolver},
      {"control_cost", "one of about-gravity, total", false, false, setControlCost},
      {"budget", "iterations, as 20, or a time, as 200us", false, false, setBudgetValue},
      {"meshes", "one of auto, hull, triangles", false, false, setMeshes},
      {"collision", "one of own, fcl", false, false, setCollision},
      {"compatibility", "one of none, mujoco", false, true, setCompatibility},
      {"package_paths", "a list of folders", false, false, setPackagePaths},
      {"most_dofs", "a whole number from 1 on", false, false, setMostDofs},
  };
  return options;
}

bool setBudget(const std::string& text, SimulationOptions& options) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !(number >= 0.0)) return false;
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (unit.empty()) {
    if (number != std::floor(number) || number > 1e9) return false;
    options.iterationBudget = static_cast<int>(number);
    return true;
  }
  for (const auto& [name, seconds] : {std::pair("us", 1e-6), std::pair("ms", 1e-3), {"s", 1.0}})
    if (unit == name) return options.timeBudget = number * seconds, true;
  return false;
}

const NamedOption* NamedOption::find(const std::string& name) {
  for (const NamedOption& option : all())
    if (name == option.name) return &option;
  return nullptr;
}

}  // namespace softgauss
