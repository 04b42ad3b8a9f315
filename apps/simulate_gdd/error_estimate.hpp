// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The error that a run's settings leave, by step doubling: beside each step of h two of h/2 are
/// taken, under the same control. For a method of order p,
///
///   x_h − x ≈ (x_h − x_{h/2}) 2^p/(2^p − 1)
///
/// Methods with error control take their halves to a sixty-fourth of the tolerance: there the
/// difference is the error. Without goals the halves go on by themselves, and the estimate is of
/// the whole run: root mean square over links and steps. With goals every pair of halves begins
/// where its step does, for the goals answer to what went before; the estimate is the sum of what
/// the steps err by.

#include <memory>

#include "apps/shared/pose_error.hpp"
#include "collision/scene_contacts.hpp"
#include "engine/engine.hpp"
#include "io/summary.hpp"

namespace softgauss::app {

class ErrorEstimate {
 public:
  /// `model` and `start`: of the run.
  ErrorEstimate(const Model& model, const State& start, bool withGoals);

  /// A step of the run from `before` to `after`, under `input`.
  void observe(const State& before, const Input& input, const State& after);

  io::ErrorOutcome outcome() const;

 private:
  bool withGoals_;
  double factor_ = 1.0;  ///< 2^p/(2^p − 1)
  Model model_;          ///< with half the step
  collision::SceneContacts contacts_;
  Data data_;
  State state_;
  LinkPoses run_, halves_;
  double total_ = 0.0, turned_ = 0.0;  ///< sums, of squares without goals
  long steps_ = 0;
  bool lost_ = false;  ///< the halves are not finite
};

}  // namespace softgauss::app
