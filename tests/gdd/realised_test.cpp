// SPDX-License-Identifier: Apache-2.0
/// Whether what moves is what the goal directed solve has found: (v⁺ − v)/h beside its a.
///
/// The judge knows velocities alone: it takes v before and after each part of a step.

#include <algorithm>
#include <iostream>

#include "tests/gdd/robot_scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

struct Realised {
  const char* robot;
  const char* link;
  Vector3 target;
  bool balances;
  bool isSprung = false;  ///< its joints have springs and dry friction, which its URDF lacks
};
void PrintTo(const Realised& r, std::ostream* out) {
  *out << r.robot << (r.isSprung ? " with springs" : "");
}

/// What the steps of a second are off by, of their largest acceleration.
struct Off {
  double p50 = 0.0, p95 = 0.0, most = 0.0;
};

/// Watches the velocity of a controlled simulation, in every part of a step.
class Witness final : public StepControl {
 public:
  explicit Witness(gdd::GoalDirectedController& controller) : controller_(controller) {}

  const VectorX* apply(const Model& model, const State& state, Data& data) noexcept override {
    if (taken_) judge(state.v);
    taken_ = false;
    const VectorX* planned = controller_.apply(model, state, data);
    if (planned) planned_ = *planned;
    from_ = state.v;
    length_ = model.options.timestep;
    return planned;
  }
  void keep(WarmStart& warmstart) noexcept override {
    controller_.keep(warmstart);
    taken_ = true;
  }
  /// The step has ended with this velocity.
  void end(const VectorX& v) {
    if (taken_) judge(v);
    taken_ = false;
  }

  std::vector<double> off;
  int leftOut = 0;  ///< parts that were not judged

 private:
  void judge(const VectorX& v) {
    // The augmented Lagrangian may end at its iteration limit, and says so.
    if (controller_.report.status == gdd::GddStatus::iterationLimit) {
      ++leftOut;
      return;
    }
    const VectorX moved = (v - from_) / length_;
    off.push_back((moved - planned_).cwiseAbs().maxCoeff() /
                  std::max(1.0, planned_.cwiseAbs().maxCoeff()));
  }

  gdd::GoalDirectedController& controller_;
  VectorX planned_, from_;
  double length_ = 0.0;
  bool taken_ = false;
};

struct Method {
  gdd::GddSolver solver;
  Integrator integrator;
  double timestep;
  bool coriolis;
};

Off offOver(const Realised& run, const Method& method) {
  RobotScene r(run.robot);
  r.model.options.timestep = method.timestep;
  r.model.options.integrator = method.integrator;
  if (!method.coriolis) r.model.options.effects.remove(Effect::coriolis);
  r.controller.solver = method.solver;
  if (run.isSprung)
    for (int i = 0; i < r.model.nv; ++i) {
      const Body& body = r.model.bodies[r.model.dofs[i].body];
      if (body.dofs != 1) continue;
      r.model.dofs[i].stiffness = 20.0;
      r.model.dofs[i].springReference = r.state.q[body.q] + 0.1;
      r.model.dofs[i].dryFriction = 0.2;
    }
  if (run.balances)
    r.addPosture();
  else
    r.addDamping();
  gdd::Reach& reach = r.addReach(run.link, run.target);
  if (run.balances) reach.weight = 1e5, reach.stiffness = 50.0, reach.damping = 15.0;
  Data data(r.model);
  Witness witness(r.controller);
  Input input;
  input.controlled = allTrees(r.model);
  for (int i = 0; i < static_cast<int>(1.0 / method.timestep); ++i) {
    const std::size_t before = witness.off.size();
    witness.leftOut = 0;
    EXPECT_NE(step(r.model, input, r.state, data, &r.contacts, &witness), SolveStatus::notFinite)
        << r.state.time;
    witness.end(r.state.v);
    // As the step says itself, but for the rounding of v⁺ − v.
    double worst = 0.0;
    for (std::size_t k = before; k < witness.off.size(); ++k)
      worst = std::max(worst, witness.off[k]);
    if (witness.leftOut == 0 &&
        witness.off.size() == before + static_cast<std::size_t>(data.stats.parts)) {
      EXPECT_NEAR(worst, data.stats.realised, 1e-9 + 1e-9 * worst);
    }
  }
  std::vector<double>& off = witness.off;
  std::sort(off.begin(), off.end());
  return {off[off.size() / 2], off[off.size() * 95 / 100], off.back()};
}

class RealisedGoals : public testing::TestWithParam<Realised> {};

constexpr double kTimesteps[] = {0.0005, 0.002, 0.01};

// Damping, springs, limits, dry friction, contacts and Coriolis forces are in the solve. The
// augmented Lagrangian meets torque limits to 1e-8 of the largest force (10.1): its a is off by
// what is cut there, up to ten times as much where links are light.
TEST_P(RealisedGoals, AreWhatWasSolved) {
  for (const gdd::GddSolver solver :
       {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian})
    for (const double timestep : kTimesteps) {
      const Off off = offOver(GetParam(), {solver, Integrator::leapfrog, timestep, true});
      EXPECT_SMALL(off.p95, solver == gdd::GddSolver::activeSet ? 1e-9 : 1e-7) << timestep;
    }
}

// Semi-implicit Euler takes damping after the solve.
TEST_P(RealisedGoals, AreThoseOfEulerButForCoriolisForces) {
  for (const double timestep : kTimesteps) {
    const Off off = offOver(
        GetParam(), {gdd::GddSolver::activeSet, Integrator::semiImplicitEuler, timestep, false});
    EXPECT_SMALL(off.p95, 1e-9) << timestep;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Robots, RealisedGoals,
    testing::Values(Realised{"humanoid", "right_hand", {0.45, -0.25, 1.1}, true},
                    Realised{"arm", "hand", {0.5, 0.3, 0.5}, false},
                    Realised{"arm", "hand", {0.5, 0.3, 0.5}, false, true},
                    Realised{"humanoid", "right_hand", {0.45, -0.25, 1.1}, true, true},
                    Realised{"hand", "index_tip", {0.05, 0.03, 0.12}, false}));

}  // namespace
}  // namespace softgauss::test
