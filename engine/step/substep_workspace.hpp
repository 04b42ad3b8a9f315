// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Memory of the leapfrog, which may take a step in parts.

#include "softgauss/engine/step/data.hpp"
#include "softgauss/engine/step/integrators/tree_substepping.hpp"
#include "softgauss/engine/step/island_substeps.hpp"

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

  /// Before stages of another state.
  void begin() {
    repeats = false;
    if (islands) islands->clear();
  }
  bool leavesAny() const { return islands && islands->any(); }
  /// Whether the body's island takes the step in parts of its own.
  bool leaves(int body) const { return islands && islands->leaves(body); }

  Model model;                             ///< with the length of a part as its step
  State before;                            ///< where the step begins
  State start;                             ///< where the part begins
  VectorX predicted;                       ///< (nv) a₋ of the first part
  VectorX predictedForces;                 ///< its State::connectionForces
  std::vector<std::uint8_t> mispredicted;  ///< (trees) 1: a₋ did not hold
  bool repeats = false;                    ///< the solve is repeated for those
  VectorX moved;                           ///< (nv) (v⁺ − v)/h, of what is followed too
  SubstepSelection substepSelection;
  TreeSubstepping treeSubstepping;
  /// Null where all trees take the same parts: there is one, or this is of the parts of an island.
  std::unique_ptr<IslandSubsteps> islands;
};

}  // namespace softgauss
