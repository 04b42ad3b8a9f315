// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The trees that stages are of: all, those that are awake (sleep.hpp), or those of one island.
/// Their bodies, dofs and coordinates are ranges.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "softgauss/engine/core/segment.hpp"
#include "softgauss/engine/model/state.hpp"

namespace softgauss {

class TreeSelection {
 public:
  TreeSelection() = default;
  /// All.
  explicit TreeSelection(const Model& model);

  /// Those trees for which `selected(tree)`.
  template <class Selected>
  void select(const Model& model, Selected&& selected) {
    clear();
    for (std::size_t t = 0; t < flags_.size(); ++t) {
      flags_[t] = selected(static_cast<int>(t)) ? 1 : 0;
      if (flags_[t]) append(model, static_cast<int>(t));
    }
  }
  void selectAll(const Model& model) {
    select(model, [](int) { return true; });
  }
  /// (trees) 1: it stands where it is, and is not selected: what touches it from among the selected
  /// ones counts as a contact, but has no rows. Empty: none.
  void setStill(std::span<const std::uint8_t> trees) { still_.assign(trees.begin(), trees.end()); }

  bool all() const { return trees_.size() == flags_.size(); }
  bool none() const { return trees_.empty(); }
  bool has(int tree) const { return flags_[idx(tree)] != 0; }
  bool isStill(int tree) const { return !still_.empty() && still_[idx(tree)] != 0; }
  bool anyStill() const { return !still_.empty(); }
  /// Whether both bodies are of trees that are selected, or the world.
  bool holds(const Model& model, int bodyA, int bodyB = 0) const {
    const auto of = [&](int body) { return body == 0 || has(model.bodies[idx(body)].tree); };
    return all() || (of(bodyA) && of(bodyB));
  }
  /// Whether a contact of these two counts: one of them is of a tree that is selected, the other
  /// too, or still, or the world.
  bool meets(const Model& model, int bodyA, int bodyB) const {
    if (still_.empty() || holds(model, bodyA, bodyB)) return holds(model, bodyA, bodyB);
    const int a = model.bodies[idx(bodyA)].tree, b = model.bodies[idx(bodyB)].tree;
    return a >= 0 && b >= 0 && ((has(a) && isStill(b)) || (isStill(a) && has(b)));
  }
  const std::vector<int>& trees() const { return trees_; }  ///< ascending
  /// (trees) 1: selected; 1: still.
  const std::vector<std::uint8_t>& flags() const { return flags_; }
  const std::vector<std::uint8_t>& still() const { return still_; }
  Segments bodies() const { return bodies_; }
  Segments dofs() const { return dofs_; }
  Segments coordinates() const { return coordinates_; }  ///< of State::q

 private:
  void clear();
  void append(const Model& model, int tree);

  std::vector<std::uint8_t> flags_, still_;           ///< (trees)
  std::vector<int> trees_;                            ///< those that are selected
  std::vector<Segment> bodies_, dofs_, coordinates_;  ///< theirs, ascending
};

/// The coordinates q of a tree.
Segment coordinatesOf(const Model& model, const Tree& tree);

/// to ← from, of these trees; what is of others stays in `to`, which is a state of the same model.
void copyState(const TreeSelection& trees, const State& from, State& to);

}  // namespace softgauss
