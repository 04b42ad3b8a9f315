// SPDX-License-Identifier: Apache-2.0
// The control cost about what holds the robot at rest, and about zero as in the paper.

#include <gtest/gtest.h>

#include "tests/gdd/robot_scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

using gdd::ControlCost;
using gdd::GddSolver;

constexpr GddSolver kSolvers[] = {GddSolver::activeSet, GddSolver::augmentedLagrangian};

/// An arm without rows, bounds and forces of motion, bent.
struct FreeArm : RobotScene {
  explicit FreeArm(GddSolver solver) : RobotScene("arm") {
    model.options.effects = EffectSet::none();
    for (const Effect effect : {Effect::gravity, Effect::armature, Effect::actuation})
      model.options.effects.insert(effect);
    for (int i = 0; i < model.nq; ++i) state.q[i] = 0.3 + 0.1 * i;
    controller.solver = solver;
    controller.limits.lower.setConstant(-kInfinity);
    controller.limits.upper.setConstant(kInfinity);
  }
};

/// The joints' distance from the posture that the humanoid was asked to keep, after 6 s [rad].
double offPosture(ControlCost cost) {
  RobotScene r("humanoid");
  r.state.q[2] -= 1e-9;  // all of both soles touch: by rounding of their angles the heels alone do
  r.controller.controlCost = cost;
  r.addPosture().weight = 10.0;
  const VectorX start = r.state.q;
  for (int i = 0; i < 3000; ++i)
    if (r.step() == SolveStatus::notFinite) return kInfinity;
  return (r.state.q - start).tail(r.model.nv - 6).cwiseAbs().maxCoeff();
}

// (1 + w) M a = w M a*, and with the paper's price w M a* − c: the arm at rest has no other forces.
TEST(ControlCost, AShareOfTheWishComesTrueAndNoneOfTheFall) {
  constexpr double kWeight = 4.0;
  for (const GddSolver solver : kSolvers) {
    for (const ControlCost cost : {ControlCost::aboutGravity, ControlCost::total}) {
      FreeArm r(solver);
      r.controller.controlCost = cost;
      gdd::Posture& posture = r.addPosture();
      posture.weight = kWeight;
      for (int i = 0; i < r.model.nq; ++i) posture.q[i] += 0.1 - 0.05 * i;
      const VectorX wish = posture.stiffness * (posture.q - r.state.q);
      ASSERT_EQ(r.step(), SolveStatus::converged);
      const MatrixX M = r.data.inertia.M.dense();
      VectorX pull = kWeight * (M * wish);
      if (cost == ControlCost::total) pull -= r.data.forces.c;
      const VectorX a = M.llt().solve(pull) / (1.0 + kWeight);
      EXPECT_SMALL((r.controller.acceleration() - a).cwiseAbs().maxCoeff(),
                   1e-9 * (1.0 + a.cwiseAbs().maxCoeff()));
    }
  }
}

// The price counts from the springs' rest too, and from a push that is known.
TEST(ControlCost, WhatHoldsAgainstAPushIsFree) {
  for (const GddSolver solver : kSolvers) {
    FreeArm r(solver);
    r.input.tau = VectorX::LinSpaced(r.model.nv, -3.0, 5.0);
    ASSERT_EQ(r.step(), SolveStatus::converged);
    EXPECT_SMALL(r.controller.acceleration().cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_SMALL((r.controller.control - r.data.forces.bias + r.input.tau).cwiseAbs().maxCoeff(),
                 1e-9 * r.data.forces.bias.cwiseAbs().maxCoeff());
  }
}

// All fall alike, so the joints feel nothing: the cheapest control is none.
TEST(ControlCost, InFreeFallNothingIsHeld) {
  for (const GddSolver solver : kSolvers) {
    RobotScene r("humanoid");
    r.model.options.effects.remove(Effect::jointLimit);
    r.controller.solver = solver;
    r.state.q[2] += 1.0;
    for (int i = 7; i < r.model.nq; ++i) r.state.q[i] += 0.02 * (i % 5);
    ASSERT_EQ(r.step(), SolveStatus::converged);
    EXPECT_SMALL(r.controller.control.cwiseAbs().maxCoeff(), 1e-9 * kWeight);
  }
}

TEST(ControlCost, AReachAloneComesToRestAtItsPlace) {
  const Vector3 target(0.5, 0.3, 0.5);
  double left[2];
  for (const ControlCost cost : {ControlCost::aboutGravity, ControlCost::total}) {
    RobotScene r("arm");
    r.controller.controlCost = cost;
    r.addReach("hand", target);
    r.addDamping();
    for (int i = 0; i < 2000; ++i) ASSERT_NE(r.step(), SolveStatus::notFinite);
    left[cost == ControlCost::total] = (r.position("hand") - target).norm();
  }
  EXPECT_SMALL(left[0], 1e-4);
  EXPECT_GT(left[1], 1e-3) << "the price of the paper is to pull at it";
}

TEST(ControlCost, WhatStandsIsNotPulledFromItsPosture) {
  const double about = offPosture(ControlCost::aboutGravity);
  // The feet sink in by tenths of a millimetre, and the posture draws the base up by the joints.
  EXPECT_SMALL(about, 5e-3);
  EXPECT_LT(10.0 * about, offPosture(ControlCost::total));
}

}  // namespace
}  // namespace softgauss::test
