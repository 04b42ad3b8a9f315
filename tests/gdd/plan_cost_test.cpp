// SPDX-License-Identifier: Apache-2.0
/// What plans cost, and the program in a box of a backward pass.

#include "softgauss/gdd/planning/plan_cost.hpp"

#include <Eigen/Eigenvalues>

#include "softgauss/gdd/planning/backward_pass.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

using namespace planning;

/// Slope and curvature of a term that is ½ |r|² are those of r, by differences of its value.
void expectModel(CostTerm& term, int seed) {
  Random random(seed);
  const Model model = randomFloatingTree(seed).build();
  const int n = model.nv;
  State state = randomState(model, random);
  Kinematics k(model);
  const auto value = [&](const VectorX& q, const VectorX& v) {
    State at = state;
    at.q = q, at.v = v;
    computeKinematics(model, at, k);
    return VectorX(VectorX::Constant(1, term.value({model, at.q, at.v, 0, &k})));
  };
  MatrixX expected(1, 2 * n);
  expected << configurationGradient(model, state.q,
                                    [&](const VectorX& q) { return value(q, state.v); }),
      gradient(state.v, [&](const VectorX& v) { return value(state.q, v); });
  value(state.q, state.v);
  ValueModel found(n);
  const double at =
      term.expand({model, state.q, state.v, 0, &k}, 2.0, found.slope, found.curvature);
  EXPECT_APPROX(found.slope.transpose(), 2.0 * expected, 1e-7) << seed;
  EXPECT_NEAR(at, value(state.q, state.v)[0], 1e-12 * std::abs(at));
  const MatrixX full = MatrixX(found.curvature.selfadjointView<Eigen::Lower>());
  EXPECT_GE(full.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-9 * full.norm());
}

TEST(PlanCost, SlopesAreThoseOfTheValue) {
  for (int seed = 0; seed < 10; ++seed) {
    Random random(seed + 50);
    const Model model = randomFloatingTree(seed).build();
    StateCost states(model, randomState(model, random).q);
    states.positionWeight = random.vector(model.nv, 1.0).cwiseAbs();
    states.velocityWeight = random.vector(model.nv, 1.0).cwiseAbs();
    expectModel(states, seed);
    const std::string frame = model.frames.back().name;
    PointCost point(model, frame, random.vector3(0.2), random.vector3(1.0), 2.0, 0.5);
    expectModel(point, seed);
    OrientationCost orientation(model, frame, random.rotation(), 3.0);
    expectModel(orientation, seed);
    CentroidalCost centroidal(model);
    centroidal.centre(random.vector3(1.0), 5.0);
    centroidal.momentum(random.vector3(1.0), 0.5);
    centroidal.angularMomentum(0.3);
    expectModel(centroidal, seed);
  }
}

TEST(BoxProgram, IsAtItsMinimum) {
  Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const int m = 1 + random.index(8);
    MatrixX A(m, m);
    for (double& x : A.reshaped()) x = random.uniform(-1.0, 1.0);
    const MatrixX H = A * A.transpose() + 0.1 * MatrixX::Identity(m, m);
    const VectorX g = random.vector(m, 3.0), lower = -random.vector(m, 1.0).cwiseAbs(),
                  upper = random.vector(m, 1.0).cwiseAbs();
    VectorX x = VectorX::Zero(m);
    BoxProgram program(m);
    ASSERT_TRUE(program.solve(H, g, lower, upper, x));
    const VectorX slope = H * x + g;
    for (int i = 0; i < m; ++i) {
      EXPECT_GE(x[i], lower[i]);
      EXPECT_LE(x[i], upper[i]);
      if (x[i] > lower[i] && x[i] < upper[i])
        EXPECT_NEAR(slope[i], 0.0, 1e-9);
      else
        EXPECT_GE(slope[i] * (x[i] == lower[i] ? 1.0 : -1.0), -1e-9);
    }
  }
}

}  // namespace
}  // namespace softgauss::test
