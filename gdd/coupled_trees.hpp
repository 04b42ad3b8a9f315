// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which trees a row of dofs couples.

#include <utility>
#include <vector>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss::gdd {

/// Whether J (nv) has an entry that is not zero among the dofs of a tree.
template <class Row>
bool moves(const Tree& tree, const Row& J) {
  return (J.segment(tree.firstDof, tree.dofEnd - tree.firstDof).array() != 0.0).any();
}

/// Appends pairs of bodies of the trees among whose dofs J (nv) has entries that are not zero.
template <class Row>
void appendCoupledTrees(const Model& model, const Row& J, std::vector<std::pair<int, int>>& pairs) {
  int first = 0;
  for (const Tree& tree : model.trees) {
    if (!moves(tree, J)) continue;
    if (first != 0) pairs.emplace_back(first, tree.rootBody);
    first = tree.rootBody;
  }
}

}  // namespace softgauss::gdd
