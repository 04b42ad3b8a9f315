// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/option.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace softgauss::io::mjcf {
namespace {

/// Flags that leave out effects.
struct EffectFlag {
  std::string_view name;
  std::initializer_list<Effect> effects;
};
const EffectFlag kEffectFlags[] = {
    {"equality", {Effect::equality}},
    {"frictionloss", {Effect::dryFriction}},
    {"limit", {Effect::jointLimit}},
    {"contact", {Effect::selfCollision, Effect::groundContact, Effect::objectContact}},
    {"spring", {Effect::spring}},
    {"damper", {Effect::damping}},
    {"passive", {Effect::spring, Effect::damping}},
    {"gravity", {Effect::gravity}},
    {"actuation", {Effect::actuation}},
    {"constraint",
     {Effect::equality, Effect::dryFriction, Effect::jointLimit, Effect::selfCollision,
      Effect::groundContact, Effect::objectContact}},
};

/// Flags that say how MuJoCo computes, not what; on or off they change nothing here.
constexpr std::string_view kWays[] = {"warmstart",   "sensor", "midphase", "eulerdamp", "autoreset",
                                      "nativeccd",   "island", "multiccd", "energy",    "fwdinv",
                                      "invdiscrete", "sleep",  "refsafe"};

void readFlags(const Element& e, Options& options, FileOptions& file) {
  e.expectAttributes({"constraint", "equality",     "frictionloss", "limit",     "contact",
                      "passive",    "spring",       "damper",       "gravity",   "clampctrl",
                      "warmstart",  "filterparent", "actuation",    "refsafe",   "sensor",
                      "midphase",   "eulerdamp",    "autoreset",    "nativeccd", "island",
                      "multiccd",   "override",     "energy",       "fwdinv",    "invdiscrete",
                      "sleep",      "diagexact"});
  const auto isOn = [&](std::string_view name, bool otherwise) {
    const auto word = e.word(name, {"disable", "enable"});
    return word ? *word == 1 : otherwise;
  };
  for (const EffectFlag& flag : kEffectFlags)
    if (!isOn(flag.name, true))
      for (const Effect effect : flag.effects) options.effects.remove(effect);
  if (isOn("override", false))
    e.fail(
        "override puts other margins and softness in place of the contacts' own, which is not "
        "simulated; expected disable");
  for (const char* needed : {"clampctrl", "filterparent"})
    if (!isOn(needed, true))
      e.fail(fmt::format("{} is disable, which is not simulated; expected enable", needed));
  if (isOn("diagexact", false)) options.exactDiagonal = true;
  for (const std::string_view way : kWays)
    if (e.has(way)) file.readPast.push_back("flag " + std::string(way));
}

}  // namespace

void readOption(const Element& e, Options& options, FileOptions& file) {
  e.expectAttributes({"timestep",
                      "impratio",
                      "tolerance",
                      "ls_tolerance",
                      "noslip_tolerance",
                      "ccd_tolerance",
                      "sleep_tolerance",
                      "mpr_tolerance",
                      "gravity",
                      "wind",
                      "magnetic",
                      "density",
                      "viscosity",
                      "o_margin",
                      "o_solref",
                      "o_solimp",
                      "o_friction",
                      "integrator",
                      "cone",
                      "jacobian",
                      "solver",
                      "iterations",
                      "ls_iterations",
                      "noslip_iterations",
                      "ccd_iterations",
                      "mpr_iterations",
                      "sdf_iterations",
                      "sdf_initpoints",
                      "actuatorgroupdisable",
                      "apirate",
                      "collision"});
  e.expectChildren({"flag"});
  const auto positive = [&](const char* name, double& x) {
    if (e.read(name, x) && !(x > 0.0))
      e.fail(fmt::format("{} is {:g}, expected more than 0", name, x));
  };
  positive("timestep", options.timestep);
  if (e.has("timestep")) file.timestepWhere = e.where;
  positive("impratio", options.impedanceRatio);
  e.read("gravity", options.gravity);
  if (const auto cone = e.word("cone", {"pyramidal", "elliptic"}))
    options.cone = *cone == 0 ? Cone::pyramidal : Cone::elliptic;
  if (e.word("integrator", {"Euler", "RK4", "implicit", "implicitfast"}))
    file.integrator = e.text("integrator");
  double medium = 0.0;
  for (const char* name : {"density", "viscosity"})
    if (e.read(name, medium) && medium != 0.0)
      e.fail(
          fmt::format("{} is {:g}: forces of a fluid are not simulated; expected 0", name, medium));
  if (Vector3 wind = Vector3::Zero(); e.read("wind", wind) && !wind.isZero(0.0))
    e.fail("wind is not simulated, expected 0 0 0");
  if (e.has("actuatorgroupdisable"))
    e.fail("actuatorgroupdisable is not read; expected the actuators left out of the file");
  if (e.word("collision", {"all", "predefined", "dynamic"}).value_or(0) != 0)
    e.fail("collision is given up by MuJoCo too; expected all, and contype and conaffinity");
  for (const char* way : {"tolerance", "ls_tolerance", "noslip_tolerance", "ccd_tolerance",
                          "sleep_tolerance", "mpr_tolerance", "jacobian", "solver", "iterations",
                          "ls_iterations", "noslip_iterations", "ccd_iterations", "mpr_iterations",
                          "magnetic", "apirate", "sdf_iterations", "sdf_initpoints"})
    if (e.has(way)) file.readPast.emplace_back(way);
  for (const Element& flags : e.children) readFlags(flags, options, file);
}

Integrator integratorOf(const std::string& word) {
  if (word == "RK4") return Integrator::rungeKutta4;
  if (word == "implicit") return Integrator::implicit;
  return Integrator::semiImplicitEuler;
}

}  // namespace softgauss::io::mjcf
