// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/articulated_factor.hpp"

#include <Eigen/Cholesky>

#include "softgauss/engine/constraints/block_jacobian.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// A forest, rows between its bodies, and P = M̂ + diag + Jᵀ H J of them: by articulated bodies, and
/// dense by columns of J.
struct Elimination {
  Model model;
  Kinematics k;
  MassMatrix inertia;
  BlockJacobian J;
  ArticulatedFactor factor;
  MatrixX P;

  Elimination(Model made, std::uint64_t seed, int blocks, double stiffness)
      : model(std::move(made)), k(model), inertia(model), factor(model) {
    Random random(seed);
    computeKinematics(model, randomState(model, random), k);
    computeMassMatrix(model, k, inertia);
    for (int i = 0; i < model.nv; i += 3) inertia.added[i] = random.uniform(0.0, 0.5);
    for (int i = 0; i < blocks; ++i) addBlock(random, i);
    std::vector<std::pair<int, int>> pairs;
    J.appendPairs(pairs);
    factor.couple(pairs);
    factor.begin(model, inertia);
    P = inertia.M.dense();
    P.diagonal() += inertia.added;
    for (int i = 0; i < J.size(); ++i) {
      const int dim = J.block(i).dim;
      MatrixX root(dim, dim), rows(dim, model.nv);
      for (double& x : root.reshaped()) x = random.uniform(-1.0, 1.0);
      const MatrixX H = stiffness * root * root.transpose();
      J.addCurvature(i, H.data(), factor);
      Eigen::RowVectorXd row(model.nv);
      for (int d = 0; d < dim; ++d) {
        J.denseRow(i, d, row);
        rows.row(d) = row;
      }
      P += rows.transpose() * H * rows;
    }
    for (int i = 0; i < model.nv; i += 4) {
      const double h = random.uniform(0.0, stiffness);
      factor.addJoint(i, h);
      P(i, i) += h;
    }
  }

  /// One point or two, with and without rotation; with the world and between any bodies.
  void addBlock(Random& random, int i) {
    RelativeMotion m;
    m.bodyA = i % 4 == 0 ? 0 : random.index(model.bodyCount());
    m.bodyB = i % 7 == 1 ? 0 : random.index(model.bodyCount());
    m.p_WA = m.p_WB = random.vector3(1.0);
    if (i % 5 == 1) m.p_WA += random.vector3(0.1);
    m.linear = random.rotation();
    m.angular = random.rotation();
    m.linearDim = random.chance(0.3) ? 1 : 3;
    m.angularDim = i % 3 == 2 ? 1 + random.index(3) : 0;
    J.add(model, k, inertia.sparsity, m);
  }

  /// Rows of two joints anywhere.
  void addPairs(Random& random, int count, double stiffness) {
    for (int i = 0; i < count; ++i) {
      const int first = random.index(model.nv), second = random.index(model.nv);
      if (first == second) continue;
      const double slope = random.uniform(-2.0, 2.0), h = random.uniform(0.1, 1.0) * stiffness;
      factor.addJoints({first, second, slope}, h);
      VectorX row = VectorX::Zero(model.nv);
      row[first] = 1.0;
      row[second] = -slope;
      P += h * row * row.transpose();
    }
  }

  /// |P x − b| over what rounding of P x is measured by, and whether the bodies move as x says.
  void check(std::uint64_t seed, double tolerance) {
    ASSERT_TRUE(factor.factor(model, k)) << "seed " << seed;
    Random random(seed);
    const VectorX b = random.vector(model.nv, 1.0);
    VectorX x = b;
    std::vector<Motion> A(model.bodies.size()), expected(model.bodies.size());
    factor.solve(model, k, x, A);
    const double size = (P.cwiseAbs() * x.cwiseAbs() + b.cwiseAbs()).maxCoeff();
    EXPECT_SMALL((P * x - b).cwiseAbs().maxCoeff() / size, tolerance) << "seed " << seed;
    moveBodies(model, k, x, expected);
    for (std::size_t body = 1; body < A.size(); ++body) {
      EXPECT_APPROX(A[body].angular, expected[body].angular, 1e-12);
      EXPECT_APPROX(A[body].linear, expected[body].linear, 1e-12);
    }
  }
};

Model freeBodies(int count, std::uint64_t seed) {
  Random random(seed);
  ModelBuilder builder("bodies");
  builder.link(emptyLink("world"));
  for (int i = 0; i < count; ++i) {
    const std::string name = "b" + std::to_string(i);
    builder.link(randomLink(name, random));
    builder.joint(jointSpec("to " + name, JointType::floating, "world", name));
  }
  return builder.build();
}

TEST(ArticulatedFactor, SolvesAsDenseWithoutRows) {
  for (int seed = 0; seed < 30; ++seed)
    Elimination(randomForest(seed).build(), seed, 0, 0.0).check(seed, 1e-14);
}

TEST(ArticulatedFactor, SolvesAsDenseWithRowsOfOneBodyAndOfTwo) {
  RandomTreeOptions options;
  options.trees = 3;
  for (int seed = 0; seed < 100; ++seed)
    Elimination(randomForest(seed, options).build(), seed, 1 + seed % 20, 1.0).check(seed, 1e-12);
}

TEST(ArticulatedFactor, SolvesAsDenseWhereRowsAreStiff) {
  // What rounding leaves of a stiffness that common ancestors do not feel is of its size.
  for (const double stiffness : {1e3, 1e6, 1e9})
    for (int seed = 0; seed < 40; ++seed)
      Elimination(randomForest(seed).build(), seed, 6, stiffness).check(seed, 1e-12);
}

TEST(ArticulatedFactor, SolvesAsDenseForFreeBodiesThatTouch) {
  for (int seed = 0; seed < 20; ++seed)
    Elimination(freeBodies(20, seed), seed, 40, 10.0).check(seed, 1e-12);
}

TEST(ArticulatedFactor, SolvesAsDenseWithRowsOfTwoJoints) {
  for (const double stiffness : {1.0, 1e4, 1e8})
    for (int seed = 0; seed < 40; ++seed) {
      Elimination e(randomForest(seed).build(), seed, seed % 5, 1.0);
      Random random(seed);
      e.addPairs(random, 1 + seed % 6, stiffness);
      e.check(seed, 1e-12);
    }
}

// A locked joint is one of infinite inertia: the others move as if it were not there.
TEST(ArticulatedFactor, LeavesLockedJointsOut) {
  for (int seed = 0; seed < 40; ++seed) {
    Elimination e(randomForest(seed).build(), seed, seed % 5, 1.0);
    VectorX x = Random(seed).vector(e.model.nv, 1.0), expected = x;
    MatrixX P = e.P;
    for (int i = seed % 2; i < e.model.nv; i += 2) {
      e.factor.lock(i);
      P.row(i).setZero();
      P.col(i).setZero();
      P(i, i) = 1.0;
      expected[i] = 0.0;
    }
    ASSERT_TRUE(e.factor.factor(e.model, e.k));
    std::vector<Motion> A(e.model.bodies.size());
    e.factor.solve(e.model, e.k, x, A);
    EXPECT_APPROX(x, P.llt().solve(expected), 1e-10) << "seed " << seed;
  }
}

TEST(ArticulatedFactor, SolvesAsDenseForALongChain) {
  for (int seed = 0; seed < 3; ++seed)
    Elimination(chain(100).build(), seed, 60, 1.0).check(seed, 1e-12);
}

TEST(ArticulatedFactor, NamesTheJointWithoutInertia) {
  ModelBuilder builder("two");
  builder.link(emptyLink("world"));
  builder.link(sphereLink("ball", 1.0, 0.1));
  builder.joint(jointSpec("slide", JointType::prismatic, "world", "ball"));
  const Model model = builder.build();
  Kinematics k(model);
  computeKinematics(model, State(model), k);
  MassMatrix inertia(model);
  computeMassMatrix(model, k, inertia);
  inertia.added[0] = -1.0;
  ArticulatedFactor factor(model);
  factor.begin(model, inertia);
  EXPECT_FALSE(factor.factor(model, k));
  EXPECT_EQ(factor.failedJoint(), 0);
}

TEST(EliminationOrder, TakesFewestCouplingsFirst) {
  // A star of 20: the middle last or with one that is left, and nothing is filled in.
  const Model model = freeBodies(20, 1);
  EliminationOrder order(model);
  std::vector<std::pair<int, int>> pairs;
  for (int b = 2; b < model.bodyCount(); ++b) pairs.emplace_back(b, 1);
  order.find(pairs);
  EXPECT_EQ(order.blocks(), 19);
  int after = 0;
  for (int b = 2; b < model.bodyCount(); ++b) after += order.isBefore(1, b);
  EXPECT_LE(after, 1);
}

TEST(EliminationOrder, PutsBodiesAfterTheirChildren) {
  for (int seed = 0; seed < 20; ++seed) {
    const Model model = randomForest(seed).build();
    EliminationOrder order(model);
    Random random(seed);
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < seed; ++i) {
      const int a = 1 + random.index(model.bodyCount() - 1),
                b = 1 + random.index(model.bodyCount() - 1);
      if (a != b) pairs.emplace_back(a, b);
    }
    order.find(pairs);
    ASSERT_EQ(order.steps(order.part(0).steps).size(), model.bodies.size() - 1);
    for (int b = 1; b < model.bodyCount(); ++b) {
      if (model.bodies[b].parent == 0) continue;
      EXPECT_TRUE(order.isBefore(b, model.bodies[b].parent));
    }
  }
}

}  // namespace
}  // namespace softgauss::test
