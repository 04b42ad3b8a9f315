// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/forces/spring.hpp"

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// A slide along x without gravity: 2 kg on a spring of 80 N/m that rests at 0.15 m.
Scene slide(double damping = 0.0) {
  ModelBuilder builder("slide");
  builder.base = BaseKind::fixed;
  builder.options.gravity.setZero();
  builder.options.timestep = 1e-4;
  builder.link(emptyLink("world")).link(boxLink("box", 2.0, {0.1, 0.1, 0.1}));
  JointSpec joint = jointSpec("x", JointType::prismatic, "world", "box", {}, Vector3::UnitX());
  joint.stiffness = 80.0;
  joint.springReference = 0.15;
  joint.damping = damping;
  return Scene(builder.joint(joint).build());
}

TEST(Spring, PullsToItsReference) {
  Scene s = slide();
  for (const double q : {-0.3, 0.15, 0.4}) {
    s.state.q[0] = q;
    s.stages();
    s.forward();
    EXPECT_SMALL(s.data->forward.a[0] + 80.0 / 2.0 * (q - 0.15), 1e-13);
  }
}

// x = x_s + A cos(ω t), ω² = k/m; symplectic Euler is of first order in h.
TEST(Spring, SwingsAsAHarmonicOscillator) {
  Scene s = slide();
  s.state.q[0] = 0.25;
  const int steps = 10000;  // 1 s
  s.steps(steps);
  const double omega = std::sqrt(40.0);
  EXPECT_SMALL(s.state.q[0] - 0.15 - 0.1 * std::cos(omega), 0.1 * omega * 1e-4);
  EXPECT_SMALL(s.state.v[0] + 0.1 * omega * std::sin(omega), 0.1 * omega * omega * 1e-4);
}

TEST(Spring, EnergyIsKept) {
  Scene s = slide();
  s.state.q[0] = 0.35;
  const auto energy = [&] {
    s.stages();
    return computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).total();
  };
  EXPECT_SMALL(energy() - 0.5 * 80.0 * 0.04, 1e-14);
  double worst = 0.0;
  for (int i = 0; i < 100; ++i) {
    s.steps(100);
    worst = std::max(worst, std::abs(energy() / 1.6 - 1.0));
  }
  // Symplectic Euler keeps a neighbouring energy: an error of ½ h ω, which does not grow.
  EXPECT_SMALL(worst, 0.5 * 1e-4 * std::sqrt(40.0) * 1.1);
}

TEST(Spring, SwitchedOffHasNeitherForceNorEnergy) {
  Scene s = slide();
  s.state.q[0] = 0.5;
  s.model.options.effects.remove(Effect::spring);
  s.stages();
  s.forward();
  EXPECT_EQ(s.data->forward.a[0], 0.0);
  EXPECT_EQ(computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).total(), 0.0);
}

}  // namespace
}  // namespace softgauss::test
