// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/solver/newton.hpp"

#include <Eigen/Cholesky>

#include "tests/support/matchers.hpp"
#include "tests/support/reference_solver.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// A dense convex problem as the solver sees it, counting what is asked of it.
class DenseObjective {
 public:
  DenseObjective(const ConvexProblem& p, VectorX start) : a(std::move(start)), p_(p) {}

  double gradient(VectorX& g) {
    g = p_.gradient(a);
    const VectorX active = activity();
    changed_ = changed_ || active != active_;
    active_ = active;
    return g.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }
  bool cellChanged() const { return changed_; }
  bool factorize() {
    changed_ = false;
    ++factorizations;
    if (singular) return false;
    const MatrixX H = p_.M + p_.J.transpose() * active_.cwiseProduct(p_.D).asDiagonal() * p_.J;
    llt_.compute(H);
    return llt_.info() == Eigen::Success;
  }
  double direction(const VectorX& g, VectorX& d) {
    d_ = d = -llt_.solve(g);
    return g.dot(d);
  }
  double unit() const { return 1.0; }
  bool staysInCell() const {
    const VectorX x = p_.J * (a + d_) - p_.aRef;
    const bool stays = (x.array() < 0.0).cast<double>().matrix() == active_;
    searches += !stays;
    return stays;
  }
  Jet along(double alpha) const {
    const VectorX x = a + alpha * d_, r = p_.J * x - p_.aRef, Jd = p_.J * d_;
    double curvature = d_.dot(p_.M * d_);
    for (Eigen::Index i = 0; i < r.size(); ++i)
      if (r[i] < 0.0) curvature += p_.D[i] * Jd[i] * Jd[i];
    return {p_.cost(x), p_.gradient(x).dot(d_), curvature};
  }
  void advance(const VectorX& d, double alpha) { a += alpha * d; }

  VectorX a;
  int factorizations = 0;
  mutable int searches = 0;
  bool singular = false;

 private:
  VectorX activity() const { return ((p_.J * a - p_.aRef).array() < 0.0).cast<double>().matrix(); }
  const ConvexProblem& p_;
  VectorX active_, d_;
  Eigen::LLT<MatrixX> llt_;
  bool changed_ = true;
};
static_assert(NewtonObjective<DenseObjective>);

ConvexProblem randomProblem(std::uint64_t seed, int rows) {
  Random random(seed);
  const int n = 8;
  ConvexProblem p;
  MatrixX A(n, n);
  for (double& x : A.reshaped()) x = random.uniform(-1.0, 1.0);
  p.M = A * A.transpose() + 0.5 * MatrixX::Identity(n, n);
  p.net = random.vector(n, 5.0);
  p.J.resize(rows, n);
  for (double& x : p.J.reshaped()) x = random.uniform(-1.0, 1.0);
  p.aRef = random.vector(rows, 3.0);
  p.D = VectorX::Constant(rows, 20.0);
  p.lower = VectorX::Zero(rows);
  p.upper = VectorX::Constant(rows, kInfinity);
  return p;
}

NewtonReport solve(DenseObjective& objective, double tolerance = 1e-11, int maxIterations = 50) {
  VectorX g, d;
  return minimize(objective, tolerance, maxIterations, g, d);
}

TEST(Newton, UnconstrainedTakesOneIteration) {
  const ConvexProblem p = randomProblem(1, 0);
  DenseObjective objective(p, VectorX::Zero(8));
  const NewtonReport report = solve(objective);
  EXPECT_EQ(report.status, SolveStatus::converged);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(report.factorizations, 1);
  EXPECT_APPROX(objective.a, p.M.llt().solve(p.net), 1e-12);
}

TEST(Newton, ExactGuessTakesNoIteration) {
  const ConvexProblem p = randomProblem(2, 12);
  DenseObjective first(p, VectorX::Zero(8));
  ASSERT_EQ(solve(first).status, SolveStatus::converged);
  DenseObjective again(p, first.a);
  const NewtonReport report = solve(again);
  EXPECT_EQ(report.status, SolveStatus::converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(again.factorizations, 0);
  EXPECT_EQ(again.a, first.a);
}

TEST(Newton, FindsTheMinimumOfRandomProblems) {
  int iterations = 0;
  for (int seed = 0; seed < 50; ++seed) {
    const ConvexProblem p = randomProblem(seed, 20);
    DenseObjective objective(p, VectorX::Constant(8, 10.0));
    const NewtonReport report = solve(objective);
    EXPECT_EQ(report.status, SolveStatus::converged) << "seed " << seed;
    EXPECT_APPROX(objective.a, solveByGaussSeidel(p).a, 1e-10) << "seed " << seed;
    EXPECT_EQ(report.factorizations, objective.factorizations);
    EXPECT_LE(report.factorizations, report.iterations);
    EXPECT_GE(report.lineSearchEvaluations, objective.searches);
    EXPECT_LT(objective.searches, report.iterations) << "the last step stays in its cell";
    iterations += report.iterations;
  }
  EXPECT_GT(iterations, 100);
  EXPECT_LT(iterations, 500);
}

TEST(Newton, StarvedSolverSaysIterationLimit) {
  for (int seed = 0; seed < 20; ++seed) {
    const ConvexProblem p = randomProblem(seed, 20);
    DenseObjective full(p, VectorX::Constant(8, 10.0));
    const int needed = solve(full).iterations;
    ASSERT_GE(needed, 2);
    DenseObjective starved(p, VectorX::Constant(8, 10.0));
    const NewtonReport report = solve(starved, 1e-11, needed - 1);
    EXPECT_EQ(report.status, SolveStatus::iterationLimit) << "seed " << seed;
    EXPECT_EQ(report.iterations, needed - 1);
    EXPECT_GT(report.residual, 1e-11);
  }
}

TEST(Newton, ResidualIsThatOfTheResult) {
  const ConvexProblem p = randomProblem(4, 20);
  for (int limit = 0; limit < 4; ++limit) {
    DenseObjective objective(p, VectorX::Constant(8, 10.0));
    const NewtonReport report = solve(objective, 1e-11, limit);
    EXPECT_EQ(report.residual, p.gradient(objective.a).cwiseAbs().maxCoeff());
  }
}

// A tolerance below rounding: the solver stops by itself, well before the limit.
TEST(Newton, StopsAtRounding) {
  const ConvexProblem p = randomProblem(5, 20);
  DenseObjective objective(p, VectorX::Constant(8, 10.0));
  const NewtonReport report = solve(objective, 1e-17, 50);
  EXPECT_LT(report.iterations, 20);
  EXPECT_LT(report.residual, 1e-12);
}

TEST(Newton, SaysNotFinite) {
  ConvexProblem p = randomProblem(6, 5);
  DenseObjective singular(p, VectorX::Zero(8));
  singular.singular = true;
  EXPECT_EQ(solve(singular).status, SolveStatus::notFinite);
  p.net[3] = kNaN;
  DenseObjective nan(p, VectorX::Zero(8));
  EXPECT_EQ(solve(nan).status, SolveStatus::notFinite);
}

// The engine's own objective.
TEST(Newton, OfTheEngineTakesNoIterationWithoutRows) {
  RandomTreeOptions options;
  options.ranges = false;
  Scene s = randomScene(3, 0, options);
  EXPECT_EQ(s.forward(), SolveStatus::converged);
  EXPECT_EQ(s.data->forward.report.iterations, 0);  // it starts at the unconstrained acceleration
}

TEST(Newton, OfTheEngineTakesNoIterationFromTheSolution) {
  int iterations = 0;
  for (int seed = 0; seed < 40; ++seed) {
    for (const bool rigid : {true, false}) {
      Scene s = randomScene(seed, 8);
      if (!rigid) s.model.options.mechanisms.remove(Mechanism::nearRigid);
      s.stages();
      s.forward();
      s.state.warmstart.a = s.data->forward.a;
      s.state.warmstart.valid = true;
      s.forward();
      // M a computed anew differs by rounding from M a carried along the iterations, which is at
      // times more than the tolerance, more often the stiffer rows are.
      EXPECT_LE(s.data->forward.report.iterations, 1) << "seed " << seed;
      if (!rigid) iterations += s.data->forward.report.iterations;
    }
  }
  EXPECT_LE(iterations, 10);
}

TEST(Newton, OfTheEngineStarvedSaysIterationLimit) {
  int starved = 0;
  for (int seed = 0; seed < 20; ++seed) {
    Scene s = randomScene(seed, 8);
    s.forward();
    if (s.data->forward.report.iterations < 2) continue;
    s.model.options.maxIterations = 1;
    EXPECT_EQ(s.forward(), SolveStatus::iterationLimit);
    EXPECT_GT(s.data->forward.report.residual, s.model.options.tolerance);
    ++starved;
  }
  EXPECT_GT(starved, 10);
}

TEST(SolveStatus, HasANameForEach) {
  EXPECT_STREQ(statusName(SolveStatus::converged), "converged");
  EXPECT_STREQ(statusName(SolveStatus::stalled), "stalled");
  EXPECT_STREQ(statusName(SolveStatus::iterationLimit), "iteration limit");
  EXPECT_STREQ(statusName(SolveStatus::notFinite), "not finite");
  EXPECT_STREQ(statusName(SolveStatus::badInput), "bad input");
}

}  // namespace
}  // namespace softgauss::test
