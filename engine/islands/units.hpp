// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Units: what always moves together, whatever touches. A unit is a robot, a free body, or several
/// of them that a connection, a weld or a coupling ties. Islands are made of units.

#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

struct Units {
  std::vector<std::vector<int>> trees;  ///< (units) of each, ascending; units by their first tree
  std::vector<int> ofTree;              ///< (trees)

  Units() = default;
  explicit Units(const Model& model);
  int size() const { return static_cast<int>(trees.size()); }
  /// The unit of a body, −1 for the world.
  int ofBody(const Model& model, int body) const {
    const int tree = model.bodies[static_cast<std::size_t>(body)].tree;
    return tree < 0 ? -1 : ofTree[static_cast<std::size_t>(tree)];
  }
};

}  // namespace softgauss
