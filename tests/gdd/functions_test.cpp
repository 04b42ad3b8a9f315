// SPDX-License-Identifier: Apache-2.0
/// Costs that the user writes: expansions, conditions of first order, value functions and LQR.

#include <Eigen/LU>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/gdd/goal_check.hpp"

namespace softgauss::test {
namespace {

using Function = gdd::GoalCost::Function;

/// ½ w |a − t|².
Function quadratic(double w, const VectorX& t) {
  return [w, t](const VectorX& a, VectorX& gradient, MatrixX& hessian) {
    gradient = w * (a - t);
    hessian = w * MatrixX::Identity(a.size(), a.size());
    return 0.5 * w * (a - t).squaredNorm();
  };
}

/// w Σ (√(1 + (a − t)²) − 1): convex, with so little curvature far off that Newton's steps
/// overshoot.
Function softAbsolute(double w, const VectorX& t) {
  return [w, t](const VectorX& a, VectorX& gradient, MatrixX& hessian) {
    const Eigen::ArrayXd x = (a - t).array(), root = (1.0 + x.square()).sqrt();
    gradient = w * x / root;
    hessian = MatrixX((w / root.cube()).matrix().asDiagonal());
    return w * (root - 1.0).sum();
  };
}

/// w Σ (1 − cos(a − t)): not convex.
Function waves(double w, const VectorX& t) {
  return [w, t](const VectorX& a, VectorX& gradient, MatrixX& hessian) {
    const Eigen::ArrayXd x = (a - t).array();
    gradient = w * x.sin();
    hessian = MatrixX((w * x.cos()).matrix().asDiagonal());
    return w * (1.0 - x.cos()).sum();
  };
}

double valueOf(const Function& f, const VectorX& a) {
  VectorX g(a.size());
  MatrixX H(a.size(), a.size());
  return f(a, g, H);
}
VectorX gradientOf(const Function& f, const VectorX& a) {
  VectorX g(a.size());
  MatrixX H(a.size(), a.size());
  f(a, g, H);
  return g;
}

/// The arm's problem with one function: solver, expansions.
struct Expanded {
  const Scene& scene;
  gdd::GoalCost cost;
  gdd::AugmentedLagrangian solver;
  gdd::SequentialQuadraticSolve expansion;
  gdd::GddReport report;

  explicit Expanded(const Scene& s)
      : scene(s), cost(s.model.nv), solver(s.model), expansion(s.model) {}
  const VectorX& solve(const Function& f) {
    cost.addFunction(f);
    const gdd::ControlLimits limits(scene.model);
    report = expansion.solve(solver, scene.model, cost, limits, *scene.data, scene.state.warmstart);
    return expansion.acceleration();
  }
};

TEST(Expansion, HasValueSlopeAndCurvatureAtItsPoint) {
  const Scene arm = drivenArm(1);
  Random random(1);
  const VectorX t = random.vector(7, 3.0), a = random.vector(7, 3.0), d = random.vector(7, 1e-4);
  for (const Function& f : {quadratic(3.0, t), softAbsolute(3.0, t), waves(3.0, t)}) {
    gdd::GoalCost cost(7);
    cost.addFunction(f);
    ASSERT_TRUE(cost.expand(arm.data->inertia.M, a, 0.0));
    EXPECT_NEAR(cost.expansionValue(a), valueOf(f, a), 1e-12);
    EXPECT_SMALL(cost.expansionError(a, VectorX::Ones(7)), 1e-14);
    VectorX gradient(7), Ma = arm.data->inertia.M.dense() * a;
    cost.gradient(a, Ma, gradient);
    EXPECT_APPROX(gradient, gradientOf(f, a), 1e-12);
    const VectorX slope = (gradientOf(f, a + d) - gradientOf(f, a - d)) / 2.0;
    const double bend = cost.curvatureAlong(d, arm.data->inertia.M.dense() * d);
    const double metric = d.dot(arm.data->inertia.M.dense() * d);
    EXPECT_GE(bend, -0.9 * metric - 1e-12 * d.squaredNorm());
    EXPECT_GE(bend, slope.dot(d) - 1e-6 * d.squaredNorm()) << "raised, never lowered";
  }
}

// A quadratic function is what the rows of the same cost are, at the price of one solve.
TEST(FunctionGoal, AQuadraticOneTakesOneSolve) {
  const Scene arm = drivenArm(4);
  Random random(4);
  const VectorX t = random.vector(7, 10.0);
  Expanded e(arm);
  const VectorX a = e.solve(quadratic(2.0, t));
  EXPECT_EQ(e.report.status, gdd::GddStatus::converged);
  EXPECT_LE(e.report.factorizations, 2);
  const MatrixX K = arm.data->inertia.M.dense() + 2.0 * MatrixX::Identity(7, 7);
  const VectorX expected = K.llt().solve(2.0 * t - arm.data->forces.c);
  EXPECT_SMALL((a - expected).norm() / expected.norm(), 1e-12);
}

// ∇(½ gᵀM⁻¹g) = M a + c without rows: the sum with ∇φ vanishes. One cell holds all of space, so the
// guess after the first solve is the solution, and the second confirms it.
TEST(FunctionGoal, ConditionsOfFirstOrderHoldAfterTwoSolves) {
  double worst = 0.0;
  int fewest = 100, most = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene arm = drivenArm(seed);
    Random random(seed + 8);
    const VectorX t = random.vector(7, 50.0);
    const double w = random.uniform(1.0, 100.0);
    for (const Function& f : {softAbsolute(w, t), waves(w, t)}) {
      Expanded e(arm);
      const VectorX a = e.solve(f);
      EXPECT_EQ(e.report.status, gdd::GddStatus::converged);
      fewest = std::min(fewest, e.expansion.solves());
      most = std::max(most, e.expansion.solves());
      const VectorX g = arm.data->inertia.hat().dense() * a + arm.data->forces.c;
      const VectorX& scale = arm.data->inertia.forceScale;
      const VectorX off = (g + gradientOf(f, a)).cwiseProduct(scale);
      worst = std::max(worst, off.cwiseAbs().maxCoeff() /
                                  std::max(1.0, g.cwiseProduct(scale).cwiseAbs().maxCoeff()));
      EXPECT_NEAR(e.report.objective,
                  0.5 * g.dot(arm.data->inertia.M.dense().llt().solve(g)) + valueOf(f, a),
                  1e-9 * std::abs(e.report.objective));
    }
  }
  EXPECT_GT(fewest, 1) << "no function is its expansion";
  EXPECT_LE(most, 3);  // two, and one more where rounding asks for it
  // Each solve ends within 1e-7 or so of stationary, where rounding ends it.
  EXPECT_SMALL(worst, 1e-6);
}

// With contacts, limits and boxes. The solver ends where a Newton step promises less than 1e-14 of
// Φ, and the expansions where ∇φ is met to 1e-8: what a step of the dense Φ + φ would still gain is
// no more than both allow, twice over, since the solver's Φ holds ψ too.
TEST(FunctionGoal, ConditionsOfFirstOrderHoldWithContactsAndBoxes) {
  double worst = 0.0;
  int smooth = 0, kinks = 0, solves = 0, most = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed + 70);
    GddScene s(lawGddScene(seed, 5));
    const int n = s.dofs();
    const VectorX t = random.vector(n, 20.0);
    const double w = random.uniform(1.0, 30.0);
    for (const Function& f : {softAbsolute(w, t), waves(w, t)}) {
      gdd::GoalCost cost = s.cost;
      cost.addFunction(f);
      gdd::SequentialQuadraticSolve expansion(s.model());
      const gdd::GddReport report =
          expansion.solve(*s.solver, s.model(), cost, s.limits, s.data(), WarmStart());
      most = std::max(most, expansion.solves());
      solves += expansion.solves();
      kinks += report.status == gdd::GddStatus::nonsmoothMinimum;
      if (report.status != gdd::GddStatus::converged) continue;
      ++smooth;
      WarmStart end;
      expansion.keepWarmStart(end);
      s.dense.lambda = end.multipliers;
      const VectorX& a = expansion.acceleration();
      VectorX slope(n);
      MatrixX hessian(n, n);
      const double size = f(a, slope, hessian) + std::abs(s.dense.objective(a));
      const VectorX gradient = slope + s.dense.augmentedGradient(a);
      const MatrixX H = s.dense.gaussNewtonHessian(a) + hessian;
      const double gain = gradient.dot(H.llt().solve(gradient));
      const double largest = slope.cwiseProduct(s.data().inertia.forceScale).cwiseAbs().maxCoeff();
      const double met = expansion.tolerance * std::max(1.0, largest);
      worst = std::max(worst, gain / (1e-14 * size + n * met * met));
      EXPECT_NEAR(report.objective, s.dense.objective(a) + valueOf(f, a), 1e-9 * size);
    }
  }
  EXPECT_EQ(smooth + kinks, 80) << "all end";
  EXPECT_GT(smooth, 20);
  EXPECT_GT(kinks, 20);
  EXPECT_SMALL(worst, 2.0);
  // Cold, with five contacts that come and go: 5.3 on average.
  EXPECT_LE(solves, 80 * 6);
  EXPECT_LE(most, 20);
}

TEST(FunctionGoal, AFunctionThatIsNotFiniteEndsTheSolve) {
  const Scene arm = drivenArm(4);
  Expanded e(arm);
  e.solve([](const VectorX&, VectorX&, MatrixX&) { return kNaN; });
  EXPECT_EQ(e.report.status, gdd::GddStatus::notFinite);
}

// ---- Value functions ----------------------------------------------------------------------------

/// Two masses in a row on rails, driven, without gravity: linear, M constant.
Scene railScene(const VectorX& q, const VectorX& v) {
  ModelBuilder b("rails");
  b.link(emptyLink("world"));
  b.link(boxLink("first", 2.0, Vector3(0.1, 0.1, 0.1)));
  b.link(boxLink("second", 0.7, Vector3(0.1, 0.1, 0.1)));
  b.joint(jointSpec("a", JointType::prismatic, "world", "first", {}, Vector3::UnitX()));
  b.joint(jointSpec("b", JointType::prismatic, "first", "second", {}, Vector3(0.6, 0.8, 0.0)));
  b.options.effects.remove(Effect::gravity);
  Scene scene(b.build());
  scene.state.q = q;
  scene.state.v = v;
  EXPECT_EQ(scene.stages(), SolveStatus::converged);
  return scene;
}

// With V of the Riccati equation of the step, greedy control is LQR: u = −K x. Goals act at
// mid-step.
TEST(ValueGoal, WithTheRiccatiValueItIsLqr) {
  Random random(6);
  const Scene scene = railScene(random.vector(2, 1.0), random.vector(2, 1.0));
  const double h = scene.model.options.timestep;
  const MatrixX M = scene.data->inertia.M.dense(), R = M.inverse();
  ASSERT_SMALL(scene.data->forces.c.norm(), 1e-14);
  MatrixX A = MatrixX::Identity(4, 4), B = MatrixX::Zero(4, 2);
  A.topRightCorner(2, 2) = h * MatrixX::Identity(2, 2);
  B << 0.5 * h * h * R, h * R;
  const MatrixX Q = VectorX(Eigen::Vector4d(3.0, 5.0, 0.1, 0.2)).asDiagonal();
  MatrixX V = Q, K(2, 4);
  for (int i = 0; i < 20000; ++i) {
    K = (R + B.transpose() * V * B).ldlt().solve(B.transpose() * V * A);
    const MatrixX next = Q + A.transpose() * V * (A - B * K);
    const double change = (next - V).norm() / next.norm();
    V = 0.5 * (next + next.transpose());
    if (change < 1e-15) break;
  }
  gdd::ValueGoal goal([&](const VectorX& q, const VectorX& v, VectorX& gradient, MatrixX& hessian) {
    VectorX x(4);
    x << q, v;
    gradient = V * x;
    hessian = V;
    return 0.5 * x.dot(V * x);
  });
  Expanded e(scene);
  goal.addCost({scene.model, scene.state, *scene.data}, e.cost);
  const gdd::ControlLimits limits(scene.model);
  const auto report =
      e.expansion.solve(e.solver, scene.model, e.cost, limits, *scene.data, WarmStart());
  EXPECT_EQ(report.status, gdd::GddStatus::converged);
  VectorX x(4);
  x << scene.state.q - 0.5 * h * scene.state.v, scene.state.v;
  const VectorX expected = -K * x;
  EXPECT_SMALL((e.expansion.force() - expected).norm() / expected.norm(), 1e-10);
}

// V that is not quadratic: gradient and curvature of ℓ are those of differences of V itself.
TEST(ValueGoal, HasTheChainRulesDerivatives) {
  const Scene arm = drivenArm(9);
  const auto V = [](const VectorX& q, const VectorX& v) {
    return std::cos(q.sum()) * v.squaredNorm() + std::exp(0.1 * v.sum());
  };
  gdd::ValueGoal goal([&](const VectorX& q, const VectorX& v, VectorX& gradient, MatrixX& hessian) {
    const double e = std::exp(0.1 * v.sum()), c = 2.0 * std::cos(q.sum());
    const double s = std::sin(q.sum());
    const Eigen::Index n = v.size();
    gradient << VectorX::Constant(n, -s * v.squaredNorm()), c * v + VectorX::Constant(n, 0.1 * e);
    hessian.topLeftCorner(n, n).setConstant(-0.5 * c * v.squaredNorm());
    hessian.topRightCorner(n, n) = VectorX::Ones(n) * (-2.0 * s * v).transpose();
    hessian.bottomLeftCorner(n, n) = hessian.topRightCorner(n, n).transpose();
    hessian.bottomRightCorner(n, n).setConstant(0.01 * e);
    hessian.diagonal().tail(n).array() += c;
    return V(q, v);
  });
  goal.weight = 3.0;
  gdd::GoalCost cost(7);
  goal.addCost({arm.model, arm.state, *arm.data}, cost);
  Random random(2);
  const VectorX a = random.vector(7, 50.0), d = random.vector(7, 1.0);
  const double h = arm.model.options.timestep;
  const auto direct = [&](const VectorX& x) {
    const VectorX v = arm.state.v + h * x;
    return 3.0 * V(arm.state.q + 0.5 * h * v, v);
  };
  EXPECT_NEAR(cost.functionValue(a), direct(a), 1e-12 * std::abs(direct(a)));
  ASSERT_TRUE(cost.expand(arm.data->inertia.M, a, 0.0));
  VectorX gradient(7);
  cost.gradient(a, arm.data->inertia.M.dense() * a, gradient);
  EXPECT_NEAR(gradient.dot(d), (direct(a + d) - direct(a - d)) / 2.0,
              1e-5 * (1e-3 + std::abs(gradient.dot(d))));
}

}  // namespace
}  // namespace softgauss::test
