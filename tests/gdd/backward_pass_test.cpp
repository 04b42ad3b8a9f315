// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/backward_pass.hpp"

#include "softgauss/engine/step/forward_derivative.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

using namespace planning;

/// Random numbers where a pass looks.
struct RandomPass {
  RandomPass(int seed, const Model& m)
      : model(m), dynamics(model, nullptr), knot(model, dynamics.step()), next(m.nv), cost(m.nv) {
    Random random(seed);
    const State at = randomState(model, random);
    const auto square = [&](ValueModel& value) {
      MatrixX root(2 * model.nv, 2 * model.nv);
      for (double& x : root.reshaped()) x = random.uniform(-1.0, 1.0);
      value.curvature = root * root.transpose();
      value.slope = random.vector(2 * model.nv, 1.0);
    };
    knot.q = at.q, knot.v = at.v, knot.a = random.vector(model.nv, 1.0);
    square(next), square(cost);
    w = random.vector(model.nv, 1.0);
    // Far above the 1e-12 by which Q_aa is raised.
    W = VectorX::Constant(model.nv, 0.1) + random.vector(model.nv, 1.0).cwiseAbs();
  }
  const Model& model;
  PlanDynamics dynamics;
  Knot knot;
  ValueModel next, cost;
  VectorX w, W;
};

Model bareTree(int seed) {
  ModelBuilder builder = randomFloatingTree(seed);
  builder.options = StepDerivative::bareStep(builder.options);
  builder.options.timestep = 0.02;
  return builder.build();
}

/// What δx, and the next state by δa, cost.
double ofStates(const RandomPass& r, const VectorX& dx, const VectorX& da) {
  VectorX after(2 * r.model.nv);
  r.knot.transition.next(dx, da, after);
  const MatrixX cost = r.cost.curvature.selfadjointView<Eigen::Lower>();
  return r.cost.slope.dot(dx) + 0.5 * dx.dot(cost * dx) + r.next.slope.dot(after) +
         0.5 * after.dot(r.next.curvature * after);
}

// Of k + K δx, at any δx and ρ, V is what Q(δx, k + K δx) is worth, where ρ raises Q for k and K
// alone: (P.4), multiplied out.
TEST(BackwardPass, ValueIsThatOfTheFeedback) {
  for (int seed = 0; seed < 10; ++seed) {
    const Model model = bareTree(seed);
    const int n = model.nv;
    for (const double rho : {0.0, 0.3}) {
      RandomPass r(seed, model);
      ASSERT_EQ(r.dynamics.linearise(r.knot), SolveStatus::converged);
      BackwardPass pass(model, {});
      Feedback f(n, n);
      ValueModel value(n);
      ASSERT_TRUE(pass.overAccelerations(r.knot, r.next, r.cost, r.w, r.W, rho, f, value));
      // As functions of δx and δa.
      const auto Q = [&](const VectorX& dx, const VectorX& da) {
        const VectorX dtau = r.knot.G * dx + r.knot.P * da;
        return ofStates(r, dx, da) + r.w.dot(dtau) + 0.5 * dtau.dot(r.W.asDiagonal() * dtau);
      };
      Random random(seed + 7);
      const double none = Q(VectorX::Zero(2 * n), f.k);
      EXPECT_NEAR(none, pass.linear() + pass.quadratic(), 1e-8 * std::abs(none));
      for (int i = 0; i < 5; ++i) {
        const VectorX dx = random.vector(2 * n, 1.0);
        const double expected = Q(dx, f.k + f.K * dx) - none;
        EXPECT_NEAR(value.slope.dot(dx) + 0.5 * dx.dot(value.curvature * dx), expected,
                    1e-8 * std::max(1.0, std::abs(Q(dx, VectorX::Zero(n)))))
            << seed << ' ' << rho;
      }
    }
  }
}

/// Q of forces u on the controlled dofs, of which `by` adds to those of the knot, and no others.
double ofControls(const RandomPass& r, const VectorX& R, const VectorX& dx, const VectorX& by) {
  const VectorX da = r.knot.P.ldlt().solve(by - r.knot.G * dx);
  return ofStates(r, dx, da) + 0.5 * (r.knot.tau + by).cwiseAbs2().dot(R) -
         0.5 * r.knot.tau.cwiseAbs2().dot(R);
}

// The same of forces, (P.5) multiplied out, in bounds that are far away and in narrow ones: what is
// at a bound stays there whatever δx is, and within them nothing is better than k.
TEST(BackwardPass, ValueIsThatOfTheFeedbackOfBoundedControls) {
  int held = 0, free = 0;
  for (int seed = 0; seed < 10; ++seed) {
    const Model model = bareTree(seed);
    const int n = model.nv;
    std::vector<int> controlled;
    for (int i = 6; i < n; ++i) controlled.push_back(i);
    const auto m = static_cast<int>(controlled.size());
    for (const double width : {kInfinity, 1.0, 0.01}) {
      RandomPass r(seed, model);
      ASSERT_EQ(r.dynamics.linearise(r.knot), SolveStatus::converged);
      const VectorX R = r.W, lower = r.knot.tau.array() - width, upper = r.knot.tau.array() + width;
      BackwardPass pass(model, controlled);
      Feedback f(m, n);
      ValueModel value(n);
      ASSERT_TRUE(pass.overControls(r.knot, r.next, r.cost, R, lower, upper, 0.0, f, value));
      const auto Q = [&](const VectorX& dx, const VectorX& du) {
        VectorX by = VectorX::Zero(n);
        by.tail(m) = du;
        return ofControls(r, R, dx, by);
      };
      Random random(seed + 7);
      const double none = Q(VectorX::Zero(2 * n), f.k);
      EXPECT_NEAR(none, pass.linear() + pass.quadratic(), 1e-8 * std::max(1.0, std::abs(none)));
      for (int i = 0; i < 5; ++i) {
        const VectorX dx = random.vector(2 * n, 1.0);
        const double expected = Q(dx, f.k + f.K * dx) - none;
        EXPECT_NEAR(value.slope.dot(dx) + 0.5 * dx.dot(value.curvature * dx), expected,
                    1e-8 * std::max(1.0, std::abs(Q(dx, VectorX::Zero(m)))))
            << seed << ' ' << width;
        const VectorX other = (f.k + random.vector(m, 0.1)).cwiseMax(-width).cwiseMin(width);
        EXPECT_GE(Q(VectorX::Zero(2 * n), other), none - 1e-9 * std::abs(none));
      }
      for (int i = 0; i < m; ++i) {
        const bool isHeld = f.K.row(i).isZero(0.0);
        ++(isHeld ? held : free);
        if (isHeld) {
          EXPECT_NEAR(std::abs(f.k[i]), width, 1e-12);  // τ ± width − τ
        }
      }
    }
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(free, 10);
}

TEST(BackwardPass, AllocatesNothing) {
  const Model model = bareTree(1);
  const int n = model.nv;
  PlanDynamics dynamics(model, nullptr);
  Knot knot(model, dynamics.step());
  ASSERT_EQ(dynamics.linearise(knot), SolveStatus::converged);
  std::vector<int> all;
  for (int i = 0; i < n; ++i) all.push_back(i);
  BackwardPass pass(model, all);
  ValueModel next(n), cost(n), value(n);
  next.curvature.setIdentity();
  Feedback feedback(n, n);
  const VectorX w = VectorX::Ones(n), W = VectorX::Ones(n), far = VectorX::Constant(n, 1e3),
                near = -far;
  const auto both = [&] {
    return pass.overAccelerations(knot, next, cost, w, W, 0.0, feedback, value) &&
           pass.overControls(knot, next, cost, W, near, far, 0.0, feedback, value);
  };
  EXPECT_TRUE(both());
  AllocationGuard guard;
  const bool done = both();
  EXPECT_EQ(guard.count(), 0);
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace softgauss::test
