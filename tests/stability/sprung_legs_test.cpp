// SPDX-License-Identifier: Apache-2.0
/// Family 5: what lands on a spring. The light foot of a sprung leg comes in alone, and the spring
/// presses on it when it is in already; a reference would push it out under that load, whatever it
/// has come to (3.7). With the mass of a reference the hopper of 40 kg below came 33 cm above its
/// start at 2 ms, as with MuJoCo's softness.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

constexpr double kGravity = 9.81;

struct Leg {
  double body, foot;  // [kg]
  double sag;         // of the spring under the body's weight [m]
  double ratio;       // of its damping
};

constexpr Leg kLegs[] = {{10.0, 1.0, 0.01, 0.0}, {10.0, 1.0, 0.03, 0.0}, {40.0, 0.8, 0.01, 0.0},
                         {40.0, 0.8, 0.01, 0.1}, {40.0, 0.8, 0.03, 0.0}, {40.0, 4.0, 0.01, 0.0}};

/// A foot on a vertical slide below a link, whose spring bears `part` of the body.
JointSpec sprung(const Leg& leg, const std::string& parent, const std::string& foot,
                 const Vector3& p, double part) {
  JointSpec joint =
      jointSpec(foot + "_leg", JointType::prismatic, parent, foot, {Matrix3::Identity(), p});
  joint.stiffness = part * leg.body * kGravity / leg.sag;
  joint.damping = 2.0 * leg.ratio * std::sqrt(joint.stiffness * part * leg.body);
  return joint;
}

std::string named(const std::string& what, const Leg& leg) {
  return what + " of " + std::to_string(leg.body) + " kg on " + std::to_string(leg.foot) +
         " kg, sag " + std::to_string(leg.sag) + " m, damping ratio " + std::to_string(leg.ratio);
}

/// Lets it fall by 0.1 m, and bounce on for three seconds. It may rise by what its spring's half
/// steps are off.
void falls(Trial& t) {
  const double fall = t.model.totalMass() * kGravity * 0.1;
  t.mayGain = 0.01 * fall;
  t.mayRise = 0.02 * fall;
  t.run(3.0);
  EXPECT_GT(t.deepest + t.fastest, 1.0) << "it has fallen";
}

TEST(SprungLegs, HoppersGainNothing) {
  for (const Leg& leg : kLegs)
    for (const double timestep : {0.0005, 0.002})
      for (const Cone cone : kCones) {
        ModelBuilder builder("hopper");
        builder.base = BaseKind::fixed;
        builder.link(emptyLink("world"));
        builder.geometry(groundSpec(1.0));
        builder.link(boxLink("body", leg.body, Vector3::Constant(0.1)));
        builder.joint(jointSpec("rail", JointType::prismatic, "world", "body"));
        const Vector3 half(0.05, 0.05, 0.02);
        builder.link(boxLink("foot", leg.foot, half));
        builder.joint(sprung(leg, "body", "foot", Vector3(0, 0, -0.4), 1.0));
        builder.geometry(geometrySpec("foot", Shape::box(half)));
        Trial t(named("a hopper", leg), with(builder, timestep, cone));
        t.state.q[0] = 0.52;
        falls(t);
      }
}

TEST(SprungLegs, QuadrupedsGainNothing) {
  for (const Leg& leg : kLegs)
    for (const double timestep : {0.0005, 0.002})
      for (const Cone cone : kCones) {
        ModelBuilder builder("quadruped");
        builder.base = BaseKind::floating;
        builder.geometry(groundSpec(1.0));
        builder.link(boxLink("body", leg.body, Vector3(0.3, 0.2, 0.1)));
        for (const double x : {-0.25, 0.25})
          for (const double y : {-0.2, 0.2}) {
            const std::string foot =
                (x < 0.0 ? "hind" : "fore") + std::string(y < 0.0 ? "_right" : "_left");
            builder.link(sphereLink(foot, 0.25 * leg.foot, 0.03));
            builder.joint(sprung(leg, "body", foot, Vector3(x, y, -0.4), 0.25));
            builder.geometry(geometrySpec(foot, Shape::sphere(0.03)));
          }
        Trial t(named("a quadruped", leg), with(builder, timestep, cone));
        t.state.q[2] = 0.53;
        falls(t);
      }
}

// The same where a range stops the light part.
TEST(SprungLegs, OnARangeGainNothing) {
  for (const Leg& leg : kLegs)
    for (const double timestep : {0.0005, 0.002, 0.005}) {
      ModelBuilder builder("range");
      builder.base = BaseKind::fixed;
      builder.link(emptyLink("world"));
      builder.link(boxLink("carriage", leg.foot, Vector3::Constant(0.05)));
      JointSpec rail = jointSpec("rail", JointType::prismatic, "world", "carriage");
      rail.lower = 0.0, rail.upper = 10.0;
      builder.joint(rail);
      builder.link(boxLink("body", leg.body, Vector3::Constant(0.1)));
      builder.joint(sprung(leg, "carriage", "body", Vector3(0, 0, 0.4), 1.0));
      Trial t(named("a carriage", leg), with(builder, timestep));
      t.state.q[0] = 0.1;
      falls(t);
    }
}

}  // namespace
}  // namespace softgauss::test
