// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What every goal owes: a cost whose gradient and curvature are those of its value, and the
/// minimum of (8.1) where nothing bounds it.

#include <Eigen/Cholesky>

#include "softgauss/gdd/gdd.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {

/// A goal's cost at a state. The scene's stages must be computed.
class GoalCheck {
 public:
  GoalCheck(const Scene& scene, const gdd::Goal& goal)
      : scene_(scene), cost_(scene.model.nv), M_(scene.data->inertia.M) {
    goal.addCost({scene.model, scene.state, *scene.data}, cost_);
  }

  double value(const VectorX& a) const { return cost_.value(a, times(a)); }
  VectorX gradient(const VectorX& a) const {
    VectorX g(a.size());
    cost_.gradient(a, times(a), g);
    return g;
  }
  /// ∇²ℓ, as the solver adds it up.
  MatrixX hessian() {
    const TreeSparsity dense = TreeSparsity::dense(scene_.model.nv);
    TreeMatrix H;
    H.resize(dense);
    H.setZero();
    H.add(M_, cost_.metricWeight());
    cost_.addRowCurvature(H);
    return H.dense();
  }

  /// ℓ is quadratic, so differences over any step are exact: worst error of ∇ℓ, dᵀ∇²ℓ d and ∇²ℓ,
  /// relative to their size.
  double differenceError(Random& random) {
    const int n = scene_.model.nv;
    const VectorX a = random.vector(n, 10.0), d = random.vector(n, 10.0);
    const double plus = value(a + d), minus = value(a - d), here = value(a);
    const double size = std::abs(plus) + std::abs(minus) + std::abs(here) + 1e-300;
    const MatrixX H = hessian();
    const double slope = gradient(a).dot(d), bend = cost_.curvatureAlong(d, times(d));
    const VectorX change = gradient(a + d) - gradient(a);
    const double scale = gradient(a + d).norm() + gradient(a).norm() + 1e-300;
    return std::max({std::abs(0.5 * (plus - minus) - slope) / size,
                     std::abs(plus - 2.0 * here + minus - bend) / size,
                     std::abs(d.dot(H * d) - bend) / size, (H * d - change).norm() / scale});
  }

  /// (M + ∇²ℓ) a = −c − ∇ℓ(0): the minimum without rows, boxes and unactuated dofs.
  VectorX closedForm() {
    const int n = scene_.model.nv;
    const VectorX zero = VectorX::Zero(n);
    const MatrixX K = M_.dense() + hessian();
    return K.llt().solve(-scene_.data->forces.c - gradient(zero));
  }
  /// What the solver finds.
  VectorX solved() {
    gdd::AugmentedLagrangian solver(scene_.model);
    const gdd::ControlLimits limits(scene_.model);
    const gdd::GddReport report =
        solver.solve(scene_.model, cost_, limits, *scene_.data, scene_.state.warmstart);
    EXPECT_EQ(report.status, gdd::GddStatus::converged);
    return solver.acceleration();
  }

 private:
  VectorX times(const VectorX& a) const {
    VectorX Ma(a.size());
    M_.multiply(a, Ma);
    return Ma;
  }

  const Scene& scene_;
  gdd::GoalCost cost_;
  const TreeMatrix& M_;
};

/// A fixed arm of seven driven hinges without boxes, in a random state.
inline Scene drivenArm(std::uint64_t seed) {
  Random random(seed);
  Scene scene(chain(7).build());
  scene.state = randomState(scene.model, random);
  EXPECT_EQ(scene.stages(), SolveStatus::converged);
  return scene;
}

/// Two trees of every joint kind, one of them floating, in a random state.
inline Scene looseScene(std::uint64_t seed) { return randomScene(seed, 0); }

/// Kinematics at a state.
inline Kinematics kinematicsAt(const Model& model, const State& state) {
  Kinematics k(model);
  computeKinematics(model, state, k);
  return k;
}

/// Rate of a feature f(kinematics) as the scene moves with the acceleration a: a law of motion that
/// knows nothing of Jacobians.
template <class F>
auto rateAlong(const Scene& scene, const VectorX& a, F&& f) {
  return alongTrajectory(scene.model, scene.state, a,
                         [&](const State& state) { return f(kinematicsAt(scene.model, state)); });
}

/// What a law of (8.1) says of one goal, over random scenes: differences, closed form.
/// make(model, random) gives the goal.
template <class Make>
void expectLawsOfGoals(Make&& make) {
  double difference = 0.0, minimum = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed + 900);
    const Scene loose = looseScene(seed);
    const auto goal = make(loose, random);
    difference = std::max(difference, GoalCheck(loose, *goal).differenceError(random));
    const Scene arm = drivenArm(seed);
    const auto reachable = make(arm, random);
    GoalCheck check(arm, *reachable);
    const VectorX expected = check.closedForm();
    minimum = std::max(minimum, (check.solved() - expected).norm() / expected.norm());
  }
  // Cancellation of a few terms of one size.
  EXPECT_SMALL(difference, 1e-12);
  EXPECT_SMALL(minimum, 1e-12);
}

/// A moving link, by name, and its body.
inline int randomMovingFrame(const Model& model, Random& random) {
  for (;;) {
    const int frame = random.index(static_cast<int>(model.frames.size()));
    if (model.bodies[model.frames[frame].body].dofs > 0) return frame;
  }
}

}  // namespace softgauss::test
