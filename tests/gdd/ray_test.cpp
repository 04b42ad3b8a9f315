// SPDX-License-Identifier: Apache-2.0
/// The exact line search against brute force, and what it promises the solver: descent.

#include <Eigen/Cholesky>
#include <algorithm>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// First local minimum of Φ(a + α d), α ≥ 0: a fine scan between the breakpoints of the rows, where
/// Φ is convex, then golden section.
class BruteForce {
 public:
  BruteForce(const DenseGdd& d, const VectorX& a, const VectorX& direction)
      : d_(d), a_(a), direction_(direction) {}

  double phi(double alpha) const { return d_.augmented(a_ + alpha * direction_); }

  double firstMinimum() const {
    const VectorX x = d_.residual(a_), dx = d_.J * direction_;
    std::vector<double> breakpoints{0.0};
    for (int i = 0; i < d_.rows(); ++i)
      for (const double breakpoint : {d_.lowerKnot(i), d_.upperKnot(i)}) {
        const double alpha = (breakpoint - x[i]) / dx[i];
        if (alpha > 0.0 && std::isfinite(alpha)) breakpoints.push_back(alpha);
      }
    std::sort(breakpoints.begin(), breakpoints.end());
    // Breakpoints that fall together (opposite edges of a pyramid) count once.
    const auto together = [](double p, double q) { return q - p <= 1e-9 * q; };
    breakpoints.erase(std::unique(breakpoints.begin(), breakpoints.end(), together),
                      breakpoints.end());
    for (std::size_t k = 0; k < breakpoints.size(); ++k) {
      const double from = breakpoints[k];
      double to = k + 1 < breakpoints.size() ? breakpoints[k + 1] : std::max(1.0, 2.0 * from);
      // Beyond the last breakpoint Φ rises at last.
      while (k + 1 == breakpoints.size() && phi(to) <= phi(from + 0.5 * (to - from)))
        to = from + 2.0 * (to - from);
      const double best = convexMinimum(from, to);
      const bool inside = best < to - 1e-7 * (to - from);
      if (inside || k + 1 == breakpoints.size()) return best;
      // At the breakpoint: does Φ fall further?
      const double next = k + 2 < breakpoints.size() ? breakpoints[k + 2] : 2.0 * to;
      if (phi(to + 1e-6 * (next - to)) >= phi(to)) return to;
    }
    return 0.0;
  }

 private:
  double convexMinimum(double from, double to) const {
    constexpr int kScan = 200;
    int best = 0;
    double least = phi(from);
    for (int i = 1; i <= kScan; ++i) {
      const double value = phi(from + (to - from) * i / kScan);
      if (value < least) least = value, best = i;
    }
    double lower = from + (to - from) * std::max(best - 1, 0) / kScan;
    double upper = from + (to - from) * std::min(best + 1, kScan) / kScan;
    constexpr double kGolden = 0.6180339887498949;
    for (int i = 0; i < 60; ++i) {
      const double p = upper - kGolden * (upper - lower), q = lower + kGolden * (upper - lower);
      (phi(p) <= phi(q) ? upper : lower) = phi(p) <= phi(q) ? q : p;
    }
    return 0.5 * (lower + upper);
  }

  const DenseGdd& d_;
  const VectorX &a_, &direction_;
};

struct RayCase {
  GddScene s;
  VectorX a, direction;
  gdd::RayResult result;

  /// A random ray of descent; every third is the Gauss–Newton direction.
  explicit RayCase(std::uint64_t seed) : RayCase(seed, lawGddScene(seed, 5)) {}
  RayCase(std::uint64_t seed, GddScene scene) : s(std::move(scene)) {
    Random random(seed + 9000);
    s.randomMultipliers(random, 3.0);
    // With the solver's penalties these dominate Φ; with small ones all terms count.
    if (seed % 2 == 0) s.dense.rho *= 1e-5;
    a = s.dense.Minv * -s.dense.c + random.vector(s.dofs(), 10.0);
    const VectorX slope = s.dense.augmentedGradient(a);
    direction = random.vector(s.dofs(), 1.0);
    if (direction.dot(slope) > 0.0) direction = -direction;
    if (seed % 3 == 0) direction = -s.dense.gaussNewtonHessian(a).ldlt().solve(slope);

    VectorX g(s.dofs()), rate(s.dofs()), Ma(s.dofs()), cost(s.dofs()), Md(s.dofs());
    inverseDynamics(s.model(), a, s.data(), g);
    TreeMatrix P;
    inverseDynamicsJacobian(s.data(), P);
    P.multiply(direction, rate);
    const TreeMatrix& M = s.data().inertia.M;
    M.multiply(a, Ma);
    M.multiply(direction, Md);
    s.cost.gradient(a, Ma, cost);
    TreeFactor massFactor;
    massFactor.compute(s.data().inertia.hat());
    s.data().constraints.setRay(direction);
    s.data().constraints.setForceRate();
    gdd::ContactForceTerms forces;
    forces.setCost(s.cost.forces());
    forces.evaluate(s.data().constraints);
    forces.setRate(s.data().constraints);
    gdd::Ray ray(s.model());
    result =
        ray.minimize(s.data().constraints, massFactor, {s.limits, s.dense.lambda, s.dense.rho}, g,
                     rate, cost.dot(direction), s.cost.curvatureAlong(direction, Md), forces);
  }
};

TEST(Ray, EndsAtTheFirstLocalMinimum) {
  double worst = 0.0, worstValue = 0.0;
  int kinks = 0, crossed = 0;
  for (int seed = 0; seed < 150; ++seed) {
    const RayCase ray(seed);
    const BruteForce brute(ray.s.dense, ray.a, ray.direction);
    const double expected = brute.firstMinimum();
    const double best = brute.phi(expected), start = brute.phi(0.0);
    worst = std::max(worst, std::abs(ray.result.alpha - expected) / expected);
    worstValue =
        std::max(worstValue, (brute.phi(ray.result.alpha) - best) / std::abs(start - best));
    EXPECT_LT(brute.phi(ray.result.alpha), start) << "seed " << seed;
    kinks += ray.result.kink;
    crossed += ray.result.crossings;
  }
  // Golden section finds a minimum to the root of the rounding of Φ, of which 1e-10 may be left.
  EXPECT_SMALL(worst, 1e-5);
  EXPECT_SMALL(worstValue, 1e-9);
  EXPECT_GT(kinks, 5);
  EXPECT_GT(crossed, 100);
}

TEST(Ray, NeitherSideOfTheMinimumIsLower) {
  for (int seed = 200; seed < 400; ++seed) {
    const RayCase ray(seed);
    const BruteForce brute(ray.s.dense, ray.a, ray.direction);
    const double alpha = ray.result.alpha, best = brute.phi(alpha);
    const double rounding = 1e-14 * (std::abs(best) + std::abs(brute.phi(0.0)));
    EXPECT_LE(best, brute.phi(alpha * (1.0 + 1e-6)) + rounding) << "seed " << seed;
    EXPECT_LE(best, brute.phi(alpha * (1.0 - 1e-6)) + rounding) << "seed " << seed;
  }
}

// A minimum at a breakpoint names the row that is there.
TEST(Ray, KinkIsTheKnotOfTheRowItNames) {
  int kinks = 0, lowerKnots = 0, upperKnots = 0;  // those of rows with two
  for (int seed = 0; seed < 1500; ++seed) {
    // Contacts, or rows with two breakpoints.
    RandomTreeOptions options;
    options.dryFriction = seed % 2 == 1;
    RayCase ray(seed, randomGddScene(seed, seed % 2 == 0 ? 5 : 0, 0.5, options));
    if (!ray.result.kink) continue;
    ++kinks;
    const DenseGdd& d = ray.s.dense;
    const int at = ray.s.rowIndex(ray.result.last.row);
    const VectorX x = d.residual(ray.a + ray.result.alpha * ray.direction);
    const bool lower = ray.result.last.index == 0 && std::isfinite(d.lowerKnot(at));
    const double above = x[at] - (lower ? d.lowerKnot(at) : d.upperKnot(at));
    EXPECT_LE(std::abs(above), 1e-9 * (1.0 + std::abs(d.aRef[at]) + d.J.row(at).norm() * 10.0));
    (lower ? lowerKnots : upperKnots) += std::isfinite(d.lowerKnot(at));
  }
  EXPECT_GT(kinks, 10);
  EXPECT_GT(lowerKnots, 2);
  EXPECT_GT(upperKnots, 2);
}

// One joint with dry friction, from far below to a wish far above: the ray passes both breakpoints,
// and the minimum is that of the piece beyond, where the friction is −f_max.
TEST(Ray, PassesBothKnotsOfDryFriction) {
  const double m = 2.0, limit = 3.0, w = 7.0, wish = 40.0;
  ModelBuilder builder("slide");
  builder.base = BaseKind::fixed;
  builder.options.gravity.setZero();
  builder.link(emptyLink("world")).link(boxLink("box", m, {0.1, 0.1, 0.1}));
  JointSpec joint = jointSpec("x", JointType::prismatic, "world", "box", {}, Vector3::UnitX());
  joint.dryFriction = limit;
  Scene scene(builder.joint(joint).build());
  scene.input.controlled = allTrees(scene.model);
  scene.stages();
  const Constraints& constraints = scene.data->constraints;
  const gdd::ControlLimits limits(scene.model);
  const VectorX lambda = VectorX::Zero(1), rho = VectorX::Ones(1);
  TreeFactor massFactor;
  massFactor.compute(scene.data->inertia.M);
  gdd::Ray ray(scene.model);
  for (const double direction : {1.0, -1.0}) {
    const VectorX a = VectorX::Constant(1, -50.0 * direction);
    const VectorX d = VectorX::Constant(1, 10.0 * direction);
    VectorX g(1);
    inverseDynamics(scene.model, a, *scene.data, g);
    EXPECT_EQ(g[0], m * a[0] - limit * direction);
    scene.data->constraints.setRay(d);
    gdd::ContactForceTerms none;
    const gdd::RayResult result =
        ray.minimize(constraints, massFactor, {limits, lambda, rho}, g, m * d,
                     w * (a[0] - wish * direction) * d[0], w * d[0] * d[0], none);
    // ½ g²/m + ½ w (a − wish)² with g = m a + f_max.
    const double best = direction * (w * wish - limit) / (m + w);
    EXPECT_EQ(result.crossings, 2);
    EXPECT_FALSE(result.kink);
    EXPECT_EQ(result.last.index, direction > 0.0 ? 1 : 0);
    EXPECT_SMALL((a[0] + result.alpha * d[0]) / best - 1.0, 1e-12);
  }
}

// Φ falls at every iteration, with whatever multipliers the iteration has. A step that takes held
// rows back to the breakpoints from which rounding moved them may raise it, and is rare.
TEST(GddSolver, ObjectiveFallsAtEveryIteration) {
  int iterations = 0, rises = 0;
  for (int seed = 0; seed < 60; ++seed) {
    GddScene s = lawGddScene(seed, 5);
    s.solver->options.maxIterations = 0;
    VectorX before = s.solve();
    for (int k = 1; k <= 40; ++k) {
      s.solver->options.maxIterations = k;
      const VectorX a = s.solve();
      const double was = s.dense.augmented(before), is = s.dense.augmented(a);
      rises += !(is <= was + 1e-12 * std::abs(was));
      if (s.report.status != gdd::GddStatus::iterationLimit) break;
      before = a;
      ++iterations;
    }
  }
  EXPECT_GT(iterations, 200);
  EXPECT_SMALL(static_cast<double>(rises) / iterations, 0.01);
}

TEST(GddSolver, ReportsTheDenseObjectiveAndViolation) {
  for (int seed = 0; seed < 60; ++seed) {
    GddScene s = lawGddScene(seed, 5);
    const VectorX& a = s.solve();
    const VectorX g = s.dense.g(a);
    const double scale = 0.5 * g.dot(s.dense.Minv * g) + std::abs(s.dense.goalCost(a));
    // Held rows count as at their breakpoints, from which rounding has moved the dense residuals.
    const double moved = (s.dense.Minv * g).dot(s.solver->force() - g);
    EXPECT_NEAR(s.report.objective, s.dense.objective(a) + moved, 1e-11 * scale) << "seed " << seed;
    EXPECT_APPROX(s.solver->force(), g, 1e-8);
    EXPECT_NEAR(s.report.violation, s.dense.violation(a), 1e-8 * g.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace softgauss::test
