// SPDX-License-Identifier: Apache-2.0
#include "apps/python/options.hpp"

#include <functional>
#include <map>

#include "apps/python/arrays.hpp"
#include "softgauss/io/names.hpp"

namespace softgauss::python {
namespace {

using O = SimulationOptions;
using Setter = std::function<void(O&, const std::string& key, const py::handle&)>;

Setter number(std::optional<double> O::*member) {
  return [member](O& o, const std::string& key, const py::handle& value) {
    o.*member = valueOf<double>(value, key, "a number");
  };
}

Setter flag(bool O::*member) {
  return [member](O& o, const std::string& key, const py::handle& value) {
    o.*member = valueOf<bool>(value, key, "True or False");
  };
}

/// One of some words, each with what it means.
template <class T>
Setter choice(std::vector<std::pair<std::string, T>> choices, std::function<void(O&, T)> set) {
  return [=](O& o, const std::string& key, const py::handle& value) {
    const auto word = valueOf<std::string>(value, key, "a word");
    std::string known;
    for (const auto& [name, meaning] : choices) {
      if (name == word) return set(o, meaning);
      known += (known.empty() ? "" : ", ") + name;
    }
    throw py::value_error(key + ": found '" + word + "', expected one of " + known);
  };
}

void setGround(O& o, const std::string& key, const py::handle& value) {
  o.groundIsDefault = false;
  o.ground.reset();
  if (!value.is_none()) o.ground = valueOf<double>(value, key, "a height [m] or None");
}

void setStart(O& o, const std::string& key, const py::handle& value) {
  for (const auto& [name, q] :
       valueOf<std::map<std::string, double>>(value, key, "a dict of joints and positions"))
    o.q0.emplace_back(name, q);
}

void setPackagePaths(O& o, const std::string& key, const py::handle& value) {
  o.packagePaths = valueOf<std::vector<std::filesystem::path>>(value, key, "a list of folders");
}

Setter integrators() {
  std::vector<std::pair<std::string, Integrator>> choices;
  for (const std::string& name : io::integratorNames())
    choices.emplace_back(name, *io::integratorCalled(name));
  return choice<Integrator>(choices, [](O& o, Integrator i) { o.integrator = i; });
}

const std::map<std::string, Setter>& setters() {
  using gdd::ControlCost, gdd::GddSolver, io::MeshUse;
  static const std::map<std::string, Setter> all = {
      {"base", choice<BaseKind>({{"fixed", BaseKind::fixed}, {"floating", BaseKind::floating}},
                                [](O& o, BaseKind kind) { o.base = kind; })},
      {"base_height", number(&O::baseHeight)},
      {"ground", setGround},
      {"timestep", number(&O::timestep)},
      {"q0", setStart},
      {"integrator", integrators()},
      {"integration_tolerance", number(&O::integrationTolerance)},
      {"cone", choice<Cone>({{"pyramidal", Cone::pyramidal}, {"elliptic", Cone::elliptic}},
                            [](O& o, Cone cone) { o.cone = cone; })},
      {"gdd_solver", choice<GddSolver>({{"active-set", GddSolver::activeSet},
                                        {"augmented-lagrangian", GddSolver::augmentedLagrangian}},
                                       [](O& o, GddSolver solver) { o.gddSolver = solver; })},
      {"control_cost", choice<ControlCost>({{"about-gravity", ControlCost::aboutGravity},
                                            {"total", ControlCost::total}},
                                           [](O& o, ControlCost cost) { o.controlCost = cost; })},
      {"meshes", choice<MeshUse>({{"auto", MeshUse::automatic},
                                  {"hull", MeshUse::hull},
                                  {"triangles", MeshUse::triangles}},
                                 [](O& o, MeshUse use) { o.meshes = use; })},
      {"collision",
       choice<bool>({{"own", false}, {"fcl", true}}, [](O& o, bool fcl) { o.throughFcl = fcl; })},
      {"compatibility", choice<bool>({{"none", false}, {"mujoco", true}},
                                     [](O& o, bool mujoco) { o.likeMujoco = mujoco; })},
      {"no_slip", flag(&O::noSlip)},
      {"ignore_velocity_limits", flag(&O::ignoreVelocityLimits)},
      {"package_paths", setPackagePaths},
      {"without_goals", flag(&O::withoutGoals)},
  };
  return all;
}

}  // namespace

SimulationOptions optionsFrom(const py::kwargs& keywords) {
  SimulationOptions options;
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    const auto setter = setters().find(name);
    if (setter == setters().end()) {
      std::string known;
      for (const auto& [other, unused] : setters()) known += (known.empty() ? "" : ", ") + other;
      throw py::type_error("found the option '" + name + "', expected one of " + known);
    }
    setter->second(options, name, value);
  }
  return options;
}

}  // namespace softgauss::python
