// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What joints and actuators do over a run: which are at their bounds, which chatter.
///
/// A control chatters where it goes up and down from step to step: with d_k = u_k − u_{k−1}, the
/// mean over the last half second of min(|d_k|, |d_{k−1}|), counted where they differ in sign, is
/// more than 5 % of the bound, or of the largest |u| where there is no bound.

#include <string>
#include <vector>

#include "softgauss/engine/model/state.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::app {

/// A control that was at a bound or went up and down, and how much.
struct WatchedControl {
  std::string name;
  double amount = 0.0;  ///< share of the steps; or the mean jump from step to step [N m or N]
  std::string unit = {};
};

/// A joint that was faster than its velocity limit.
struct FastJoint {
  std::string name;
  double speed = 0.0, limit = 0.0;  ///< [rad/s or m/s]
  std::string unit;
};

class JointWatch {
 public:
  JointWatch(const Model& model, const gdd::ControlLimits& limits);

  /// Forces on joints and commands of the box's actuators as applied in a step of length `h` [s],
  /// and the state after it.
  void observe(const VectorX& tau, const VectorX& commands, const State& state, double h);
  bool hasSeen() const { return steps_ > 0; }
  template <class Archive>
  void archive(Archive& a) {
    a.sized(controls_);
    a(steps_, v_, q_, fastest_);
    if constexpr (Archive::kReads)
      a.expect(fastest_.size() == model_.nv &&
               (steps_ == 0 || (steps_ > 0 && v_.size() == model_.nv && q_.size() == model_.nq)));
  }

  /// Those of the dofs for which `counts` (nv) is set that were at their bound in a fifth of the
  /// last half second.
  std::vector<std::string> saturatedNow(const std::vector<char>& counts) const;
  /// Of joints that are at an end of their range now.
  std::vector<std::string> atRangeEnd(const std::vector<char>& counts) const;
  /// The fastest speed of these dofs [rad/s or m/s].
  double speed(const std::vector<char>& counts) const;

  /// Over the whole run: at their bound in more than 5 % of the steps, the most first.
  std::vector<WatchedControl> saturated() const;
  /// At the end of the run, the worst first.
  std::vector<WatchedControl> chattering() const;
  /// Over the whole run: those that were more than 5 % faster than their limit, the worst first.
  std::vector<FastJoint> tooFast() const;

 private:
  struct Control {
    std::string name, unit;
    std::vector<int> dofs;  ///< that it pulls
    double lower, upper;
    bool actuated = true;
    double recent = 0.0;  ///< share of recent steps at a bound, exponentially weighted
    long full = 0;        ///< steps at a bound
    double last = 0.0, jump = 0.0, jumps = 0.0, largest = 0.0;

    template <class Archive>
    void archive(Archive& a) {
      a(recent, full, last, jump, jumps, largest);
    }
  };
  void see(Control& control, double u, double forget);
  bool concerns(const Control& control, const std::vector<char>& counts) const;

  const Model& model_;
  std::vector<Control> controls_;  ///< of the dofs that have one, then of the box's actuators
  std::size_t actuators_ = 0;      ///< how many of the latter
  long steps_ = 0;
  VectorX v_, q_;
  VectorX fastest_;  ///< (nv) largest |v| so far
};

}  // namespace softgauss::app
