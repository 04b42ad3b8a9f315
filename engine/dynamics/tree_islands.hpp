// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Islands of trees: two trees are of one where rows couple them, directly or through others.
///
/// P = M + Jᵀ∇²s J has no entry between two islands, so the objective of (1.1) is the sum of theirs
/// and each is minimised by itself, in its own number of iterations: what one comes to does not
/// depend, to the last bit, on who else is in the scene. A tree without rows of two trees is an
/// island. Islands are in the order of their first trees. Trees that are asleep are of none.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "softgauss/engine/core/segment.hpp"
#include "softgauss/engine/core/union_find.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss {

class TreeIslands {
 public:
  TreeIslands() = default;
  explicit TreeIslands(const Model& model);

  /// Finds them anew where rows couple these pairs of bodies, of trees that are not `still` (trees;
  /// empty: of all). The world couples nothing.
  void find(const Model& model, const std::vector<std::pair<int, int>>& pairs,
            std::span<const std::uint8_t> still = {});

  int size() const { return bodies_.size(); }
  /// Its bodies, and its dofs, ascending.
  Segments bodies(int island) const { return bodies_[island]; }
  Segments dofs(int island) const { return dofs_[island]; }
  /// (bodies) the island of each, −1: none; the first one for the world.
  const std::vector<int>& ofBody() const { return ofBody_; }

 private:
  UnionFind sets_;
  std::vector<int> ofBody_;  ///< (bodies)
  SegmentSets bodies_, dofs_;
};

}  // namespace softgauss
