// SPDX-License-Identifier: Apache-2.0
/// A step is a function of the state: bits, input that is not finite, warm starts, mad goals.

#include "tests/gdd/gdd_scene.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// A humanoid that stands and reaches, some steps into it.
std::unique_ptr<RobotScene> reachingHumanoid(int steps = 20) {
  auto r = std::make_unique<RobotScene>("humanoid");
  r->addReach("right_hand", {0.45, -0.25, 1.10});
  r->addDamping();
  for (int i = 0; i < steps; ++i) EXPECT_NE(r->step(), SolveStatus::notFinite);
  return r;
}

TEST(GddState, SameInputGivesTheSameBits) {
  auto first = reachingHumanoid(0), second = reachingHumanoid(0);
  for (int i = 0; i < 200; ++i) {
    first->step();
    second->step();
    ASSERT_EQ(hash(first->state), hash(second->state)) << "step " << i;
  }
}

// All that the next step depends on is in State: neither Data nor the controller remembers.
TEST(GddState, CopiedStateContinuesWithTheSameBits) {
  auto first = reachingHumanoid(100), second = reachingHumanoid(0);
  second->state = first->state;
  for (int i = 0; i < 100; ++i) {
    first->step();
    second->step();
    ASSERT_EQ(hash(first->state), hash(second->state)) << "step " << i;
  }
}

// The breakpoints of a kink, by names that find them again, and when to look for a better minimum.
TEST(GddState, KnotsAndSearchesAreKeptFromStepToStep) {
  auto r = reachingHumanoid(0);
  r->addReach("left_hand", {0.9, 0.5, 1.4}).weight = 3000.0;  // out of reach: it stumbles
  const WarmStart& warm = r->state.warmstart;
  int kinks = 0, longestWait = 0;
  for (int i = 0; i < 200; ++i) {
    ASSERT_NE(r->step(), SolveStatus::notFinite);
    ASSERT_EQ(static_cast<int>(warm.breakpoints.size()), r->controller.report.heldRows);
    for (const BreakpointKey& name : warm.breakpoints) {
      const auto breakpoint = r->data.constraints.find(name);
      ASSERT_TRUE(breakpoint.has_value());
      EXPECT_EQ(r->data.constraints.nameOf(*breakpoint), name);
    }
    kinks += warm.breakpoints.empty() ? 0 : 1;
    longestWait = std::max(longestWait, warm.gddSearchWait.front());
  }
  EXPECT_GT(kinks, 0);
  EXPECT_GT(longestWait, 1);
  EXPECT_LE(longestWait, r->controller.activeSet.options.longestSearchWait);
}

/// The step refuses, and leaves the state as it was.
void expectRefused(RobotScene& r, SolveStatus status = SolveStatus::notFinite) {
  const State before = r.state;
  EXPECT_EQ(r.step(), status);
  EXPECT_EQ(r.data.stats.status, status);
  EXPECT_EQ(hash(r.state), hash(before));
}

TEST(GddState, InputThatIsNotFiniteIsRefusedAndTheStateKept) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    auto r = reachingHumanoid();
    const State good = r->state;
    r->state.q[9] = bad;
    expectRefused(*r);
    r->state = good;
    r->state.v[3] = bad;
    expectRefused(*r);
    r->state = good;
    r->input.tau = VectorX::Zero(r->model.nv);
    r->input.tau[8] = bad;
    expectRefused(*r);
    r->input.tau.setZero();
    r->input.wrenches.push_back({1, {Vector3::Zero(), Vector3(0, bad, 0)}});
    expectRefused(*r);
    r->input.wrenches.clear();
    EXPECT_NE(r->step(), SolveStatus::notFinite) << "it goes on after a refusal";
  }
}

TEST(GddState, GoalThatIsNotFiniteIsRefusedAndTheStateKept) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    auto r = reachingHumanoid();
    auto& reach = static_cast<gdd::Reach&>(*r->controller.goals[0]);
    auto& damping = static_cast<gdd::VirtualDamping&>(*r->controller.goals[1]);
    const Vector3 target = reach.p_WTarget;
    reach.p_WTarget.x() = bad;
    expectRefused(*r);
    reach.p_WTarget = target;
    reach.weight = bad;
    expectRefused(*r);
    reach.weight = 100.0;
    damping.rate = bad;
    expectRefused(*r);
    damping.rate = 10.0;
    EXPECT_NE(r->step(), SolveStatus::notFinite);
  }
}

// Bounds that cross, that are no numbers, or that leave no finite value.
TEST(GddState, BoxThatIsNoneIsRefusedAndTheStateKept) {
  const std::pair<double, double> none[] = {{1.0, -1.0},
                                            {kNaN, 1.0},
                                            {-1.0, kNaN},
                                            {kInfinity, kInfinity},
                                            {kInfinity, -kInfinity},
                                            {-kInfinity, -kInfinity}};
  for (const auto solver : {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian}) {
    for (const bool functions : {false, true}) {
      auto r = reachingHumanoid(5);
      r->controller.solver = solver;
      if (functions)
        r->controller.goals.push_back(std::make_unique<gdd::FunctionGoal>(
            [](const gdd::GoalContext&, const VectorX& a, VectorX& gradient, MatrixX& hessian) {
              gradient = a;
              hessian.setIdentity();
              return 0.5 * a.squaredNorm();
            }));
      const gdd::ControlLimits good = r->controller.limits;
      for (const auto& [lower, upper] : none) {
        for (const int i : {2, 9}) {  // a root force, a joint
          r->controller.limits.lower[i] = lower;
          r->controller.limits.upper[i] = upper;
          expectRefused(*r, SolveStatus::badInput);
          EXPECT_EQ(r->controller.report.status, gdd::GddStatus::badLimits);
          EXPECT_EQ(r->data.stats.badDof, i);
          r->controller.limits = good;
        }
      }
      r->controller.limits.upper.conservativeResize(3);
      expectRefused(*r, SolveStatus::badInput);
      EXPECT_EQ(r->controller.report.status, gdd::GddStatus::badLimits);
      r->controller.limits = good;
      EXPECT_NE(r->step(), SolveStatus::notFinite) << "it goes on after a refusal";
      EXPECT_NE(r->controller.report.status, gdd::GddStatus::badLimits);
    }
  }
}

TEST(GddState, WarmStartThatIsNotFiniteIsAColdStart) {
  auto cold = reachingHumanoid();
  const State good = cold->state;
  cold->state.warmstart.gddValid = false;
  ASSERT_NE(cold->step(), SolveStatus::notFinite);
  for (const double bad : {kNaN, kInfinity}) {
    for (const bool control : {false, true}) {
      auto r = reachingHumanoid(0);
      r->state = good;
      (control ? r->state.warmstart.control : r->state.warmstart.gddA)[4] = bad;
      ASSERT_NE(r->step(), SolveStatus::notFinite);
      EXPECT_EQ(r->state.v, cold->state.v);
      EXPECT_EQ(r->controller.control, cold->controller.control);
    }
    auto r = reachingHumanoid(0);
    r->state = good;
    r->state.warmstart.gddValid = false;
    r->state.warmstart.a[2] = bad;
    ASSERT_NE(r->step(), SolveStatus::notFinite);
    EXPECT_APPROX(r->state.v, cold->state.v, 1e-9);
  }
}

// The problem is not convex: another start may end in another minimum, yet mostly it does not.
TEST(GddState, WarmStartsFromElsewhereChangeTheObjectiveOnlyUpToLocalMinima) {
  int same = 0, total = 0, unfinished = 0;
  for (int seed = 0; seed < 40; ++seed) {
    GddScene s = lawGddScene(seed, 5);
    s.solve();
    const double reference = s.report.objective;
    const VectorX a = s.solver->acceleration();
    const VectorX g = s.dense.g(a);
    const double scale = 0.5 * g.dot(s.dense.Minv * g) + std::abs(s.dense.goalCost(a));
    if (s.report.status == gdd::GddStatus::iterationLimit) continue;
    Random random(seed + 500);
    for (int i = 0; i < 5; ++i) {
      WarmStart& warm = s.scene.state.warmstart;
      warm.gddValid = true;
      warm.gddA = a + random.vector(s.dofs(), 1.0 + a.cwiseAbs().maxCoeff());
      warm.multipliers = random.vector(s.dofs(), 10.0);
      s.solve();
      ++total;
      const bool ended = s.report.status != gdd::GddStatus::iterationLimit;
      unfinished += !ended;
      same += std::abs(s.report.objective - reference) <= 1e-6 * scale;
      const double forces = std::max(1.0, s.dense.c.cwiseAbs().maxCoeff());
      EXPECT_TRUE(!ended || s.report.violation <= 1e-8 * forces) << s.report.violation;
    }
  }
  RecordProperty("total", total);
  EXPECT_SMALL(1.0 - static_cast<double>(same) / total, 0.4);
  EXPECT_SMALL(static_cast<double>(unfinished) / total, 0.1);
}

// A solve that starts at its own solution stays there.
TEST(GddState, ExactWarmStartTakesNoStep) {
  int checked = 0;
  for (int seed = 0; seed < 40; ++seed) {
    GddScene s = lawGddScene(seed, 5);
    s.solve();
    if (s.report.status != gdd::GddStatus::converged) continue;
    ++checked;
    const VectorX a = s.solver->acceleration();
    s.solver->keepWarmStart(s.scene.state.warmstart);
    s.solve();
    EXPECT_EQ(s.report.status, gdd::GddStatus::converged) << "seed " << seed;
    EXPECT_LE(s.report.iterations, 2) << "seed " << seed;
    EXPECT_APPROX(s.solver->acceleration(), a, 1e-7);
  }
  EXPECT_GT(checked, 10);
}

TEST(GddState, UnreachableAndContradictoryGoalsStayFinite) {
  auto r = std::make_unique<RobotScene>("humanoid");
  r->addReach("right_hand", {1e3, 0.0, 1e3});
  r->addReach("right_hand", {-10.0, 0.0, 0.0}).weight = 1e6;
  r->addReach("left_foot", {0.0, 0.0, -5.0});
  r->addReach("right_hand", {10.0, 0.0, 0.0}).weight = 1e6;
  for (int i = 0; i < 500; ++i) {
    ASSERT_NE(r->step(), SolveStatus::notFinite) << "step " << i;
    ASSERT_TRUE(r->controlsAllowed());
  }
  EXPECT_LT(r->state.v.cwiseAbs().maxCoeff(), 1e4);
}

TEST(GddState, GoalsWithoutWeightAskForNothing) {
  RobotScene r("arm");
  r.controller.controlCost = gdd::ControlCost::total;
  r.addReach("hand", {0.5, 0.3, 0.5}).weight = 0.0;
  ASSERT_EQ(r.step(), SolveStatus::converged);
  // ½ gᵀR g alone: let go.
  EXPECT_SMALL(r.controller.control.cwiseAbs().maxCoeff(), 1e-9);
}

TEST(GddState, AModelWithoutDofsSteps) {
  ModelBuilder builder("rock");
  builder.link(emptyLink("world"));
  const Model model = builder.build();
  gdd::GoalDirectedController controller(model);
  controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  State state(model);
  Data data(model);
  EXPECT_NE(controller.step(model, {}, state, data, nullptr), SolveStatus::notFinite);
}

}  // namespace
}  // namespace softgauss::test
