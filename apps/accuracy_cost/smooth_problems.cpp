// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "apps/accuracy_cost/elliptic.hpp"
#include "apps/accuracy_cost/problem.hpp"
#include "apps/accuracy_cost/rigid_body_motion.hpp"
#include "softgauss/io/urdf.hpp"

/// Problems without contact.

namespace softgauss::app {
namespace {

constexpr double kGravity = 9.81;
constexpr double kDegree = std::numbers::pi / 180.0;

LinkSpec named(const std::string& name) {
  LinkSpec link;
  link.name = name;
  return link;
}

/// θ̈ = −ω² sin θ from rest at θ₀:  sin ½θ = k cd(ω t), k = sin ½θ₀.
Problem pendulum() {
  static constexpr double kMass = 1.0, kLength = 0.5, kRadius = 0.05, kStart = 1.5;
  Problem p;
  p.name = "pendulum";
  p.lossless = true;
  p.title = "Pendulum from 86°, against elliptic functions";
  p.build = [] {
    ModelBuilder builder("pendulum");
    LinkSpec bob = named("bob");
    bob.mass = kMass;
    bob.com = Vector3(0, 0, -kLength);
    bob.I_Lcm = 0.4 * kMass * kRadius * kRadius * Matrix3::Identity();
    builder.link(named("world")).link(bob);
    builder.joint(
        joint("hinge", JointType::continuous, "world", "bob", Vector3::UnitY(), Vector3::Zero()));
    return builder;
  };
  p.start = [](const Model&, State& state) { state.q[0] = kStart; };
  p.exact = [](const Model&, double t, State& state) {
    const double inertia = kMass * kLength * kLength + 0.4 * kMass * kRadius * kRadius;
    const double omega = std::sqrt(kMass * kGravity * kLength / inertia);
    const double k = std::sin(0.5 * kStart);
    const Jacobi e = jacobi(omega * t, k);
    const double cd = e.cn / e.dn;
    state.q[0] = 2.0 * std::asin(k * cd);
    // d cd/du = −(1 − k²) sn/dn²
    const double rate = -(1.0 - k * k) * e.sn / (e.dn * e.dn) * omega;
    state.v[0] = 2.0 * k * rate / std::sqrt(1.0 - k * k * cd * cd);
  };
  return p;
}

/// q̈ = −(k q + d q̇)/m, underdamped.
Problem springMassDamper() {
  static constexpr double kMass = 2.0, kStiffness = 800.0, kDamping = 8.0, kStart = 0.1;
  Problem p;
  p.name = "spring_mass_damper";
  p.title = "Mass on a damped spring, against the closed form";
  p.build = [] {
    ModelBuilder builder("spring");
    builder.options.effects.remove(Effect::gravity);
    builder.link(named("world")).link(boxLink("mass", kMass, {0.05, 0.05, 0.05}));
    JointSpec slide =
        joint("slide", JointType::prismatic, "world", "mass", Vector3::UnitX(), Vector3::Zero());
    slide.stiffness = kStiffness;
    slide.damping = kDamping;
    builder.joint(slide);
    return builder;
  };
  p.start = [](const Model&, State& state) { state.q[0] = kStart; };
  p.exact = [](const Model&, double t, State& state) {
    const double s = 0.5 * kDamping / kMass, w = std::sqrt(kStiffness / kMass - s * s);
    const double decay = kStart * std::exp(-s * t);
    state.q[0] = decay * (std::cos(w * t) + s / w * std::sin(w * t));
    state.v[0] = -decay * (w + s * s / w) * std::sin(w * t);
  };
  return p;
}

ModelBuilder chain(int links, bool planar) {
  ModelBuilder builder("chain");
  builder.link(named("world"));
  std::string parent = "world";
  for (int i = 0; i < links; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(boxLink(name, 1.0, {0.02, 0.02, 0.1}, {0, 0, -0.1}));
    builder.joint(joint("joint" + std::to_string(i), JointType::continuous, parent, name,
                        planar || i % 2 == 0 ? Vector3::UnitY() : Vector3::UnitX(),
                        Vector3(0, 0, i == 0 ? 0.0 : -0.2)));
    parent = name;
  }
  return builder;
}

Problem chainProblem(const std::string& name, const std::string& title, int links, bool planar,
                     double bend) {
  Problem p;
  p.name = name;
  p.title = title;
  p.lossless = true;
  p.build = [=] { return chain(links, planar); };
  p.start = [=](const Model& model, State& state) {
    for (int i = 0; i < model.nv; ++i) state.q[i] = i == 0 ? 1.2 : bend;
  };
  return p;
}

/// Precession about z, tilt, spin: three hinges in one point.
Problem top() {
  static constexpr double kMass = 1.0, kHeight = 0.1, kSpin = 100.0, kTilt = 20.0 * kDegree;
  static constexpr double kAcross = 8e-4, kAxial = 1.2e-3;
  Problem p;
  p.name = "spinning_top";
  p.lossless = true;
  p.title = "Heavy symmetric top, 100 rad/s, tilted by 20°, against elliptic functions";
  p.build = [] {
    ModelBuilder builder("top");
    builder.link(named("world")).link(named("precession")).link(named("tilt"));
    LinkSpec body = named("top");
    body.mass = kMass;
    body.com = Vector3(0, 0, kHeight);
    body.I_Lcm = Vector3(kAcross, kAcross, kAxial).asDiagonal();
    builder.link(body);
    builder.joint(joint("phi", JointType::continuous, "world", "precession", Vector3::UnitZ(),
                        Vector3::Zero()));
    // At zero it is tilted, for where the axes of precession and spin are parallel M is singular.
    JointSpec theta = joint("theta", JointType::continuous, "precession", "tilt", Vector3::UnitX(),
                            Vector3::Zero());
    theta.X_PC.R = Eigen::AngleAxisd(kTilt, Vector3::UnitX()).toRotationMatrix();
    builder.joint(theta);
    builder.joint(
        joint("psi", JointType::continuous, "tilt", "top", Vector3::UnitZ(), Vector3::Zero()));
    return builder;
  };
  p.start = [](const Model&, State& state) { state.v[2] = kSpin; };
  p.exact = [](const Model&, double t, State& state) {
    const TopAngles top = topAngles(kAcross + kMass * kHeight * kHeight, kAxial,
                                    kMass * kGravity * kHeight, kTilt, kSpin, t);
    state.q << top.precession, top.tilt - kTilt, top.spin;
    state.v << top.precessionRate, top.tiltRate, top.spinRate;
  };
  return p;
}

Problem freeBody() {
  Problem p;
  p.name = "free_body";
  p.lossless = true;
  p.title = "Torque-free body, 10 rad/s near its middle axis, against elliptic functions";
  p.build = [] {
    ModelBuilder builder("free");
    builder.options.effects.remove(Effect::gravity);
    builder.base = BaseKind::floating;
    builder.link(boxLink("body", 1.0, {0.05, 0.1, 0.2}));
    return builder;
  };
  p.start = [](const Model&, State& state) { state.v << 0.3, -0.2, 0.1, 0.2, 10.0, 0.1; };
  p.exact = [](const Model& model, double t, State& state) {
    const Matrix3 I = boxLink("body", 1.0, {0.05, 0.1, 0.2}).I_Lcm;
    const Turn turn = freeTurn(I.diagonal(), Vector3(0.2, 10.0, 0.1), t);
    const Eigen::Quaterniond rotation(turn.R_WB);
    const Vector3 velocity(0.3, -0.2, 0.1);
    state.q = State(model).q;
    state.q.head<3>() += t * velocity;
    state.q.tail<4>() << rotation.w(), rotation.vec();
    state.v << velocity, turn.w_B;
  };
  return p;
}

Problem arm(const std::string& robots) {
  Problem p;
  p.name = "arm";
  p.title = "Arm moved by open-loop torques, within its limits";
  p.passive = false;
  p.periods = p.windowPeriods = 31;
  p.build = [robots] { return io::readUrdf(robots + "/arm.urdf"); };
  p.start = [](const Model& model, State& state) {
    for (int i = 0; i < model.nv; ++i) state.q[i] = 0.3 * (i % 2 == 0 ? 1.0 : -1.0);
  };
  // What holds it at the start, and a slow wave on top, a tenth of it.
  p.force = [](const Model& model, double t, VectorX& tau) {
    State state(model);
    for (int i = 0; i < model.nv; ++i) state.q[i] = 0.3 * (i % 2 == 0 ? 1.0 : -1.0);
    Data data(model);
    computeStages(model, {}, state, data, nullptr);
    tau = data.forces.bias;
    for (int i = 0; i < model.nv; ++i)
      tau[i] *= 1.0 + 0.1 * std::sin(2.0 * std::numbers::pi * t + i);
  };
  return p;
}

Problem astronaut(const std::string& robots) {
  Problem p;
  p.name = "humanoid_in_the_air";
  p.title = "Humanoid without gravity or ground, all joints in motion";
  p.build = [robots] {
    ModelBuilder builder = io::readUrdf(robots + "/humanoid.urdf");
    builder.base = BaseKind::floating;
    for (const Effect effect : {Effect::gravity, Effect::selfCollision, Effect::jointLimit})
      builder.options.effects.remove(effect);
    return builder;
  };
  p.periods = p.windowPeriods = 31;
  p.start = [](const Model& model, State& state) {
    for (int i = 0; i < model.nv; ++i) state.v[i] = std::sin(1.0 + 1.7 * i);
  };
  return p;
}

}  // namespace

LinkSpec boxLink(const std::string& name, double mass, const Vector3& half, const Vector3& com) {
  LinkSpec link;
  link.name = name;
  link.mass = mass;
  link.com = com;
  const Vector3 s = half.cwiseProduct(half) * mass / 3.0;
  link.I_Lcm = Vector3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal();
  return link;
}

JointSpec joint(const std::string& name, JointType type, const std::string& parent,
                const std::string& child, const Vector3& axis, const Vector3& place) {
  JointSpec spec;
  spec.name = name;
  spec.type = type;
  spec.parent = parent;
  spec.child = child;
  spec.axis = axis;
  spec.X_PC.p = place;
  return spec;
}

std::vector<Problem> smoothProblems(const std::string& robots) {
  return {pendulum(),
          springMassDamper(),
          chainProblem("double_pendulum", "Double pendulum", 2, true, 0.5),
          top(),
          freeBody(),
          chainProblem("chain_5", "Planar chain of 5 links", 5, true, 0.1),
          chainProblem("chain_20", "Chain of 20 links with crossed axes", 20, false, 0.05),
          arm(robots),
          astronaut(robots)};
}

}  // namespace softgauss::app
