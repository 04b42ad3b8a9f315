// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/accuracy_cost/problem.hpp"
#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/io/urdf.hpp"

/// Problems with contact.

namespace softgauss::app {
namespace {

GeometrySpec shape(const std::string& link, const Shape& shape, double friction) {
  GeometrySpec g;
  g.name = link + "/shape";
  g.link = link;
  g.shape = shape;
  g.material.slidingFriction = friction;
  return g;
}

ModelBuilder floating(const LinkSpec& link, const Shape& solid, double friction,
                      const Vector3& place) {
  ModelBuilder builder("body");
  builder.base = BaseKind::floating;
  builder.X_WRoot.p = place;
  builder.link(link);
  builder.geometry(shape(link.name, solid, friction));
  return builder;
}

/// All methods have the same law of contact: the leapfrog's near-rigid rows depend on the step, and
/// no other integrator has them.
void addRoughGround(ModelBuilder& builder, double friction) {
  builder.options.mechanisms.remove(Mechanism::nearRigid);
  builder.geometry(shape("world", Shape::plane(), friction));
}

LinkSpec ball(const std::string& name, double mass, double radius) {
  LinkSpec link;
  link.name = name;
  link.mass = mass;
  link.I_Lcm = 0.4 * mass * radius * radius * Matrix3::Identity();
  return link;
}

LinkSpec capsule(const std::string& name, double mass, double radius, double half) {
  LinkSpec link;
  link.name = name;
  link.mass = mass;
  const double along = 0.5 * mass * radius * radius;
  const double across = mass * (0.25 * radius * radius + half * half / 3.0);
  link.I_Lcm = Vector3(across, across, along).asDiagonal();
  return link;
}

Problem contactProblem(const std::string& name, const std::string& title, int periods) {
  Problem p;
  p.name = name;
  p.title = title;
  p.periods = periods;
  return inWindows(std::move(p));
}

Problem slidingBlock() {
  Problem p = contactProblem("sliding_block", "Block sliding to rest on a plane, mu = 0.3", 31);
  p.build = [] {
    const Vector3 half(0.1, 0.1, 0.05);
    ModelBuilder builder =
        floating(boxLink("block", 1.0, half), Shape::box(half), 0.3, {0, 0, 0.05});
    addRoughGround(builder, 0.3);
    return builder;
  };
  p.start = [](const Model&, State& state) { state.v[0] = 2.0; };
  return p;
}

Problem bouncingBall() {
  Problem p = contactProblem("bouncing_ball", "Ball that falls, bounces and rolls, mu = 0.5", 31);
  p.build = [] {
    ModelBuilder builder = floating(ball("ball", 1.0, 0.1), Shape::sphere(0.1), 0.5, {0, 0, 0.3});
    addRoughGround(builder, 0.5);
    return builder;
  };
  p.start = [](const Model&, State& state) { state.v[0] = 1.0; };
  return p;
}

Problem boxStack() {
  Problem p = contactProblem("box_stack", "Five boxes of 1 kg set down on one another", 31);
  p.build = [] {
    ModelBuilder builder("stack");
    const Vector3 half(0.1, 0.1, 0.1);
    for (int i = 0; i < 5; ++i)
      builder.add(floating(boxLink("box", 1.0, half), Shape::box(half), 0.7,
                           {0.01 * (i % 2), 0.0, 0.1 + 0.205 * i}),
                  fmt::format("b{}", i));
    addRoughGround(builder, 0.7);
    return builder;
  };
  return p;
}

Problem capsules() {
  Problem p = contactProblem("27_capsules", "27 capsules that fall on one another", 31);
  p.chaotic = true;
  // Points of contact come and go all the time, in the pile five times in a millisecond.
  p.windowPeriods = 1;
  p.referenceTolerance = 1e-10;
  p.build = [] {
    ModelBuilder builder("capsules");
    for (int i = 0; i < 27; ++i) {
      // Each is further from the next than the 0.3 m that it is long: none begins within another.
      ModelBuilder one = floating(capsule("capsule", 1.0, 0.05, 0.1), Shape::capsule(0.05, 0.1),
                                  0.5, {0.31 * (i % 3), 0.31 * (i / 3 % 3), 0.25 + 0.35 * (i / 9)});
      const Vector3 axis = Vector3(std::sin(1.0 + i), std::cos(2.0 * i), 0.3).normalized();
      one.X_WRoot.R = Eigen::AngleAxisd(0.8 * i, axis).toRotationMatrix();
      builder.add(one, fmt::format("c{}", i));
    }
    addRoughGround(builder, 0.5);
    return builder;
  };
  return p;
}

Problem humanoid(const std::string& robots) {
  Problem p = contactProblem("humanoid_landing", "Humanoid that falls from 0.1 m", 31);
  p.build = [robots] {
    ModelBuilder builder = io::readUrdf(robots + "/humanoid.urdf");
    builder.base = BaseKind::floating;
    addRoughGround(builder, 0.8);
    return builder;
  };
  p.start = [](const Model& model, State& state) {
    Kinematics kinematics(model);
    computeKinematics(model, state, kinematics);
    state.q[2] += 0.1 - collision::lowestPoint(model, kinematics, 0);
  };
  return p;
}

/// The hand's own joints pull with a tenth of their largest torque.
Problem squeeze(const std::string& robots) {
  Problem p = contactProblem("hand_squeezes_ball", "Hand that closes on a ball", 31);
  p.passive = false;
  p.build = [robots] {
    ModelBuilder builder("grasp");
    ModelBuilder hand = io::readUrdf(robots + "/hand.urdf");
    hand.base = BaseKind::fixed;
    builder.add(hand, "hand");
    builder.add(
        floating(ball("ball", 0.05, 0.025), Shape::sphere(0.025), 1.0, {0.16, 0.012, -0.04}),
        "ball");
    builder.options.effects.remove(Effect::gravity);
    return builder;
  };
  p.force = [](const Model& model, double, VectorX& tau) {
    tau.setZero(model.nv);
    for (int i = 0; i < model.nv; ++i)
      if (model.dofs[i].actuated && std::isfinite(model.dofs[i].effortUpper))
        tau[i] = model.dofs[i].effortUpper / 10.0;
  };
  return p;
}

}  // namespace

std::vector<Problem> contactProblems(const std::string& robots) {
  return {slidingBlock(), bouncingBall(),   boxStack(),
          capsules(),     humanoid(robots), squeeze(robots)};
}

Problem inWindows(Problem problem) {
  problem.contact = true;
  problem.windows = 10;
  problem.windowPeriods = 3;  // as far as the next one begins
  return problem;
}

Problem lasting(Problem problem, double seconds) {
  problem.periods = problem.windowPeriods =
      std::max(1, static_cast<int>(std::lround(seconds / kPeriod)));
  problem.windows = 1;
  problem.name += fmt::format("_{:g}s", seconds);
  problem.title += fmt::format(", {:g} s", seconds);
  return problem;
}

std::vector<Problem> allProblems(const std::string& robots) {
  std::vector<Problem> problems = smoothProblems(robots);
  for (Problem& p : contactProblems(robots)) problems.push_back(std::move(p));
  return problems;
}

}  // namespace softgauss::app
