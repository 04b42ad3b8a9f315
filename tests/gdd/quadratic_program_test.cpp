// SPDX-License-Identifier: Apache-2.0
/// The program (10.8) against its conditions of Karush, Kuhn and Tucker, which for a convex program
/// are those of the minimum: whoever found it, the guess of the face or the dual method.

#include "softgauss/gdd/quadratic_program.hpp"

#include <Eigen/Cholesky>

#include "tests/support/random.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

struct Program {
  MatrixX K;
  VectorX q, lower, upper, distance;
  RowMajorMatrixX N;
};

/// p = 0 is feasible; some bounds and rows are at 0 to begin with, some rows copies of others.
Program randomProgram(Random& random, int n, int rows, bool copies) {
  Program p;
  MatrixX A(n, n);
  for (int j = 0; j < n; ++j) A.col(j) = random.vector(n, 1.0);
  p.K = A * A.transpose() + 0.01 * n * MatrixX::Identity(n, n);
  p.q = random.vector(n, 3.0);
  p.lower.resize(n), p.upper.resize(n);
  p.N.resize(rows, n), p.distance.resize(rows);
  for (int i = 0; i < n; ++i) {
    p.lower[i] = random.chance(0.3) ? 0.0 : -random.uniform(0.1, 2.0);
    p.upper[i] = p.lower[i] < 0.0 && random.chance(0.3) ? 0.0 : random.uniform(0.1, 2.0);
  }
  for (int k = 0; k < rows; ++k) {
    p.N.row(k) = random.vector(n, 1.0).transpose();
    p.distance[k] = random.chance(0.5) ? 0.0 : random.uniform(0.0, 1.0);
    if (copies && k > 0 && random.chance(0.4)) {
      const double scale = random.uniform(0.5, 2.0);
      p.N.row(k) = scale * p.N.row(k - 1);
      p.distance[k] = scale * p.distance[k - 1];
    }
  }
  return p;
}

/// The largest violation of a condition, over the size of the terms.
double largestViolation(const Program& program, const gdd::QuadraticProgram& solver) {
  const VectorX& p = solver.solution();
  const VectorX& beta = solver.boundMultipliers();
  const int rows = static_cast<int>(program.distance.size());
  VectorX left = program.K * p + program.q - beta;
  double worst = 0.0;
  const double size = std::max(1.0, program.q.cwiseAbs().maxCoeff());
  for (int k = 0; k < rows; ++k) {
    const double nu = solver.rowMultipliers()[k];
    const double slack = program.N.row(k).dot(p) + program.distance[k];
    left -= nu * program.N.row(k).transpose();
    worst = std::max({worst, -nu / size, -slack, std::abs(nu * slack) / size});
  }
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    worst = std::max({worst, program.lower[i] - p[i], p[i] - program.upper[i]});
    const double pull = beta[i] > 0.0 ? p[i] - program.lower[i] : program.upper[i] - p[i];
    worst = std::max(worst, std::abs(beta[i]) * pull / size);
  }
  return std::max(worst, left.cwiseAbs().maxCoeff() / size);
}

// 1e-10: K's condition number is up to 1e4 here, and rows may be nearly parallel.
TEST(QuadraticProgram, SolutionsSatisfyTheConditions) {
  for (const bool copies : {false, true}) {
    Random random(copies ? 2 : 1);
    double worst = 0.0;
    int active = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const int n = 1 + trial % 23, rows = trial % 7;
      const Program program = randomProgram(random, n, rows, copies);
      gdd::QuadraticProgram solver;
      ASSERT_TRUE(solver.setHessian(program.K));
      ASSERT_TRUE(solver.minimize(program.q, program.lower, program.upper, program.N,
                                  program.distance, rows))
          << "trial " << trial;
      worst = std::max(worst, largestViolation(program, solver));
      for (const double nu : solver.rowMultipliers()) active += nu > 0.0;
      const VectorX& p = solver.solution();
      const double decrease = -(0.5 * p.dot(program.K * p) + program.q.dot(p));
      EXPECT_SMALL((decrease - solver.decrease()) / std::max(1.0, decrease), 1e-10);
    }
    EXPECT_SMALL(worst, 1e-10);
    EXPECT_GT(active, 500);
  }
}

// The guess of the face must not be what decides: it has to agree with the dual method, which sees
// the program when a row stands there twice.
TEST(QuadraticProgram, ARowThatStandsTwiceChangesNothing) {
  Random random(3);
  double worst = 0.0;
  for (int trial = 0; trial < 500; ++trial) {
    const int n = 2 + trial % 20, rows = 1 + trial % 4;
    const Program once = randomProgram(random, n, rows, false);
    Program twice = once;
    twice.N.conservativeResize(2 * rows, n);
    twice.distance.conservativeResize(2 * rows);
    for (int k = 0; k < rows; ++k) {
      twice.N.row(rows + k) = once.N.row(k);
      twice.distance[rows + k] = once.distance[k];
    }
    VectorX p[2];
    for (const bool doubled : {false, true}) {
      const Program& program = doubled ? twice : once;
      gdd::QuadraticProgram solver;
      ASSERT_TRUE(solver.setHessian(program.K));
      ASSERT_TRUE(solver.minimize(program.q, program.lower, program.upper, program.N,
                                  program.distance, doubled ? 2 * rows : rows));
      p[doubled] = solver.solution();
    }
    worst = std::max(worst, (p[0] - p[1]).cwiseAbs().maxCoeff());
  }
  EXPECT_SMALL(worst, 1e-10);
}

// What a gradient that has changed by ρ promises, multipliers kept, is ½ ρᵀK⁻¹ρ.
TEST(QuadraticProgram, PromiseIsThatOfTheGradientLeft) {
  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const int n = 1 + trial % 23, rows = trial % 5;
    const Program program = randomProgram(random, n, rows, false);
    gdd::QuadraticProgram solver;
    ASSERT_TRUE(solver.setHessian(program.K));
    ASSERT_TRUE(solver.minimize(program.q, program.lower, program.upper, program.N,
                                program.distance, rows));
    const VectorX slope = program.K * solver.solution() + program.q;
    EXPECT_SMALL(solver.predictedDecrease(slope), 1e-18);
    const VectorX rho = random.vector(n, 1.0);
    const double expected = 0.5 * rho.dot(program.K.llt().solve(rho));
    EXPECT_SMALL(solver.predictedDecrease(slope + rho) / expected - 1.0, 1e-7);
  }
}

TEST(QuadraticProgram, AHessianThatIsNotPositiveDefiniteIsRefused) {
  MatrixX K = MatrixX::Identity(3, 3);
  K(2, 2) = -1.0;
  gdd::QuadraticProgram solver;
  EXPECT_FALSE(solver.setHessian(K));
}

}  // namespace
}  // namespace softgauss::test
