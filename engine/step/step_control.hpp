// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What finds the applied force of a step from the step's own problem: goals do this (gdd/).

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

class StepControl {
 public:
  virtual ~StepControl() = default;

  /// (8) of the paper: finds the control and gives it to setAppliedForce(). All stages up to the
  /// rows are those of the solve that follows; `state` is the one that they were made at. A step
  /// in parts asks in every part. Returns the acceleration (nv) that the control is to cause, from
  /// which forward dynamics starts; null where there is none, with data.stats.status and badDof
  /// set.
  virtual const VectorX* apply(const Model& model, const State& state, Data& data) noexcept = 0;

  /// Whether there is anything to choose: a control that is always zero leaves motion passive.
  virtual bool acts() const noexcept { return true; }

  /// Whether the acceleration that apply() has returned is that of forward dynamics, to rounding:
  /// the rows are evaluated there, and data.forward.gradient is what is left of the equation of
  /// motion.
  virtual bool isSolved() const noexcept { return false; }

  /// What apply() has found has been done: keeps where the next solve may start.
  virtual void keep(WarmStart& warmstart) noexcept = 0;
};

}  // namespace softgauss
