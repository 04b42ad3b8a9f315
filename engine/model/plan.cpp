// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/plan.hpp"

#include <algorithm>
#include <set>

namespace softgauss {
namespace {

/// A tree whose rows of M have nothing beside the diagonal: one joint of one dof, or a free body
/// about its centre of mass and principal axes.
bool isDiagonal(const Model& model, const Tree& tree) {
  if (tree.dofEnd - tree.firstDof == 1) return true;
  if (tree.bodyEnd - tree.rootBody != 1) return false;
  const Body& body = model.bodies[tree.rootBody];
  return body.com.isZero(0.0) && body.I_Bcm.xy == 0.0 && body.I_Bcm.xz == 0.0 &&
         body.I_Bcm.yz == 0.0;
}

/// Which contacts the shapes allow, whatever the switches say.
EffectSet possibleContacts(const Model& model) {
  EffectSet possible = EffectSet::none();
  bool world = false;
  std::set<int> robots, bodies;
  for (const Geometry& geometry : model.geometries) {
    const int robot = model.bodies[geometry.body].robot;
    if (geometry.body == 0) {
      world = true;
      continue;
    }
    if (bodies.insert(geometry.body).second && !robots.insert(robot).second)
      possible.insert(Effect::selfCollision);
  }
  if (world && !robots.empty()) possible.insert(Effect::groundContact);
  if (robots.size() > 1) possible.insert(Effect::objectContact);
  return possible;
}

/// Whether a connection has a lever on a floating tree, which may swing too fast for a step
/// (6.8).
bool mayNeedGeometricStiffness(const Model& model) {
  const Options& o = model.options;
  if (!o.uses(Mechanism::geometricStiffness) || o.isMultiStage() ||
      o.integrator == Integrator::implicit)
    return false;
  const auto hasLever = [&](int body, const Vector3& p_BP) {
    const Body& b = model.bodies[body];
    if (b.tree < 0) return false;
    const bool isRoot = body == model.trees[b.tree].rootBody;
    return model.floats(b.tree) && !(isRoot && p_BP == b.com);
  };
  return std::any_of(model.connections.begin(), model.connections.end(), [&](const Connection& c) {
    return hasLever(c.bodyA, c.p_AP) || hasLever(c.bodyB, c.p_BP);
  });
}

}  // namespace

Plan::Plan(const Model& model) : options_(model.options) {
  const EffectSet& allowed = model.options.effects;
  const auto run = [&](Effect effect, bool called) {
    const bool runs = called && allowed.has(effect) && kBuiltEffects.has(effect);
    if (runs) effects.insert(effect);
    return runs;
  };
  const auto anyDof = [&](auto&& has) {
    return std::any_of(model.dofs.begin(), model.dofs.end(), has);
  };
  const auto anySurface = [&](auto&& has) {
    return std::any_of(model.geometries.begin(), model.geometries.end(),
                       [&](const Geometry& g) { return has(g.material); }) ||
           std::any_of(model.contactPairs.begin(), model.contactPairs.end(),
                       [&](const ContactPair& p) { return has(p.material); });
  };

  // Smooth forces and the integrator.
  gravity = run(Effect::gravity, model.nv > 0 && !model.options.gravity.isZero(0.0));
  bearsWeight = gravity && std::any_of(model.bodies.begin(), model.bodies.end(),
                                       [](const Body& b) { return b.borneMass != 0.0; });
  coriolis = run(Effect::coriolis,
                 std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) {
                   return body.joint == JointKind::revolute || body.joint == JointKind::floating;
                 }));
  const bool euler = model.options.integrator == Integrator::semiImplicitEuler;
  drifts = model.options.integrator == Integrator::leapfrog;
  inSolve = (model.options.implicitInSolve && euler) || drifts;
  if (run(Effect::damping, anyDof([](const Dof& d) { return d.damping > 0.0; }))) {
    damping.resize(model.nv);
    for (int i = 0; i < model.nv; ++i) damping[i] = model.dofs[i].damping;
  }
  if (run(Effect::spring, anyDof([](const Dof& d) { return d.stiffness != 0.0; })))
    for (int i = 0; i < model.nv; ++i) {
      const Dof& dof = model.dofs[i];
      if (dof.stiffness != 0.0)
        springs.push_back({i, model.bodies[dof.body].q, dof.stiffness, dof.springReference});
    }
  run(Effect::armature, anyDof([](const Dof& d) { return d.armature != 0.0; }));
  externalWrench = run(Effect::externalWrench, model.nv > 0);  // Input is not of the model
  for (const Tree& tree : model.trees) diagonal.push_back(isDiagonal(model, tree));
  anyDiagonal = std::ranges::count(diagonal, 1) > 0;
  allDiagonal = anyDiagonal && std::ranges::count(diagonal, 0) == 0;

  // Rows.
  const bool servos = anyDof([](const Dof& d) { return d.servo.exists(); });
  if (run(Effect::actuation, servos || anyDof([](const Dof& d) { return d.actuated; })) && servos)
    rows.insert(RowKind::servo);
  if (run(Effect::jointLimit, !model.ranges.empty())) rows.insert(RowKind::jointLimit);
  if (run(Effect::dryFriction, anyDof([](const Dof& d) { return d.dryFriction != 0.0; })))
    rows.insert(RowKind::dryFriction);
  if (run(Effect::equality,
          !model.connections.empty() || !model.welds.empty() || !model.couplings.empty())) {
    if (!model.connections.empty()) rows.insert(RowKind::connection);
    if (mayNeedGeometricStiffness(model)) rows.insert(RowKind::geometricStiffness);
    if (!model.welds.empty()) rows.insert(RowKind::weld);
    if (!model.couplings.empty()) rows.insert(RowKind::coupling);
  }
  const EffectSet possible = possibleContacts(model);
  bool contacts = false;
  for (const Effect effect : {Effect::selfCollision, Effect::groundContact, Effect::objectContact})
    contacts |= run(effect, possible.has(effect));
  if (!contacts) return;
  const auto rubs = [](const Material& m) { return m.slidingFriction >= kSmallestFriction; };
  // A mix takes the larger condim and the larger coefficient, or those of the higher priority.
  const bool friction = anySurface([](const Material& m) { return m.condim > 1; }) &&
                        anySurface([&](const Material& m) { return rubs(m); });
  const bool frictionless =
      anySurface([&](const Material& m) { return m.condim == 1 || !rubs(m); });
  const bool elliptic = model.options.cone == Cone::elliptic;
  if (frictionless || !elliptic) rows.insert(RowKind::pyramid);
  if (elliptic && friction) rows.insert(RowKind::ellipticCone);
  if (run(Effect::torsionalFriction, anySurface([](const Material& m) { return m.condim >= 4; })))
    run(Effect::rollingFriction, anySurface([](const Material& m) { return m.condim >= 6; }));
}

bool Plan::fits(const Model& model) const {
  const Options &now = model.options, &then = options_;
  for (int i = 0; i < model.nv; ++i) {
    const Dof& dof = model.dofs[i];
    if (dof.dryFriction != 0.0 && now.effects.has(Effect::dryFriction) &&
        !rows.has(RowKind::dryFriction))
      return false;
    if (dof.servo.exists() && now.effects.has(Effect::actuation) && !rows.has(RowKind::servo))
      return false;
    const double planned = hasDamping() ? damping[i] : 0.0;
    if (now.effects.has(Effect::damping) && dof.damping != planned) return false;
  }
  return now.effects == then.effects && now.gravity == then.gravity &&
         now.implicitInSolve == then.implicitInSolve && now.integrator == then.integrator &&
         now.cone == then.cone && now.exactDiagonal == then.exactDiagonal &&
         now.mechanisms == then.mechanisms;
}

}  // namespace softgauss
