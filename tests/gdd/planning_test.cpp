// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <optional>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/step/forward_derivative.hpp"
#include "softgauss/engine/step/step.hpp"
#include "softgauss/gdd/goals/quadratic_value.hpp"
#include "softgauss/gdd/planning/planner.hpp"
#include "tests/gdd/rails.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

using namespace planning;

// ---- A linear system ----------------------------------------------------------------------------

Model railsOf(double step) {
  ModelBuilder b = rails();
  b.options = StepDerivative::bareStep(b.options);
  b.options.timestep = step;
  return b.build();
}

std::unique_ptr<StateCost> towards(const Model& model, const VectorX& q, double position,
                                   double velocity) {
  auto term = std::make_unique<StateCost>(model, q);
  term->positionWeight.setConstant(position);
  term->velocityWeight.setConstant(velocity);
  return term;
}

// With x⁺ = A x + B u and quadratic costs, Riccati's recursion gives the least cost ½ xᵀS x from x.
// One iteration of phase I finds it, and so does one of phase F.
TEST(Planner, OnALinearModelTheFirstIterationIsRiccatis) {
  constexpr double kStep = 0.02;
  constexpr int kKnots = 30;
  const Model model = railsOf(kStep);
  const int n = model.nv;
  Random random(3);
  const VectorX q = random.vector(n, 1.0), v = random.vector(n, 1.0);

  Data data(model);
  Input input;
  input.tau = VectorX::Zero(n);
  State state(model);
  StepDerivative step(model);
  ASSERT_EQ(step.compute(model, input, state, nullptr, data), SolveStatus::converged);
  const MatrixX A = step.state(), B = step.tau();
  const MatrixX R = kStep * 0.01 * MatrixX::Identity(n, n);
  MatrixX Q = MatrixX::Identity(2 * n, 2 * n), S = Q;
  Q.topLeftCorner(n, n) *= 3.0 * kStep, Q.bottomRightCorner(n, n) *= 0.5 * kStep;
  S.topLeftCorner(n, n) *= 20.0, S.bottomRightCorner(n, n) *= 2.0;
  MatrixX K;
  for (int t = 0; t < kKnots; ++t) {
    K = (R + B.transpose() * S * B).llt().solve(B.transpose() * S * A);
    S = Q + A.transpose() * S * (A - B * K);
  }
  VectorX x(2 * n);
  x << q, v;
  const double least = 0.5 * x.dot(S * x);

  Planner planner(model, {kStep, kKnots});
  planner.cost.running.push_back(towards(model, VectorX::Zero(n), 3.0, 0.5));
  planner.cost.final.push_back(towards(model, VectorX::Zero(n), 20.0, 2.0));
  PlanOptions options;
  options.infeasible = 1;
  const MotionPlan& plan = planner.solve(q, v, options);
  EXPECT_EQ(plan.status, PlanStatus::converged);
  EXPECT_NEAR(plan.costs[0], least, 1e-10 * least);
  EXPECT_NEAR(plan.cost, least, 1e-10 * least);
  EXPECT_APPROX(plan.tau[0], VectorX(-K * x), 1e-8);
  EXPECT_SMALL(plan.gap, 1e-10);
}

// ---- Smooth and fully actuated ------------------------------------------------------------------

// At a feasible point the subproblem over accelerations is that over controls (substitute
// δa = P⁻¹(δu − G δx)): all three end where the cost is stationary.
TEST(Planner, PhasesAndPlainControlsEndAtOneMinimum) {
  const Model model = chain(3).build();
  const int n = model.nv;
  VectorX target = VectorX::Constant(n, 0.7);
  target[1] = -0.5;
  double cost[3];
  for (const int method : {0, 1, 2}) {
    Planner planner(model, {0.05, 20});
    planner.cost.running.push_back(towards(model, target, 0.1, 0.01));
    planner.cost.final.push_back(towards(model, target, 100.0, 10.0));
    planner.cost.effort.setConstant(1e-3);
    PlanOptions options;
    options.tolerance = 1e-14;
    options.feasible = method == 0 ? 0 : 200;
    options.infeasible = method == 0 ? 100 : 1;
    options.inPhaseF.goalDirected = method != 2;
    options.inPhaseF.plainControls = method == 2;
    const MotionPlan& plan = planner.solve(model.q0, VectorX::Zero(n), options);
    cost[method] = method == 0 ? plan.costs.back() : plan.cost;
  }
  EXPECT_NEAR(cost[1], cost[0], 1e-8 * cost[0]);
  EXPECT_NEAR(cost[2], cost[0], 1e-8 * cost[0]);
}

// ---- What is underactuated, and bounded ---------------------------------------------------------

Model cartPole(std::optional<double> effort) {
  ModelBuilder b("cart-pole");
  b.link(emptyLink("world"));
  LinkSpec cart = sphereLink("cart", 1.0, 0.1);
  LinkSpec pole = sphereLink("pole", 0.2, 0.2, {0, 0, -0.5});
  b.link(cart).link(pole);
  JointSpec slide = jointSpec("slide", JointType::prismatic, "world", "cart", {}, Vector3::UnitX());
  slide.effort = effort;
  JointSpec hinge = jointSpec("hinge", JointType::continuous, "cart", "pole", {}, Vector3::UnitY());
  hinge.effort = 0.0;
  b.joint(slide).joint(hinge);
  return b.build();
}

void swingUp(Planner& planner) {
  const VectorX up = Eigen::Vector2d(0.0, std::numbers::pi);
  planner.cost.running.push_back(towards(planner.model(), up, 0.2, 0.02));
  planner.cost.final.push_back(towards(planner.model(), up, 200.0, 20.0));
  planner.cost.effort[0] = 0.02;
  planner.rootCost[1] = 200.0;
}

TEST(Planner, SwingsUpWithinBoundsByWhatTheStepDoes) {
  for (const std::optional<double> effort :
       {std::optional<double>(), std::optional<double>(15.0)}) {
    const Model model = cartPole(effort);
    Planner planner(model, {0.05, 40});
    swingUp(planner);
    PlanOptions options;
    options.infeasible = 30;
    const MotionPlan& plan = planner.solve(model.q0, VectorX::Zero(2), options);
    EXPECT_TRUE(plan.status == PlanStatus::converged || plan.status == PlanStatus::iterationLimit);
    EXPECT_NEAR(plan.q.back()[1], std::numbers::pi, 0.1);
    EXPECT_EQ(plan.rootForce, 0.0);
    EXPECT_SMALL(plan.gap, 1e-10);
    for (std::size_t i = static_cast<std::size_t>(plan.infeasible); i + 1 < plan.costs.size(); ++i)
      EXPECT_LE(plan.costs[i + 1], plan.costs[i]);
    // Step by step, for an open loop would leave an unstable plan by rounding alone.
    const Model& bare = planner.model();
    Data data(bare);
    for (std::size_t t = 0; t < plan.tau.size(); ++t) {
      EXPECT_LE(std::abs(plan.tau[t][0]), effort.value_or(kInfinity));
      EXPECT_EQ(plan.tau[t][1], 0.0);
      State state(bare);
      state.q = plan.q[t], state.v = plan.v[t];
      Input input;
      input.tau = plan.tau[t];
      input.controlled = allTrees(bare);
      ASSERT_EQ(softgauss::step(bare, input, state, data, nullptr), SolveStatus::converged);
      EXPECT_APPROX(state.q, plan.q[t + 1], 1e-10);
      EXPECT_APPROX(state.v, plan.v[t + 1], 1e-10);
    }
  }
}

// Off kinks phase F takes the steps of iterative LQR: its control k + K δx is that of Riccati's
// recursion over controls, here with differences of step() itself.
TEST(Planner, OffKinksPhaseFHasTheFeedbackOfIterativeLqr) {
  constexpr double kStep = 0.05, kDelta = 1e-5;
  const Model model = cartPole({});
  Planner planner(model, {kStep, 20});
  swingUp(planner);
  PlanOptions options;
  options.infeasible = options.feasible = 4;  // not at the minimum
  const MotionPlan plan = planner.solve(model.q0, VectorX::Zero(2), options);
  ASSERT_TRUE(planner.refresh());
  ASSERT_EQ(planner.feasible().rho(), 0.0);
  const Model& bare = planner.model();
  Data data(bare);
  Input input;
  input.controlled = allTrees(bare);
  const auto next = [&](const VectorX& at) {  // of (q, v, u)
    State state(bare);
    state.q = at.head(2), state.v = at.segment(2, 2);
    input.tau = Eigen::Vector2d(at[4], 0.0);
    EXPECT_EQ(softgauss::step(bare, input, state, data, nullptr), SolveStatus::converged);
    VectorX x(4);
    x << state.q, state.v;
    return x;
  };
  const auto error = [&](std::size_t t) {
    VectorX e(4);
    e << plan.q[t] - VectorX(Eigen::Vector2d(0.0, std::numbers::pi)), plan.v[t];
    return e;
  };
  const VectorX running = kStep * Eigen::Vector4d(0.2, 0.2, 0.02, 0.02),
                last = Eigen::Vector4d(200.0, 200.0, 20.0, 20.0);
  const double R = kStep * 0.02;
  MatrixX V = last.asDiagonal();
  VectorX s = last.cwiseProduct(error(plan.tau.size()));
  for (std::size_t t = plan.tau.size(); t-- > 0;) {
    VectorX at(5);
    at << plan.q[t], plan.v[t], plan.tau[t][0];
    MatrixX J(4, 5);
    for (int i = 0; i < 5; ++i) {
      const VectorX d = kDelta * VectorX::Unit(5, i);
      J.col(i) = (next(at + d) - next(at - d)) / (2.0 * kDelta);
    }
    const MatrixX A = J.leftCols(4), B = J.rightCols(1);
    const MatrixX Qux = B.transpose() * V * A;
    const double Quu = R + (B.transpose() * V * B)(0), Qu = R * at[4] + B.col(0).dot(s);
    const Feedback& found = planner.feasible().feedback()[t];
    EXPECT_APPROX(found.K, MatrixX(-Qux / Quu), 1e-6) << t;
    EXPECT_NEAR(found.k[0], -Qu / Quu, 1e-6 * std::max(1.0, std::abs(Qu / Quu))) << t;
    s = VectorX(running.cwiseProduct(error(t)) + A.transpose() * s - Qux.transpose() * (Qu / Quu));
    V = MatrixX(MatrixX(running.asDiagonal()) + A.transpose() * V * A -
                Qux.transpose() * Qux / Quu);
  }
}

TEST(Planner, GivesTheSameBitsAgain) {
  std::vector<MotionPlan> plans;
  for (int i = 0; i < 2; ++i) {
    const Model model = cartPole(10.0);
    Planner planner(model, {0.05, 30});
    swingUp(planner);
    plans.push_back(planner.solve(model.q0, VectorX::Zero(2)));
  }
  EXPECT_EQ(plans[0].costs, plans[1].costs);
  EXPECT_EQ(plans[0].q.back(), plans[1].q.back());
}

TEST(Planner, RefusesWhatIsNotFinite) {
  const Model model = cartPole({});
  Planner planner(model, {0.05, 5});
  swingUp(planner);
  const VectorX bad = VectorX::Constant(2, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(planner.solve(bad, VectorX::Zero(2)).status, PlanStatus::refused);
  EXPECT_EQ(planner.solve(model.q0, VectorX::Zero(3)).status, PlanStatus::refused);
  EXPECT_THROW(Planner(model, {0.0, 5}), ModelError);
  EXPECT_THROW(Planner(model, {0.05, 0}), ModelError);
}

/// A cost, or its slope, that is not a number at a knot.
struct NotFinite final : CostTerm {
  int knot;
  bool inSlope;
  NotFinite(int k, bool slope) : knot(k), inSlope(slope) {}
  double of(const KnotView& at, bool bad) const {
    return bad && at.knot == knot ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  }
  double value(const KnotView& at) override { return of(at, !inSlope); }
  double expand(const KnotView& at, double, VectorX& slope, MatrixX&) override {
    slope[1] += of(at, inSlope);
    return of(at, !inSlope);
  }
};

TEST(Planner, TellsTheKnotThatItRefuses) {
  const Model model = cartPole({});
  for (const bool inSlope : {false, true})
    for (const int knot : {0, 3, 5}) {
      Planner planner(model, {0.05, 5});
      swingUp(planner);
      auto& terms = knot == 5 ? planner.cost.final : planner.cost.running;
      terms.push_back(std::make_unique<NotFinite>(knot, inSlope));
      const MotionPlan& plan = planner.solve(model.q0, VectorX::Zero(2));
      EXPECT_EQ(plan.status, PlanStatus::refused) << knot << inSlope;
      EXPECT_EQ(plan.refusedKnot, knot) << inSlope;
      // The planner goes on as before.
      terms.pop_back();
      EXPECT_EQ(planner.solve(model.q0, VectorX::Zero(2)).refusedKnot, -1);
      EXPECT_LT(planner.plan().gap, 1e-10);
    }
}

// ---- The goal ----------------------------------------------------------------------------------

// ℓ(a) is V at the state where the step by a ends, to the order that the expansion has.
TEST(QuadraticValue, IsTheValueAtTheStepsEnd) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::semiImplicitEuler}) {
    for (int seed = 0; seed < 10; ++seed) {
      Random random(seed);
      ModelBuilder builder = randomFloatingTree(seed);
      builder.options = StepDerivative::bareStep(builder.options);
      builder.options.integrator = integrator;
      builder.options.timestep = 0.02;
      const Model model = builder.build();
      const int n = model.nv;
      const State begin = randomState(model, random);
      gdd::QuadraticValue goal(model);
      goal.q = begin.q;
      integratePosition(model, random.vector(n, 0.1), 1.0, goal.q);
      goal.v = random.vector(n, 1.0);
      goal.slope = random.vector(2 * n, 1.0);
      MatrixX root(2 * n, 2 * n);
      for (double& x : root.reshaped()) x = random.uniform(-1.0, 1.0);
      goal.curvature = root * root.transpose();
      goal.about = random.vector(n, 5.0);
      const double h = model.options.timestep;
      const auto value = [&](const VectorX& a) {
        State end = begin;
        const bool drifts = integrator == Integrator::leapfrog;
        if (drifts) integratePosition(model, end.v, 0.5 * h, end.q);
        end.v += h * a;
        integratePosition(model, end.v, drifts ? 0.5 * h : h, end.q);
        VectorX e(2 * n);
        e << positionDifference(model, goal.q, end.q), end.v - goal.v;
        return goal.slope.dot(e) + 0.5 * e.dot(goal.curvature * e);
      };
      State at = begin;
      if (integrator == Integrator::leapfrog) integratePosition(model, at.v, 0.5 * h, at.q);
      Data data(model);
      computeStages(model, Input{}, at, data, nullptr);
      gdd::GoalCost cost(n);
      cost.clear();
      goal.addCost({model, at, data}, cost);
      VectorX slope(n), Ma(n);
      data.inertia.M.multiply(goal.about, Ma);
      cost.gradient(goal.about, Ma, slope);
      const MatrixX expected = gradient(
          goal.about, [&](const VectorX& a) { return VectorX(VectorX::Constant(1, value(a))); },
          1e-4);
      EXPECT_APPROX(slope.transpose(), expected, 1e-7) << seed;
    }
  }
}

}  // namespace
}  // namespace softgauss::test
