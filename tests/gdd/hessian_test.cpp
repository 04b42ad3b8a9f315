// SPDX-License-Identifier: Apache-2.0
/// Gradient and Gauss–Newton Hessian of Φ (10.2), (10.4) against dense formulae and differences.

#include <Eigen/Cholesky>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// A random scene at a random acceleration near the unconstrained one, rows evaluated there. Every
/// third has gears, differentials and tendons, and every sixth another control cost.
struct AtPoint {
  GddScene s;
  VectorX a;
  gdd::GaussNewtonHessian hessian;
  TreeFactor massFactor;

  explicit AtPoint(std::uint64_t seed, bool withForces = true)
      : s(lawGddScene(seed, 5)), hessian(s.model()) {
    Random random(seed + 5000);
    if (!withForces || seed % 6 == 0) s.removeForces();
    if (seed % 3 == 0) s.addRandomActuators(random, true);
    if (seed % 6 == 0) {
      s.dense.Minv = MatrixX(random.vector(s.dofs(), 1.0).cwiseAbs2().asDiagonal());
      s.dense.Minv.diagonal().array() += 0.1;
      s.cost.clear(gdd::ForceMetric::diagonal(s.dense.Minv.diagonal()));
      Random goals(seed + 6000);
      s.dense.A.resize(0, s.dofs());
      s.dense.y.resize(0);
      s.dense.w.resize(0);
      s.dense.metric = 0.0;
      s.dense.offset.setZero();
      s.addRandomGoals(goals);
    }
    s.randomMultipliers(random, 5.0);
    // Penalties of the size of R, so that no term drowns the others.
    s.dense.rho *= 1e-5;
    a = -s.dense.M.llt().solve(s.dense.c) + random.vector(s.dofs(), 20.0);
    VectorX unused(s.dofs());
    inverseDynamics(s.model(), a, s.data(), unused);
    massFactor.compute(s.data().inertia.hat());
    hessian.setCell(s.data());
  }

  gdd::ContactForceTerms forces() {
    gdd::ContactForceTerms terms;
    terms.setCost(s.cost.forces());
    terms.evaluate(s.data().constraints);
    return terms;
  }

  /// ∇Φ as the solver composes it.
  VectorX gradient() {
    VectorX g(s.dofs());
    inverseDynamics(s.model(), a, s.data(), g);
    const gdd::BoundPenalty bounds{s.limits, s.dense.lambda, s.dense.rho};
    VectorX w(s.dofs()), y(s.dofs()), slope(s.dofs());
    s.cost.controlCost().multiply(massFactor, g, w);
    s.limits.coordinates(g, y);
    for (int i = 0; i < s.dofs(); ++i) slope[i] = bounds.at(i, y[i]).slope;
    s.limits.addSlope(slope, w);
    VectorX result(s.dofs()), Ma(s.dofs()), cost(s.dofs());
    hessian.multiplyP(w, result);
    s.data().inertia.M.multiply(a, Ma);
    s.cost.gradient(a, Ma, cost);
    forces().addGradient(s.data().constraints, cost);
    return result + cost;
  }
};

/// Half the way along ±e_i to the nearest breakpoint of a row or of a bound.
double safeStep(const DenseGdd& d, const VectorX& a, int i) {
  const VectorX x = d.residual(a), t = d.coordinates(d.g(a)) + d.lambda.cwiseQuotient(d.rho);
  const VectorX rate = d.coordinates(d.P(a).col(i));
  double nearest = 2.0;
  const auto meet = [&](double distance, double speed) {
    if (speed != 0.0) nearest = std::min(nearest, std::abs(distance / speed));
  };
  for (int r = 0; r < d.rows(); ++r)
    for (const double breakpoint : {d.lowerKnot(r), d.upperKnot(r)})
      meet(x[r] - breakpoint, d.J(r, i));
  for (int k = 0; k < d.dofs(); ++k) {
    if (d.lower[k] == d.upper[k]) continue;
    meet(t[k] - d.lower[k], rate[k]);
    meet(t[k] - d.upper[k], rate[k]);
  }
  return 0.5 * nearest;
}

// In a cell Φ is a quadratic, so that central differences are exact but for rounding.
TEST(GddGradient, IsTheDifferenceOfTheDenseObjective) {
  double worst = 0.0;
  for (int seed = 0; seed < 60; ++seed) {
    AtPoint at(seed);
    const DenseGdd& d = at.s.dense;
    const VectorX gradient = at.gradient();
    EXPECT_APPROX(gradient, d.augmentedGradient(at.a), 1e-11) << "seed " << seed;
    for (int i = 0; i < at.s.dofs(); ++i) {
      const double step = safeStep(d, at.a, i);
      if (step < 1e-5) continue;  // too near to a breakpoint to tell
      VectorX ahead = at.a, behind = at.a;
      ahead[i] += step;
      behind[i] -= step;
      const double plus = d.augmented(ahead), minus = d.augmented(behind);
      const double difference = (plus - minus) / (ahead[i] - behind[i]);
      const double rounding = 1e-15 * std::max(std::abs(plus), std::abs(minus)) / step;
      const double scale = gradient.cwiseAbs().maxCoeff();
      const double error = std::max(0.0, std::abs(difference - gradient[i]) - 100.0 * rounding);
      worst = std::max(worst, error / scale);
    }
  }
  // P w sums terms that are 1e3 times their sum.
  EXPECT_SMALL(worst, 1e-9);
}

TEST(GddGradient, PenaltyHasTheDenseValueSlopeAndCurvature) {
  for (int seed = 0; seed < 20; ++seed) {
    AtPoint at(seed);
    const DenseGdd& d = at.s.dense;
    const gdd::BoundPenalty bounds{at.s.limits, d.lambda, d.rho};
    const VectorX g = d.g(at.a), y = d.coordinates(g), curvature = d.penaltyCurvature(g);
    VectorX slope(at.s.dofs()), sum = VectorX::Zero(at.s.dofs());
    for (int i = 0; i < at.s.dofs(); ++i) {
      const Jet psi = bounds.at(i, y[i]);
      slope[i] = psi.slope;
      EXPECT_EQ(psi.curvature, curvature[i]);
      EXPECT_NEAR(psi.value, 0.5 * slope[i] * slope[i] / d.rho[i], 1e-12 * psi.value);
    }
    at.s.limits.addSlope(slope, sum);
    EXPECT_APPROX(sum, d.penaltySlope(g), 1e-12);
  }
}

TEST(GddHessian, SolveInvertsTheDenseFormula) {
  double worst = 0.0;
  int bounded = 0, active = 0;
  for (int seed = 0; seed < 100; ++seed) {
    AtPoint at(seed);
    const DenseGdd& d = at.s.dense;
    const VectorX curvature = d.penaltyCurvature(d.g(at.a));
    gdd::ContactForceTerms forces = at.forces();
    ASSERT_TRUE(at.hessian.factorize(at.s.data(), at.massFactor, curvature, at.s.limits, at.s.cost,
                                     forces));
    const MatrixX H = d.gaussNewtonHessian(at.a);
    Random random(seed);
    const VectorX b = H * random.vector(at.s.dofs(), 1.0);
    VectorX x = b;
    at.hessian.solve(x);
    // Backward error: what a stable factorisation of this matrix promises.
    const double backward = (H * x - b).norm() / (H.norm() * x.norm());
    worst = std::max(worst, backward);
    for (int i = 0; i < at.s.dofs(); ++i) bounded += curvature[i] != 0.0 && d.lower[i] < d.upper[i];
    active += (d.residual(at.a).array() < 0.0).count();
  }
  EXPECT_SMALL(worst, 1e-14);
  EXPECT_GT(bounded, 100);
  EXPECT_GT(active, 100);
}

TEST(GddHessian, MultipliesByTheJacobianOfInverseDynamics) {
  double worst = 0.0;
  for (int seed = 0; seed < 60; ++seed) {
    AtPoint at(seed);
    Random random(seed);
    const VectorX x = random.vector(at.s.dofs(), 1.0);
    VectorX y(at.s.dofs());
    at.hessian.multiplyP(x, y);
    const VectorX expected = at.s.dense.P(at.a) * x;
    worst = std::max(worst, (y - expected).norm() / expected.norm());
  }
  EXPECT_SMALL(worst, 1e-13);
}

TEST(GoalCost, ValueAndCurvatureAreThoseOfTheDenseFormula) {
  double worst = 0.0;
  for (int seed = 0; seed < 60; ++seed) {
    AtPoint at(seed, false);
    const DenseGdd& d = at.s.dense;
    Random random(seed);
    const VectorX x = random.vector(at.s.dofs(), 10.0);
    const TreeMatrix& M = at.s.data().inertia.M;
    VectorX Mx(at.s.dofs());
    M.multiply(x, Mx);
    const double scale = d.goalCost(at.a) + 1.0;
    worst = std::max(worst, std::abs(at.s.cost.value(x, Mx) - d.goalCost(x)) /
                                (std::abs(d.goalCost(x)) + scale));
    const double curvature = x.dot(d.goalHessian() * x);
    worst = std::max(worst, std::abs(at.s.cost.curvatureAlong(x, Mx) - curvature) / curvature);
  }
  EXPECT_SMALL(worst, 1e-13);
}

}  // namespace
}  // namespace softgauss::test
