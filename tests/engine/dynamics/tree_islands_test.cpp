// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_islands.hpp"

#include <gtest/gtest.h>

#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

int treeOf(const Model& model, int body) { return model.bodies[idx(body)].tree; }

/// (trees × trees) who is reached from whom, by Warshall's algorithm.
std::vector<std::vector<bool>> reach(const Model& model,
                                     const std::vector<std::pair<int, int>>& pairs) {
  const std::size_t n = model.trees.size();
  std::vector<std::vector<bool>> together(n, std::vector<bool>(n));
  for (std::size_t t = 0; t < n; ++t) together[t][t] = true;
  for (const auto& [bodyA, bodyB] : pairs) {
    const int a = treeOf(model, bodyA), b = treeOf(model, bodyB);
    if (a >= 0 && b >= 0) together[idx(a)][idx(b)] = together[idx(b)][idx(a)] = true;
  }
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (together[i][k] && together[k][j]) together[i][j] = true;
  return together;
}

/// Counts in `seen` what is in the segments of an island.
void countSegments(Segments segments, std::vector<int>& seen) {
  int before = -1;
  for (const Segment s : segments) {
    EXPECT_LT(before, s.begin);  // ascending, and neighbours are one segment
    EXPECT_LT(s.begin, s.end);
    before = s.end;
    for (int i = s.begin; i < s.end; ++i) ++seen[idx(i)];
  }
}

/// Eight chains of one to three links.
Model chains(int seed) {
  ModelBuilder builder("chains");
  for (int i = 0; i < 8; ++i) builder.add(chain(1 + (seed + i) % 3), "chain" + std::to_string(i));
  return builder.build();
}

TEST(TreeIslands, AreTreesThatPairsReach) {
  int several = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const Model model = chains(seed);
    Random random(seed);
    std::vector<std::pair<int, int>> pairs;
    for (int i = 0; i < seed % 7; ++i)
      pairs.emplace_back(random.index(model.bodyCount()), random.index(model.bodyCount()));
    TreeIslands islands(model);
    EXPECT_EQ(islands.size(), static_cast<int>(model.trees.size()));
    islands.find(model, pairs);
    const auto together = reach(model, pairs);
    for (int a = 1; a < model.bodyCount(); ++a)
      for (int b = 1; b < model.bodyCount(); ++b)
        EXPECT_EQ(islands.ofBody()[idx(a)] == islands.ofBody()[idx(b)],
                  together[idx(treeOf(model, a))][idx(treeOf(model, b))]);
    std::vector<int> bodies(model.bodies.size()), dofs(idx(model.nv));
    for (int i = 0; i < islands.size(); ++i) {
      countSegments(islands.bodies(i), bodies);
      countSegments(islands.dofs(i), dofs);
      for (const Segment s : islands.bodies(i))
        for (int b = s.begin; b < s.end; ++b) EXPECT_EQ(islands.ofBody()[idx(b)], i);
    }
    bodies.erase(bodies.begin());  // the world is of none
    EXPECT_EQ(bodies, std::vector<int>(bodies.size(), 1));
    EXPECT_EQ(dofs, std::vector<int>(dofs.size(), 1));
    several += islands.size() > 1 && islands.size() < static_cast<int>(model.trees.size());
  }
  EXPECT_GT(several, 10);
}

// Who is still is of none, and ties nobody.
TEST(TreeIslands, LeaveOutWhoIsStill) {
  const Model model = chains(0);
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t t = 0; t + 1 < model.trees.size(); ++t)
    pairs.emplace_back(model.trees[t].rootBody, model.trees[t + 1].rootBody);
  std::vector<std::uint8_t> still(model.trees.size(), 0);
  still[3] = 1;
  TreeIslands islands(model);
  islands.find(model, pairs, still);
  ASSERT_EQ(islands.size(), 2);
  for (std::size_t t = 0; t < model.trees.size(); ++t)
    EXPECT_EQ(islands.ofBody()[idx(model.trees[t].rootBody)], t < 3 ? 0 : t == 3 ? -1 : 1);
  EXPECT_EQ(islands.bodies(0).size(), 1u);
  EXPECT_EQ(islands.dofs(1).front().begin, model.trees[4].firstDof);
}

}  // namespace
}  // namespace softgauss::test
