// SPDX-License-Identifier: Apache-2.0
/// Actuators of any kind, τ = B u, and any control cost R: against formulae in which neither the
/// coordinates of a box nor a solver occur.

#include <Eigen/Cholesky>
#include <cstdlib>
#include <iostream>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/gdd/goal_check.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/gdd/solvers.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// B: a column for each open coordinate.
MatrixX openColumns(const gdd::ControlLimits& limits) {
  MatrixX B(limits.lower.size(), 0);
  for (Eigen::Index i = 0; i < limits.lower.size(); ++i) {
    if (limits.lower[i] == limits.upper[i]) continue;
    B.conservativeResize(Eigen::NoChange, B.cols() + 1);
    B.col(B.cols() - 1) = limits.transmission->T().col(i);
  }
  return B;
}

MatrixX randomMetric(int n, Random& random) {
  const MatrixX A = MatrixX::NullaryExpr(n, n, [&] { return random.uniform(-1.0, 1.0); });
  return A * A.transpose() + 0.5 * MatrixX::Identity(n, n);
}

/// A wish for every dof, so that ∇²ℓ has full rank.
void addMetricGoals(GddScene& s, Random& random) {
  s.addRandomGoals(random);
  s.addMetric(random.uniform(0.1, 2.0), random.vector(s.dofs(), 10.0));
}

template <class Solver>
class Actuation : public testing::Test {
 protected:
  /// Solves cold.
  VectorX solve(GddScene& s) {
    Solver solver(s.model());
    s.report = solver.solve(s.model(), s.cost, s.limits, s.data(), WarmStart());
    force_ = solver.force();
    return solver.acceleration();
  }

  /// Worst distance of the controls from the closed form, over free arms: (12) with any B and R.
  ///   (Bᵀ R B + Sᵀ∇²ℓ S) u = −Sᵀ∇ℓ(−M⁻¹c),    S = M⁻¹B
  double worstOfClosedForms(bool tendons, bool diagonal) {
    double worst = 0.0;
    for (int seed = 0; seed < 60; ++seed) {
      Random random(seed + 77);
      GddScene s(drivenArm(seed));
      MatrixX R = randomMetric(s.dofs(), random);
      if (diagonal) R = MatrixX(R.diagonal().asDiagonal());
      s.cost.clear(diagonal ? gdd::ForceMetric::diagonal(R.diagonal())
                            : gdd::ForceMetric::dense(R));
      const int hand = s.model().bodyCount() - 1;
      s.addPoint(hand, s.data().kinematics.X_WB[hand].p + random.vector3(0.1),
                 random.uniform(0.1, 10.0), random.vector3(20.0));
      s.addMetric(random.uniform(0.1, 2.0), random.vector(s.dofs(), 10.0));
      s.addRandomActuators(random, tendons);
      for (Eigen::Index i = 0; i < s.dofs(); ++i)
        if (s.limits.lower[i] < s.limits.upper[i])
          s.limits.lower[i] = -kInfinity, s.limits.upper[i] = kInfinity;
      const DenseGdd& d = s.dense;
      const MatrixX B = openColumns(s.limits), S = d.Mhat.llt().solve(B);
      const VectorX a0 = -d.Mhat.llt().solve(d.c);
      const MatrixX K = B.transpose() * R * B + S.transpose() * d.goalHessian() * S;
      const VectorX tau = B * K.llt().solve(-S.transpose() * d.goalGradient(a0));
      const VectorX a = solve(s);
      EXPECT_EQ(s.report.status, gdd::GddStatus::converged) << "seed " << seed;
      EXPECT_EQ(s.dense.rows(), 0);
      worst = std::max(worst, (force_ - tau).norm() / std::max(tau.norm(), d.c.norm()));
      worst = std::max(worst, (a - a0 - d.Mhat.llt().solve(tau)).norm() / a.norm());
    }
    return worst;
  }

  VectorX force_;
};

TYPED_TEST_SUITE(Actuation, GddSolvers);

constexpr bool kPenalised[] = {true, false};
template <class Solver>
constexpr bool penalises = kPenalised[std::is_same_v<Solver, gdd::ActiveSet>];

TYPED_TEST(Actuation, IsTheClosedFormWhereActuatorsReachAllForces) {
  EXPECT_SMALL(this->worstOfClosedForms(false, true), 1e-12);
  EXPECT_SMALL(this->worstOfClosedForms(false, false), 1e-12);
}

TYPED_TEST(Actuation, IsTheClosedFormWhereSomeForcesAreOutOfReach) {
  // Solver 1 meets g_z = 0 to 1e-10 of the forces; M⁻¹ makes more of that in a.
  const double tolerance = penalises<TypeParam> ? 1e-9 : 1e-12;
  EXPECT_SMALL(this->worstOfClosedForms(true, true), tolerance);
  EXPECT_SMALL(this->worstOfClosedForms(true, false), tolerance);
}

/// What the conditions of Karush, Kuhn and Tucker miss, in the coordinates of the actuators:
/// Tᵀ(R g + P⁻¹∇ℓ) = β with β ≥ 0 at a lower bound, ≤ 0 at an upper one, 0 between.
double wrongMultiplier(const GddScene& s, const VectorX& a, int& atBounds) {
  const DenseGdd& d = s.dense;
  const MatrixX& T = s.limits.transmission->T();
  const VectorX g = d.g(a), y = d.coordinates(g), effort = d.Minv * g;
  const VectorX wish = d.P(a).llt().solve(d.goalGradient(a));
  const VectorX beta = T.transpose() * (effort + wish);
  const double force = std::max(1.0, d.c.cwiseAbs().maxCoeff());
  double worst = 0.0;
  for (int i = 0; i < d.dofs(); ++i) {
    if (d.lower[i] == d.upper[i]) continue;
    const double near = 1e-7 * force / s.limits.forcePerUnit(i);
    const double scale =
        T.col(i).cwiseAbs().dot(effort.cwiseAbs() + wish.cwiseAbs()) + 1e-3 * beta.norm();
    double wrong = std::abs(beta[i]);
    if (y[i] < d.lower[i] + near) wrong = -beta[i], ++atBounds;
    if (y[i] > d.upper[i] - near) wrong = beta[i], ++atBounds;
    worst = std::max(worst, wrong / scale);
  }
  return worst;
}

TYPED_TEST(Actuation, ConditionsHoldBetweenContactsLimitsAndBounds) {
  double worst = 0.0, worstViolation = 0.0;
  int atBounds = 0, smooth = 0, certified = 0;
  for (int seed = 0; seed < 150; ++seed) {
    GddScene s = lawGddScene(seed, 4, 0.0);
    Random random(seed + 5);
    s.addRandomActuators(random, true);
    const VectorX a = this->solve(s);
    certified += s.report.status == gdd::GddStatus::nonsmoothMinimum;
    if (s.report.status != gdd::GddStatus::converged) continue;
    ++smooth;
    ++certified;
    worst = std::max(worst, wrongMultiplier(s, a, atBounds));
    worstViolation = std::max(worstViolation,
                              s.report.violation / std::max(1.0, s.dense.c.cwiseAbs().maxCoeff()));
  }
  // As for boxes of single joints (control_limits_test.cpp).
  EXPECT_SMALL(worst, 1e-6);
  EXPECT_SMALL(worstViolation, penalises<TypeParam> ? 1e-8 : 1e-11);
  EXPECT_GT(smooth, 30);
  EXPECT_GT(certified, 120);
  EXPECT_GT(atBounds, 50);
}

// A gear changes the unit of a command. Scaled with its bounds, it changes no force and no motion.
TYPED_TEST(Actuation, AGearWithItsBoundsChangesNothing) {
  double worst = 0.0;
  int compared = 0, atBounds = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const auto solveWith = [&](bool geared) {
      GddScene s = lawGddScene(seed, 4, 0.0);
      Random random(seed + 5);
      s.addRandomActuators(random, true);
      if (geared) {
        std::vector<gdd::Actuator> actuators = s.limits.transmission->actuators();
        for (gdd::Actuator& actuator : actuators) {
          const double gear = random.uniform(0.01, 100.0);
          for (gdd::Actuator::Pull& pull : actuator.pulls) pull.coefficient *= gear;
          actuator.lower /= gear;
          actuator.upper /= gear;
        }
        s.limits = gdd::ControlLimits(s.model(), std::move(actuators));
        s.matchBox();
      }
      const VectorX a = this->solve(s);
      int count = 0;
      wrongMultiplier(s, a, count);
      return std::tuple(a, s.report.status, count);
    };
    const auto [a, status, count] = solveWith(false);
    const auto [aGeared, statusGeared, countGeared] = solveWith(true);
    EXPECT_EQ(status, statusGeared) << "seed " << seed;
    if (status != gdd::GddStatus::converged && status != gdd::GddStatus::nonsmoothMinimum) continue;
    EXPECT_EQ(count, countGeared) << "seed " << seed;
    ++compared;
    atBounds += count;
    worst = std::max(worst, (a - aGeared).norm() / a.norm());
  }
  // Both solvers scale with the gear; solver 1 ends within its tolerance of g_z = 0, on either
  // side.
  EXPECT_SMALL(worst, penalises<TypeParam> ? 1e-7 : 1e-10);
  EXPECT_GT(compared, 50);
  EXPECT_GT(atBounds, 20);
}

// Without bounds only the space that actuators span matters.
TYPED_TEST(Actuation, ADifferentialWithoutBoundsIsTwoMotors) {
  double worst = 0.0;
  int compared = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const auto solveWith = [&](bool coupled) {
      GddScene s = lawGddScene(seed, 4, 0.0);
      Random random(seed + 5);
      if (coupled) {
        s.addRandomActuators(random, false);
        for (Eigen::Index i = 0; i < s.dofs(); ++i)
          if (s.limits.lower[i] < s.limits.upper[i])
            s.limits.lower[i] = -kInfinity, s.limits.upper[i] = kInfinity;
        s.matchBox();
      }
      return std::pair(this->solve(s), s.report.status);
    };
    const auto [single, singleStatus] = solveWith(false);
    const auto [coupled, status] = solveWith(true);
    EXPECT_EQ(status, singleStatus) << "seed " << seed;
    if (status != gdd::GddStatus::converged && status != gdd::GddStatus::nonsmoothMinimum) continue;
    ++compared;
    worst = std::max(worst, (single - coupled).norm() / single.norm());
  }
  EXPECT_SMALL(worst, penalises<TypeParam> ? 1e-7 : 1e-10);
  EXPECT_GT(compared, 50);
}

/// A floating tree of which tendons pull some dofs together, its root forces allowed at a price, or
/// forbidden.
struct RootForces {
  VectorX a;
  double largest = 0.0;  ///< of all z
};

// The paper's continuation: root forces that are allowed fall as 1/price, those among dofs that a
// tendon ties too, and the motion tends to the one without.
TYPED_TEST(Actuation, RootForcesVanishAsTheirPriceGrows) {
  int tied = 0;
  for (int seed = 0; seed < 5; ++seed) {
    ModelBuilder builder = randomFloatingTree(seed, true);
    builder.options.effects.remove(Effect::jointLimit);
    const auto solveWith = [&](double price) {
      Random random(seed);
      Scene scene(builder.build());
      scene.state = randomState(scene.model, random);
      EXPECT_EQ(scene.stages(), SolveStatus::converged);
      GddScene s(std::move(scene));
      addMetricGoals(s, random);
      s.addRandomActuators(random, true, 100.0);
      if (price > 0.0) {
        s.limits.allowRootForces(s.model());
        gdd::Effort effort = gdd::Effort::rootForces(s.model(), s.limits);
        EXPECT_GE(effort.dofs.size(), 6u);
        tied += static_cast<int>(effort.directions.cols());
        effort.weight = price;
        effort.addCost({s.model(), s.scene.state, s.data()}, s.cost);
      }
      RootForces result;
      result.a = this->solve(s);
      EXPECT_EQ(s.report.status, gdd::GddStatus::converged) << "seed " << seed << ", " << price;
      for (int i = 0; i < s.dofs(); ++i)
        if (s.limits.isRootForce(s.model(), i))
          result.largest = std::max(result.largest, std::abs(s.limits.coordinate(i, this->force_)));
      return result;
    };
    const RootForces none = solveWith(0.0);
    const RootForces one = solveWith(1.0);
    RootForces before = solveWith(1e2);
    EXPECT_GT(one.largest, before.largest);
    for (const double price : {1e4, 1e6, 1e8}) {
      const RootForces dear = solveWith(price);
      EXPECT_GT(before.largest, 5.0 * dear.largest) << "seed " << seed << ", " << price;
      if (price == 1e8) {
        EXPECT_NEAR(before.largest / dear.largest, 100.0, 2.0) << "seed " << seed;
      }
      EXPECT_LT((dear.a - none.a).norm(), 0.2 * (before.a - none.a).norm())
          << "seed " << seed << ", " << price;
      before = dear;
    }
  }
  EXPECT_GT(tied, 5) << "tendons are to leave root forces among the dofs that they pull";
}

// The same on its feet: what the humanoid would take from the sky to keep its posture, and how
// little of that is left as it gets dear. With SOFTGAUSS_TABLES it prints what
// docs/benchmarks/gdd_evidence.md shows.
TYPED_TEST(Actuation, TheHumanoidsRootForcesVanishAsTheirPriceGrows) {
  // Both soles in the ground; at 0 those corners touch that rounding of their angles lowers.
  for (const double depth : {1e-4, 0.0}) {
    const auto firstStep = [&](double price) {
      RobotScene r("humanoid");
      r.state.q[2] -= depth;
      r.addPosture();
      r.addReach("right_hand", Vector3(0.45, -0.25, 1.1));
      if (penalises<TypeParam>) r.controller.solver = gdd::GddSolver::augmentedLagrangian;
      if (price > 0.0) {
        r.controller.limits.allowRootForces(r.model);
        auto effort =
            std::make_unique<gdd::Effort>(gdd::Effort::rootForces(r.model, r.controller.limits));
        effort->weight = price;
        r.controller.goals.push_back(std::move(effort));
      }
      EXPECT_EQ(r.step(), SolveStatus::converged);
      return r.controller.control;
    };
    const VectorX without = firstStep(0.0);
    EXPECT_EQ(without.head(6).cwiseAbs().maxCoeff(), 0.0);
    std::vector<double> root, off;
    for (const double price : {1.0, 1e2, 1e4, 1e6}) {
      const VectorX control = firstStep(price);
      root.push_back(control.head(6).cwiseAbs().maxCoeff());
      off.push_back((control - without).norm() / without.norm());
      if (depth == 0.0 || !std::getenv("SOFTGAUSS_TABLES")) continue;
      std::cout << (penalises<TypeParam> ? "solver 1" : "solver 2") << "  price " << price
                << "  largest root force " << root.back() << "  control off by " << off.back()
                << '\n';
    }
    EXPECT_GT(root[0], root[1]);
    EXPECT_GT(root[1], 10.0 * root[2]);
    EXPECT_NEAR(root[2] / root[3], 100.0, 5.0);
    EXPECT_LT(off[2], 0.1 * off[1]);
    EXPECT_LT(off[3], 0.1 * off[2]);
  }
}

}  // namespace
}  // namespace softgauss::test
