// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Trees that turn far within a step are followed through it by sub-steps of their own
/// (docs/decisions/0025-trees-that-turn-far.md).
///
/// How far a tree turns is told by what (T.16) knows already: the change of the Coriolis and
/// gyroscopic forces to mid-step, Δb = b(q, v + ½ h a) − b(q, v), gives h M⁻¹Δb of velocity, which
/// is set against the velocities of the tree's joints, those that turn and those that slide apart:
///
///   turn = max_i |h (M⁻¹Δb)_i| / max_i (|v_i| + h |a_i|)                                 (T.93)
///
/// It is about ½ (h ω)² for a body that tumbles at ω, and nothing for a wheel or a ball, whose spin
/// makes no such forces. Where it exceeds kFollowedTurn the tree moves by (T.91) under the forces
/// of the step, to a tolerance; all others move by (T.16), bit for bit.
///
/// Semi-implicit Euler keeps the velocity of half a step earlier: its q⁺ = q + h v⁺ is that of the
/// leapfrog. So ½ h a′ is added to v where a tree begins to be followed, and left out of v⁺ in the
/// first step after that. State::followed tells which of the two v is.

#include <cstdint>
#include <vector>

#include "engine/step/integrators/tree_motion.hpp"

namespace softgauss {

struct Data;

struct FollowedTrees {
  std::vector<double> turn;            ///< (trees) of (T.93), in the last step
  std::vector<std::uint8_t> followed;  ///< (trees) 1: it was, in the last step
  VectorX push;                        ///< (nv) Jᵀf of the step
  VectorX q;                           ///< (nq) scratch
  TreeMotion motion;

  FollowedTrees() = default;
  explicit FollowedTrees(const Model& model)
      : turn(model.trees.size(), 0.0),
        followed(model.trees.size(), 0),
        push(VectorX::Zero(model.nv)),
        q(model.q0),
        motion(model) {}

  /// Finds which trees are to be followed; `change` = M⁻¹Δb (nv). Whether there is one, or was one
  /// in the step before.
  bool needed(const Model& model, const Data& data, State& state, const VectorX& change);
  /// Corrects v⁺ = v + h a′ of those trees. `held` is scratch (nv).
  void follow(const Model& model, Data& data, State& state, VectorX& held, VectorX& vPlus);
  /// The positions of the followed trees.
  void copyPositions(const Model& model, VectorX& qPlus) const;
  std::size_t bytes() const;

  /// Of (T.93).
  static const double kFollowedTurn;
};

}  // namespace softgauss
