// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a goal without a weight of its own weighs beside the others: the one rule for files, the
/// command line, C++, Python, sweeps and the live page.
///
/// Two goals that pull at one point from rest balance where, with the effective mass
/// Λ = (J M⁻¹Jᵀ)⁻¹ of the link, a posture of weight w_p and d the way from the place to where the
/// posture would have the point,
///   w k_r e = w_p k_p Λ d                                                               (9.23)
/// so the place is missed by the share (w_p/w)(k_p/k_r) Λ of the way. Hence
///   1. the default weight of a goal counts w_p times, w_p ≥ 1 the largest weight of the postures
///      that act with it and hold a joint that it moves;
///   2. a posture yields to the places that such goals seek (posture.hpp): its spring is not felt
///      in the directions that they take, and what is left where the base is fixed is nothing.
/// A weight that is given stays, nothing yields to it, and a posture nobody asked for is weak.

#include <algorithm>
#include <memory>
#include <vector>

#include "softgauss/engine/core/check.hpp"

namespace softgauss {
struct Model;
}

namespace softgauss::gdd {

class Goal;

/// The default of one weight of a goal, for as long as nobody changes that weight.
class DefaultWeight {
 public:
  /// `alone`: without a posture beside it.
  explicit DefaultWeight(double alone) : alone_(alone), now_(alone) {}
  /// Sets `weight` as it is beside a posture of this weight, unless somebody has changed it.
  void setBeside(double posture, double& weight) {
    if (isAt(weight)) weight = now_ = alone_ * std::max(1.0, posture);
  }
  bool isAt(double weight) const { return weight == now_; }
  /// From now on the weight is the user's own, whatever it is.
  void giveUp() { now_ = kNaN; }

 private:
  double alone_, now_;
};

/// Brings every weight that nobody has given to what it is beside the postures among the goals, and
/// tells those postures what they yield to. To be called again where goals come, go, or change
/// their weights or times.
void weighDefaults(const Model& model, const std::vector<std::unique_ptr<Goal>>& goals);

}  // namespace softgauss::gdd
