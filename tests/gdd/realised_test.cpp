// SPDX-License-Identifier: Apache-2.0
/// Whether what moves is what the goal directed solve has found: (v⁺ − v)/h beside its a.
///
/// The judge knows velocities alone: it takes v before and after each part of a step.

#include <algorithm>
#include <iostream>

#include "tests/gdd/robot_scene.hpp"
#include "tests/support/sample_models.hpp"
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
  void keep(WarmStart& warmstart, const TreeSelection& trees) noexcept override {
    controller_.keep(warmstart, trees);
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
// what is cut there, up to eleven times as much where links are light. The active set ends by
// forward dynamics where corrections do not, in every step.
TEST_P(RealisedGoals, AreWhatWasSolved) {
  for (const gdd::GddSolver solver :
       {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian})
    for (const double timestep : kTimesteps) {
      const Off off = offOver(GetParam(), {solver, Integrator::leapfrog, timestep, true});
      const bool exact = solver == gdd::GddSolver::activeSet;
      EXPECT_SMALL(exact ? off.most : off.p95, exact ? 1e-9 : 1.1e-7) << timestep;
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

/// An arm of three links that carries 10 kg on a rope of three bars of 0.1 kg and 0.1 m; all hangs
/// down.
ModelBuilder armWithRope(double timestep) {
  constexpr double kLength = 0.1;
  ModelBuilder builder = chain(3);
  builder.options.timestep = timestep;
  std::string above = "link2";
  Vector3 end(0.0, 0.0, -0.2), place(0.0, 0.0, -0.6);
  const auto hang = [&](const LinkSpec& link, double top) {
    ModelBuilder one(link.name);
    one.base = BaseKind::floating;
    one.X_WRoot = Transform{Matrix3::Identity(), place - Vector3(0.0, 0.0, top)};
    one.link(link);
    builder.add(one, "");
    ConnectSpec tie;
    tie.linkA = link.name, tie.p_LAP = Vector3(0.0, 0.0, top);
    tie.linkB = above, tie.p_LBP = end;
    builder.connect(tie);
    above = link.name, end = Vector3(0.0, 0.0, -top);
    place.z() -= 2.0 * top;
  };
  for (int i = 0; i < 3; ++i)
    hang(boxLink("bar" + std::to_string(i), 0.1, Vector3(0.01, 0.01, 0.5 * kLength)),
         0.5 * kLength);
  hang(sphereLink("load", 10.0, 0.05), 0.0);
  return builder;
}

// Bars that swing faster than a step follows are held by rows of the one solve (6.9), which goals
// see: the arm and its rope move as solved.
TEST(RealisedGoals, HoldWithARopeThatIsStabilised) {
  for (const Integrator integrator : {Integrator::leapfrog, Integrator::semiImplicitEuler})
    for (const double timestep : kTimesteps) {
      ModelBuilder builder = armWithRope(timestep);
      builder.options.integrator = integrator;
      const Model model = builder.build();
      gdd::GoalDirectedController controller(model);
      controller.goals.push_back(
          std::make_unique<gdd::Reach>(model, "link2", Vector3(0.15, 0.1, -0.35)));
      controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
      State state(model);
      Data data(model);
      Witness witness(controller);
      int held = 0;
      while (state.time < 1.0) {
        ASSERT_NE(step(model, {}, state, data, nullptr, &witness), SolveStatus::notFinite);
        witness.end(state.v);
        held += data.stats.stabilisedBodies;
        EXPECT_SMALL(data.stats.realised, 1e-9);
      }
      if (timestep > 1e-3) {
        EXPECT_GT(held, 100);
      }
      EXPECT_SMALL(*std::max_element(witness.off.begin(), witness.off.end()), 1e-9) << timestep;
    }
}

// A control that is exact is not solved for again. What forward dynamics finds from nowhere, of the
// same stages, is the same: its minimum is the only one.
TEST(Realised, AnExactControlCausesWhatForwardDynamicsFinds) {
  for (const char* robot : {"humanoid", "arm"}) {
    RobotScene r(robot);
    const bool stands = r.model.floats(0);
    r.addReach(stands ? "right_hand" : "hand",
               stands ? Vector3(0.45, -0.25, 1.10) : Vector3(0.5, 0.3, 0.5));
    r.addDamping();
    int exact = 0;
    for (int i = 0; i < 300; ++i) {
      ASSERT_EQ(r.step(), SolveStatus::converged);
      if (r.controller.known().front() == 0) continue;
      ++exact;
      const VectorX a = r.data.forward.a;
      EXPECT_SMALL(r.data.forward.report.residual, r.model.options.tolerance);
      ASSERT_EQ(forwardDynamics(r.model, nullptr, r.data), SolveStatus::converged);
      EXPECT_SMALL((r.data.forward.a - a).cwiseAbs().maxCoeff(),
                   1e-9 * std::max(1.0, a.cwiseAbs().maxCoeff()));
    }
    EXPECT_GT(exact, 250) << robot;
  }
}

}  // namespace
}  // namespace softgauss::test
