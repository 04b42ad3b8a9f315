// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/explain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/text_table.hpp"
#include "softgauss/io/warning_list.hpp"

namespace softgauss::io {
namespace {

using detail::counted;
using detail::listed;

const char* kindName(JointKind kind) {
  switch (kind) {
    case JointKind::world:
      return "world";
    case JointKind::revolute:
      return "revolute";
    case JointKind::prismatic:
      return "prismatic";
    case JointKind::floating:
      return "floating";
  }
  return "";
}

std::string orDash(double x) { return x == 0.0 ? "-" : detail::shortNumber(x); }

std::string headText(const Model& model, const ExplainContext& context) {
  std::size_t actuated = 0;
  for (const Dof& dof : model.dofs) actuated += dof.actuated ? 1 : 0;
  const double moving = model.totalMass();
  const double mass = context.contents ? context.contents->mass : moving;
  const std::size_t links = context.contents ? idx(context.contents->links) : model.frames.size();

  std::string out = fmt::format("{}\n", model.name);
  out +=
      fmt::format("  {}{}, {} moving bodies after merging fixed joints\n", counted(links, "link"),
                  context.contents ? ", " + counted(idx(context.contents->joints), "joint") : "",
                  model.bodies.size() - 1);
  out += fmt::format("  {} degrees of freedom, {} actuated\n", model.nv, actuated);
  out += fmt::format("  {:.6g} kg", mass);
  if (std::abs(mass - moving) > 1e-9 * mass)
    out += fmt::format(", of which {:.6g} kg move", moving);
  out += "\n";
  for (const Tree& tree : model.trees) {
    const Body& root = model.bodies[idx(tree.rootBody)];
    out += root.joint == JointKind::floating
               ? fmt::format("  '{}' floats", model.bodyNames[idx(tree.rootBody)])
               : fmt::format("  '{}' hangs from the world on {} '{}'",
                             model.bodyNames[idx(tree.rootBody)], kindName(root.joint),
                             model.jointNames[idx(tree.rootBody)]);
    out += fmt::format(" ({} dof)\n", tree.dofEnd - tree.firstDof);
  }
  return out;
}

std::string jointsText(const Model& model, const ExplainContext& context) {
  std::map<int, const JointRange*> ranges;
  for (const JointRange& range : model.ranges) ranges[range.body] = &range;
  std::set<std::string> driven;
  for (const SceneActuator& actuator : context.actuators)
    for (const auto& [joint, coefficient] : actuator.joints) driven.insert(joint);
  detail::TextTable table;
  table.row({"joint", "kind", "moves", "range", "start", "effort", "damping", "friction"});
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[idx(b)];
    const std::string& joint = model.jointNames[idx(b)];
    if (body.joint == JointKind::floating) {
      table.row({joint, kindName(body.joint), model.bodyNames[idx(b)], "-", "-", "-", "-", "-"});
      continue;
    }
    const Dof& dof = model.dofs[idx(body.v)];
    const bool turns = body.joint == JointKind::revolute;
    const auto range = ranges.find(b);
    table.row({joint, kindName(body.joint), model.bodyNames[idx(b)],
               range == ranges.end() ? "-"
                                     : fmt::format("{:.4g} .. {:.4g} {}", range->second->lower,
                                                   range->second->upper, turns ? "rad" : "m"),
               detail::shortNumber(model.q0[body.q]),
               driven.count(joint) ? "by actuators"
               : !dof.actuated     ? "not actuated"
               : std::isinf(dof.effortUpper)
                   ? "no box"
                   : fmt::format("{:.4g} {}", dof.effortUpper, turns ? "N m" : "N"),
               orDash(dof.damping), orDash(dof.dryFriction)});
  }
  return "joints\n" + table.text();
}

std::string framesText(const Model& model) {
  std::vector<std::string> massless;
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[idx(b)].massless) massless.push_back(model.bodyNames[idx(b)]);
  std::map<int, std::vector<std::string>> merged;
  for (const Frame& frame : model.frames)
    if (frame.name != model.bodyNames[idx(frame.body)]) merged[frame.body].push_back(frame.name);

  std::string out;
  if (!massless.empty())
    out += fmt::format(
        "moving links without mass, which move with the links that hang from them\n  {}\n",
        listed(massless, massless.size()));
  if (!merged.empty()) {
    detail::TextTable table;
    for (const auto& [body, names] : merged)
      table.row({model.bodyNames[idx(body)], "<- " + listed(names, names.size())});
    out += "links on fixed joints, kept as frames of the body they are merged with\n";
    out += table.text();
  }
  return out;
}

const char* shapeName(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::plane:
      return "plane";
    case ShapeKind::sphere:
      return "sphere";
    case ShapeKind::capsule:
      return "capsule";
    case ShapeKind::cylinder:
      return "cylinder";
    case ShapeKind::box:
      return "box";
    case ShapeKind::ellipsoid:
      return "ellipsoid";
    case ShapeKind::mesh:
      return "mesh";
    case ShapeKind::triangles:
      return "triangle mesh";
  }
  return "";
}

std::string shapesText(const Model& model, const ExplainContext& context) {
  std::map<ShapeKind, std::size_t> counts;
  for (const Geometry& geometry : model.geometries) ++counts[geometry.shape.kind];
  std::vector<std::string> kinds;
  for (const auto& [kind, count] : counts)
    kinds.push_back(fmt::format("{} {}", shapeName(kind), count));
  std::string out = "collision shapes\n";
  out += fmt::format("  {}\n", kinds.empty() ? "none" : listed(kinds));
  if (context.testedPairs)
    out += fmt::format("  {} may touch\n", counted(idx(*context.testedPairs), "pair"));
  if (!model.contactPairs.empty())
    out +=
        fmt::format("  {} with a surface of its own\n", counted(model.contactPairs.size(), "pair"));
  std::map<std::string, std::vector<std::string>> byReason;
  for (const FilteredPair& pair : context.filtered)
    byReason[pair.reason].push_back(fmt::format("{} - {}{}{}", pair.first, pair.second,
                                                pair.detail.empty() ? "" : " ", pair.detail));
  if (context.unreachablePairs > 0)
    out += fmt::format("  {} never tested: out of each other's reach\n",
                       counted(static_cast<std::size_t>(context.unreachablePairs), "pair"));
  for (const auto& [reason, pairs] : byReason) {
    out += fmt::format("  {} never tested: {}\n", counted(pairs.size(), "pair"), reason);
    for (const std::string& pair : pairs) out += fmt::format("    {}\n", pair);
  }
  return out;
}

/// For each link how far it is from the others, the nearest first.
std::string clearancesText(const ExplainContext& context) {
  constexpr std::size_t kMost = 24;
  constexpr double kTouching = 1e-9;  // [m], above rounding
  std::map<std::string, std::vector<std::string>> links;
  for (const LinkDistance& pair : context.clearances) {
    const std::string distance =
        pair.distance > kTouching ? fmt::format("{:.4g} mm", 1e3 * pair.distance) : "touches";
    links[pair.first].push_back(pair.second + " " + distance);
    links[pair.second].push_back(pair.first + " " + distance);
  }
  if (links.empty()) return {};
  detail::TextTable table;
  for (const auto& [link, others] : links) table.row({link, listed(others, kMost)});
  return "clearance at the start, between links that no joint joins\n" + table.text();
}

std::string servosText(const Model& model) {
  detail::TextTable table;
  table.row({"servo of", "kp", "kd", "effort", "set point", "its rate"});
  bool any = false;
  for (const Dof& dof : model.dofs) {
    const Servo& s = dof.servo;
    if (!s.exists()) continue;
    any = true;
    table.row(
        {model.jointNames[idx(dof.body)], detail::shortNumber(s.kp), detail::shortNumber(s.kd),
         std::isfinite(s.effort) ? detail::shortNumber(s.effort) : "-",
         s.kp > 0.0 ? detail::shortNumber(s.setPoint) : "-", detail::shortNumber(s.setPointRate)});
  }
  return any ? "servos, which act where no goal does\n" + table.text() : "";
}

std::string actuatorsText(const ExplainContext& context) {
  if (context.actuators.empty()) return {};
  detail::TextTable table;
  table.row({"actuator", "drives, by the force per command", "bounds of the command"});
  for (const SceneActuator& actuator : context.actuators) {
    std::string joints;
    for (const auto& [joint, coefficient] : actuator.joints)
      joints += fmt::format("{}{} {:.4g}", joints.empty() ? "" : ", ", joint, coefficient);
    const bool bounded = std::isfinite(actuator.lower) || std::isfinite(actuator.upper);
    table.row({actuator.name, joints,
               bounded ? fmt::format("{:.4g} .. {:.4g}", actuator.lower, actuator.upper) : "-"});
  }
  return "actuators\n" + table.text();
}

std::string wrenchesText(const ExplainContext& context) {
  if (context.wrenches.empty()) return {};
  const auto vector = [](const Vector3& x, const char* unit) {
    return x.isZero(0.0) ? std::string("-")
                         : fmt::format("({:.4g}, {:.4g}, {:.4g}) {}", x.x(), x.y(), x.z(), unit);
  };
  detail::TextTable table;
  table.row({"link", "force", "moment", "at", "from", "to"});
  for (const TimedWrench& w : context.wrenches)
    table.row({w.link, vector(w.force_W, "N"), vector(w.moment_W, "N m"), vector(w.p_LP, "m"),
               fmt::format("{:.4g} s", w.start),
               std::isinf(w.end) ? "-" : fmt::format("{:.4g} s", w.end)});
  return "wrenches from outside, in world axes, at points of links\n" + table.text();
}

/// How many rows an effect may make: "21", or of how many pairs, "37 pairs", where the number of
/// points is not known before shapes touch; empty for what makes none of its own.
std::string mostRows(const Model& model, const ExplainContext& context, Effect effect) {
  const auto pairsThat = [&](auto&& belong) {
    const auto count =
        std::count_if(context.pairs.begin(), context.pairs.end(), [&](const auto& pair) {
          const auto robotOf = [&](int geometry) {
            return model.bodies[model.geometries[geometry].body].robot;
          };
          return belong(robotOf(pair.first), robotOf(pair.second));
        });
    return detail::counted(static_cast<std::size_t>(count), "pair");
  };
  switch (effect) {
    case Effect::jointLimit:
      return std::to_string(model.ranges.size());
    case Effect::dryFriction:
      return std::to_string(std::count_if(model.dofs.begin(), model.dofs.end(),
                                          [](const Dof& dof) { return dof.dryFriction > 0.0; }));
    case Effect::equality:
      return std::to_string(3 * model.connections.size() + 6 * model.welds.size() +
                            model.couplings.size());
    case Effect::groundContact:
      return pairsThat([](int a, int b) { return a < 0 || b < 0; });
    case Effect::selfCollision:
      return pairsThat([](int a, int b) { return a >= 0 && a == b; });
    case Effect::objectContact:
      return pairsThat([](int a, int b) { return a >= 0 && b >= 0 && a != b; });
    default:
      return {};
  }
}

/// A cost of a step; what a trial cannot tell from none is noise.
std::string costText(double us) {
  constexpr double kNoise = 0.1;
  return us < kNoise ? fmt::format("< {} µs", kNoise) : fmt::format("{:.2f} µs", us);
}

std::string mechanismsText(const Options& options) {
  detail::TextTable left, out;
  for (const MechanismName& m : kMechanismNames)
    (options.uses(m.mechanism) ? left : out).row({std::string(m.name), std::string(m.description)});
  std::string text = "mechanisms of the step\n" + left.text();
  if (!out.text().empty()) text += "mechanisms that are left out\n" + out.text();
  return text;
}

std::string effectsText(const Model& model, const ExplainContext& context) {
  detail::TextTable on, off;
  if (!context.costs.empty()) on.row({"", "rows", "at most", "memory", "a step", ""});
  for (const EffectNote& note : effectNotes(model, context.wrenches)) {
    if (!note.on || context.costs.empty()) {
      (note.on ? on : off).row({note.name, note.reason});
      continue;
    }
    const auto found = context.costs.find(note.name);
    const EffectCost cost = found == context.costs.end() ? EffectCost{} : found->second;
    on.row({note.name, std::to_string(cost.rows),
            mostRows(model, context, *effectFromName(note.name)), fmt::format("{} B", cost.bytes),
            found == context.costs.end() ? "-" : costText(cost.us), note.reason});
  }
  return "effects that are simulated, and the elements that call for them\n" + on.text() +
         "effects that are off, and why\n" + off.text();
}

/// What --reach, --hold and --q0, and goals in files, can name.
std::string aimsText(const Model& model) {
  std::vector<std::string> links, joints;
  for (const Frame& frame : model.frames)
    if (frame.body != 0) links.push_back(frame.name);
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[idx(b)].dofs == 1) joints.push_back(model.jointNames[idx(b)]);
  return fmt::format(
      "to aim at\n  links, for --reach, --hold and goals\n    {}\n  joints, for --q0, --torques "
      "and "
      "goals\n    {}\n",
      links.empty() ? "none" : listed(links, links.size()),
      joints.empty() ? "none" : listed(joints, joints.size()));
}

}  // namespace

std::string explain(const Model& model, const ExplainContext& context) {
  std::string out;
  const auto section = [&](const std::string& text) {
    if (!out.empty() && !text.empty()) out += "\n";
    out += text;
  };
  section(headText(model, context));
  section(jointsText(model, context));
  section(servosText(model));
  section(actuatorsText(context));
  section(framesText(model));
  section(shapesText(model, context));
  section(clearancesText(context));
  section(softnessText(model, context));
  section(wrenchesText(context));
  section(effectsText(model, context));
  section(mechanismsText(model.options));
  section(aimsText(model));
  if (const std::vector<std::string> told = grouped(model.warnings); !told.empty()) {
    std::string warnings = "warnings\n";
    for (const std::string& warning : told) warnings += "  " + warning + "\n";
    section(warnings);
  }
  return out;
}

}  // namespace softgauss::io
