// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Trees that no row and no control acts on, and that turn far in a step, are followed through it:
/// they go by (T.91) from (q, v) to (q⁺, v⁺) under the applied forces, to a tolerance, with damping
/// and all springs on the way. What they do to others is nothing, so it matters to no one else.

#include "engine/step/integrators/tree_motion.hpp"
#include "engine/step/resolution.hpp"

namespace softgauss {

struct Data;

class FreeTrees {
 public:
  FreeTrees() = default;
  explicit FreeTrees(const Model& model);

  /// Follows those that `resolution` calls free, from where `start` is, and overwrites their q, v
  /// and last acceleration in `end`, and data.acceleration. A tree that needs more sub-steps than
  /// allowed stays as `end` has it (StepStats::abandonedTrees). False: not finite.
  bool follow(const Model& model, const Input& input, const Resolution& resolution,
              const State& start, Data& data, State& end);
  std::size_t bytes() const;

 private:
  VectorX held_, pushed_;  ///< (nv) applied forces, and those of wrenches
  TreeMotion motion_;
};

}  // namespace softgauss
