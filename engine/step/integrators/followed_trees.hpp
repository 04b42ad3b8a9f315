// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Trees that turn far within a step are followed through it by sub-steps of their own
/// (docs/decisions/0025-trees-that-turn-far.md).
///
/// How far a tree turns is told by what (T.16) knows already: the change of the Coriolis and
/// gyroscopic forces to mid-step, Δb = b(q, v + ½ h a) − b(q, v), gives h M⁻¹Δb of velocity, which
/// is set against the velocities of the tree's joints, those that turn and those that slide apart,
/// and by what it does to the energy of motion:
///
///   turn = h max(max_i |(M⁻¹Δb)_i| / max_i (|v_i| + h |a_i|),
///                2 √(Δbᵀ M⁻¹Δb / (vᵀM v + h² aᵀM a)))                                     (T.93)
///
/// It is about ½ (h ω)² for a body that tumbles at ω, and nothing for a wheel or a ball, whose spin
/// makes no such forces. By the second part a fast joint of little inertia hides nothing of what
/// the others turn; it counts for trees with joints whose energy nothing else changes much,
/// neither damping, nor applied forces, nor ties. Where turn exceeds kFollowedTurn the tree moves
/// by (T.91) under the forces of the step, to a tolerance; all others move by (T.16), bit for bit.
/// So does what a connection or a weld holds where it turns by more than kTiedTurn, a ball too: the
/// rows turn with it.
///
/// Semi-implicit Euler keeps the velocity of half a step earlier: its q⁺ = q + h v⁺ is that of the
/// leapfrog. So ½ h a′ is added to v where a tree begins to be followed, and left out of v⁺ in the
/// first step after that; where rows push, ½ h a_c of Coriolis forces alone instead (T.118).
/// State::velocityOf tells which of the two v is.
///
/// What rows and the applied τ do to a followed tree that rows push is done at the step's start, at
/// once, and the tree goes on without them:
///
///   v ← v + ½ h a_s(q) + h M̂⁻¹(Jᵀf + τ − D v − K (q + h v − q_s)),  then (T.91),
///   then v⁺ ← v − ½ h a_s(q⁺)                                                         (T.130)
///
/// with K the stiff springs, those of (T.95), a_s the acceleration that gravity, the other springs
/// and wrenches give at rest, and M̂ = M + h D + h² K in all of it, on the way too: what damping and
/// stiff springs do is that of the step's end, and a joint that they hold does not whip between. A
/// force that is held while the tree turns works where it is not any more, and positions that move
/// with half of what it does make energy out of a stiff contact, as explicit Euler does. f is that
/// of (T.1) without what the velocities of these trees make, Coriolis forces and J̇ v of their rows:
/// over the step these turn, and (T.91) has them. Then a kick takes velocity out of the rows and
/// puts none in, however far the tree turns.
///
/// With turn < 0.05 a single body without ties is not followed while rows push it: (T.123) has its
/// Coriolis forces and the rows' answer. Links without ties, and single bodies on ties that turn by
/// less than kTiedTurn, roll on as they have come, and f has their Coriolis forces, with J̇ v of
/// their rows. The kick then puts h c into its rows, c = −J a_c, and on its way the tree takes it
/// out again. The rows damp the mean of J v and J v + h c, so that f works against no speed of its
/// own making:
///
///   a_ref ← a_ref + ½ h b J a_c                                                        (T.120)

#include <cstdint>
#include <vector>

#include "engine/step/integrators/tree_motion.hpp"

namespace softgauss {

struct Data;

struct FollowedTrees {
  std::vector<double> turn;            ///< (trees) of (T.93), in the last step
  std::vector<std::uint8_t> followed;  ///< (trees) 1: it was, in the last step
  std::vector<std::uint8_t> pushed;    ///< (trees) 1: followed, and rows push it
  VectorX push;                        ///< (nv) Jᵀf of the step
  VectorX coriolis;                    ///< (nv) a_c of (T.118)
  VectorX a, net, bias;                ///< (nv) of (T.1) with all forces, while kick() holds
  VectorX smooth, kicked;              ///< (nv) scratch
  std::vector<double> references;      ///< of its rows
  VectorX q;                           ///< (nq) scratch
  std::vector<std::uint8_t> tied;      ///< (trees) 1: connections or welds hold it
  TreeMotion::AtEnd atEnd;             ///< of the model's joints
  TreeMotion motion;

  FollowedTrees() = default;
  explicit FollowedTrees(const Model& model);

  /// Finds which trees are to be followed; `change` = M⁻¹Δb (nv). Whether there is one, or was one
  /// in the step before.
  bool needed(const Model& model, const Data& data, State& state, const VectorX& change);
  /// Finds which of them rows push, and whether there is one.
  bool anyPushed(const Model& model, const Data& data);
  /// Solves (T.1) again, by (T.120) and without what the velocities of the other pushed trees make:
  /// Coriolis forces, and J̇ v of their rows; a′ of all trees follows. False: not finite.
  bool kick(const Model& model, Data& data, const State& state);
  /// Puts (T.1) back as it was.
  void endKick(const Model& model, Data& data);
  /// Corrects v⁺ = v + h a′ of the followed trees. `held` is scratch (nv).
  void follow(const Model& model, Data& data, State& state, VectorX& held, VectorX& vPlus);
  /// The positions of the followed trees.
  void copyPositions(const Model& model, VectorX& qPlus) const;
  std::size_t bytes() const;

  /// Of (T.93).
  static const double kFollowedTurn;
};

/// Whether the step before has followed the tree whose velocity this is.
inline bool wasFollowed(VelocityOf instant) {
  return instant == VelocityOf::now || instant == VelocityOf::halfAStepAgoPushed;
}

}  // namespace softgauss
