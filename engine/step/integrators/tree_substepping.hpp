// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Trees that no row and no control acts on are followed through the step: they go by (6.5) from
/// (q, v) to (q⁺, v⁺) under the applied forces, to a tolerance, with damping and all springs on the
/// way. What they do to others is nothing, so it matters to no one else.

#include "softgauss/engine/step/integrators/tree_motion.hpp"
#include "softgauss/engine/step/substep_selection.hpp"

namespace softgauss {

struct Data;

class TreeSubstepping {
 public:
  TreeSubstepping() = default;
  explicit TreeSubstepping(const Model& model);

  /// Follows those that `substepSelection` calls free, from where `start` is, and overwrites their
  /// q, v and last acceleration in `end`, and data.acceleration. A tree that needs more sub-steps
  /// than allowed stays as `end` has it (StepStats::abandonedTrees). False: not finite.
  bool integrate(const Model& model, const SubstepSelection& substepSelection, const State& start,
                 Data& data, State& end);
  std::size_t bytes() const;

 private:
  VectorX held_;  ///< (nv) applied forces
  TreeMotion motion_;
};

}  // namespace softgauss
