// SPDX-License-Identifier: Apache-2.0
/// The greedy control of the optimal value function is the optimal control
/// (22).
///
/// The system is that of the leapfrog, q_m = q + ½ h v, v⁺ = v + h f(q_m, v, u),
/// q⁺ = q_m + ½ h v⁺; the running cost that of (20), ½ (u, 0)ᵀM⁻¹(u, 0) + p(q, v).
/// Goals act at q_m.

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <type_traits>

#include "softgauss/gdd/goals/functions.hpp"
#include "softgauss/gdd/sequential_quadratic_solve.hpp"
#include "tests/gdd/pendulum_value.hpp"
#include "tests/gdd/rails.hpp"
#include "tests/gdd/solvers.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// The control that goals find at a scene's state.
template <class Solver>
class Greedy {
 public:
  Greedy(Scene &scene, gdd::ValueGoal goal)
      : s_(scene),
        goal_(std::move(goal)),
        solver_(scene.model),
        expansion_(scene.model),
        cost_(scene.model.nv),
        limits_(scene.model) {}

  VectorX control() {
    EXPECT_EQ(s_.stages(), SolveStatus::converged);
    cost_.clear();
    goal_.addCost({s_.model, s_.state, *s_.data}, cost_);
    report = expansion_.solve(solver_, s_.model, cost_, limits_, *s_.data, s_.state.warmstart);
    return limits_.clamp(expansion_.force());
  }
  gdd::GddReport report;

 private:
  Scene &s_;
  gdd::ValueGoal goal_;
  Solver solver_;
  gdd::SequentialQuadraticSolve expansion_;
  gdd::GoalCost cost_;
  gdd::ControlLimits limits_;
};

template <class Solver>
class ValueFunction : public testing::Test {};
TYPED_TEST_SUITE(ValueFunction, GddSolvers);

// ---- A linear system ----------------------------------------------------------------------------

Scene railScene(bool passive) {
  ModelBuilder b = rails(passive);
  b.options.timestep = 0.01;
  return Scene(b.build());
}

/// A = ∂x⁺/∂x, B = ∂x⁺/∂u, x = (q, v); R of the actuated dofs; S of V* = ½ xᵀS
/// x; u = −K x.
struct Regulator {
  std::vector<int> actuated;
  MatrixX A, B, Q, R, S, K;

  explicit Regulator(Scene &scene) {
    EXPECT_EQ(scene.stages(), SolveStatus::converged);
    const int n = scene.model.nv;
    const double h = scene.model.options.timestep;
    const MatrixX M = scene.data->inertia.M.dense(), one = MatrixX::Identity(n, n);
    MatrixX felt = M;  // damping is that of the step's end
    for (int i = 0; i < n; ++i) felt(i, i) += h * scene.model.dofs[i].damping;
    const MatrixX Minv = felt.llt().solve(one);
    for (int i = 0; i < n; ++i)
      if (scene.model.dofs[i].actuated) actuated.push_back(i);
    const int m = static_cast<int>(actuated.size());
    A = MatrixX::Identity(2 * n, 2 * n);
    A.topRightCorner(n, n) = h * MatrixX::Identity(n, n);
    B = MatrixX::Zero(2 * n, m);
    R.resize(m, m);
    // δa = −M̂⁻¹(K δq_m + D δv), of which q⁺ has ½ h² and v⁺ has h.
    const auto adds = [&](auto &&column, const VectorX &a) {
      column.head(n) += 0.5 * h * h * a;
      column.tail(n) += h * a;
    };
    for (int i = 0; i < n; ++i) {
      const double k = scene.model.dofs[i].stiffness, d = scene.model.dofs[i].damping;
      adds(A.col(i), -k * Minv.col(i));
      adds(A.col(n + i), -(0.5 * h * k + d) * Minv.col(i));
    }
    for (int j = 0; j < m; ++j) {
      adds(B.col(j), Minv.col(actuated[j]));
      for (int i = 0; i < m; ++i) R(i, j) = Minv(actuated[i], actuated[j]);
    }
    Q = MatrixX::Identity(2 * n, 2 * n);
    Q.topLeftCorner(n, n) *= 200.0;
    // Riccati's equation, by the iteration that dynamic programming is.
    S = Q;
    for (int i = 0; i < 100000; ++i) {
      K = (R + B.transpose() * S * B).llt().solve(B.transpose() * S * A);
      MatrixX next = Q + A.transpose() * S * (A - B * K);
      next = (0.5 * (next + next.transpose())).eval();
      const double change = (next - S).norm() / next.norm();
      S = next;
      if (change < 1e-15) break;
    }
  }

  gdd::ValueGoal goal() const {
    const Eigen::Index n = A.rows() / 2;
    return gdd::ValueGoal(
        [this, n](const VectorX &q, const VectorX &v, VectorX &gradient, MatrixX &hessian) {
          VectorX x(2 * n);
          x << q, v;
          gradient = S * x;
          hessian = S;
          return 0.5 * x.dot(gradient);
        });
  }
};

/// Along a trajectory: worst difference from −K x, over |K x|, and from
/// (21), over V.
template <class Solver>
std::pair<double, double> worstOnTrajectory(bool passive) {
  Scene scene = railScene(passive);
  const Regulator lqr(scene);
  const int n = scene.model.nv;
  Greedy<Solver> greedy(scene, lqr.goal());
  Random random(5);
  VectorX x = random.vector(2 * n, 1.0);
  double worstControl = 0.0, worstBellman = 0.0;
  for (int i = 0; i < 100; ++i) {
    scene.state.q = x.head(n) + 0.5 * scene.model.options.timestep * x.tail(n);
    scene.state.v = x.tail(n);
    const VectorX all = greedy.control();
    EXPECT_EQ(greedy.report.status, gdd::GddStatus::converged);
    VectorX u(lqr.R.rows());
    for (std::size_t k = 0; k < lqr.actuated.size(); ++k) u[k] = all[lqr.actuated[k]];
    const VectorX expected = -lqr.K * x;
    worstControl = std::max(worstControl, (u - expected).norm() / expected.norm());
    const VectorX next = lqr.A * x + lqr.B * u;
    const double V = 0.5 * x.dot(lqr.S * x);
    const double right =
        0.5 * x.dot(lqr.Q * x) + 0.5 * u.dot(lqr.R * u) + 0.5 * next.dot(lqr.S * next);
    worstBellman = std::max(worstBellman, std::abs(V - right) / V);
    x = next;
  }
  return {worstControl, worstBellman};
}

TYPED_TEST(ValueFunction, OfRiccatiGivesLqr) {
  const auto [control, bellman] = worstOnTrajectory<TypeParam>(false);
  EXPECT_SMALL(control, 1e-10);
  EXPECT_SMALL(bellman, 1e-12);
}

TYPED_TEST(ValueFunction, OfRiccatiGivesLqrWithAPassiveJoint) {
  const auto [control, bellman] = worstOnTrajectory<TypeParam>(true);
  // Solver 1 ends with a force of 1e-10 of the largest on the joint that has none.
  constexpr bool kExact = std::is_same_v<TypeParam, gdd::ActiveSet>;
  EXPECT_SMALL(control, kExact ? 1e-10 : 1e-9);
  EXPECT_SMALL(bellman, 1e-12);
}

// ---- A nonlinear one
// ----------------------------------------------------------------------------

Scene pendulumScene(const PendulumPlant &plant) {
  ModelBuilder b = pendulum(0.5, 1.0, 0.05, 0.0, plant.damping);
  b.options.timestep = plant.h;
  return Scene(b.build());
}

PendulumPlant pendulumPlant() {
  PendulumPlant plant;
  plant.M = 0.5 * 0.5 + 0.4 * 0.05 * 0.05;
  plant.gravity = 9.81 * 0.5;
  plant.damping = 0.1;
  return plant;
}

gdd::ValueGoal goalOf(const PendulumValue &V) {
  return gdd::ValueGoal(
      [&V](const VectorX &q, const VectorX &v, VectorX &gradient, MatrixX &hessian) {
        const PendulumValue::Model model = V.model(q[0], v[0]);
        gradient = model.slope;
        hessian = model.curvature;
        return model.value;
      });
}

/// A way up under greedy control.
struct Swing {
  double cost = 0.0;   ///< summed
  double worst = 0.0;  ///< largest difference from the best control, over the weight [-]
  double left = 0.0;   ///< from upright and at rest, at the end
};

template <class Solver>
Swing swingUp(const PendulumPlant &plant, const PendulumValue &V, double q, double v) {
  Scene scene = pendulumScene(plant);
  Greedy<Solver> greedy(scene, goalOf(V));
  Swing swing;
  for (int i = 0; i < 300; ++i) {
    scene.state.q[0] = plant.middle(q, v);
    scene.state.v[0] = v;
    const double u = greedy.control()[0];
    double best = 0.0;
    V.backup(q, v, best);
    swing.worst = std::max(swing.worst, std::abs(u - best) / plant.gravity);
    swing.cost += plant.running(q, v, u);
    q = plant.middle(q, v);
    v += plant.h * plant.acceleration(q, v, u);
    q = plant.middle(q, v);
  }
  swing.left = std::hypot(std::remainder(q - std::numbers::pi, 2.0 * std::numbers::pi), v);
  return swing;
}

// What the greedy control costs until the pendulum stands is V at the start, up
// to the grid's error, which falls with the cube of its width.
TYPED_TEST(ValueFunction, OfAPendulumStandsItUpAtTheLeastCost) {
  const PendulumPlant plant = pendulumPlant();
  double error[2] = {};
  for (const int fine : {0, 1}) {
    const int nodes = fine ? 96 : 48;
    const PendulumValue V(plant, nodes, nodes + 1, 14.0);
    Random random(3);
    for (int i = 0; i < 6; ++i) {
      const double q = std::numbers::pi + random.uniform(-2.8, 2.8), v = random.uniform(-3.0, 3.0);
      const Swing swing = swingUp<TypeParam>(plant, V, q, v);
      EXPECT_SMALL(swing.worst, 1e-6);
      EXPECT_SMALL(swing.left, 1e-2);
      error[fine] += std::abs(swing.cost / V.at(q, v) - 1.0) / 6.0;
    }
  }
  if (std::getenv("SOFTGAUSS_TABLES"))
    std::cout << "mean difference of cost and V: " << error[0] << ", finer " << error[1] << '\n';
  EXPECT_SMALL(error[1], 0.003);
  EXPECT_LT(error[1], 0.3 * error[0]);
}

}  // namespace
}  // namespace softgauss::test
