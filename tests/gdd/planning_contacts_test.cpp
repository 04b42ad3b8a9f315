// SPDX-License-Identifier: Apache-2.0
/// Plans that touch: from no guess at all, on planning contacts, then on those of the scene.

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/step/step.hpp"
#include "softgauss/io/plan_task.hpp"
#include "softgauss/io/simulation/scene.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

using namespace planning;

std::unique_ptr<ContactSource> contactsOf(const Model& model) {
  return std::make_unique<collision::SceneContacts>(model);
}

/// A task of data/plans with its planner.
struct PlannedTask {
  explicit PlannedTask(const std::string& name, int threads = 1)
      : file(std::string(SOFTGAUSS_SOURCE_DIR) + "/data/plans/" + name + ".yaml"),
        scene(loadScene(file)),
        task(io::readPlanTask(file, scene->model, scene->initial)),
        planner(scene->model, {task.steps.step, task.steps.knots, threads}, contactsOf) {
    task.setCosts(planner);
  }
  const MotionPlan& solve(const std::vector<VectorX>& start = {}) {
    return task.solve(planner, scene->initial, start);
  }
  std::vector<VectorX> randomStart(int seed, double sigma) const {
    Random random(seed);
    std::vector<VectorX> a;
    for (int t = 0; t < task.steps.knots; ++t)
      a.push_back(random.vector(scene->model.nv, sigma * std::sqrt(3.0)));
    return a;
  }

  std::string file;
  std::unique_ptr<softgauss::Scene> scene;
  io::PlanTask task;
  Planner planner;
};

/// The largest difference that one step by the plan's controls makes from its next state, step by
/// step; where `knowsLast` is off, without what the step before has done.
double stepError(const Model& model, const MotionPlan& plan, bool knowsLast) {
  Data data(model);
  collision::SceneContacts contacts(model);
  Input input;
  input.controlled = allTrees(model);
  double worst = 0.0;
  for (std::size_t t = 0; t < plan.tau.size(); ++t) {
    State state(model);
    state.q = plan.q[t], state.v = plan.v[t];
    if (t > 0 && knowsLast) state.a = plan.a[t - 1], state.hasAcceleration = true;
    input.tau = plan.tau[t];
    EXPECT_EQ(step(model, input, state, data, &contacts), SolveStatus::converged);
    worst = std::max({worst, (state.v - plan.v[t + 1]).cwiseAbs().maxCoeff(),
                      positionDifference(model, plan.q[t + 1], state.q).cwiseAbs().maxCoeff()});
  }
  return worst;
}

/// What is promised of every plan.
void expectWithinWhatActuatorsDo(const Model& model, const MotionPlan& plan) {
  EXPECT_EQ(plan.rootForce, 0.0);
  EXPECT_SMALL(plan.gap, 1e-10);
  for (const VectorX& tau : plan.tau)
    for (int i = 0; i < model.nv; ++i) {
      EXPECT_GE(tau[i], model.dofs[idx(i)].actuated ? model.dofs[idx(i)].effortLower : 0.0);
      EXPECT_LE(tau[i], model.dofs[idx(i)].actuated ? model.dofs[idx(i)].effortUpper : 0.0);
    }
  // The same solve twice, within its tolerance times the step.
  EXPECT_SMALL(stepError(model, plan, true), 1e-10);
}

/// How many contacts these poses have.
int touches(const Model& model, const std::vector<VectorX>& poses) {
  Kinematics kinematics(model);
  collision::SceneContacts source(model);
  ContactSet contacts;
  int count = 0;
  for (const VectorX& q : poses) {
    State state(model);
    state.q = q;
    computeKinematics(model, state, kinematics);
    contacts.clear();
    source.detect(model, kinematics, contacts);
    count += static_cast<int>(contacts.contacts.size());
  }
  return count;
}

// Nothing touches at the start, 82 mm apart, and standing still costs 48: the finger has to find
// the wheel.
TEST(PlanningContacts, AFingerFindsTheWheelAndTurnsIt) {
  PlannedTask spinner("spinner");
  EXPECT_EQ(touches(spinner.planner.model(), {spinner.scene->initial.q}), 0);
  const MotionPlan& plan = spinner.solve();
  expectWithinWhatActuatorsDo(spinner.planner.model(), plan);
  EXPECT_GT(touches(spinner.planner.model(), plan.q), 0);
  EXPECT_GT(plan.q.back()[2], 1.5);
  EXPECT_LT(plan.cost, 5.0);
}

// Half a metre ahead of a root that nobody pulls. Who stands still pays 3.0 for not being there,
// were standing free; so does nobody who falls. From rest, and from most of eight starts that are
// random: of thirty, 28 were found to arrive.
TEST(PlanningContacts, AHopperGoesAheadFromMostStarts) {
  constexpr double kStands = 3.0;
  PlannedTask hopper("hopper");
  const Model& model = hopper.planner.model();
  int arrive = 0;
  for (int seed = 0; seed <= 8; ++seed) {
    const MotionPlan& plan =
        seed == 0 ? hopper.solve() : hopper.solve(hopper.randomStart(seed, 0.1));
    expectWithinWhatActuatorsDo(model, plan);
    if (plan.cost < kStands) {
      ++arrive;
      EXPECT_GT(plan.q.back()[0], 0.1) << seed;
      EXPECT_NEAR(plan.q.back()[1], 0.61, 0.2) << seed;
    }
    if (seed > 0) continue;
    EXPECT_EQ(arrive, 1);
    // A step looks at the one before, where the foot slides.
    EXPECT_GT(stepError(model, plan, false), 1e-4);
  }
  EXPECT_GE(arrive, 7);
}

TEST(PlanningContacts, LeaveTheModelAsItWas) {
  PlannedTask hopper("hopper");
  const Model& model = hopper.planner.model();
  const Material own = model.geometries[0].material;
  hopper.planner.setContacts({0.02, 0.05, 1e-3, 0.9});
  EXPECT_EQ(model.geometries[0].material.margin, 0.01);
  EXPECT_EQ(model.geometries[0].material.impedance.dMin, 1e-3);
  EXPECT_FALSE(model.options.uses(Mechanism::slipCorrection));
  EXPECT_FALSE(model.options.uses(Mechanism::nearRigid));
  hopper.planner.setOwnContacts();
  EXPECT_EQ(model.geometries[0].material, own);
  EXPECT_TRUE(model.options.uses(Mechanism::slipCorrection));
  EXPECT_TRUE(model.options.uses(Mechanism::nearRigid));
  EXPECT_EQ(hopper.scene->model.geometries[0].material, own);
}

TEST(PlanningContacts, RefuseWhatIsOutOfRange) {
  PlannedTask hopper("hopper");
  for (const PlanningContacts& bad :
       {PlanningContacts{-1.0, 0.05, 1e-4, 0.9}, PlanningContacts{0.01, 0.0, 1e-4, 0.9},
        PlanningContacts{0.01, 0.05, 0.0, 0.9}, PlanningContacts{0.01, 0.05, 1e-4, 1.0}})
    EXPECT_THROW(hopper.planner.setContacts(bad), ModelError);
}

// After its first iterations, in which buffers grow with what touches.
TEST(PlanningContacts, PhaseIAllocatesNothing) {
  for (const char* name : {"hopper", "quadruped"}) {
    PlannedTask planned(name);
    Planner& planner = planned.planner;
    planner.setContacts(planned.task.contacts->contacts);
    const Model& model = planner.model();
    KnotThreads threads(model, contactsOf, 2);
    Problem problem{model,
                    planner.cost,
                    planned.task.steps.knots,
                    planner.rootCost,
                    VectorX::Zero(model.nv),
                    VectorX::Zero(model.nv),
                    {}};
    for (int i = 0; i < model.nv; ++i)
      if (problem.isControlled(i)) {
        problem.controlled.push_back(i);
        problem.lower[i] = model.dofs[idx(i)].effortLower;
        problem.upper[i] = model.dofs[idx(i)].effortUpper;
        problem.rootCost[i] = planner.cost.effort[i];
      }
    InfeasiblePhase phase(problem, threads);
    Trajectory begin(problem, threads.own());
    begin.knots[0].q = planned.scene->initial.q;
    ASSERT_TRUE(phase.start(begin));
    for (int i = 0; i < 10; ++i) phase.iterate();
    ASSERT_TRUE(phase.start(begin));
    const AllocationGuard guard;
    for (int i = 0; i < 10; ++i) phase.iterate();
    EXPECT_EQ(guard.count(), 0) << name;
  }
}

// A search keeps what is better, on the scene's own contacts, and is what its seed makes it. Some
// seeds find nothing better in so many tries.
TEST(PlanningContacts, ASearchFindsBetterPlansAndTheSameAgain) {
  int better = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    PlannedTask spinner("spinner"), again("spinner");
    PlanSearch search = spinner.task.search;
    search.seed = seed;
    EXPECT_GT(search.tries, 0);
    spinner.task.search.tries = again.task.search.tries = 0;
    const double before = spinner.solve().cost;
    again.solve();
    const MotionPlan& plan = spinner.planner.search(spinner.scene->initial, search);
    expectWithinWhatActuatorsDo(spinner.planner.model(), plan);
    EXPECT_LE(plan.cost, before);
    better += plan.cost < before;
    EXPECT_EQ(spinner.planner.feasible().trajectory().cost, plan.cost);
    EXPECT_EQ(plan.q, again.planner.search(again.scene->initial, search).q);
  }
  EXPECT_GT(better, 0);
}

// Interrupted whenever, in a stage of planning contacts too, the plan there is is one of the scene.
TEST(PlanningContacts, AnInterruptedPlanIsOneOfTheScene) {
  for (const char* name : {"hopper", "spinner"}) {
    PlannedTask whole(name);
    whole.task.search.tries = 0;
    const int iterations = whole.solve().iterations;
    int found = 0;
    for (const double share : {0.05, 0.3, 0.6, 0.9}) {
      PlannedTask planned(name);
      const int most = static_cast<int>(share * iterations);
      planned.planner.progress = [&](const MotionPlan& now) { return now.iterations < most; };
      const MotionPlan& plan = planned.solve();
      if (plan.status == PlanStatus::infeasible) continue;  // none yet that holds there
      ++found;
      EXPECT_EQ(plan.status, PlanStatus::interrupted) << name << ", " << share;
      expectWithinWhatActuatorsDo(planned.planner.model(), plan);
    }
    EXPECT_GE(found, 3) << name;
  }
}

// Knots go over threads, more of them than knots too, and each is what it is alone. The humanoid's
// contacts are of pairs with and without a closed form of their derivatives.
TEST(PlanningContacts, GiveTheSameBitsOnAnyNumberOfThreads) {
  for (const char* name : {"hopper", "humanoid_rises"}) {
    PlannedTask alone(name);
    PlanOptions some;
    some.infeasible = some.feasible = 10;
    const auto plan = [&](PlannedTask& planned) {
      planned.task.options = some;
      planned.task.contacts->stages = 1;
      return planned.solve();
    };
    const MotionPlan a = plan(alone);
    for (const int threads : {2, 3, 64}) {
      PlannedTask together(name, threads);
      const MotionPlan b = plan(together);
      EXPECT_EQ(a.costs, b.costs) << name << ", " << threads;
      EXPECT_EQ(a.q, b.q) << name << ", " << threads;
      EXPECT_EQ(a.tau, b.tau) << name << ", " << threads;
    }
  }
  EXPECT_THROW(PlannedTask("hopper", 0), ModelError);
}

// A planner that has planned before, on other contacts and another start, plans as a new one does.
TEST(PlanningContacts, GiveTheSameBitsAgain) {
  PlannedTask first("hopper"), again("hopper");
  again.solve(again.randomStart(7, 0.1));
  const MotionPlan &a = first.solve(), &b = again.solve();
  EXPECT_EQ(a.costs, b.costs);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.tau, b.tau);
}

}  // namespace
}  // namespace softgauss::test
