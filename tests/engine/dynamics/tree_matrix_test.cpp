// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_matrix.hpp"

#include <Eigen/Cholesky>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// Coupled sets: pairs of whole branches, as contacts between bodies make them.
struct Couplings {
  std::vector<Segment> segments;
  std::vector<int> setEnd;
};

Couplings randomCouplings(const TreeSparsity& tree, Random& random, int sets) {
  Couplings c;
  for (int i = 0; i < sets; ++i) {
    int a = random.index(tree.size()), b = random.index(tree.size());
    if (a > b) std::swap(a, b);
    // All ancestors of both, ascending.
    std::vector<bool> in(static_cast<std::size_t>(tree.size()), false);
    for (const int row : {a, b})
      for (const Segment* s = tree.begin(row); s != tree.end(row); ++s)
        for (int j = s->begin; j < s->end; ++j) in[j] = true;
    for (int j = 0; j < tree.size(); ++j)
      if (in[j] && (j == 0 || !in[j - 1]))
        c.segments.push_back({j, j + 1});
      else if (in[j])
        c.segments.back().end = j + 1;
    c.setEnd.push_back(static_cast<int>(c.segments.size()));
  }
  return c;
}

/// True where the pattern has an entry, both triangles.
Eigen::Matrix<bool, -1, -1> patternOf(const TreeSparsity& sparsity) {
  Eigen::Matrix<bool, -1, -1> P =
      Eigen::Matrix<bool, -1, -1>::Constant(sparsity.size(), sparsity.size(), false);
  for (int i = 0; i < sparsity.size(); ++i)
    for (const Segment* s = sparsity.begin(i); s != sparsity.end(i); ++s)
      for (int j = s->begin; j < s->end; ++j) P(i, j) = P(j, i) = true;
  return P;
}

/// A random positive definite matrix on a pattern: diagonally dominant.
TreeMatrix randomMatrix(const TreeSparsity& sparsity, Random& random) {
  TreeMatrix A;
  A.resize(sparsity);
  A.setZero();
  for (int i = 0; i < A.size(); ++i)
    for (const Segment* s = sparsity.begin(i); s != sparsity.end(i); ++s)
      for (int j = s->begin; j < s->end; ++j)
        A.row(i)[j] = i == j ? 2.0 * A.size() : random.uniform(-1.0, 1.0);
  return A;
}

// The dense factorisation that LᵀDL is: from the last row to the first.
TEST(TreeFactor, SolvesAsDenseCholesky) {
  for (int seed = 0; seed < 30; ++seed) {
    const Model model = randomForest(seed).build();
    Random random(seed);
    const TreeSparsity tree(model);
    const TreeMatrix A = randomMatrix(tree, random);
    TreeFactor factor;
    ASSERT_TRUE(factor.compute(A));
    const VectorX b = random.vector(model.nv, 1.0);
    VectorX x = b;
    factor.solve(x);
    // Well conditioned: rounding only.
    EXPECT_APPROX(x, A.dense().llt().solve(b), 1e-14) << "seed " << seed;
  }
}

TEST(TreeFactor, SolvesOnCoupledPatterns) {
  for (int seed = 0; seed < 30; ++seed) {
    const Model model = randomForest(seed).build();
    Random random(seed);
    const TreeSparsity tree(model);
    const Couplings c = randomCouplings(tree, random, 1 + seed % 4);
    TreeSparsity coupled;
    coupled.couple(tree, c.segments, c.setEnd);
    const TreeMatrix A = randomMatrix(coupled, random);
    TreeFactor factor;
    ASSERT_TRUE(factor.compute(A));
    const VectorX b = random.vector(model.nv, 1.0);
    VectorX x = b;
    factor.solve(x);
    EXPECT_APPROX(x, A.dense().llt().solve(b), 1e-14) << "seed " << seed;
  }
}

// A step keeps its memory while contacts come and go: what an earlier pattern left between the
// entries of a row must not matter.
TEST(TreeFactor, ForgetsThePatternsBefore) {
  const Model model = randomForest(12).build();
  Random random(12);
  const TreeSparsity tree(model);
  TreeSparsity coupled;
  TreeMatrix P;
  TreeFactor factor;
  for (int trial = 0; trial < 40; ++trial) {
    const Couplings c = randomCouplings(tree, random, trial % 5);
    coupled.couple(tree, c.segments, c.setEnd);
    const TreeMatrix A = randomMatrix(coupled, random), M = randomMatrix(tree, random);
    P.resize(coupled);
    P.assign(A);
    P.add(M);
    ASSERT_TRUE(factor.compute(trial % 2 == 0 ? P : M));
    const VectorX b = random.vector(model.nv, 1.0);
    VectorX x = b;
    factor.solve(x);
    const MatrixX dense = M.dense() + (trial % 2 == 0 ? A.dense() : MatrixX(0.0 * A.dense()));
    EXPECT_APPROX(x, dense.llt().solve(b), 1e-14) << trial;
  }
}

TEST(TreeFactor, IsLTransposeDL) {
  const Model model = randomForest(7).build();
  Random random(7);
  const TreeSparsity tree(model);
  const TreeMatrix A = randomMatrix(tree, random);
  TreeFactor factor;
  ASSERT_TRUE(factor.compute(A));
  MatrixX L = MatrixX::Identity(model.nv, model.nv);
  VectorX D(model.nv);
  for (int k = 0; k < model.nv; ++k) {
    D[k] = 1.0 / factor.inversePivot(k);
    for (const Segment* s = tree.begin(k); s != tree.end(k); ++s)
      for (int j = s->begin; j < std::min(s->end, k); ++j) L(k, j) = factor.lowerRow(k)[j];
  }
  EXPECT_APPROX(L.transpose() * D.asDiagonal() * L, A.dense(), 1e-14);
}

TEST(TreeFactor, HalvesMakeTheWholeAndTheQuadraticForm) {
  for (int seed = 0; seed < 10; ++seed) {
    const Model model = randomForest(seed).build();
    Random random(seed);
    const TreeSparsity tree(model);
    const TreeMatrix A = randomMatrix(tree, random);
    TreeFactor factor;
    ASSERT_TRUE(factor.compute(A));
    const VectorX b = random.vector(model.nv, 1.0);
    VectorX half = b, whole = b;
    factor.solve(whole);
    factor.solveTransposed(half);
    double form = 0.0;
    for (int k = 0; k < model.nv; ++k) form += half[k] * half[k] * factor.inversePivot(k);
    EXPECT_SMALL(form / b.dot(whole) - 1.0, 1e-13);
    for (int k = 0; k < model.nv; ++k) half[k] *= factor.inversePivot(k);
    factor.solveLower(half);
    EXPECT_EQ(half, whole);
  }
}

TEST(TreeFactor, AddsADiagonal) {
  const Model model = randomForest(8).build();
  Random random(8);
  const TreeSparsity tree(model);
  const TreeMatrix A = randomMatrix(tree, random);
  const VectorX d = random.vector(model.nv, 1.0).cwiseAbs(), b = random.vector(model.nv, 1.0);
  TreeFactor factor;
  ASSERT_TRUE(factor.compute(A, d.data()));
  VectorX x = b;
  factor.solve(x);
  EXPECT_APPROX(x, (A.dense() + MatrixX(d.asDiagonal())).llt().solve(b), 1e-14);
}

TEST(TreeFactor, RefusesWhatIsNotPositiveDefinite) {
  const Model model = randomForest(9).build();
  Random random(9);
  const TreeSparsity tree(model);
  const TreeMatrix good = randomMatrix(tree, random);
  TreeFactor factor;
  for (const int i : {0, model.nv / 2, model.nv - 1})
    for (const double bad : {0.0, -1.0, kNaN, kInfinity}) {
      TreeMatrix A = good;
      A.row(i)[i] = bad;
      EXPECT_FALSE(factor.compute(A)) << i << " " << bad;
    }
  EXPECT_TRUE(factor.compute(good));

  // Positive diagonal, yet indefinite: [[1, 2], [2, 1]].
  const Model two = chain(2).build();
  const TreeSparsity pair(two);
  TreeMatrix A;
  A.resize(pair);
  A.row(0)[0] = A.row(1)[1] = 1.0;
  A.row(1)[0] = 2.0;
  EXPECT_FALSE(factor.compute(A));
}

TEST(TreeSparsity, OfATreeIsItsAncestors) {
  const Model model = randomForest(10).build();
  const auto P = patternOf(TreeSparsity(model));
  for (int i = 0; i < model.nv; ++i)
    for (int j = 0; j <= i; ++j) {
      bool ancestor = false;
      for (int k = i; k >= 0; k = model.dofs[k].parent) ancestor |= k == j;
      EXPECT_EQ(P(i, j), ancestor) << i << ", " << j;
    }
}

TEST(TreeSparsity, CoupledContainsProductsAndIsClosedUnderElimination) {
  for (int seed = 0; seed < 30; ++seed) {
    const Model model = randomForest(seed).build();
    Random random(seed);
    const TreeSparsity tree(model);
    const Couplings c = randomCouplings(tree, random, 3);
    TreeSparsity coupled;
    coupled.couple(tree, c.segments, c.setEnd);
    const auto P = patternOf(coupled), T = patternOf(tree);
    EXPECT_TRUE((T.array() <= P.array()).all());
    int begin = 0;
    for (const int end : c.setEnd) {
      for (int s = begin; s < end; ++s)
        for (int t = begin; t < end; ++t)
          EXPECT_TRUE(P.block(c.segments[s].begin, c.segments[t].begin,
                              c.segments[s].end - c.segments[s].begin,
                              c.segments[t].end - c.segments[t].begin)
                          .all());
      begin = end;
    }
    for (int k = 0; k < model.nv; ++k)
      for (int i = 0; i < k; ++i)
        for (int j = 0; j < i; ++j)
          if (P(k, i) && P(k, j)) {
            EXPECT_TRUE(P(i, j)) << k << ": " << i << ", " << j;
          }
  }
}

TEST(TreeSparsity, CouplesAcrossMoreThan64Dofs) {
  RandomTreeOptions options;
  options.trees = 12;
  options.links = 12;
  const Model forest = randomForest(2, options).build();
  ASSERT_GT(forest.nv, 130);
  Random random(1);
  const TreeSparsity sparse(forest);
  const Couplings c = randomCouplings(sparse, random, 8);
  TreeSparsity coupled;
  coupled.couple(sparse, c.segments, c.setEnd);
  const TreeMatrix A = randomMatrix(coupled, random);
  TreeFactor factor;
  ASSERT_TRUE(factor.compute(A));
  VectorX x = random.vector(forest.nv, 1.0);
  const VectorX b = x;
  factor.solve(x);
  EXPECT_APPROX(x, A.dense().llt().solve(b), 1e-14);
}

TEST(TreeMatrix, MultipliesAddsAndAssignsAsDense) {
  const Model model = randomForest(11).build();
  Random random(11);
  const TreeSparsity tree(model);
  const Couplings c = randomCouplings(tree, random, 2);
  TreeSparsity coupled;
  coupled.couple(tree, c.segments, c.setEnd);
  const TreeMatrix A = randomMatrix(tree, random), B = randomMatrix(coupled, random);
  const VectorX x = random.vector(model.nv, 1.0);
  VectorX y = VectorX::Constant(model.nv, kNaN);
  B.multiply(x, y);
  EXPECT_APPROX(y, B.dense() * x, 1e-14);

  TreeMatrix C;
  C.resize(coupled);
  C.assign(A);
  EXPECT_EQ(C.dense(), A.dense());
  C.assign(B);
  EXPECT_EQ(C.dense(), B.dense());
  C.add(A, -0.5);
  EXPECT_APPROX(C.dense(), B.dense() - 0.5 * A.dense(), 1e-14);
}

TEST(TreeSparsity, DenseCouplesAll) { EXPECT_TRUE(patternOf(TreeSparsity::dense(5)).all()); }

}  // namespace
}  // namespace softgauss::test
