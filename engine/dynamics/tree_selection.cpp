// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_selection.hpp"

namespace softgauss {

TreeSelection::TreeSelection(const Model& model) : trees_(model.trees.size()) {
  bodies_.reserve(trees_.size());
  dofs_.reserve(trees_.size());
  select(model, [](int) { return true; });
}

void TreeSelection::append(const Tree& tree) {
  const auto add = [](Segment s, std::vector<Segment>& segments) {
    if (!segments.empty() && segments.back().end == s.begin)
      segments.back().end = s.end;
    else
      segments.push_back(s);
  };
  add({tree.rootBody, tree.bodyEnd}, bodies_);
  add({tree.firstDof, tree.dofEnd}, dofs_);
}

}  // namespace softgauss
