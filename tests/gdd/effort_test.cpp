// SPDX-License-Identifier: Apache-2.0
/// The price on single forces, and what root forces do as their price grows.

#include <Eigen/Cholesky>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/gdd/goal_check.hpp"
#include "tests/gdd/robot_scene.hpp"

namespace softgauss::test {
namespace {

/// A random price on about half of the dofs; the dense formulae take it into R.
VectorX addRandomPrice(GddScene& s, Random& random) {
  VectorX price = VectorX::Zero(s.dofs());
  for (int i = 0; i < s.dofs(); ++i) {
    if (random.chance(0.5)) continue;
    price[i] = random.uniform(0.1, 3.0) * s.data().weights.dof[i];
    s.cost.addControlCost(i, price[i]);
  }
  s.dense.Minv.diagonal() += price;  // the R of its formulae
  return price;
}

TEST(Effort, PenaltyHasItsDerivatives) {
  Random random(3);
  gdd::ControlLimits limits;
  limits.lower = VectorX::Constant(1, -2.0);
  limits.upper = VectorX::Constant(1, 1.0);
  const VectorX lambda = VectorX::Constant(1, 0.7), rho = VectorX::Constant(1, 5.0);
  const gdd::BoundPenalty bounds{limits, lambda, rho};
  for (int i = 0; i < 50; ++i) {
    const double g = random.uniform(-5.0, 5.0), h = 1e-5;
    const Jet here = bounds.at(0, g);
    EXPECT_NEAR((bounds.at(0, g + h).value - bounds.at(0, g - h).value) / (2 * h), here.slope,
                1e-4);
    EXPECT_NEAR((bounds.at(0, g + h).slope - bounds.at(0, g - h).slope) / (2 * h), here.curvature,
                1e-4);
  }
}

// Fully driven, without rows: (M + M W M + ∇²ℓ) a = −c − M W c − ∇ℓ(0).
TEST(Effort, AFreeArmSolvesItsLinearSystem) {
  double worst = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed + 40);
    GddScene s(drivenArm(seed));
    s.addRandomGoals(random);
    addRandomPrice(s, random);
    const DenseGdd& d = s.dense;
    const MatrixX H = d.M * d.Minv * d.M + d.goalHessian();
    const VectorX rhs = -d.M * (d.Minv * d.c) - d.goalGradient(VectorX::Zero(s.dofs()));
    const VectorX expected = H.llt().solve(rhs);
    worst = std::max(worst, (s.solve() - expected).norm() / expected.norm());
    // The objective that is reported holds the price.
    EXPECT_NEAR(s.report.objective, d.objective(s.solver->acceleration()),
                1e-10 * (1.0 + std::abs(s.report.objective)));
  }
  // The price squares the condition of M.
  EXPECT_SMALL(worst, 1e-11);
}

/// What a Newton step of the dense Φ would still gain at the solver's minimum, against Φ: worst
/// case.
double worstGain(bool priced) {
  double worst = 0.0;
  int checked = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed + 400);
    GddScene s(lawGddScene(seed, 5));
    if (priced) addRandomPrice(s, random);
    const VectorX& a = s.solve();
    if (s.report.status != gdd::GddStatus::converged) continue;
    ++checked;
    const VectorX gradient = s.dense.augmentedGradient(a);
    const double gain = gradient.dot(s.dense.gaussNewtonHessian(a).llt().solve(gradient));
    worst = std::max(worst, gain / std::abs(s.dense.objective(a)));
  }
  EXPECT_GT(checked, 20);
  return worst;
}

// With contacts, limits and boxes: the solver's minimum is one of the dense Φ, with a price as well
// as without. The solver ends where a Newton step promises less than 1e-14 of Φ; twice that, since
// its Φ holds ψ too and rounds otherwise. The gradient itself is then of no set size: where a price
// and ρ = 1e5 w_i make H stiff, 1e-14 of Φ is 3e-6 of the terms that cancel in it.
TEST(Effort, ItsMinimumIsThatOfTheDenseProblem) {
  EXPECT_SMALL(worstGain(false), 2e-14);
  EXPECT_SMALL(worstGain(true), 2e-14);
}

// Root forces that are allowed and priced fall as 1/w, and the solution tends to that without any.
TEST(Effort, RootForcesVanishAsTheirPriceGrows) {
  for (int seed = 0; seed < 5; ++seed) {
    Random random(seed + 2000);
    ModelBuilder builder = randomFloatingTree(seed, true);
    builder.options.effects.remove(Effect::jointLimit);
    const auto scene = [&] {
      Random same(seed);
      Scene s(builder.build());
      s.state = randomState(s.model, same);
      EXPECT_EQ(s.stages(), SolveStatus::converged);
      return s;
    };
    const auto solve = [&](double weight) {
      GddScene s(scene());
      Random goals(seed + 9);
      s.addRandomGoals(goals);
      if (weight > 0.0) {
        s.limits.allowRootForces(s.model());
        const gdd::Effort effort = [&] {
          gdd::Effort e(gdd::Effort::rootDofs(s.model()));
          e.weight = weight;
          return e;
        }();
        effort.addCost({s.model(), s.scene.state, s.data()}, s.cost);
      }
      const VectorX a = s.solve();
      double root = 0.0;
      for (const int i : gdd::Effort::rootDofs(s.model()))
        root = std::max(root, std::abs(s.solver->force()[i]));
      return std::pair(a, root);
    };
    const auto [exact, none] = solve(0.0);
    const auto [a4, root4] = solve(1e4);
    const auto [a6, root6] = solve(1e6);
    EXPECT_GT(root4, 10.0 * none);
    EXPECT_NEAR(root4 / root6, 100.0, 10.0) << "seed " << seed;
    EXPECT_LT((a6 - exact).norm(), 0.1 * (a4 - exact).norm());
  }
}

// Of two ways to put the hand where it shall be, the one that spares the dear joint.
TEST(Effort, ADearJointIsSpared) {
  const auto used = [](double weight) {
    RobotScene r("arm");
    r.addReach("hand", Vector3(0.5, 0.3, 0.5));
    r.addDamping();
    const int dof = gdd::Effort::actuatedDofs(r.model).at(1);
    auto effort = std::make_unique<gdd::Effort>(std::vector<int>{dof});
    effort->weight = weight;
    r.controller.goals.push_back(std::move(effort));
    double sum = 0.0;
    for (int i = 0; i < 200; ++i) {
      EXPECT_NE(r.step(), SolveStatus::notFinite);
      sum += std::abs(r.controller.control[dof]);
    }
    return sum;
  };
  EXPECT_LT(used(30.0), 0.5 * used(0.0));
}

// After its last goal F has its minimum 0 at u = 0, where no share of F is small: the controls
// vanish against the forces at work, and every solve ends by itself.
TEST(Effort, WithoutGoalsTheSearchEnds) {
  for (const gdd::GddSolver solver :
       {gdd::GddSolver::augmentedLagrangian, gdd::GddSolver::activeSet}) {
    RobotScene r("arm");
    r.controller.solver = solver;
    r.controller.controlCost = gdd::ControlCost::total;  // else gravity would be held
    auto look = std::make_unique<gdd::LookAt>(r.model, "hand", Vector3(0.8, 0.6, 0.2));
    look->endTime = 0.5;
    r.controller.goals.push_back(std::move(look));
    int without = 0;
    for (int i = 0; i < 1000; ++i) {
      EXPECT_NE(r.step(), SolveStatus::notFinite);
      const gdd::GddReport& report = r.controller.report;
      EXPECT_NE(report.status, gdd::GddStatus::iterationLimit) << "step " << i;
      EXPECT_GE(report.stationarity, 0.0);
      if (i < 260) continue;
      ++without;
      EXPECT_SMALL(
          r.controller.control.cwiseAbs().maxCoeff() / r.data.forces.c.cwiseAbs().maxCoeff(),
          1e-12);
    }
    EXPECT_GT(without, 700);
  }
}

}  // namespace
}  // namespace softgauss::test
