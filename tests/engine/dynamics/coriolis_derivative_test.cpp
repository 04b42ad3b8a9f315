// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/coriolis_derivative.hpp"

#include <Eigen/LU>

#include "softgauss/engine/dynamics/tree_lu.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

constexpr int kSeeds = 40;

MatrixX dense(const Model& model, const TreePair& A) {
  MatrixX full = MatrixX::Zero(model.nv, model.nv);
  for (int i = 0; i < model.nv; ++i) {
    full(i, i) = A.lower.row(i)[i];
    for (int j = model.dofs[i].parent; j >= 0; j = model.dofs[j].parent) {
      full(i, j) = A.lower.row(i)[j];
      full(j, i) = A.upper.row(i)[j];
    }
  }
  return full;
}

TreePair massPlus(const Scene& s, double scale) {
  TreePair A;
  CoriolisDerivative(s.model).addTo(s.model, s.data->kinematics, s.data->inertia, scale, A);
  return A;
}

// b is quadratic in v, so that central differences are exact at any length: here 1.
TEST(CoriolisDerivative, IsTheDerivativeOfTheBias) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Scene s = randomScene(seed, 0);
    const int n = s.model.nv;
    RneaWorkspace work(s.model);
    MatrixX expected(n, n);
    VectorX plus(n), minus(n);
    for (int j = 0; j < n; ++j) {
      computeBiasAt(s.model, s.data->kinematics, s.data->inertia, s.state.v + VectorX::Unit(n, j),
                    work, plus);
      computeBiasAt(s.model, s.data->kinematics, s.data->inertia, s.state.v - VectorX::Unit(n, j),
                    work, minus);
      expected.col(j) = 0.5 * (plus - minus);
    }
    EXPECT_GT(expected.norm(), 0.1);
    EXPECT_GT((expected - expected.transpose()).norm(), 0.1);
    const MatrixX found = dense(s.model, massPlus(s, 1.0)) - dense(s.model, massPlus(s, 0.0));
    // Differences of forces of O(100).
    EXPECT_APPROX(found, expected, 1e-12) << "seed " << seed;
  }
}

TEST(CoriolisDerivative, WithoutScaleIsTheMassMatrix) {
  const Scene s = randomScene(3, 0);
  EXPECT_APPROX(dense(s.model, massPlus(s, 0.0)), s.data->inertia.M.dense(), 1e-15);
}

TEST(TreeLu, SolvesWhatADenseSolverSolves) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Scene s = randomScene(seed, 0);
    TreePair A = massPlus(s, 0.01);
    const MatrixX full = dense(s.model, A);
    Random random(seed);
    const VectorX b = random.vector(s.model.nv, 10.0);
    VectorX x = b;
    TreeLu lu;
    ASSERT_TRUE(lu.compute(s.model, A));
    lu.solve(s.model, A, x);
    // Condition numbers reach 1e5.
    EXPECT_APPROX(x, full.partialPivLu().solve(b), 1e-10) << "seed " << seed;
  }
}

TEST(TreeLu, RefusesWhatIsNoMassMatrixAnyMore) {
  Scene s = randomScene(1, 0);
  s.state.v *= 1e6;
  s.stages();
  TreePair A = massPlus(s, 1.0);
  EXPECT_FALSE(TreeLu().compute(s.model, A));
}

}  // namespace
}  // namespace softgauss::test
