// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a goal would leave if it weighed something else: found, not guessed.
///
/// Where robots are at rest, the slopes of (8.1) at a = v = 0 balance (goal_balance.hpp):
///   w ∇λ(q) + Σ_k ∇ℓ_k(q) + P w_u(q) = J_Kᵀμ,
/// w λ being the cost of the goal. Near such a q its error falls with w as
///   e(w) ≈ c e_0 / (c + w),   c = w e(w) / (e_0 − e(w)),
/// e_0 being what is left where it weighs nothing, so w has to be c (e_0 − e) / e for an error of
/// e. That chooses what to try and is no answer, for with q go J, the contacts, and which bounds
/// are met. The balance is solved anew: from the present state the motion goes on with the other
/// weight, with whatever else weights decide (weighDefaults()), and with the same physics and
/// limits, until the error rests. Time stands still meanwhile: what acts now acts on, and nothing
/// else begins.

#include <functional>
#include <optional>

#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss::gdd {

class OtherWeight {
 public:
  /// Of the controller's goals, limits and prices. Both have to live as long.
  OtherWeight(const Model& model, GoalDirectedController& controller);

  /// A step that was taken: its stages, contact forces, and the seconds since the trial began.
  using Watch = std::function<void(const Data&, const ContactForces&, double)>;

  /// The error that `goal` comes to rest with where `weight`, one of its own, is `tried`; nothing
  /// where a step was refused or it has not come to rest within kLongest. `error`: which of its
  /// figures. Goals and weights are as they were afterwards.
  std::optional<double> leaves(const Goal& goal, const GoalError& error, double& weight,
                               double tried, const Input& input, const State& from,
                               ContactSource* contacts, const Watch& watch = {});

  /// The weight with which the estimate leaves `wanted`, where `now` leaves `left` of e_0 = `most`:
  /// the next power of ten, at least ten and at most kMostRaised times what it is.
  static double toTry(double now, double left, double most, double wanted);

  static constexpr double kLongest = 3.0;      ///< [s]
  static constexpr double kMostRaised = 1e6;   ///< times what it is
  static constexpr double kRestTime = 0.25;    ///< the error rests where in as long a time [s]
  static constexpr double kRestChange = 0.02;  ///< it changes by less, of what counts as met

 private:
  std::optional<double> errorOf(const Goal& goal, const GoalError& error, const State& state);

  const Model& model_;
  GoalDirectedController& controller_;
  GoalDirectedController trial_;
  Data data_;
  ContactForces touching_;
  std::vector<GoalError> figures_;
};

}  // namespace softgauss::gdd
