// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/dry_friction.hpp"

#include <algorithm>

#include "softgauss/engine/constraints/impedance.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// R of friction on 2 kg whose softness nobody gave: d = dMin = 0.9 where there is no depth.
constexpr double kSoft = 0.1 / 0.9 * 0.5;

/// A slide along x without gravity: mass 2, dry friction 3.
Scene slide(double speed, double force) {
  ModelBuilder builder("slide");
  builder.base = BaseKind::fixed;
  builder.options.gravity.setZero();
  builder.link(emptyLink("world")).link(boxLink("box", 2.0, {0.1, 0.1, 0.1}));
  JointSpec joint = jointSpec("x", JointType::prismatic, "world", "box", {}, Vector3::UnitX());
  joint.dryFriction = 3.0;
  builder.joint(joint);
  Scene s(builder.build());
  s.state.v[0] = speed;
  s.input.tau[0] = force;
  s.stages();
  return s;
}

TEST(DryFriction, RowIsThatOfTheDof) {
  Scene s = slide(0.7, 0.0);
  const DryFriction& rows = s.data->constraints.dryFriction;
  ASSERT_EQ(rows.rowCount(), 1);
  EXPECT_EQ(rows.dof(0), 0);
  EXPECT_EQ(rows.limit[0], 3.0);
  // It leaves 1/(1 + κ) of what moves 1/A = m, and stops within the step.
  EXPECT_SMALL(1.0 / rows.D[0] - kSoft, 1e-15);
  EXPECT_SMALL(rows.reference[0] + 0.7 / s.model.options.timestep, 1e-12);
}

// A softness that is given is B = b/R: d = dMin at r = 0, A = 1/m, b = 2/(dMax tc).
TEST(DryFriction, HasTheDampingOfItsImpedance) {
  for (const double timestep : {0.0005, 0.002, 0.01}) {
    Scene s = slide(0.7, 0.0);
    s.model.options.timestep = timestep;
    s.model.dofs[0].frictionImpedance.timeConstant = 0.05;
    s.stages();
    const double b = 2.0 / (0.95 * 0.05), R = 0.1 / 0.9 * 0.5;
    const DryFriction& rows = s.data->constraints.dryFriction;
    EXPECT_SMALL(rows.D[0] * R / (timestep * b) - 1.0, 1e-12);
    EXPECT_SMALL(rows.D[0] * rows.reference[0] / (b / R * 0.7) + 1.0, 1e-12);
  }
}

TEST(DryFriction, SlidingFeelsTheLimitAgainstItsMotion) {
  for (const double sign : {-1.0, 1.0})
    for (const double force : {-8.0, 0.0, 8.0}) {
      Scene s = slide(2.0 * sign, force);
      s.forward();
      EXPECT_EQ(s.data->constraints.dryFriction.f[0], -3.0 * sign);
      EXPECT_SMALL(s.data->forward.a[0] - 0.5 * (force - 3.0 * sign), 1e-14);
    }
}

// Stopping distance of Coulomb friction: v²/(2 f/m), reached in the time v m/f.
TEST(DryFriction, StopsASlideAfterItsStoppingDistance) {
  Scene s = slide(1.5, 0.0);
  const double h = s.model.options.timestep;
  s.steps(static_cast<int>(1.5 * 2.0 / 3.0 / h) + 100);
  EXPECT_SMALL(s.state.v[0], 1e-5);
  EXPECT_SMALL(s.state.q[0] - 1.5 * 1.5 * 2.0 / 6.0, 3.0 * h * 1.5);
}

// A load below the limit is held, without creep, or, where it is as soft as in motion, with the
// creep that softness needs; one above it is not.
TEST(DryFriction, HoldsALoadBelowItsLimitAndSlidesAboveIt) {
  Scene held = slide(0.0, 2.0);
  held.steps(500);
  EXPECT_SMALL(held.state.v[0], 1e-8 * kSoft * 2.0 * held.model.options.timestep);
  EXPECT_SMALL(held.data->constraints.dryFriction.f[0] + 2.0, 1e-9);

  const double R = 0.1 / 0.9 * 0.5, b = 2.0 / (0.95 * 0.02);
  Scene soft = slide(0.0, 2.0);
  soft.model.options.constraintModel = ConstraintModel::mujoco;
  soft.steps(500);
  EXPECT_SMALL(soft.state.v[0] / (R * 2.0 / b) - 1.0, 1e-9);
  EXPECT_SMALL(soft.data->constraints.dryFriction.f[0] + 2.0, 1e-9);

  Scene slides = slide(0.0, 4.0);
  slides.steps(500);
  EXPECT_SMALL(slides.data->forward.a[0] - 0.5, 1e-12);
}

// (5.6): R falls with the speed below twice the creep of the limit, down to 10⁻⁹; goals may have
// it soft again.
TEST(DryFriction, HardensAsItComesToRest) {
  const double R = kSoft, slow = 2.0 * 3.0 * R * 0.002;
  for (const double share : {0.0, 1e-12, 1e-3, 0.5, 1.0, 2.0}) {
    Scene s = slide(-share * slow, 0.0);
    DryFriction& rows = s.data->constraints.dryFriction;
    EXPECT_SMALL(1.0 / rows.D[0] / (R * std::clamp(share, 1e-9, 1.0)) - 1.0, 1e-12) << share;
    s.input.controlled = allTrees(s.model);
    s.stages();
    EXPECT_SMALL(1.0 / rows.D[0] / R - 1.0, 1e-15) << share;
  }
}

TEST(DryFriction, NeverExceedsItsLimitNorDrives) {
  int sliding = 0, sticking = 0;
  for (int seed = 1; seed < 400; seed += 2) {
    Scene s = lawScene(seed, 4);
    s.state.v *= 0.01;
    s.stages();
    s.forward();
    const DryFriction& rows = s.data->constraints.dryFriction;
    for (int i = 0; i < rows.rowCount(); ++i) {
      const double limit = s.model.dofs[rows.dof(i)].dryFriction;
      EXPECT_LE(std::abs(rows.f[i]), limit);
      ++(std::abs(rows.f[i]) == limit ? sliding : sticking);
      // The force opposes the velocity that the row sees coming, v + a/b.
      EXPECT_LE(rows.f[i] * rows.x[i], 0.0);
    }
  }
  EXPECT_GT(sliding, 100);
  EXPECT_GT(sticking, 100);
}

TEST(DryFriction, SwitchedOffMakesNoRows) {
  Scene s = slide(1.0, 0.0);
  s.model.options.effects.remove(Effect::dryFriction);
  s.stages();
  EXPECT_EQ(s.data->stats.rows, 0);
}

}  // namespace
}  // namespace softgauss::test
