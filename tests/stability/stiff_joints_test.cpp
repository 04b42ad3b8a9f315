// SPDX-License-Identifier: Apache-2.0
/// Family 5: joints whose damping, springs or dry friction are stiff against the step.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

/// The level arm with this damping in every joint.
ModelBuilder arm(double damping, double h) {
  ModelBuilder builder = with(levelArm(), h);
  for (const char* hinge : {"hinge0", "hinge1", "hinge2"})
    builder.findJoint(hinge)->damping = damping;
  return builder;
}

// Damping up to h d/I = 10⁴, thrown at 10 rad/s: the energy never rises, and each joint ends at the
// creep g_i/d under its own weight.
TEST(StiffJoints, DampingBringsToRestWithoutOvershoot) {
  // M_ii of the last hinge: 1 kg × (0.1² + (0.2² + 0.04²)/12) kg m².
  const double inertia = 0.01 + (0.04 + 0.0016) / 12.0;
  for (const double h : {0.0005, 0.002, 0.005, 0.01, 0.02})
    for (const double ratio : {1.0, 1e2, 1e4}) {
      const double d = ratio * inertia / h;
      Trial t("h d/I = " + std::to_string(static_cast<int>(ratio)), arm(d, h));
      t.state.v.setConstant(10.0);
      t.mayGain = 1e-9 * t.energy().total();
      t.run(1.0);
      if (ratio == 1.0) continue;  // not stiff: the links may still throw each other
      t.expect("speed", t.fastest, 10.0, "rad/s");
      // Weight on the first hinge: 3 kg × g × 0.3 m at most.
      t.expect("creep", t.state.v.cwiseAbs().maxCoeff(), 1.01 * 3.0 * 9.81 * 0.3 / d, "rad/s");
    }
}

// Springs in all three hinges whose period is a tenth of the step, begun off their rest: the energy
// never rises, and the arm ends where they carry its weight.
TEST(StiffJoints, SpringsFasterThanTheStepComeToRest) {
  const double inertia = 0.01 + (0.04 + 0.0016) / 12.0;  // M_ii of the last hinge
  for (const double h : {0.0005, 0.002, 0.005, 0.01, 0.02})
    for (const double swing : {2.0, 2.0 * M_PI * 10.0}) {  // ω h
      Model model = arm(0.0, h).build();
      const double k = inertia * swing * swing / (h * h);
      for (Dof& dof : model.dofs) dof.stiffness = k;
      Trial t("spring, rad a step " + std::to_string(static_cast<int>(swing)), std::move(model));
      t.state.q = Vector3(0.1, -0.2, 0.1);
      t.state.v.setConstant(5.0);
      const double E0 = t.energy().total();
      t.mayGain = 1e-9 * E0;
      t.run(2.0);
      if (swing < 3.0) continue;  // the arm as a whole swings slower than the step, and goes on
      // The weight of 3 kg at 0.3 m, on the first spring.
      t.expect("bends", t.state.q.cwiseAbs().maxCoeff(), 1.01 * 3.0 * 9.81 * 0.3 / k, "rad");
      t.expect("speed at rest", t.state.v.cwiseAbs().maxCoeff(), 1e-6, "rad/s");
    }
}

/// A level arm of 1 kg and 0.5 m on one hinge with dry friction that could carry a ton.
ModelBuilder held(double h, double friction) {
  ModelBuilder builder("held");
  builder.link(emptyLink("world")).link(boxLink("arm", 1.0, {0.25, 0.02, 0.02}, {0.25, 0, 0}));
  JointSpec hinge = jointSpec("hinge", JointType::continuous, "world", "arm", {}, Vector3::UnitY());
  hinge.dryFriction = friction;
  builder.joint(hinge);
  builder.options.timestep = h;
  return builder;
}
constexpr double kLoad = 9.81 * 0.25;  // [N m]

// As MuJoCo has it: the joint creeps at τ R/b.
TEST(StiffJoints, DryFrictionCreepsByItsSoftnessAsInMujoco) {
  for (const double friction : {3.0, 5000.0})
    for (const double h : {0.0005, 0.002, 0.005, 0.01}) {
      Model model = held(h, friction).build();
      model.options.useMujocoModel();
      Trial t("dry friction, soft", std::move(model));
      t.run(0.5);
      const double R = 0.1 / 0.9 * t.data->weights.dof[0],
                   b = 2.0 / (0.95 * std::max(0.02, 2.0 * h));
      // The weight's moment falls with the cosine of what it has crept.
      const double creep = kLoad * std::cos(t.state.q[0]) * R / b;
      t.expect("creep against tau R/b", t.state.v[0] / creep - 1.0, 0.01, "");
    }
}

// The default sticks: 1e-6 rad in a minute, with torques up to 99 % of the friction, and after it
// was shaken.
void sticks(double h, double friction, double seconds, bool shaken) {
  Trial t(shaken ? "dry friction, shaken" : "dry friction", held(h, friction));
  if (shaken) {  // thrown at 1 rad/s, it stops; its friction dies out in some time constants
    t.state.v[0] = -1.0;
    t.run(4.0);
  }
  const double begun = t.state.q[0];
  t.run(seconds);
  t.expect("creep", std::abs(t.state.q[0] - begun) * 60.0 / seconds, 1e-6, "rad in 60 s");
}

TEST(StiffJoints, DryFrictionSticks) {
  for (const double friction : {kLoad / 0.99, 3.0, 100.0, 1e6})
    for (const double h : {0.0005, 0.002, 0.005, 0.01, 0.02}) {
      sticks(h, friction, 6.0, false);
      if (friction < 10.0 && friction > 2.9) sticks(h, friction, 6.0, true);
    }
}

TEST(StiffJoints, DryFrictionSticksForAMinuteLong) {
  for (const double friction : {kLoad / 0.99, 3.0, 100.0, 1e6})
    for (const double h : {0.0005, 0.002, 0.005, 0.01, 0.02}) sticks(h, friction, 60.0, false);
}

// What is stuck holds a load that swings through zero, and slides as soon as it is more than the
// friction.
TEST(StiffJoints, DryFrictionHoldsWhateverSwings) {
  for (const double h : {0.002, 0.01}) {
    Trial t("dry friction, load swings", held(h, 2.0 * kLoad));
    t.run(10.0, [&] { t.input.tau[0] = 0.9 * kLoad * std::sin(20.0 * t.state.time); });
    t.expect("creep", std::abs(t.state.q[0]), 1e-6 / 6.0, "rad");
    t.input.tau[0] = 3.1 * kLoad;  // less its weight 2.1
    t.run(h);
    EXPECT_GT(t.state.v[0] * t.model.dofs[0].dryFriction, 0.0);
  }
}

/// A base of 0.5 to 20 kg that floats, with two to nine links of 20 g to 3 kg on it and on each
/// other; joints with and without damping of up to 1 N m s, springs of up to 100 N m and dry
/// friction, whatever their inertia. It whirls and is left to itself.
void whirls(int seed, double timestep) {
  Random random(seed);
  ModelBuilder builder = with(ModelBuilder("robot"), timestep);
  builder.base = BaseKind::floating;
  builder.options.gravity.setZero();
  builder.link(boxLink("link0", decades(random, 0.5, 20.0), Vector3(0.15, 0.1, 0.05)));
  const int links = 2 + random.index(8);
  for (int i = 1; i <= links; ++i) {
    const std::string name = "link" + std::to_string(i);
    const double half = random.uniform(0.05, 0.15);
    builder.link(
        boxLink(name, decades(random, 0.02, 3.0), Vector3(0.02, 0.02, half), {0, 0, -half}));
    const int parent = random.index(i);
    Transform X_PC{random.rotation(), Vector3(0, 0, parent ? -0.15 : 0.05)};
    JointSpec joint = jointSpec(name + "_joint", JointType::continuous,
                                "link" + std::to_string(parent), name, X_PC, random.direction());
    if (random.chance(0.5)) joint.damping = decades(random, 1e-3, 1.0);
    if (random.chance(0.5)) joint.armature = decades(random, 1e-5, 0.1);
    if (random.chance(0.3)) joint.dryFriction = decades(random, 0.01, 2.0);
    if (random.chance(0.3)) joint.stiffness = decades(random, 0.1, 100.0);
    builder.joint(joint);
  }
  Trial t("robot " + std::to_string(seed), builder);
  t.state.v.head(6) = random.vector(6, 3.0);
  for (int i = 6; i < t.model.nv; ++i) t.state.v[i] = random.uniform(-8.0, 8.0);
  const double begun = t.energy().kinetic;
  t.mayGain = 0.02 * begun;  // of energies half a step apart
  t.mayRise = 0.02 * begun;
  t.run(3.0);
  t.expect("fastest", t.fastest, 50.0 * std::sqrt(begun), "rad/s");
}

// A light joint that a spring and damping hold fast, between links that whirl and dry friction:
// half steps of that spring threw such a robot to 10⁵ rad/s within 0.1 s at 5 ms.
TEST(StiffJoints, RobotsWhirlWithoutGain) {
  for (const double timestep : {0.002, 0.005, 0.01})
    for (int seed = 0; seed < 60; ++seed) whirls(seed, timestep);
}

TEST(StiffJoints, SameBits) {
  expectSameBits([] {
    Trial t("dry friction", held(0.002, 3.0));
    t.state.v[0] = -1.0;
    t.run(0.5);
    return hash(t.state);
  });
}

}  // namespace
}  // namespace softgauss::test
