// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/block_jacobian.hpp"

#include "softgauss/engine/dynamics/body_motion.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

using Matrix3X = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// A block between two bodies of a random forest, and the same by dense Jacobians.
struct Probe {
  Model model;
  Kinematics k;
  TreeSparsity tree;
  BlockJacobian J;
  std::vector<MatrixX> dense;
  std::vector<std::pair<int, int>> bodies;

  explicit Probe(std::uint64_t seed, int blocks = 12)
      : model(randomForest(seed).build()), k(model), tree(model) {
    Random random(seed);
    const State state = randomState(model, random);
    computeKinematics(model, state, k);
    Matrix3X Ja(3, model.nv), Jb(3, model.nv);
    for (int i = 0; i < blocks; ++i) {
      const int a = i == 0 ? 0 : random.index(model.bodyCount());
      const int b = i == 1 ? 0 : random.index(model.bodyCount());
      // One point in half of the blocks, two in the others; some with rotation, some that alone.
      RelativeMotion m;
      m.bodyA = a;
      m.bodyB = b;
      m.p_WA = m.p_WB = random.vector3(1.0);
      if (i % 2 == 1) m.p_WA += random.vector3(0.1);
      m.linear = random.rotation();
      m.angular = random.rotation();
      m.linearDim = random.chance(0.3) ? 1 : 3;
      m.angularDim = i % 3 == 2 ? 1 + random.index(3) : 0;
      if (i == 8) m.linearDim = 0;
      J.add(model, k, tree, m);
      MatrixX rows(m.linearDim + m.angularDim, model.nv);
      pointJacobian(model, k, a, m.p_WA, Ja);
      pointJacobian(model, k, b, m.p_WB, Jb);
      rows.topRows(m.linearDim) = m.linear.leftCols(m.linearDim).transpose() * (Jb - Ja);
      rotationJacobian(model, k, a, Ja);
      rotationJacobian(model, k, b, Jb);
      rows.bottomRows(m.angularDim) = m.angular.leftCols(m.angularDim).transpose() * (Jb - Ja);
      dense.push_back(rows);
      bodies.emplace_back(a, b);
    }
  }
};

TEST(BlockJacobian, IsTheDifferenceOfPointJacobians) {
  for (int seed = 0; seed < 30; ++seed) {
    const Probe p(seed);
    for (int i = 0; i < p.J.size(); ++i) {
      Eigen::RowVectorXd row(p.model.nv);
      for (int d = 0; d < p.J.block(i).dim; ++d) {
        p.J.denseRow(i, d, row);
        EXPECT_APPROX(row, p.dense[i].row(d), 1e-14)
            << "seed " << seed << ", bodies " << p.bodies[i].first << ", " << p.bodies[i].second;
      }
    }
  }
}

TEST(BlockJacobian, MultipliesAndTransposesAsDense) {
  for (int seed = 0; seed < 30; ++seed) {
    const Probe p(seed);
    Random random(seed);
    const VectorX a = random.vector(p.model.nv, 1.0);
    for (int i = 0; i < p.J.size(); ++i) {
      const int dim = p.J.block(i).dim;
      VectorX y(dim);
      p.J.multiply(i, a, y.data());
      EXPECT_APPROX(y, p.dense[i] * a, 1e-14);
      const VectorX f = random.vector(dim, 1.0);
      VectorX tau = a;
      p.J.addTransposed(i, f.data(), tau);
      EXPECT_APPROX(tau, a + p.dense[i].transpose() * f, 1e-14);
    }
  }
}

TEST(BlockJacobian, MultipliesAndTransposesByBodies) {
  for (int seed = 0; seed < 30; ++seed) {
    const Probe p(seed);
    Random random(seed);
    const VectorX a = random.vector(p.model.nv, 1.0);
    std::vector<Motion> A(p.model.bodies.size());
    moveBodies(p.model, p.k, a, A);
    for (int i = 0; i < p.J.size(); ++i) {
      const int dim = p.J.block(i).dim;
      VectorX y(dim);
      p.J.multiply(i, BodyMotion{a, A}, y.data());
      EXPECT_APPROX(y, p.dense[i] * a, 1e-14);
      const VectorX f = random.vector(dim, 1.0);
      VectorX tau = a;
      std::vector<Force> F(p.model.bodies.size());
      BodyForce force{tau, F};
      p.J.addTransposed(i, f.data(), force);
      addBodyForces(p.model, p.k, F, tau);
      EXPECT_APPROX(tau, a + p.dense[i].transpose() * f, 1e-14);
    }
  }
}

TEST(BlockJacobian, CurvatureIsJtHJ) {
  for (int seed = 0; seed < 30; ++seed) {
    Probe p(seed);
    Random random(seed);
    std::vector<Segment> segments;
    std::vector<int> setEnd;
    p.J.appendCouplings(segments, setEnd);
    TreeSparsity coupled;
    coupled.couple(p.tree, segments, setEnd);
    TreeMatrix P;
    P.resize(coupled);
    P.setZero();
    MatrixX expected = MatrixX::Zero(p.model.nv, p.model.nv);
    for (int i = 0; i < p.J.size(); ++i) {
      const int dim = p.J.block(i).dim;
      MatrixX H(dim, dim);
      for (double& x : H.reshaped()) x = random.uniform(-1.0, 1.0);
      H = (H + H.transpose()).eval();
      p.J.addCurvature(i, H.data(), P);
      expected += p.dense[i].transpose() * H * p.dense[i];
    }
    EXPECT_APPROX(P.dense(), expected, 1e-14) << "seed " << seed;
  }
}

TEST(BlockJacobian, CouplesExactlyWhereBothBranchesMove) {
  int coupling = 0, single = 0;
  for (int seed = 0; seed < 30; ++seed) {
    const Probe p(seed);
    for (int i = 0; i < p.J.size(); ++i) {
      // Two branches: some pair of dofs in the row, neither of which is an ancestor of the other.
      std::vector<int> dofs;
      for (int j = 0; j < p.model.nv; ++j)
        if (!p.dense[i].col(j).isZero(1e-14)) dofs.push_back(j);
      bool branches = false;
      for (const int j : dofs)
        for (const int l : dofs) {
          if (l >= j) continue;
          bool ancestor = false;
          for (int m = j; m >= 0; m = p.model.dofs[m].parent) ancestor |= m == l;
          branches |= !ancestor;
        }
      // A branch whose columns happen to vanish may still be marked.
      if (branches) {
        EXPECT_TRUE(p.J.block(i).couples);
      }
      (p.J.block(i).couples ? coupling : single) += 1;
    }
    for (const std::size_t i : {0u, 1u}) EXPECT_FALSE(p.J.block(static_cast<int>(i)).couples);
  }
  EXPECT_GT(coupling, 50);
  EXPECT_GT(single, 50);
}

TEST(BlockJacobian, LeavesOutDofsThatMoveBothBodies) {
  // Two links of the same floating humanoid: the pelvis' six dofs cancel exactly.
  const Model model = humanoid().build();
  Kinematics k(model);
  computeKinematics(model, State(model), k);
  const TreeSparsity tree(model);
  BlockJacobian J;
  RelativeMotion feet, leg;
  feet.bodyA = model.findJoint("left_foot");
  feet.bodyB = model.findJoint("right_foot");
  leg.bodyA = model.findJoint("left_thigh");
  leg.bodyB = model.findJoint("left_foot");
  feet.linearDim = leg.linearDim = 3;
  J.add(model, k, tree, feet);
  EXPECT_EQ(J.block(0).columns, 12);
  EXPECT_TRUE(J.block(0).couples);
  J.add(model, k, tree, leg);
  EXPECT_EQ(J.block(1).columns, 3);
  EXPECT_FALSE(J.block(1).couples);
  // Points apart: the pelvis turns one about the other.
  feet.p_WA = Vector3(0.01, 0.0, 0.0);
  J.add(model, k, tree, feet);
  EXPECT_EQ(J.block(2).columns, 18);
  EXPECT_TRUE(J.block(2).couples);
}

}  // namespace
}  // namespace softgauss::test
