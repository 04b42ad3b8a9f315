// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The trees that stages are of: all, or those of one island, whose bodies and dofs are ranges.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "softgauss/engine/core/segment.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss {

class TreeSelection {
 public:
  TreeSelection() = default;
  /// All.
  explicit TreeSelection(const Model& model);

  /// Those trees for which `selected(tree)`.
  template <class Selected>
  void select(const Model& model, Selected&& selected) {
    bodies_.clear(), dofs_.clear();
    for (std::size_t t = 0; t < trees_.size(); ++t) {
      trees_[t] = selected(static_cast<int>(t)) ? 1 : 0;
      if (trees_[t]) append(model.trees[t]);
    }
    all_ = std::ranges::find(trees_, 0) == trees_.end();
  }

  bool all() const { return all_; }
  bool has(int tree) const { return trees_[idx(tree)] != 0; }
  /// Whether both bodies are of trees that are selected, or the world.
  bool holds(const Model& model, int bodyA, int bodyB = 0) const {
    const auto of = [&](int body) { return body == 0 || has(model.bodies[idx(body)].tree); };
    return all_ || (of(bodyA) && of(bodyB));
  }
  Segments bodies() const { return bodies_; }
  Segments dofs() const { return dofs_; }
  std::size_t bytes() const { return bytesOfAll(trees_, bodies_, dofs_); }

 private:
  void append(const Tree& tree);

  bool all_ = true;
  std::vector<std::uint8_t> trees_;     ///< (trees) 1: selected
  std::vector<Segment> bodies_, dofs_;  ///< theirs, ascending
};

}  // namespace softgauss
