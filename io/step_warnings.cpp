// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/step_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/constraints/contact_softness.hpp"
#include "softgauss/engine/constraints/inverse_weight.hpp"
#include "softgauss/engine/constraints/supported_mass.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::io {
namespace {

constexpr double kFarthestDrive = M_PI;    // h² u w [rad or m]
constexpr double kFastestSpring = 1.0;     // h √(k w)
constexpr double kHardestDamping = 100.0;  // h d w
constexpr double kFastestTie = 1.0;        // h √(ΣL g |r|/I)
constexpr double kLeastDamping = 0.1;      // d w [1/s]
constexpr double kUsualStep = 0.002;       // [s]
constexpr double kLongStep = 50.0;         // times that: what is softened is no news

void joints(const Model& model, const InverseWeights& weights, std::vector<std::string>& out) {
  const double h = model.options.timestep;
  const EffectSet& effects = model.options.effects;
  for (int i = 0; i < model.nv; ++i) {
    const Dof& dof = model.dofs[idx(i)];
    const double w = weights.dof[idx(i)];
    const std::string& joint = model.jointNames[idx(dof.body)];
    if (const double swing = h * std::sqrt(std::max(0.0, dof.stiffness * w));
        swing > kFastestSpring && effects.has(Effect::spring))
      out.push_back(fmt::format(
          "joint '{}': its spring of {:g} on an inertia of {:.3g} oscillates by {:.3g} rad in a "
          "step "
          "of "
          "{:g} s, expected at most {:g}; try a step below {:.2g} s, armature above {:.2g}, or a "
          "softer spring",
          joint, dof.stiffness, 1.0 / w, swing, h, kFastestSpring, h * kFastestSpring / swing,
          dof.stiffness * h * h));
    if (const double stop = h * dof.damping * w;
        stop > kHardestDamping && effects.has(Effect::damping))
      out.push_back(fmt::format(
          "joint '{}': its damping of {:g} on an inertia of {:.3g} is {:.3g} times what stops it "
          "in "
          "a step of {:g} s, expected at most {:g}; the joint hardly moves; try armature, or less "
          "damping",
          joint, dof.damping, 1.0 / w, stop, h, kHardestDamping));
    const double effort = std::max(-dof.effortLower, dof.effortUpper);
    if (const double way = h * h * effort * w;
        dof.actuated && std::isfinite(effort) && way > kFarthestDrive)
      out.push_back(fmt::format(
          "joint '{}': its effort of {:g} on an inertia of {:.3g} moves it by {:.3g} rad or m in "
          "the "
          "first step of {:g} s, expected at most {:.3g}; try armature above {:.2g}, or the effort "
          "that "
          "the actuator has",
          joint, effort, 1.0 / w, way, h, kFarthestDrive, h * h * effort / kFarthestDrive));
  }
}

/// What a step does not follow of a reference: a bounce that is too fast (3.5) or, where rows are
/// explicit, one that grows.
void reference(const Impedance& p, const std::string& what, const Options& options,
               std::vector<std::string>& out) {
  const double h = options.timestep;
  const auto [K, B] = referenceOf(p, h);
  if (!p.direct && p.timeConstant < 2.0 * h)
    out.push_back(
        fmt::format("{}: its time constant of {:g} s is clamped to {:g} s, two steps; try a step "
                    "of {:.2g} s",
                    what, p.timeConstant, 2.0 * h, 0.5 * p.timeConstant));
  if (!options.hasRowLaw()) {
    if (h * h * K + 2.0 * h * B > 4.0)
      out.push_back(
          fmt::format("{}: its reference of {:g}/s² and {:g}/s grows in steps of {:g} s; try a "
                      "step below {:.2g} s, or lower numbers",
                      what, K, B, h, K > 0.0 ? (std::sqrt(B * B + 4.0 * K) - B) / K : 2.0 / B));
  } else if (const double most = kFastestBounce / (h * h); B * B <= K && K > most * (1.0 + 1e-9)) {
    out.push_back(fmt::format(
        "{}: its spring of {:g}/s² is clamped to {:g}/s², as it would swing by more than half a "
        "radian in a step of {:g} s; try a step of {:.2g} s",
        what, K, most, h, std::sqrt(kFastestBounce / K)));
  }
}

void references(const Model& model, std::vector<std::string>& out) {
  const Options& options = model.options;
  std::vector<Material> seen;
  for (const Geometry& g : model.geometries) {
    if (g.material.spring || std::find(seen.begin(), seen.end(), g.material) != seen.end())
      continue;
    seen.push_back(g.material);
    reference(g.material.impedance, fmt::format("surface of '{}'", g.name), options, out);
  }
  for (const JointRange& range : model.ranges)
    reference(range.impedance,
              fmt::format("range of joint '{}'", model.jointNames[idx(range.body)]), options, out);
  for (const ContactPair& pair : model.contactPairs)
    if (!pair.material.spring)
      reference(pair.material.impedance,
                fmt::format("contact of '{}' and '{}'", model.geometries[idx(pair.geometryA)].name,
                            model.geometries[idx(pair.geometryB)].name),
                options, out);
  const auto between = [&](const char* what, int a, int b) {
    return fmt::format("{} of '{}' and '{}'", what, model.bodyNames[idx(a)],
                       model.bodyNames[idx(b)]);
  };
  for (const Connection& c : model.connections)
    reference(c.impedance, between("connection", c.bodyA, c.bodyB), options, out);
  for (const Weld& w : model.welds)
    reference(w.impedance, between("weld", w.bodyA, w.bodyB), options, out);
  for (const JointCoupling& c : model.couplings)
    reference(c.impedance, fmt::format("coupling of joint '{}'", model.jointNames[idx(c.follower)]),
              options, out);
}

/// A free body that hangs on equality constraints swings about its centre, as a bead on a string
/// does: the string's force is L g on each, at its arm r, against the least inertia across r.
void tiedSwings(const Model& model, const InverseWeights& weights, const ContactSet& touching,
                std::vector<std::string>& out) {
  const double h = model.options.timestep, g = model.options.gravity.norm();
  const EffectSet& effects = model.options.effects;
  if (!effects.has(Effect::equality) || !effects.has(Effect::gravity)) return;
  Kinematics kinematics(model);
  computeKinematics(model, State(model), kinematics);
  SupportedMass load;
  load.assemble(model, kinematics, touching, weights);
  std::vector<double> squares(model.bodies.size(), 0.0);  // ω²
  const auto add = [&](int body, int other, const Vector3& p_BP) {
    const Body& b = model.bodies[idx(body)];
    if (b.joint != JointKind::floating || b.massless) return;
    const Vector3 r = p_BP - b.com;
    if (r.norm() < 1e-9) return;
    Eigen::Matrix<double, 3, 2> across;
    across << frameFromNormal(r.normalized()).rightCols<2>();
    const Eigen::Matrix2d I = across.transpose() * b.I_Bcm.matrix() * across;
    const double least = 0.5 * (I.trace() - std::hypot(I(0, 0) - I(1, 1), 2.0 * I(0, 1)));
    squares[idx(body)] += load.mass(model, body, other) * g * r.norm() / least;
  };
  for (const Connection& c : model.connections)
    add(c.bodyA, c.bodyB, c.p_AP), add(c.bodyB, c.bodyA, c.p_BP);
  for (const Weld& w : model.welds)
    add(w.bodyA, w.bodyB, w.X_AF.p), add(w.bodyB, w.bodyA, w.X_BF.p);
  for (int b = 1; b < model.bodyCount(); ++b)
    if (const double swing = h * std::sqrt(squares[idx(b)]); swing > kFastestTie)
      out.push_back(
          fmt::format("link '{}' is light for the load on its connections and welds: it oscillates "
                      "by {:.3g} rad "
                      "in a step of {:g} s, expected at most {:g}; try a step below {:.2g} s, or "
                      "joints, which do not oscillate",
                      model.bodyNames[idx(b)], swing, h, kFastestTie, h * kFastestTie / swing));
}

/// `implicit` makes energy where links swing freely in each other.
void freeLinks(const Model& model, const InverseWeights& weights, std::vector<std::string>& out) {
  const Options& options = model.options;
  const bool ofOneEnd = options.integrator == Integrator::implicit ||
                        options.integrator == Integrator::semiImplicitEuler;
  if (!ofOneEnd || options.stepDoubling || !options.effects.has(Effect::coriolis)) return;
  for (const Tree& tree : model.trees) {
    int joints = 0, free = -1;
    for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
      const Body& body = model.bodies[idx(b)];
      if (body.joint == JointKind::floating) continue;
      ++joints;
      const double takes = model.dofs[idx(body.v)].damping * weights.dof[idx(body.v)];
      const bool damped = options.effects.has(Effect::damping) && takes > kLeastDamping;
      if (body.joint == JointKind::revolute && !damped && free < 0) free = b;
    }
    const bool floats = model.floats(model.bodies[idx(tree.rootBody)].tree);
    if (free < 0 || joints + floats < 2) continue;
    out.push_back(
        fmt::format("joint '{}' is hardly damped, and the integrator {} adds energy to freely "
                    "swinging links, as much as they have within seconds; try leapfrog, or damping",
                    model.jointNames[idx(free)], integratorName(options.integrator)));
  }
}

void overlaps(const Model& model, const ContactSet& touching, std::vector<std::string>& out) {
  std::map<std::pair<int, int>, double> deepest;
  for (const Contact& c : touching.contacts)
    if (-c.distance > kToldOverlap) {
      double& depth = deepest[{c.geometryA, c.geometryB}];
      depth = std::max(depth, -c.distance);
    }
  std::vector<std::pair<double, std::pair<int, int>>> order;
  for (const auto& [pair, depth] : deepest) order.emplace_back(-depth, pair);
  std::sort(order.begin(), order.end());
  for (const auto& [depth, pair] : order) {
    const Material m = pairMaterial(model, pair.first, pair.second);
    const double least = 2.0 * model.options.timestep;
    const double time = std::max(
        least, std::max(m.impedance.timeConstant, least) * std::min(1.0, m.impedance.dampingRatio));
    std::string speed;
    if (!m.spring && !m.impedance.direct)
      speed = fmt::format(" and leave each other with up to {:.2g} m/s", -depth / time);
    out.push_back(
        fmt::format("'{}' and '{}' overlap by {:.3g} mm at the start{}; try another start, or "
                    "larger distances",
                    model.geometries[idx(pair.first)].name, model.geometries[idx(pair.second)].name,
                    -1e3 * depth, speed));
  }
}

}  // namespace

std::vector<std::string> stepWarnings(const Model& model, const ContactSet& touching) {
  std::vector<std::string> out;
  const InverseWeights weights(model);
  const double times = model.options.timestep / kUsualStep;
  if (times >= kLongStep) {
    out.push_back(fmt::format(
        "a step of {:g} s is {:.3g} times the usual {:g} s: contacts, joint limits, springs and "
        "all else that is faster are softened or diverge; try --timestep {:g}",
        model.options.timestep, times, kUsualStep, kUsualStep));
  } else {
    joints(model, weights, out);
    references(model, out);
    tiedSwings(model, weights, touching, out);
  }
  freeLinks(model, weights, out);
  overlaps(model, touching, out);
  return out;
}

}  // namespace softgauss::io
