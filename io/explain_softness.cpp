// SPDX-License-Identifier: Apache-2.0
/// The part of explain() that tells how deep things sink and how fast they creep.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/constraints/contact_softness.hpp"
#include "softgauss/engine/constraints/inverse_weight.hpp"
#include "softgauss/engine/constraints/stiction.hpp"
#include "softgauss/engine/constraints/supported_mass.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/text_table.hpp"
#include "softgauss/io/explain.hpp"

namespace softgauss::io {
namespace {

/// A body that rests on another, by one contact.
struct Rest {
  int geometryA = 0, geometryB = 0;
  double mass = 0.0;    ///< that rests [kg]
  double weight = 0.0;  ///< A [1/kg], as (5.1) and (5.3) have it
  double sinks = 0.0;   ///< rises with the depth
};

/// All that touch with one pair of surfaces: which sinks least, which most.
struct Group {
  std::string surfaces;
  Rest least, most;
  bool within = false;  ///< one robot; told where nothing else has these surfaces
};

std::string surfaceName(const Geometry& g, const ExplainContext& context) {
  for (const auto& [name, material] : context.materials)
    if (material == g.material) return name;
  return fmt::format("that of '{}'", g.name);
}

/// Pairs of geometries, by their surfaces.
std::vector<Group> groupsOf(const Model& model, const ExplainContext& context) {
  const InverseWeights weights(model);
  std::vector<std::string> names;
  for (const Geometry& g : model.geometries) names.push_back(surfaceName(g, context));
  std::map<std::pair<std::string, std::string>, Group> groups;
  for (const auto& [a, b] : context.pairs) {
    const Geometry &first = model.geometries[idx(a)], &second = model.geometries[idx(b)];
    Rest rest{a, b, restingMass(model, first.body, second.body),
              weights.translation[idx(first.body)] + weights.translation[idx(second.body)], 0.0};
    if (rest.mass == 0.0) continue;
    if (model.options.constraintModel == ConstraintModel::softgauss)
      rest.weight =
          cappedInverseMass(rest.weight, contactShare(model, first.body, second.body, 1, 1));
    std::pair<std::string, std::string> key = std::minmax(names[idx(a)], names[idx(b)]);
    std::string surfaces = key.first == key.second
                               ? fmt::format("{} on itself", key.first)
                               : fmt::format("{} and {}", key.first, key.second);
    const bool own = std::any_of(model.contactPairs.begin(), model.contactPairs.end(),
                                 [pair = std::pair(std::minmax(a, b))](const ContactPair& p) {
                                   return pair == std::minmax(p.geometryA, p.geometryB);
                                 });
    if (own) {
      surfaces = fmt::format("'{}' and '{}', a surface of their own", first.name, second.name);
      key = {surfaces, ""};
    }
    rest.sinks = rest.mass * (first.material.spring || second.material.spring ? 1.0 : rest.weight);
    const bool within = model.bodies[idx(first.body)].tree == model.bodies[idx(second.body)].tree;
    const auto [at, isNew] = groups.try_emplace(key, Group{surfaces, rest, rest, within});
    Group& group = at->second;
    if (within && !group.within) continue;
    if (group.within && !within) group = {surfaces, rest, rest, false};
    if (rest.sinks < group.least.sinks) group.least = rest;
    if (rest.sinks > group.most.sinks) group.most = rest;
  }
  std::vector<Group> list;
  for (auto& [key, group] : groups) list.push_back(std::move(group));
  return list;
}

/// What is in force between the two.
Material surfaceOf(const Model& model, const Rest& rest) {
  const int a = model.geometries[idx(rest.geometryA)].body;
  const int b = model.geometries[idx(rest.geometryB)].body;
  return effectiveMaterial(pairMaterial(model, rest.geometryA, rest.geometryB),
                           reducedMass(model, a, b), model.options);
}

/// The body that rests, of the two that a pair of geometries joins.
const std::string& restingBody(const Model& model, const Rest& rest) {
  const int a = model.geometries[idx(rest.geometryA)].body;
  const int b = model.geometries[idx(rest.geometryB)].body;
  const int tree = model.bodies[idx(a)].tree;
  const bool first = tree >= 0 && model.trees[idx(tree)].mass == rest.mass;
  return model.bodyNames[idx(first ? a : b)];
}

std::string formOf(const Material& pair, const Options& options) {
  if (pair.spring)
    return fmt::format("a spring of {:.4g} N/m, {:.4g} N s/m", pair.spring->stiffness,
                       pair.spring->damping);
  const Impedance& p = pair.impedance;
  if (options.hasRowLaw() && p == Impedance{}) return "near-rigid, as no softness is given";
  const std::string reference =
      p.direct
          ? fmt::format("reference {:.4g} 1/s², {:.4g} 1/s", p.direct->stiffness, p.direct->damping)
          : fmt::format("time constant {:.4g} s, damping ratio {:.4g}", p.timeConstant,
                        p.dampingRatio);
  return fmt::format("{}, impedance {:.4g} to {:.4g}", reference, p.dMin, p.dMax);
}

/// Creep under goals for each newton [m/(N s)]: what is near-rigid sticks (5.7), but for solver 1.
double creepUnderGoals(const Material& pair, const ContactAtRest& at, const Options& options) {
  const bool sticks = options.hasRowLaw() && !pair.spring && pair.impedance == Impedance{} &&
                      options.cone == Cone::pyramidal && options.uses(Mechanism::stiction);
  return (sticks ? kLeastUnderGoals : 1.0) * at.mobility;
}

}  // namespace

std::string softnessText(const Model& model, const ExplainContext& context) {
  const double gravity = model.options.gravity.norm();
  if (context.pairs.empty() || gravity == 0.0) return {};
  std::string out;
  for (const Group& group : groupsOf(model, context)) {
    detail::TextTable table;
    table.row({"on one contact", "sinks [mm]", "[N/m]", "[N s/m]",
               "under goals creeps [mm/s per N]", "up to [N]", "impedance",
               "reference [1/s²], [1/s]"});
    const bool both = group.least.sinks < group.most.sinks;
    for (const Rest* rest : {&group.least, both ? &group.most : nullptr}) {
      if (!rest) continue;
      const Material pair = surfaceOf(model, *rest);
      const ContactAtRest at =
          contactAtRest(pair, rest->weight, rest->mass * gravity, model.options);
      const bool rubs = at.mobility > 0.0;
      const double d = at.equivalent.dMax;
      const bool possible = d >= 1e-4 && d <= 0.9999;  // as an impedance, which is clamped
      table.row(
          {fmt::format("'{}', {:.4g} kg", restingBody(model, *rest), rest->mass),
           fmt::format("{:.4g}", 1e3 * at.depth), fmt::format("{:.4g}", at.stiffness),
           fmt::format("{:.4g}", at.damping),
           rubs ? fmt::format("{:.4g}", 1e3 * creepUnderGoals(pair, at, model.options)) : "slides",
           rubs ? fmt::format("{:.4g}", at.stickForce) : "-",
           possible ? fmt::format("{:.4g}", d) : "-",
           possible ? fmt::format("{:.4g}, {:.4g}", at.equivalent.direct->stiffness,
                                  at.equivalent.direct->damping)
                    : "-"});
    }
    const Material pair = surfaceOf(model, group.most);
    out += fmt::format("  {}: friction {:.4g}, condim {}, {}\n", group.surfaces,
                       pair.slidingFriction, pair.condim, formOf(pair, model.options));
    out += table.text();
  }
  if (out.empty()) return out;
  if (model.options.exactDiagonal)
    out +=
        "  With the exact diagonal, softness by an impedance follows the configuration;\n"
        "  these figures are those of the constant inverse weights.\n";
  return fmt::format("softness of contacts, {} (docs/guide/contact.md)\n",
                     model.options.cone == Cone::elliptic ? "elliptic cones" : "pyramidal cones") +
         out;
}

}  // namespace softgauss::io
