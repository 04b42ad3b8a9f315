// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Memory of the leapfrog, which may take a step in parts.

#include "engine/step/data.hpp"
#include "engine/step/integrators/free_trees.hpp"

namespace softgauss {

struct StepParts {
  explicit StepParts(const Model& m)
      : model(m),
        before(m),
        start(m),
        predicted(VectorX::Zero(m.nv)),
        moved(predicted),
        resolution(m),
        freeTrees(m) {}

  Model model;        ///< with the length of a part as its step
  State before;       ///< where the step begins
  State start;        ///< where the part begins
  VectorX predicted;  ///< (nv) a₋ of the first part
  VectorX moved;      ///< (nv) (v⁺ − v)/h, of what is followed too
  Resolution resolution;
  FreeTrees freeTrees;
};

}  // namespace softgauss
