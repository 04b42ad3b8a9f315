// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/contact_softness.hpp"

#include <cmath>
#include <complex>
#include <utility>

#include "softgauss/engine/step/inverse.hpp"
#include "softgauss/engine/step/snapshot.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

/// A ball of 1.5 kg on the ground, both of the same surface, one contact.
Scene ball(const Material& material, double timestep = 0.002) {
  ModelBuilder builder = freeBody(sphereLink("ball", 1.5, 0.1));
  GeometrySpec ground = groundSpec(1.0), shape = geometrySpec("ball", Shape::sphere(0.1));
  shape.material = material;
  ground.material = material;
  ground.material.spring.reset();
  builder.geometry(ground).geometry(shape);
  builder.options.timestep = timestep;
  return Scene(builder.build(), std::make_shared<SampleContacts>());
}

/// Of the only contact, on the ball, upwards [N].
double normalForce(const Scene& s) {
  std::vector<Snapshot::ContactForce> forces;
  contactForces(*s.data, forces);
  return forces.empty() ? 0.0 : forces.front().force.z();
}

Material sprung(double stiffness, double damping, double friction = 1.0, int condim = 3) {
  Material m;
  m.slidingFriction = friction;
  m.condim = condim;
  m.spring = {stiffness, 0.0, damping, 0.0};
  return m;
}

// (3.8) is the implicit Euler step of a spring and a damper: the force is that of the state in
// which the step ends, pressing only. K and B appear here as such, not as D and a_ref.
TEST(ContactSpring, ForceIsThatOfTheStepsEnd) {
  const double K = 2e4, B = 30.0;
  int pressed = 0, free = 0;
  for (const int condim : {1, 3, 4, 6})
    for (const double mu : {0.1, 0.7, 2.0})
      for (const double speed : {-1.0, -0.1, 0.0, 0.02, 1.0}) {
        Scene s = ball(sprung(K, B, mu, condim));
        s.model.options.cone = speed == -0.1 ? Cone::elliptic : Cone::pyramidal;
        s.state.q[2] = 0.1 - 1e-3;
        s.state.v[2] = speed;
        s.step();
        const double f = normalForce(s);
        const double end = -K * (s.state.q[2] - 0.1) - B * s.state.v[2];
        if (f > 0.0) {
          ++pressed;
          EXPECT_SMALL(f / end - 1.0, 1e-10) << "condim " << condim << ", mu " << mu;
        } else {
          ++free;
          EXPECT_LE(end, 1e-10);  // it would pull
        }
      }
  EXPECT_EQ(pressed + free, 60);
  EXPECT_GE(free, 12);  // at 1 m/s upwards it lets go
}

TEST(ContactSpring, LetsGoAndDoesNotStick) {
  Scene s = ball(sprung(100.0, 1e4));
  s.state.q[2] = 0.1 - 1e-3;
  s.state.v[2] = 0.5;
  s.step();
  EXPECT_EQ(s.data->stats.contacts, 1);
  EXPECT_EQ(normalForce(s), 0.0);
  EXPECT_SMALL(s.state.v[2] - (0.5 - 9.81 * 0.002), 1e-14);
}

// However stiff, undamped or light: the energy never grows.
TEST(ContactSpring, NoStiffnessMakesTheStepUnstable) {
  for (const double K : {1e2, 1e5, 1e8, 1e11})
    for (const double B : {0.0, 1.0, 1e6}) {
      Scene s = ball(sprung(K, B, 0.8));
      s.state.q[2] = 0.1 + 1e-3;
      s.state.v.head<2>() = Eigen::Vector2d(0.3, -0.1);
      // What is gained where a step ends deep in the ground is less than a hundredth.
      double top = 0.0;
      for (int i = 0; i < 2000; ++i) {
        ASSERT_NE(s.step(), SolveStatus::notFinite);
        top = std::max(top, s.state.q[2]);
      }
      EXPECT_LT(top, 0.1 + 1.01e-3) << "K " << K << ", B " << B;
      EXPECT_LT(s.state.v.head<2>().norm(), 0.32) << "K " << K << ", B " << B;
    }
}

TEST(ContactSpring, InverseRecoversForward) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    Scene s = lawScene(seed, 12);
    s.model.options.cone = seed % 3 == 0 ? Cone::elliptic : Cone::pyramidal;
    int with = 0;
    for (std::size_t i = 0; i < s.model.geometries.size(); i += 2, ++with)
      s.model.geometries[i].material.spring = {i % 4 == 0 ? 5e4 : 0.0, i % 4 == 0 ? 0.0 : 1e-3, 0.0,
                                               0.5};
    ASSERT_GT(with, 2);
    s.stages();
    ASSERT_EQ(s.forward(), SolveStatus::converged);
    VectorX tau;
    inverseDynamics(s.model, s.data->forward.a, *s.data, tau);
    const VectorX applied = s.data->forces.net + s.data->forces.c;
    EXPECT_SMALL((tau - applied).norm() / std::max(1.0, tau.norm()), 1e-10) << seed;
  }
}

TEST(ContactSpring, RestDepthIsTheDepthUnderTheWeight) {
  const ContactSpring s = inNewtons({0.0, 2e-3, 0.0, 0.4}, 3.0, 9.81);
  EXPECT_SMALL(3.0 * 9.81 / s.stiffness - 2e-3, 1e-17);
  // ζ is the damping ratio of m ẍ + B ẋ + K x = 0.
  EXPECT_SMALL(s.damping / (2.0 * 3.0 * std::sqrt(s.stiffness / 3.0)) - 0.4, kRounding);
  EXPECT_EQ(s.restDepth, 0.0);
  EXPECT_EQ(s.dampingRatio, 0.0);
  EXPECT_EQ(inNewtons({500.0, 0.0, 7.0, 0.0}, 3.0, 9.81), (ContactSpring{500.0, 0.0, 7.0, 0.0}));
}

// One behind the other: at a low frequency ω the complex stiffness is 1/(1/Z₁ + 1/Z₂), Z = K + iωB.
TEST(ContactSpring, InSeriesIsTheSlowMotionOfBoth) {
  using Complex = std::complex<double>;
  const ContactSpring a{3e4, 0.0, 100.0, 0.0}, b{1e5, 0.0, 20.0, 0.0};
  const double w = 1e-4;  // (ωB/K)² is below rounding
  const Complex Z =
      1.0 / (1.0 / Complex(a.stiffness, w * a.damping) + 1.0 / Complex(b.stiffness, w * b.damping));
  for (const ContactSpring& s : {inSeries(a, b), inSeries(b, a)}) {
    EXPECT_SMALL(s.stiffness / Z.real() - 1.0, 1e-12);
    EXPECT_SMALL(s.damping / (Z.imag() / w) - 1.0, 1e-9);
  }
}

// A spring against a surface that has none is that spring; depths of rest add up.
TEST(ContactSpring, MixesAsTwoSurfacesThatBothGiveWay) {
  ModelBuilder builder = freeBody(sphereLink("ball", 2.0, 0.1));
  GeometrySpec ground = groundSpec(1.0), shape = geometrySpec("ball", Shape::sphere(0.1));
  shape.material.spring = {0.0, 1e-3, 0.0, 1.0};
  Model model = builder.geometry(ground).geometry(shape).build();
  const double weight = 2.0 * model.options.gravity.norm();
  EXPECT_SMALL(pairMaterial(model, 0, 1).spring->stiffness / (weight / 1e-3) - 1.0, kRounding);
  model.geometries[0].material.spring = {0.0, 3e-3, 0.0, 1.0};
  EXPECT_SMALL(pairMaterial(model, 0, 1).spring->stiffness / (weight / 4e-3) - 1.0, kRounding);
  EXPECT_EQ(pairMaterial(model, 0, 1), pairMaterial(model, 1, 0));
  Material own;
  own.spring = {777.0, 0.0, 5.0, 0.0};
  model.contactPairs.push_back({0, 1, own});
  EXPECT_EQ(pairMaterial(model, 1, 0).spring, own.spring);
}

// What is at most half damped is a spring of the pair's own mass, by the recipe (3.11); what is
// damped more stays a reference, and so do all in --compatibility mujoco.
TEST(ContactSpring, WhatBouncesIsASpringOfItsOwnMass) {
  Options options;
  options.timestep = 0.002;
  const double mass = 2.5;
  Material pair;
  for (const auto& [ratio, timeConstant] : {std::pair(0.1, 0.2), {0.3, 0.1}, {0.5, 0.05}}) {
    pair.impedance.dampingRatio = ratio;
    pair.impedance.timeConstant = timeConstant;
    const double K = std::pow(timeConstant * ratio, -2.0), B = 2.0 / timeConstant;
    const Material m = effectiveMaterial(pair, mass, options);
    ASSERT_TRUE(m.spring);
    EXPECT_SMALL(m.spring->stiffness / (mass * K) - 1.0, 1e-12);
    // Half a step of the spring damps as well.
    EXPECT_SMALL(m.spring->damping / (mass * (B - 0.001 * K)) - 1.0, 1e-12);
    Material given = pair;
    given.impedance.direct = {K, B};
    const Material same = effectiveMaterial(given, mass, options);
    EXPECT_SMALL(same.spring->stiffness / m.spring->stiffness - 1.0, 1e-12);
    EXPECT_SMALL(same.spring->damping / m.spring->damping - 1.0, 1e-12);
    Options mujoco = options;
    mujoco.constraintModel = ConstraintModel::mujoco;
    EXPECT_EQ(effectiveMaterial(pair, mass, mujoco), pair);
  }
  // Faster than a step lets bounce: K as in (3.5).
  pair.impedance.dampingRatio = 0.05, pair.impedance.timeConstant = 0.02;
  const Material fast = effectiveMaterial(pair, mass, options);
  ASSERT_TRUE(fast.spring);
  EXPECT_SMALL(fast.spring->stiffness / mass * std::pow(2.0 * 0.002, 2.0) - 1.0, 1e-12);
  EXPECT_SMALL(fast.spring->damping / (mass * (100.0 - 0.001 * 62500.0)) - 1.0, 1e-12);
  pair.impedance.dampingRatio = 0.51, pair.impedance.timeConstant = 0.1;
  EXPECT_EQ(effectiveMaterial(pair, mass, options), pair);
  pair = sprung(4e4, 200.0);
  EXPECT_EQ(effectiveMaterial(pair, mass, options), pair);
}

TEST(ContactSpring, TheLighterTreeRests) {
  ModelBuilder builder("two");
  builder.base = BaseKind::floating;
  builder.link(sphereLink("small", 0.5, 0.1)).link(sphereLink("big", 20.0, 0.2));
  builder.link(sphereLink("tail", 3.0, 0.1));
  builder.joint(jointSpec("hip", JointType::revolute, "small", "tail"));
  const Model model = builder.build();
  const auto body = [&](const char* name) { return model.frames[model.findFrame(name)].body; };
  EXPECT_EQ(restingMass(model, body("small"), body("big")), 3.5);
  EXPECT_EQ(restingMass(model, body("big"), body("tail")), 3.5);
  EXPECT_EQ(restingMass(model, 0, body("big")), 20.0);
  EXPECT_EQ(restingMass(model, body("tail"), 0), 3.5);
  EXPECT_EQ(restingMass(model, 0, 0), 0.0);
  EXPECT_EQ(reducedMass(model, 0, body("big")), 20.0);
  EXPECT_EQ(reducedMass(model, body("big"), body("tail")), 70.0 / 23.5);
  EXPECT_EQ(reducedMass(model, 0, 0), 0.0);
}

// The equivalent impedance makes the same rows at that depth.
TEST(ContactAtRest, EquivalentImpedanceMakesTheSameRows) {
  const double weight = 0.4, load = 30.0;
  for (const bool spring : {false, true})
    for (const double mu : {0.0, 0.5, 1.0}) {
      Options options;
      options.cone = mu == 1.0 ? Cone::elliptic : Cone::pyramidal;
      options.impedanceRatio = 3.0;
      Material pair = spring ? sprung(4e4, 200.0, mu) : Material{};
      pair.slidingFriction = mu;
      const ContactAtRest rest = contactAtRest(pair, weight, load, options);
      Material other = pair;
      other.spring.reset();
      other.impedance = rest.equivalent;
      const int dim = frictionDim(pair, options.effects);
      EXPECT_EQ(dim, mu > 0.0 ? 2 : 0);
      const Softness a = contactSoftness(pair, dim, -rest.depth, weight, options);
      Options mujoco = options;  // to whose model an impedance of constant d belongs
      mujoco.useMujocoModel();
      const Softness b = contactSoftness(other, dim, -rest.depth, weight, mujoco);
      EXPECT_SMALL(a.R / b.R - 1.0, 1e-12);
      EXPECT_SMALL(a.stiffness / b.stiffness - 1.0, 1e-12);
      EXPECT_SMALL(a.damping / b.damping - 1.0, 1e-12);
    }
}

TEST(ContactAtRest, WithoutAReferenceSpringSinksForEver) {
  Material pair;
  pair.impedance.direct = {0.0, 10.0};
  EXPECT_EQ(contactAtRest(pair, 1.0, 10.0, {}).depth, kInfinity);
}

}  // namespace
}  // namespace softgauss::test
