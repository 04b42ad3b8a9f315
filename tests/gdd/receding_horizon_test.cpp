// SPDX-License-Identifier: Apache-2.0
/// Plans that are acted out by goal directed dynamics in the simulator, whose steps are finer than
/// the plan's and have all mechanisms.

#include "softgauss/gdd/planning/receding_horizon.hpp"

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/step/step.hpp"
#include "softgauss/io/plan_task.hpp"
#include "softgauss/io/simulation/scene.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

using namespace planning;

/// A task of data/plans in the simulator.
struct ActedTask {
  explicit ActedTask(const std::string& name, double step = 0.005)
      : file(std::string(SOFTGAUSS_SOURCE_DIR) + "/data/plans/" + name + ".yaml"),
        scene(loadScene(file)),
        task(io::readPlanTask(file, scene->model, scene->initial)),
        planner(scene->model, task.steps, [](const Model& model) {
          return std::make_unique<collision::SceneContacts>(model);
        }) {
    task.setCosts(planner);
    scene->model.options.timestep = step;
  }
  /// On contacts that begin 5 mm apart, or on those of the scene.
  void plan(bool gently) {
    if (gently && task.contacts) {
      task.endsOnOwnContacts = false;
      task.contacts->contacts.margin = 0.005;
    }
    task.solve(planner, scene->initial);
  }
  /// The state after `seconds`.
  State act(const HorizonOptions& options, double seconds) {
    const Model& model = scene->model;
    RecedingHorizon horizon(planner, options);
    gdd::GoalDirectedController controller(model);
    horizon.attach(controller);
    State state = scene->initial;
    EXPECT_TRUE(horizon.begin(state));
    Data data(model);
    collision::SceneContacts contacts(model);
    while (state.time < seconds - 1e-9) {
      horizon.update(state);
      const SolveStatus status = controller.step(model, {}, state, data, &contacts);
      EXPECT_FALSE(isRefused(status));
      if (isRefused(status)) break;
    }
    report = horizon.report();
    return state;
  }

  std::string file;
  std::unique_ptr<softgauss::Scene> scene;
  io::PlanTask task;
  Planner planner;
  HorizonReport report;
};

double farthest(const ActedTask& acted, const State& state) {
  return positionDifference(acted.scene->model, acted.task.q.back(), state.q).cwiseAbs().maxCoeff();
}

// Upright and at rest, four seconds after the plan ends.
TEST(RecedingHorizon, AnAcrobotSwingsUpAndStays) {
  ActedTask acted("acrobot");
  acted.plan(false);
  const State end = acted.act({.period = 0.02}, 6.0);
  EXPECT_LT(farthest(acted, end), 0.02);
  EXPECT_LT(end.v.cwiseAbs().maxCoeff(), 0.05);
  EXPECT_EQ(acted.report.ticks, 299);
  EXPECT_EQ(acted.report.failed, 0);
}

// Ten steps of the simulator are one of the plan, whose error is theirs.
TEST(RecedingHorizon, ActsAPlanOutWithoutMakingItAnew) {
  ActedTask acted("cart_pole");
  acted.plan(false);
  const State end = acted.act({}, 3.0);
  const VectorX off = positionDifference(acted.scene->model, acted.planner.plan().q.back(), end.q);
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 0.01);
  EXPECT_EQ(acted.report.ticks, 0);
}

/// Nothing, but for a while not a number: in its slope at the knot.
struct Broken final : CostTerm {
  int knot;
  const bool& on;
  Broken(int k, const bool& isOn) : knot(k), on(isOn) {}
  double value(const KnotView&) override { return 0.0; }
  double expand(const KnotView& at, double, VectorX& slope, MatrixX&) override {
    if (on && at.knot >= knot) slope[0] = std::numeric_limits<double>::quiet_NaN();
    return 0.0;
  }
};

// A tick whose models are not finite leaves those before, at the end of the plan and within it; the
// next one plans as ever.
TEST(RecedingHorizon, GoesOnAfterACostThatWasNotFinite) {
  for (const int knot : {60, 30}) {
    ActedTask acted("cart_pole");
    acted.plan(false);
    bool broken = false;
    auto& terms = knot == 60 ? acted.planner.cost.final : acted.planner.cost.running;
    terms.push_back(std::make_unique<Broken>(knot, broken));
    const Model& model = acted.scene->model;
    RecedingHorizon horizon(acted.planner, {.period = 0.02, .keepsEnd = true});
    gdd::GoalDirectedController controller(model);
    horizon.attach(controller);
    State state = acted.scene->initial;
    ASSERT_TRUE(horizon.begin(state));
    Data data(model);
    for (int i = 0; i < 900; ++i) {  // 4.5 s
      broken = state.time > 0.49 && state.time < 0.55;
      horizon.update(state);
      ASSERT_FALSE(isRefused(controller.step(model, {}, state, data, nullptr))) << state.time;
    }
    EXPECT_EQ(horizon.report().failed, 3) << knot;
    EXPECT_LT(farthest(acted, state), 0.05) << knot;
  }
}

// Who has not called for a second plans once, and then at the rate again.
TEST(RecedingHorizon, ALateCallerPlansOnce) {
  ActedTask acted("cart_pole");
  acted.plan(false);
  RecedingHorizon horizon(acted.planner, {.period = 0.02});
  State state = acted.scene->initial;
  ASSERT_TRUE(horizon.begin(state));
  const auto ticksAt = [&](double time) {
    state.time = time;
    horizon.update(state);
    return horizon.report().ticks;
  };
  EXPECT_EQ(ticksAt(0.02), 1);
  EXPECT_EQ(ticksAt(1.03), 2);
  EXPECT_EQ(ticksAt(1.031), 2);
  EXPECT_EQ(ticksAt(1.04), 3);
}

// After the first ticks, in which buffers grow.
TEST(RecedingHorizon, ATickAllocatesNothing) {
  ActedTask acted("cart_pole");
  acted.plan(false);
  RecedingHorizon horizon(acted.planner, {.period = 0.02, .iterations = 2});
  gdd::GoalDirectedController controller(acted.scene->model);
  horizon.attach(controller);
  State state = acted.scene->initial;
  ASSERT_TRUE(horizon.begin(state));
  const auto tick = [&](int i) {
    state.time = 0.02 * i;
    horizon.update(state);
  };
  for (int i = 1; i <= 2; ++i) tick(i);
  const AllocationGuard guard;
  for (int i = 3; i <= 6; ++i) tick(i);
  EXPECT_EQ(guard.count(), 0);
  EXPECT_EQ(horizon.report().ticks, 6);
}

/// A state of a plan's step and what is left of it.
struct PartOfStep {
  PartOfStep(const ActedTask& acted, std::size_t t, double part)
      : plan(acted.planner.plan()), model(acted.planner.model()), state(model) {
    const double h = model.options.timestep, passed = part * h;
    model.options.timestep = h - passed;
    state.time = static_cast<double>(t) * h + passed;
    state.v = plan.v[t] + passed * plan.a[t];
    state.q = plan.q[t] + passed * (plan.v[t] + 0.5 * passed * plan.a[t]);
  }
  /// ∂v̇/∂u of a dof.
  VectorX answerTo(int dof) const {
    Data data(model);
    Input input;
    input.controlled = allTrees(model);
    VectorX v[2];
    for (const int pulled : {0, 1}) {
      State end = state;
      input.tau = pulled * VectorX::Unit(model.nv, dof);
      EXPECT_FALSE(isRefused(step(model, input, end, data, nullptr)));
      v[pulled] = end.v;
    }
    return (v[1] - v[0]) / model.options.timestep;
  }
  const MotionPlan& plan;
  Model model;
  State state;
};

// The steps of the plan by its own step: what V asks for is what was planned.
TEST(RecedingHorizon, InThePlansStepItIsThePlansControl) {
  ActedTask acted("acrobot");
  acted.plan(false);
  const MotionPlan& plan = acted.planner.plan();
  RecedingHorizon horizon(acted.planner);
  gdd::GoalDirectedController controller(acted.planner.model());
  horizon.attach(controller);
  ASSERT_TRUE(horizon.begin(acted.scene->initial));
  double largest = 0.0, worst = 0.0;
  for (std::size_t t = 0; t < plan.tau.size(); ++t) {
    PartOfStep now(acted, t, 0.0);
    Data data(now.model);
    horizon.update(now.state);
    ASSERT_FALSE(isRefused(controller.step(now.model, {}, now.state, data, nullptr)));
    largest = std::max(largest, plan.tau[t].cwiseAbs().maxCoeff());
    worst = std::max(worst, (controller.control - plan.tau[t]).cwiseAbs().maxCoeff());
  }
  // Planning ended where an iteration lowers the cost by 1e-6 of it: u is known to its root.
  EXPECT_GT(largest, 10.0);
  EXPECT_SMALL(worst / largest, 1e-2);
}

// In what is left of a step R u + (∂v̇/∂u)ᵀ(∂V/∂v + ½ r ∂V/∂q) = 0 at its end: the least of (P.9),
// and optimal control in continuous time for small r.
TEST(RecedingHorizon, InPartsOfAStepItIsOptimalForWhatIsLeft) {
  ActedTask acted("acrobot");
  acted.plan(false);
  RecedingHorizon horizon(acted.planner);
  gdd::GoalDirectedController controller(acted.planner.model());
  horizon.attach(controller);
  ASSERT_TRUE(horizon.begin(acted.scene->initial));
  const std::vector<ValueModel>& values = acted.planner.feasible().values();
  const int elbow = 1;
  for (const double part : {0.0, 0.3, 0.9, 0.999}) {
    for (const std::size_t t : {0u, 7u, 23u, 39u}) {
      PartOfStep now(acted, t, part);
      const VectorX answer = now.answerTo(elbow);
      Data data(now.model);
      horizon.update(now.state);
      ASSERT_FALSE(isRefused(controller.step(now.model, {}, now.state, data, nullptr)));
      VectorX e(4);
      e << now.state.q - now.plan.q[t + 1], now.state.v - now.plan.v[t + 1];
      const MatrixX H = values[t + 1].curvature.selfadjointView<Eigen::Lower>();
      const VectorX slope = values[t + 1].slope + H * e;
      const VectorX pull = slope.tail(2) + 0.5 * now.model.options.timestep * slope.head(2);
      const double price = acted.task.effort[elbow] * controller.control[elbow];
      EXPECT_SMALL(
          std::abs(price + answer.dot(pull)) / (std::abs(price) + answer.norm() * pull.norm()),
          1e-6)
          << part << " of step " << t;
    }
  }
}

// The pole is up after three seconds of pushes of 6 N at most, and stays there: final terms count
// from the plan's end on.
TEST(RecedingHorizon, KeepsWhatItHasReached) {
  ActedTask acted("cart_pole");
  acted.plan(false);
  const State end = acted.act({.period = 0.02, .keepsEnd = true}, 5.0);
  EXPECT_LT(farthest(acted, end), 0.01);
  EXPECT_LT(end.v.cwiseAbs().maxCoeff(), 0.01);
  EXPECT_EQ(acted.report.failed, 0);
}

TEST(RecedingHorizon, GivesTheSameBitsAgain) {
  ActedTask first("cart_pole"), again("cart_pole");
  first.plan(false), again.plan(false);
  EXPECT_EQ(first.act({.period = 0.02}, 1.0).q, again.act({.period = 0.02}, 1.0).q);
}

TEST(RecedingHorizon, RefusesWhatIsOutOfRange) {
  ActedTask acted("cart_pole");
  EXPECT_THROW(RecedingHorizon(acted.planner, {.period = 0.06}), ModelError);
  EXPECT_THROW(RecedingHorizon(acted.planner, {.period = -0.01}), ModelError);
  EXPECT_THROW(RecedingHorizon(acted.planner, {.iterations = -1}), ModelError);
  // Nothing was planned.
  EXPECT_FALSE(RecedingHorizon(acted.planner).begin(acted.scene->initial));
}

// On the scene's own contacts, by steps of a tenth of the plan's: the hop goes where it was
// planned. (When its plan recedes the hopper falls: decision 0060.)
TEST(RecedingHorizon, AHopperHopsAsPlanned) {
  ActedTask acted("hopper", 0.002);
  acted.plan(false);
  const MotionPlan& plan = acted.planner.plan();
  const double duration = acted.task.steps.knots * acted.task.steps.step;
  const State end = acted.act({}, duration);
  const VectorX off = positionDifference(acted.scene->model, plan.q.back(), end.q);
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 0.05);
}

}  // namespace
}  // namespace softgauss::test
