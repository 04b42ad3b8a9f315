// SPDX-License-Identifier: Apache-2.0
/// Family 1: light bodies under heavy ones.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

// MuJoCo 3.12: 0.21 mm for 1 kg on 1 kg; 1,000 kg sinks through 10 cm and topples.
void carries(double load, double timestep, Cone cone) {
  Trial t(std::to_string(static_cast<int>(load)) + " kg on 1 kg",
          with(tower({1.0, load}), timestep, cone));
  t.mayGain = 1e-9 * load * 9.81;  // a nanometre of the load's height: rounding
  t.run(3.0);
  // 2 mm, and the depth goes with the square of the time constant, which is at least two steps.
  const double depth = 2e-3 * std::pow(std::max(1.0, 2.0 * timestep / 0.02), 2.0);
  // A body falls for a step before the one below stops it, and for another one on a moving support.
  t.expect("landing", t.deepest, depth + 3.0 * 9.81 * timestep * timestep, "m");
  t.expect("penetration at rest", t.data->stats.maxPenetration, depth, "m");
  t.expect("tilt", tilt(t, "box1"), 1e-3, "rad");
  t.expect("speed at rest", t.state.v.cwiseAbs().maxCoeff(), 1e-4, "m/s");
}

TEST(MassRatio, LightBoxCarriesHeavyBox) {
  for (const double load : {1.0, 10.0, 100.0, 1e3, 1e4, 1e6})
    for (const double timestep : kSteps)
      for (const Cone cone : kCones) carries(load, timestep, cone);
}

/// Two fingers of 10 g on slides, and a cube between their pads, which touch it.
ModelBuilder gripper(double load) {
  ModelBuilder builder("gripper");
  builder.base = BaseKind::fixed;
  builder.link(emptyLink("world"));
  for (const double side : {-1.0, 1.0}) {
    const std::string name = side < 0.0 ? "left" : "right";
    builder.link(boxLink(name, 0.01, Vector3(0.01, 0.05, 0.05)));
    builder.joint(jointSpec(name + "_slide", JointType::prismatic, "world", name,
                            {Matrix3::Identity(), Vector3(0.1099 * side, 0, 1.0)},
                            Vector3(-side, 0, 0)));
    builder.geometry(geometrySpec(name, Shape::box(Vector3(0.01, 0.05, 0.05)), 1.0));
  }
  addBody(builder, "load", Shape::box(Vector3::Constant(0.1)), load,
          {Matrix3::Identity(), Vector3(0, 0, 1.0)});
  return builder;
}

// Friction holds 3 times the weight of 10 kg. What a soft friction
// slips in 10 s must leave half of the pad of 0.1 m.
TEST(MassRatio, LightGripperHoldsHeavyLoad) {
  for (const double timestep : {0.002, 0.005, 0.01})
    for (const Cone cone : kCones) {
      Trial t("10 g fingers hold 10 kg", with(gripper(10.0), timestep, cone));
      t.input.tau.head(2).setConstant(150.0);
      // Fingers of 20 g that close on a contact that gives way by 2 mm under 150 N each.
      t.mayGain = 2.0 * 150.0 * 2e-3;
      t.run(1.0);
      const Vector3 begun = t.origin("load");
      t.run(4.0);
      t.expect("slip", (t.origin("load") - begun).norm() / 4.0, 5e-3, "m/s");
      t.expect("penetration at rest", t.data->stats.maxPenetration, 2e-3, "m");
      t.expect("tilt", tilt(t, "load"), 1e-2, "rad");
    }
}

/// Two slides, or two hinges that the weight turns, one on the other, both at the ends of their
/// ranges.
ModelBuilder stopped(bool slide, double light, double heavy) {
  ModelBuilder builder("stopped");
  builder.base = BaseKind::fixed;
  builder.link(emptyLink("world"));
  const Vector3 com = slide ? Vector3::Zero() : Vector3(0.2, 0, 0);
  Vector3 at = Vector3::Zero();
  std::string last = "world";
  for (const auto& [name, mass] : {std::pair("stage", light), std::pair("load", heavy)}) {
    builder.link(boxLink(name, mass, Vector3::Constant(0.05), com));
    JointSpec joint = jointSpec(
        name + std::string("_joint"), slide ? JointType::prismatic : JointType::revolute, last,
        name, {Matrix3::Identity(), at}, slide ? Vector3::UnitZ() : Vector3::UnitY());
    joint.lower = slide ? 0.0 : -1.0, joint.upper = slide ? 1.0 : 0.0;
    builder.joint(joint);
    last = name, at = 2.0 * com;
  }
  return builder;
}

// A range feels the link that it stops, and bears what slides or turns on it (5.4): 100 kg on a
// stage of 1 kg came to lie 20 mm below both stops, and fell on through one of 10 g.
TEST(MassRatio, RangesBearWhatMovesOnThem) {
  for (const bool slide : {true, false})
    for (const double light : {0.01, 1.0})
      for (const double heavy : {1.0, 100.0, 1000.0})
        for (const double timestep : kSteps) {
          Trial t(std::to_string(heavy) + " kg at the end of its range on " +
                      std::to_string(light) + (slide ? " kg, slides" : " kg, hinges"),
                  with(stopped(slide, light, heavy), timestep));
          t.run(3.0);
          const double soft = std::pow(std::max(1.0, timestep / 0.01), 2.0);
          t.expect("beyond its range", t.state.q.cwiseAbs().maxCoeff(),
                   (slide ? 1e-3 : 5e-3) * soft, slide ? "m" : "rad");
          t.expect("speed at rest", t.state.v.cwiseAbs().maxCoeff(), 1e-6, slide ? "m/s" : "rad/s");
        }
}

/// Two links of 1 kg and 0.3 m, at their end a link of `mass` and a thousandth of a millimetre's
/// radius, hinged about all three axes in turn.
ModelBuilder lightTip(double mass, double armature) {
  ModelBuilder builder("light tip");
  builder.link(emptyLink("world"));
  std::string parent = "world";
  const Vector3 axes[] = {Vector3::UnitY(), Vector3::UnitY(), Vector3::UnitX(), Vector3::UnitY(),
                          Vector3::UnitZ()};
  for (int i = 0; i < 5; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(i < 2 ? boxLink(name, 1.0, {0.15, 0.02, 0.02}, {0.15, 0, 0})
                       : sphereLink(name, mass, 1e-6, {1e-3, 1e-3, 0.0}));
    JointSpec hinge =
        jointSpec("hinge" + std::to_string(i), JointType::revolute, parent, name,
                  {Matrix3::Identity(), Vector3(0 < i && i < 3 ? 0.3 : 0, 0, 0)}, axes[i]);
    hinge.lower = -2.0, hinge.upper = 2.0;
    hinge.armature = i < 2 ? 0.0 : armature;
    builder.joint(hinge);
    parent = name;
  }
  return builder;
}

// Links of next to no inertia at the end of an arm that swings and meets its limits: what they do
// does not throw the arm, with and without armature.
TEST(MassRatio, NearZeroInertias) {
  for (const double mass : {1e-3, 1e-6, 1e-9})
    for (const double armature : {0.0, 1e-6, 1e-2})
      for (const double timestep : {0.0005, 0.002, 0.01}) {
        ModelBuilder builder = with(lightTip(mass, armature), timestep);
        Trial t(
            "tip of " + std::to_string(1e6 * mass) + " mg, armature " + std::to_string(armature),
            builder);
        t.mayGain = 0.05 * 2.0 * 9.81 * 0.3;  // of what the arm can give
        // What a limit does to a tree that turns far in a step is done at the step's start.
        t.mayRise = 0.2 * t.mayGain;
        t.run(2.0);
        // The arm alone, from level, falls with no more than √(3 g/l) of either link.
        t.expect("arm's speed", t.state.v.head<2>().cwiseAbs().maxCoeff(), 40.0, "rad/s");
      }
}

TEST(MassRatio, SameBits) {
  expectSameBits([] {
    Trial t("1000 kg on 1 kg", tower({1.0, 1000.0}));
    t.run(0.2);
    return hash(t.state);
  });
}

}  // namespace
}  // namespace softgauss::test
