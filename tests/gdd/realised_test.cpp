// SPDX-License-Identifier: Apache-2.0
/// Whether what moves is what the goal directed solve has found: (v⁺ − v)/h beside its a.
///
/// The judge knows positions in time alone: it takes v before and after each step.

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
};
void PrintTo(const Realised& r, std::ostream* out) { *out << r.robot; }

/// What the steps of a second are off by, of their largest acceleration.
struct Off {
  double p50 = 0.0, p95 = 0.0, most = 0.0;
};

Off offOver(const Realised& run, gdd::GddSolver solver, double timestep, bool coriolis) {
  RobotScene r(run.robot);
  r.model.options.timestep = timestep;
  if (!coriolis) r.model.options.effects.remove(Effect::coriolis);
  r.controller.solver = solver;
  if (run.balances)
    r.addPosture();
  else
    r.addDamping();
  gdd::Reach& reach = r.addReach(run.link, run.target);
  if (run.balances) reach.weight = 1e5, reach.stiffness = 50.0, reach.damping = 15.0;
  std::vector<double> off;
  for (int i = 0; i < static_cast<int>(1.0 / timestep); ++i) {
    const VectorX before = r.state.v;
    EXPECT_NE(r.step(), SolveStatus::notFinite) << r.state.time;
    const VectorX& planned = r.controller.expansion.acceleration();
    const VectorX moved = (r.state.v - before) / timestep;
    // The augmented Lagrangian may end at its iteration limit, and says so.
    if (r.controller.report.status == gdd::GddStatus::iterationLimit) continue;
    off.push_back((moved - planned).cwiseAbs().maxCoeff() /
                  std::max(1.0, planned.cwiseAbs().maxCoeff()));
    // As the step says itself, but for the rounding of v⁺ − v.
    EXPECT_NEAR(off.back(), r.data.stats.realised, 1e-10 + 1e-9 * off.back());
  }
  std::sort(off.begin(), off.end());
  return {off[off.size() / 2], off[off.size() * 95 / 100], off.back()};
}

class RealisedGoals : public testing::TestWithParam<Realised> {};

// Damping, springs, limits, dry friction and contacts are in the solve. The augmented Lagrangian
// meets torque limits to 1e-8 of the largest force (T.18): its a is off by what is cut there, up to
// ten times as much where links are light.
TEST_P(RealisedGoals, AreWhatWasSolvedButForCoriolisForces) {
  for (const gdd::GddSolver solver :
       {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian})
    for (const double timestep : {0.0005, 0.002, 0.01}) {
      const Off off = offOver(GetParam(), solver, timestep, false);
      EXPECT_SMALL(off.p95, solver == gdd::GddSolver::activeSet ? 1e-9 : 1e-7) << timestep;
    }
}

// What Coriolis forces gain by mid-step still follows the solve, and the step says by how much.
TEST_P(RealisedGoals, AreToldByTheStep) {
  for (const double timestep : {0.002, 0.01}) {
    const Off off = offOver(GetParam(), gdd::GddSolver::activeSet, timestep, true);
    if (std::getenv("SOFTGAUSS_TABLES"))
      std::cout << GetParam().robot << ", " << 1e3 * timestep << " ms: p50 " << off.p50 << ", p95 "
                << off.p95 << ", most " << off.most << '\n';
  }
}

INSTANTIATE_TEST_SUITE_P(
    Robots, RealisedGoals,
    testing::Values(Realised{"humanoid", "right_hand", {0.45, -0.25, 1.1}, true},
                    Realised{"arm", "hand", {0.5, 0.3, 0.5}, false},
                    Realised{"hand", "index_tip", {0.05, 0.03, 0.12}, false}));

}  // namespace
}  // namespace softgauss::test
