// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <set>

#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/explain.hpp"

namespace softgauss::io {
namespace {

using detail::counted;

/// What in the scene calls for an effect: how many, and the first of them.
struct Callers {
  std::size_t count = 0;
  std::string first;

  void add(const std::string& name) {
    if (count++ == 0) first = name;
  }
  std::string text(std::string_view noun) const {
    return fmt::format("{}, {}'{}'", counted(count, noun), count > 1 ? "first " : "", first);
  }
};

const std::string& jointOf(const Model& model, int body) {
  return model.jointNames[static_cast<std::size_t>(body)];
}

std::string bodyPair(const Model& model, int a, int b) {
  return model.bodyNames[static_cast<std::size_t>(a)] + " - " +
         model.bodyNames[static_cast<std::size_t>(b)];
}

template <class Predicate>
Callers dofsWith(const Model& model, Predicate&& predicate) {
  Callers callers;
  for (const Dof& dof : model.dofs)
    if (predicate(dof)) callers.add(jointOf(model, dof.body));
  return callers;
}

/// Shapes by what carries them.
struct ShapeCensus {
  Callers world, moving;
  std::set<int> robots;
  Callers selfTouching;  ///< robots with shapes on more than one body

  explicit ShapeCensus(const Model& model) {
    std::map<int, std::set<int>> bodies;  // by robot
    for (const Geometry& geometry : model.geometries) {
      const int robot = model.bodies[static_cast<std::size_t>(geometry.body)].robot;
      (robot < 0 ? world : moving).add(geometry.name);
      if (robot < 0) continue;
      robots.insert(robot);
      bodies[robot].insert(geometry.body);
    }
    for (const auto& [robot, touching] : bodies)
      if (touching.size() > 1)
        selfTouching.add(model.bodyNames[static_cast<std::size_t>(*touching.begin())]);
  }
};

/// Collects the notes; knows which effects the engine has and which are switched on.
class Notes {
 public:
  explicit Notes(const Model& model) : model_(model) {}

  void add(const char* name, bool asked, const std::string& why, const std::string& whyNot) {
    const std::optional<Effect> effect = effectFromName(name);
    EffectNote note{name, false, asked ? why : whyNot, asked};
    if (asked && !effect)
      note.reason += "; not simulated yet";
    else if (asked && !kBuiltEffects.has(*effect))
      note.reason += "; this build of the engine is without it";
    else if (asked && !model_.options.effects.has(*effect))
      note.reason += "; switched off by --effects";
    else
      note.on = asked;
    list.push_back(note);
  }
  void add(const char* name, const Callers& callers, std::string_view noun,
           const std::string& whyNot) {
    add(name, callers.count > 0, callers.text(noun), whyNot);
  }

  std::vector<EffectNote> list;

 private:
  const Model& model_;
};

}  // namespace

std::vector<EffectNote> effectNotes(const Model& model, const std::vector<TimedWrench>& wrenches) {
  const auto& g = model.options.gravity;
  const bool moves = model.nv > 0;
  const std::size_t moving = model.bodies.size() - 1;

  Callers ranges, equalities;
  for (const JointRange& range : model.ranges) ranges.add(jointOf(model, range.body));
  for (const Connection& c : model.connections) equalities.add(bodyPair(model, c.bodyA, c.bodyB));
  for (const Weld& w : model.welds) equalities.add(bodyPair(model, w.bodyA, w.bodyB));
  for (const JointCoupling& c : model.couplings) equalities.add(jointOf(model, c.follower));
  Callers torsional, rolling;
  for (const Geometry& geometry : model.geometries) {
    if (geometry.material.condim >= 4) torsional.add(geometry.name);
    if (geometry.material.condim >= 6) rolling.add(geometry.name);
  }
  for (const ContactPair& pair : model.contactPairs) {
    const std::string& name = model.geometries[static_cast<std::size_t>(pair.geometryA)].name;
    if (pair.material.condim >= 4) torsional.add(name);
    if (pair.material.condim >= 6) rolling.add(name);
  }
  Callers forced;
  for (const TimedWrench& wrench : wrenches) forced.add(wrench.link);
  const ShapeCensus shapes(model);

  Notes notes(model);
  notes.add("gravity", moves && !g.isZero(0.0),
            fmt::format("({:.6g}, {:.6g}, {:.6g}) m/s² on {:.4g} kg", g.x(), g.y(), g.z(),
                        model.totalMass()),
            moves ? "gravity is zero" : "nothing moves");
  notes.add("coriolis", moves,
            moving == 1 ? "1 moving body" : fmt::format("{} moving bodies", moving),
            "nothing moves");
  notes.add("damping", dofsWith(model, [](const Dof& d) { return d.damping > 0.0; }), "dof",
            "no joint has damping");
  notes.add("spring", dofsWith(model, [](const Dof& d) { return d.stiffness > 0.0; }), "dof",
            "no joint has a spring");
  notes.add("armature", dofsWith(model, [](const Dof& d) { return d.armature > 0.0; }), "dof",
            "no joint has rotor inertia");
  notes.add("actuation", dofsWith(model, [](const Dof& d) { return d.actuated; }), "actuated joint",
            "no joint is actuated");
  notes.add("external_wrench", forced, "wrench", "no force or moment is applied from outside");
  notes.add("joint_limit", ranges, "joint range", "no joint has a range");
  notes.add("dry_friction", dofsWith(model, [](const Dof& d) { return d.dryFriction > 0.0; }),
            "dof", "no joint has friction");
  notes.add("equality", equalities, "equality constraint", "no mimic joint, weld or connection");
  notes.add("self_collision", shapes.selfTouching, "robot", "no robot has shapes on two bodies");
  notes.add(
      "ground_contact", shapes.world.count > 0 && shapes.moving.count > 0,
      fmt::format("{} fixed to the world (first '{}') against {} that move",
                  counted(shapes.world.count, "shape"), shapes.world.first, shapes.moving.count),
      shapes.world.count == 0 ? "no ground or other shape is fixed to the world"
                              : "no moving body has a shape");
  notes.add("object_contact", shapes.robots.size() > 1,
            fmt::format("{} robots with shapes", shapes.robots.size()),
            "fewer than two robots have shapes");
  notes.add("torsional_friction", torsional, "shape", "no shape has condim 4 or 6");
  notes.add("rolling_friction", rolling, "shape", "no shape has condim 6");
  return notes.list;
}

std::vector<std::string> effectsOn(const std::vector<EffectNote>& notes) {
  std::vector<std::string> names;
  for (const EffectNote& note : notes)
    if (note.on) names.push_back(note.name);
  return names;
}

}  // namespace softgauss::io
