// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What rows do about the velocity of mid-step.
///
/// (T.1) is of the velocity v of the step's start, which a leapfrog has from half a step before.
/// Semi-implicit Euler takes Coriolis forces at v_m = v + ½ h â, and rows answer what these forces
/// are more, Δb = b(q, v_m) − b(q, v), and by how much more their J turns. δ leads from a to the
/// solution of (T.1) at v_m:
///
///   a + δ = argmin  ½ aᵀM a + aᵀ(c + Δb − τ) + s(J a − a_ref + J̇ v|v_m − J̇ v|v)       (T.123)
///
/// one iteration of Newton's from a with the factor that is there, where no row changes its piece.
/// Were Δb to act on the bodies alone, rows would find it out a step later, by the velocity that it
/// has left, and answer by their damping; a top gains by that. What connections and welds hold is
/// apart: its Δb does act alone, for (T.116) answers by the way that it has come.

#include <vector>

#include "engine/dynamics/kinematics.hpp"
#include "engine/model/state.hpp"

namespace softgauss {

struct Data;

class MidStep {
 public:
  MidStep() = default;
  explicit MidStep(const Model& model);

  /// Solves (T.123); the rows' forces are then those of mid-step, all else of Data as it was.
  /// `bias` = Δb, `present` has v. False: not finite.
  bool answer(const Model& model, Data& data, const State& present, const VectorX& vMiddle,
              const VectorX& bias);
  /// Without an answer: Δb acts on the bodies alone.
  void leaveAlone(const VectorX& bias) { change_ = -bias; }
  /// Makes the rows' forces those of a, and those of mid-step again.
  void leave(Data& data) const;
  void enter(Data& data) const;
  /// (nv) M δ, less Δb of what is tied: what mid-step adds to M a.
  const VectorX& change() const { return change_; }
  std::size_t bytes() const;

 private:
  Kinematics kinematics_;                        ///< poses of the step's start, velocities of v_m
  State state_;                                  ///< q of the step's start, v_m
  VectorX a_, middle_;                           ///< (nv) a, a + δ
  VectorX Ma_, Md_, scale_;                      ///< (nv) of ForwardSolution, while it serves here
  VectorX net_, change_, gradient_, direction_;  ///< (nv)
  std::vector<double> references_, middleReferences_;  ///< of all rows, for a and for a + δ
};

}  // namespace softgauss
