// SPDX-License-Identifier: Apache-2.0
/// Family 5: references that are less than critically damped. Whatever the step, what bounces gains
/// no energy.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

constexpr double kRatios[] = {0.05, 0.2, 0.5};

Impedance underdamped(double ratio) {
  Impedance impedance;
  impedance.timeConstant = 0.02;
  impedance.dampingRatio = ratio;
  return impedance;
}

std::string named(const std::string& what, double ratio) {
  std::ostringstream text;
  text << what << ", ratio " << ratio;
  return text.str();
}

// A ball falls by 0.2 m on a floor. It rises no higher than it began, E is asserted at every step,
// and it is never deeper than the undamped spring takes it, v t_c ζ, and a step.
TEST(Bounces, BallOnAFloorGainsNothing) {
  for (const double ratio : kRatios)
    for (const double timestep : kSteps)
      for (const Cone cone : kCones) {
        ModelBuilder builder = with(sphereOnPlane(0.1, 1.0, 0.5), timestep, cone);
        builder.X_WRoot.p.z() = 0.3;
        Model model = builder.build();
        for (Geometry& g : model.geometries) g.material.impedance = underdamped(ratio);
        Trial t(named("ball", ratio), std::move(model));
        double highest = 0.0;
        t.run(3.0, [&] {
          if (t.deepest > 0.0) highest = std::max(highest, t.state.q[2]);
        });
        EXPECT_GT(t.deepest, 0.0);
        t.expect("rises to", highest, 0.3, "m");
        const double v = std::sqrt(2.0 * 9.81 * 0.2);
        t.expect("deepest", t.deepest,
                 (v + 9.81 * 0.02) * (std::max(0.02 * ratio, 2.0 * timestep) + timestep), "m");
      }
}

// A pendulum swings from level into the end of its range.
TEST(Bounces, JointInItsRangeGainsNothing) {
  for (const double ratio : kRatios)
    for (const double timestep : kSteps) {
      ModelBuilder builder = with(pendulum(0.5, 1.0, 0.05), timestep);
      JointSpec& hinge = *builder.findJoint("hinge");
      hinge.type = JointType::revolute;
      hinge.lower = -0.2, hinge.upper = 3.0;
      Model model = builder.build();
      for (JointRange& range : model.ranges) range.impedance = underdamped(ratio);
      Trial t(named("range", ratio), std::move(model));
      t.state.q[0] = 0.5 * M_PI;
      // Half a step behind, v shows the weight's power over it.
      t.mayGain = 0.5 * timestep * 9.81 * std::sqrt(2.0 * 9.81 * 0.5);
      double highest = 0.0;
      bool met = false;
      t.run(5.0, [&] {
        met |= t.state.q[0] < -0.2;
        if (met) highest = std::max(highest, t.state.q[0]);
      });
      EXPECT_TRUE(met);
      t.expect("swings back to", highest, 0.5 * M_PI, "rad");
    }
}

// A body hangs on a connection, begun 0.1 m off, without weight: it swings about its place, ever
// less.
TEST(Bounces, ConnectionGainsNothing) {
  for (const double ratio : kRatios)
    for (const double timestep : kSteps) {
      ModelBuilder builder = with(freeBody(sphereLink("body", 1.0, 0.1)), timestep);
      builder.options.gravity.setZero();
      ConnectSpec tie;
      tie.linkA = "body";
      tie.linkB = "world";
      tie.impedance = underdamped(ratio);
      builder.connect(tie);
      Trial t(named("connection", ratio), builder);
      t.state.q[2] = 0.1;
      // What the spring has, of at most a radian a step: the fastest is ω times the way.
      const double omega = 1.0 / std::max(std::max(0.02, 2.0 * timestep) * ratio, timestep);
      t.mayGain = 0.5 * std::pow(0.1 * omega, 2.0);
      double farthest = 0.0;
      t.run(3.0, [&] {
        if (t.state.time > 1.5) farthest = std::max(farthest, t.state.q.head<3>().norm());
      });
      // Its reference dies out by e^(−t/t_c), t_c 0.02 s or two steps.
      t.expect("swings after 1.5 s", farthest, 1e-6, "m");
    }
}

/// Cubes fall, one above the other with these gaps [m], on a floor.
void stackFalls(const std::vector<double>& masses, double gap, double ratio, double timestep,
                Cone cone) {
  std::ostringstream name;
  for (const double& mass : masses) name << mass << (&mass == &masses.back() ? " kg" : ", ");
  Model model = with(tower(masses), timestep, cone).build();
  for (Geometry& g : model.geometries) g.material.impedance = underdamped(ratio);
  Trial t(named(name.str(), ratio), std::move(model));
  for (std::size_t i = 0; i < masses.size(); ++i)
    t.state.q[7 * static_cast<Eigen::Index>(i) + 2] += gap * (static_cast<double>(i) + 1.0);
  // Above 0.5 a contact is a reference, and gives this back to what is heavier (decision 0032).
  if (ratio > 0.5 && ratio < 0.9) t.mayRise = (ratio < 0.8 ? 0.04 : 0.001) * t.energy().total();
  t.run(1.0);
}

// Heavy cubes above light ones. A reference would push the heavy one with what the light one has
// brought: 1 and 100 kg with a ratio of 0.05 at 0.5 ms rose by two thirds of their energy.
TEST(Bounces, HeapsOfUnlikeMassesGainNothing) {
  for (const auto& masses : {std::vector{1.0, 100.0}, {1.0, 1.0, 1000.0}})
    for (const double ratio : {0.05, 0.15, 0.49, 0.5, 0.7})
      for (const double timestep : kSteps)
        for (const Cone cone : kCones) stackFalls(masses, 0.05, ratio, timestep, cone);
}
TEST(Bounces, HeapsOfUnlikeMassesAtEveryRatioLong) {
  for (const auto& masses : {std::vector{1.0, 1.0, 1000.0},
                             {1.0, 100.0},
                             {1.0, 1000.0},
                             {1.0, 1.0, 1.0, 100.0},
                             {10.0, 1.0, 1000.0},
                             {1.0, 1e4}})
    for (const double ratio : {0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.55, 0.6, 0.65, 0.7, 0.8, 0.9, 1.0})
      for (const double gap : {0.01, 0.03, 0.05, 0.1})
        for (const double timestep : {0.0005, 0.001, 0.002, 0.005})
          stackFalls(masses, gap, ratio, timestep, Cone::elliptic);
}

// A rod and a plate land on a corner: what one corner has brought does not come back by another.
TEST(Bounces, WhatLandsOnACornerGainsNothing) {
  for (const auto& [name, half] :
       {std::pair<std::string, Vector3>{"rod", {0.3, 0.02, 0.02}}, {"plate", {0.3, 0.3, 0.02}}})
    for (const double ratio : {0.02, 0.2, 0.6})
      for (const double timestep : kSteps)
        for (const Cone cone : kCones) {
          ModelBuilder builder = with(ModelBuilder(name), timestep, cone);
          builder.geometry(groundSpec(0.7));
          addBody(builder, name, Shape::box(half), 1.0,
                  {Eigen::AngleAxisd(0.2, Vector3(0.8, 0.6, 0.0)).toRotationMatrix(),
                   Vector3(0.0, 0.0, 0.4)});
          Model model = builder.build();
          for (Geometry& g : model.geometries) g.material.impedance = underdamped(ratio);
          Trial t(named(name, ratio), std::move(model));
          t.run(1.5);
          EXPECT_GT(t.deepest, 0.0);
        }
}

}  // namespace
}  // namespace softgauss::test
