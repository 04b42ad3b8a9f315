// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Memory of the leapfrog, which may take a step in parts.

#include "softgauss/engine/step/data.hpp"
#include "softgauss/engine/step/integrators/tree_substepping.hpp"

namespace softgauss {

struct SubstepWorkspace {
  explicit SubstepWorkspace(const Model& m)
      : model(m),
        before(m),
        start(m),
        predicted(VectorX::Zero(m.nv)),
        predictedForces(before.connectionForces),
        mispredicted(m.trees.size(), 0),
        moved(predicted),
        substepSelection(m),
        treeSubstepping(m) {}

  Model model;                             ///< with the length of a part as its step
  State before;                            ///< where the step begins
  State start;                             ///< where the part begins
  VectorX predicted;                       ///< (nv) a₋ of the first part
  VectorX predictedForces;                 ///< its State::connectionForces
  std::vector<std::uint8_t> mispredicted;  ///< (trees) 1: a₋ did not hold
  VectorX moved;                           ///< (nv) (v⁺ − v)/h, of what is followed too
  SubstepSelection substepSelection;
  TreeSubstepping treeSubstepping;
};

}  // namespace softgauss
