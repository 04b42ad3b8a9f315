// SPDX-License-Identifier: Apache-2.0
/// What holds goals back: shares in closed form, and laws that hold wherever a solve ends.

#include "softgauss/gdd/goal_balance.hpp"

#include <numeric>

#include "softgauss/engine/step/inverse.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

using Kind = gdd::Opponent::Kind;

constexpr double kMass = 2.0;       // of the slider [kg]
constexpr double kBeyond = -0.001;  // an end of a range, 1 mm behind the slider [m]

/// A slider along x, at rest where nothing pulls, with a goal that pulls it 0.1 m on.
struct PulledSlider {
  Model model;
  State state;
  gdd::GoalDirectedController controller;

  explicit PulledSlider(double effort = kInfinity, double upper = 1.0)
      : model(make(effort, upper)), state(model), controller(model) {
    state.q.setZero();
    controller.controlCost = gdd::ControlCost::total;
    auto reach = std::make_unique<gdd::Reach>(model, "cart", Vector3(0.1, 0.0, 0.0));
    reach->weight = kWish;
    controller.goals.push_back(std::move(reach));
  }
  /// A posture of this weight at the start.
  void addPosture(double weight) {
    auto posture = std::make_unique<gdd::Posture>(state.q);
    posture->weight = weight;
    posture->stiffness = 100.0;
    controller.goals.push_back(std::move(posture));
  }
  /// The shares of what opposes the reach, by kind.
  std::map<Kind, double> shares(ContactSource* contacts = nullptr) {
    gdd::GoalBalance balance(model, controller);
    EXPECT_TRUE(balance.solve({}, state, contacts));
    EXPECT_LT(balance.imbalance(), 1e-9);
    std::map<Kind, double> shares;
    for (const gdd::Opponent& o : balance.against(0).opponents) shares[o.kind] += o.share;
    return shares;
  }

  static constexpr double kWish = 6.0;  ///< w of the reach [kg]

  static Model make(double effort, double upper) {
    JointSpec slide;
    slide.lower = -1.0;
    slide.upper = upper;
    if (std::isfinite(effort)) slide.effort = effort;
    return slidingCart(kMass, slide);
  }
};

// (M + w + w_p M) a = w k e: what opposes w(k e − a) is M a, the price of u = M a with R = M⁻¹, and
// w_p M a of the posture, which is where it wants to be.
TEST(GoalBalance, SharesOfAPostureAndThePriceAreThoseOfTheClosedForm) {
  for (const double weight : {0.5, 1.0, 50.0}) {
    PulledSlider s;
    s.addPosture(weight);
    const auto shares = s.shares();
    ASSERT_EQ(shares.size(), 2u);
    EXPECT_NEAR(shares.at(Kind::controlCost), 1.0 / (1.0 + weight), 1e-12);
    EXPECT_NEAR(shares.at(Kind::goal), weight / (1.0 + weight), 1e-12);
  }
}

// At its bound the control is u: the price opposes with u, the bound with the rest of w(k e − a).
TEST(GoalBalance, ABoundOfAControlHasWhatThePriceLeaves) {
  const double effort = 3.0, a = effort / kMass;
  const double pull = PulledSlider::kWish * (100.0 * 0.1 - a);
  const auto shares = PulledSlider(effort).shares();
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_NEAR(shares.at(Kind::controlCost), effort / pull, 1e-12);
  EXPECT_NEAR(shares.at(Kind::controlLimit), 1.0 - effort / pull, 1e-12);
}

// Pressed against the end of its range the slider needs M + s″ for an acceleration: M is the
// price's, s″ the range's.
TEST(GoalBalance, AnEndOfARangeHasTheShareOfItsStiffness) {
  PulledSlider s(kInfinity, kBeyond);
  Data data(s.model);
  ASSERT_EQ(computeStages(s.model, {}, s.state, data, nullptr), SolveStatus::converged);
  ASSERT_EQ(data.constraints.jointLimit.rowCount(), 1);
  const double stiffness = data.constraints.jointLimit.D[0];
  const auto shares = s.shares();
  ASSERT_EQ(shares.size(), 2u);
  EXPECT_NEAR(shares.at(Kind::range), stiffness / (kMass + stiffness), 1e-12);
  EXPECT_NEAR(shares.at(Kind::controlCost), kMass / (kMass + stiffness), 1e-12);
}

// What pulls the same way is no opponent: the shares of the others still add up to 1.
TEST(GoalBalance, WhatHelpsTakesNoShare) {
  PulledSlider s;
  s.addPosture(3.0);
  s.state.q[0] = -0.2;  // the posture asks for 20 m/s², the reach for 18
  dynamic_cast<gdd::Reach&>(*s.controller.goals[0]).stiffness = 60.0;
  const auto shares = s.shares();
  ASSERT_EQ(shares.size(), 1u);
  EXPECT_EQ(shares.at(Kind::controlCost), 1.0);
}

// Of w k e at rest, w(k e − a) is left: M/(M + w) of it where nothing is in the way. Against a
// range, u = M a + D (a + a_ref), (M + D) u/M = w (k e − a).
TEST(GoalBalance, TellsHowFarAGoalIsHeld) {
  const auto held = [](PulledSlider& s) {
    gdd::GoalBalance balance(s.model, s.controller);
    EXPECT_TRUE(balance.solve({}, s.state, nullptr));
    return balance.against(0).held;
  };
  PulledSlider free, blocked(kInfinity, kBeyond);
  const double w = PulledSlider::kWish, wish = 100.0 * 0.1;
  EXPECT_NEAR(held(free), kMass / (kMass + w), 1e-12);
  Data data(blocked.model);
  ASSERT_EQ(computeStages(blocked.model, {}, blocked.state, data, nullptr), SolveStatus::converged);
  const double D = data.constraints.jointLimit.D[0], P = kMass + D;
  const double a =
      (w * wish - P / kMass * D * data.constraints.jointLimit.reference[0]) / (w + P * P / kMass);
  EXPECT_NEAR(held(blocked), std::min(1.0, (wish - a) / wish), 1e-9);
}

/// A humanoid on its feet that reaches, turns a hand and keeps its posture, after some steps.
struct StandingReach : RobotScene {
  explicit StandingReach(gdd::GddSolver solver) : RobotScene("humanoid") {
    gdd::Reach& reach = addReach("right_hand", {0.6, -0.3, 1.3});
    reach.R_WTarget = Matrix3::Identity();
    reach.weight = 500.0;
    addReach("left_hand", {0.3, 0.6, 1.0}).weight = 200.0;
    addPosture().weight = 1000.0;
    addDamping();
    controller.motionLimits.emplace();
    controller.solver = solver;
    for (int i = 0; i < 100; ++i) EXPECT_EQ(step(), SolveStatus::converged);
  }
};

// Σ∇ℓ + P w = J_Kᵀμ leaves no multiplier to a control within its bounds, whichever solver has found
// the point: to what the solvers promise, 1e-12 of the objective and 1e-8 of the slope.
TEST(GoalBalance, SlopesAddUpToNothingWhereEitherSolverEnds) {
  for (const gdd::GddSolver solver :
       {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian}) {
    StandingReach s(solver);
    gdd::GoalBalance balance(s.model, s.controller);
    ASSERT_TRUE(balance.solve(s.input, s.state, &s.contacts));
    EXPECT_LT(balance.imbalance(), 1e-6);
    ASSERT_EQ(balance.goalCount(), 5);
    for (int i = 0; i < balance.goalCount(); ++i) {
      const auto opponents = balance.against(i).opponents;
      if (opponents.empty()) continue;
      double sum = 0.0;
      for (const gdd::Opponent& o : opponents) {
        EXPECT_GT(o.share, 0.0);
        sum += o.share;
      }
      EXPECT_NEAR(sum, 1.0, 1e-6) << balance.goalName(i);
      EXPECT_TRUE(std::is_sorted(opponents.begin(), opponents.end(),
                                 [](const auto& a, const auto& b) { return a.share > b.share; }));
    }
  }
}

// What a run asks of itself at its end does not change the run.
TEST(GoalBalance, LeavesTheControllersRunAsItWas) {
  StandingReach asked(gdd::GddSolver::activeSet), other(gdd::GddSolver::activeSet);
  gdd::GoalBalance balance(asked.model, asked.controller);
  ASSERT_TRUE(balance.solve(asked.input, asked.state, &asked.contacts));
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(asked.step(), SolveStatus::converged);
    ASSERT_EQ(other.step(), SolveStatus::converged);
  }
  EXPECT_EQ(asked.state.q, other.state.q);
  EXPECT_EQ(asked.state.v, other.state.v);
}

}  // namespace
}  // namespace softgauss::test
