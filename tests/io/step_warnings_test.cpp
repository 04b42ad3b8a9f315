// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/step_warnings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "softgauss/engine/engine.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

/// The warnings of a pendulum of 1 kg at 0.5 m after `change`.
template <class Change>
std::vector<std::string> warningsOf(Change&& change, const ContactSet& touching = {}) {
  ModelBuilder builder = pendulum(0.5, 1.0, 0.05);
  builder.geometry(groundSpec(1.0));
  builder.geometry(geometrySpec("bob", Shape::sphere(0.05)));
  change(*builder.findJoint("hinge"));
  Model model = builder.build();
  return io::stepWarnings(model, touching);
}

void expectOne(const std::vector<std::string>& warnings, const std::string& first,
               const std::string& second) {
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find(first), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find(second), std::string::npos) << warnings[0];
}

TEST(StepWarnings, AreSilentWhereTheStepCarriesAll) {
  EXPECT_TRUE(warningsOf([](JointSpec& j) { j.stiffness = 100.0, j.damping = 10.0; }).empty());
}

// At 250 times the usual step every number of the scene is too fast for it: that is one warning.
TEST(StepWarnings, AFarTooLongStepIsOneWarning) {
  Model model = humanoid().build();
  model.options.timestep = 0.5;
  expectOne(io::stepWarnings(model, {}), "a step of 0.5 s is 250 times the usual 0.002 s",
            "try --timestep 0.002");
}

// The inertia is 0.25 kg m² and a little; at 2 ms it carries springs up to 62,500 N m/rad.
TEST(StepWarnings, NameTheSpringThatIsFasterThanTheStep) {
  expectOne(warningsOf([](JointSpec& j) { j.stiffness = 1e6; }), "joint 'hinge': its spring",
            "try a step below 0.0005 s");
  EXPECT_TRUE(warningsOf([](JointSpec& j) { j.stiffness = 60000.0; }).empty());
}

TEST(StepWarnings, NameTheDampingThatStopsItsJoint) {
  expectOne(warningsOf([](JointSpec& j) { j.damping = 1e5; }), "joint 'hinge': its damping",
            "expected at most 100");
}

// 5 % of an effort of 10⁶ N m is what a comparison of engines swings by; the joint would turn by
// 16 rad in the first step.
TEST(StepWarnings, NameTheEffortThatOutrunsTheStep) {
  expectOne(warningsOf([](JointSpec& j) { j.effort = 1e6; }), "joint 'hinge': its effort",
            "try armature above 1.3,");
  EXPECT_TRUE(warningsOf([](JointSpec& j) { j.effort = 1e4; }).empty());
}

// A bar of 0.1 kg and 0.1 m between ties, the lower one under 100 kg: ω² = (L₁ + L₂) g r/I, with
// I = m l²/12, is 1085 rad/s.
TEST(StepWarnings, NameTheBodyThatIsLightForWhatHangsOnIt) {
  ModelBuilder builder("hung");
  builder.base = BaseKind::floating;
  builder.link(boxLink("bar", 0.1, Vector3(0.05, 0.001, 0.001)));
  builder.link(sphereLink("load", 100.0, 0.05));
  ConnectSpec tie;
  tie.linkA = "bar", tie.linkB = "world";
  tie.p_LAP = Vector3(-0.05, 0, 0);
  builder.connect(tie);
  tie.linkA = "load", tie.linkB = "bar";
  tie.p_LAP = Vector3::Zero(), tie.p_LBP = Vector3(0.05, 0, 0);
  builder.connect(tie);
  builder.options.timestep = 0.01;
  const std::vector<std::string> told = io::stepWarnings(builder.build(), {});
  expectOne(told, "link 'bar' is light", "oscillates by 10.8 rad in a step of 0.01 s");
  EXPECT_NE(told[0].find("try a step below 0.00092 s"), std::string::npos) << told[0];
  builder.options.timestep = 0.0009;
  EXPECT_TRUE(io::stepWarnings(builder.build(), {}).empty());
}

/// Largest energy above the start in ten seconds of two links on hinges that are thrown against
/// each other, of what their motion and weight have; ∞ where a step is refused.
double gainOfTwoLinks(Integrator integrator, double damping) {
  ModelBuilder builder("two links");
  LinkSpec world;
  world.name = "world";
  builder.link(world);
  for (int i = 0; i < 2; ++i) {
    const std::string link = "link" + std::to_string(i);
    builder.link(boxLink(link, 1.0, Vector3(0.15, 0.02, 0.02), Vector3(0.15, 0, 0)));
    JointSpec joint =
        jointSpec("hinge" + std::to_string(i), JointType::continuous, i ? "link0" : "world", link,
                  {Matrix3::Identity(), Vector3(i ? 0.3 : 0, 0, 0)}, Vector3::UnitY());
    joint.damping = damping;
    builder.joint(joint);
  }
  builder.options.integrator = integrator;
  builder.options.timestep = 0.002;
  const Model model = builder.build();
  const std::vector<std::string> told = io::stepWarnings(model, {});
  EXPECT_EQ(told.size(), integrator != Integrator::leapfrog && damping < 1e-3 ? 1u : 0u);
  if (!told.empty()) expectOne(told, "joint 'hinge0' is hardly damped", "try leapfrog");
  State state(model);
  state.v << 10.0, -10.0;
  Data data(model);
  Kinematics k(model);
  const auto energy = [&] {
    computeKinematics(model, state, k);
    return computeEnergy(model, k, state.q, state.v);
  };
  const double start = energy().total(), has = energy().kinetic + 2.0 * 9.81 * 0.3;
  double gain = 0.0;
  for (int i = 0; i < 5000; ++i) {
    if (isRefused(step(model, {}, state, data, nullptr))) return kInfinity;
    gain = std::max(gain, (energy().total() - start) / has);
  }
  return gain;
}

// What the warning says is so, and what it says to try does.
TEST(StepWarnings, NameTheJointsByWhichLinksGain) {
  EXPECT_GT(gainOfTwoLinks(Integrator::implicit, 0.0), 0.5);
  EXPECT_GT(gainOfTwoLinks(Integrator::implicit, 1e-9), 0.5);
  EXPECT_GT(gainOfTwoLinks(Integrator::semiImplicitEuler, 0.0), 0.05);
  EXPECT_LT(gainOfTwoLinks(Integrator::leapfrog, 0.0), 0.01);
  EXPECT_LT(gainOfTwoLinks(Integrator::implicit, 0.1), 1e-6);
}

TEST(StepWarnings, NameTheSurfaceThatIsFasterThanTheStep) {
  Model model = sphereOnPlane(0.1, 1.0, 1.0).build();
  const auto of = [&](const Impedance& surface) {
    for (Geometry& g : model.geometries)
      if (g.body != 0) g.material.impedance = surface;
    return io::stepWarnings(model, {});
  };
  const auto direct = [](double stiffness, double damping) {
    Impedance p;
    p.direct = ReferenceSpring{stiffness, damping};
    return p;
  };
  const Impedance fast{0.001}, bouncy{0.02, 0.1};
  expectOne(of(fast), "surface of '", "is clamped to 0.004 s");
  expectOne(of(bouncy), "is clamped to 62500/s²", "try a step of 0.001 s");
  expectOne(of(direct(2e6, 100.0)), "surface of '", "its spring of 2e+06/s² is clamped");
  EXPECT_TRUE(of(direct(62499.0, 0.0)).empty());
  EXPECT_TRUE(of(direct(251e3, 502.0)).empty());  // more than half damped: no bounce is lost
  model.options.constraintModel = ConstraintModel::mujoco;
  EXPECT_TRUE(of(bouncy).empty());
  expectOne(of(Impedance{0.02, 0.04}), "surface of '", "grows in steps of 0.002 s");
  expectOne(of(direct(2e6, 100.0)), "surface of '", "grows in steps of 0.002 s");
}

TEST(StepWarnings, NameThePairThatOverlapsAtTheStart) {
  const auto nothing = [](JointSpec&) {};
  ContactSet touching;
  Contact c;
  c.geometryA = 0, c.geometryB = 1, c.bodyB = 1;
  c.distance = -0.05;
  touching.add(c);
  expectOne(warningsOf(nothing, touching), "overlap by 50 mm", "up to 2.5 m/s");
  touching.contacts[0].distance = -0.5e-3;
  EXPECT_TRUE(warningsOf(nothing, touching).empty());
}

}  // namespace
}  // namespace softgauss::test
