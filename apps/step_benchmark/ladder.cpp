// SPDX-License-Identifier: Apache-2.0
#include "apps/step_benchmark/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss::app {
namespace {

/// A description to which one effect is added.
struct Base {
  ModelBuilder builder;
  std::vector<std::string> joints;  ///< with one dof each
};

Base makeBase(const std::string& robots, const std::string& name) {
  Base base;
  const bool plain = name == "plainarm";
  base.builder = name == "boxes" ? freeBoxes(20, 0.1)
                                 : io::readUrdf(robots + "/" + (plain ? "arm" : name) + ".urdf");
  if (plain) {
    base.builder.options.integrator = Integrator::semiImplicitEuler;
    base.builder.options.implicitInSolve = false;
  }
  const Model model = base.builder.build();
  for (int b = 1; b < model.bodyCount(); ++b) {
    const auto i = static_cast<std::size_t>(b);
    if (model.bodies[i].dofs == 1) base.joints.push_back(model.jointNames[i]);
  }
  EffectSet& effects = base.builder.options.effects = EffectSet::none();
  for (const Effect e : {Effect::gravity, Effect::coriolis, Effect::armature, Effect::actuation})
    effects.insert(e);
  return base;
}

void addGround(Base& base, double height, int condim) {
  GeometrySpec plane;
  plane.name = "ground";
  plane.link = "world";
  plane.shape = Shape::plane();
  plane.X_LG.p.z() = height;
  plane.material.condim = condim;
  base.builder.geometry(plane);
  base.builder.options.effects.insert(Effect::groundContact);
}

/// Height of the lowest shape in the initial configuration [m].
double bottom(const Base& base) {
  const Model model = base.builder.build();
  Kinematics k(model);
  computeKinematics(model, State(model), k);
  double lowest = kInfinity;
  for (int tree = 0; tree < static_cast<int>(model.trees.size()); ++tree)
    lowest = std::min(lowest, collision::lowestPoint(model, k, tree));
  return lowest;
}

/// Adds the effect of a rung; false where the base has nothing that it could be added to.
bool addEffect(Base& base, const std::string& effect) {
  Options& options = base.builder.options;
  const auto eachJoint = [&](auto&& change) {
    for (const std::string& joint : base.joints) change(*base.builder.findJoint(joint));
    return !base.joints.empty();
  };
  if (effect == "nothing" || effect == "gdd") return effect == "nothing" || !base.joints.empty();
  if (effect == "damping") {
    options.effects.insert(Effect::damping);
    return eachJoint([](JointSpec& j) { j.damping = 0.5; });
  }
  if (effect == "limits_idle" || effect == "limits_active") {
    options.effects.insert(Effect::jointLimit);
    const bool active = effect == "limits_active";
    return eachJoint([&](JointSpec& j) { j.lower = active ? 0.01 : -50.0, j.upper = 50.0; });
  }
  if (effect == "dry_friction") {
    options.effects.insert(Effect::dryFriction);
    return eachJoint([](JointSpec& j) { j.dryFriction = 0.2; });
  }
  if (effect == "equality") {
    ConnectSpec tie;  // of the last body to where it is
    const Model model = base.builder.build();
    Kinematics k(model);
    computeKinematics(model, State(model), k);
    int body = model.bodyCount() - 1;
    while (model.bodies[static_cast<std::size_t>(body)].massless) --body;
    tie.linkA = model.bodyNames[static_cast<std::size_t>(body)];
    tie.linkB = "world";
    tie.p_LBP = k.X_WB[static_cast<std::size_t>(body)].p;
    options.effects.insert(Effect::equality);
    base.builder.connect(tie);
    return true;
  }
  if (effect == "self_collision_idle") {
    options.effects.insert(base.joints.empty() ? Effect::objectContact : Effect::selfCollision);
    return true;
  }
  addGround(base, effect == "ground_idle" ? bottom(base) - 0.5 : bottom(base) + 1e-4,
            effect == "rolling_friction" ? 6 : 3);
  if (effect == "elliptic_cone") options.cone = Cone::elliptic;
  if (effect == "rolling_friction") {
    options.effects.insert(Effect::torsionalFriction);
    options.effects.insert(Effect::rollingFriction);
  }
  return true;
}

std::unique_ptr<Scene> makeEffectScene(const std::string& robots, const std::string& base,
                                       const std::string& effect) {
  Base described = makeBase(robots, base);
  addEffect(described, effect);
  auto scene = makeScene(std::move(described.builder), false);
  if (effect == "gdd") {
    scene->state.q = scene->model.q0;
    if (base == "arm")
      addReach(*scene, "hand", {0.5, 0.3, 0.5});
    else
      addReach(*scene, "right_hand", {0.45, -0.25, 1.10});
  }
  return scene;
}

}  // namespace

std::vector<Rung> ladder(const std::string& robots) {
  std::vector<Rung> rungs;
  for (const char* effect : {"nothing", "self_collision_idle"})
    rungs.push_back({fmt::format("plainarm_{}", effect),
                     [=] { return makeEffectScene(robots, "plainarm", effect); }});
  for (const char* base : {"arm", "humanoid", "boxes"})
    for (const char* effect : {"nothing", "damping", "limits_idle", "limits_active", "dry_friction",
                               "equality", "self_collision_idle", "ground_idle", "contact",
                               "rolling_friction", "elliptic_cone", "gdd"}) {
      Base trial = makeBase(robots, base);
      if (!addEffect(trial, effect)) continue;
      rungs.push_back({fmt::format("{}_{}", base, effect),
                       [=] { return makeEffectScene(robots, base, effect); }});
    }
  return rungs;
}

std::unique_ptr<Scene> makeRung(const std::string& robots, const std::string& name) {
  for (const Rung& rung : ladder(robots))
    if (rung.name == name) return rung.make();
  throw std::runtime_error("there is no rung " + name);
}

}  // namespace softgauss::app
