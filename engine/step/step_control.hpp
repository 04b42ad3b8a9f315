// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What finds the applied force of a step from the step's own problem: goals do this (gdd/).

#include <cstdint>
#include <span>

#include "softgauss/engine/step/forward.hpp"

namespace softgauss {

class StepControl {
 public:
  virtual ~StepControl() = default;

  /// (8) of the paper: finds the control and gives it to setAppliedForce(). All stages up to the
  /// rows are those of the solve that follows; `state` is the one that they were made at. A step
  /// in parts asks in every part. Returns the acceleration (nv) that the control is to cause, from
  /// which forward dynamics starts, as it does elsewhere from what is there; null where there is
  /// none, with data.stats.status and badDof set.
  virtual const VectorX* apply(const Model& model, const State& state, Data& data) noexcept = 0;

  /// Whether apply() gives the rows of which it needs J their columns (Constraints::addColumns());
  /// else all have them.
  virtual bool addsColumns() const noexcept { return false; }

  /// Whether there is anything to choose: a control that is always zero leaves motion passive.
  virtual bool acts() const noexcept { return true; }

  /// (trees) 1 where the acceleration that apply() has returned is what the tree is to do; others
  /// move as they do by themselves. Empty: everywhere.
  virtual std::span<const std::uint8_t> controlled() const noexcept { return {}; }

  /// Where that is the solution of forward dynamics, which takes it.
  virtual KnownTrees known() const noexcept { return {}; }

  /// Whether a tree may fall asleep (sleep.hpp) after a step that has ended at this time [s], as
  /// far as the control is concerned.
  virtual bool letsSleep(const Model&, int tree, double) const noexcept {
    return controlled().empty() ? !acts() : controlled()[idx(tree)] == 0;
  }
  /// Where apply() has returned null: (trees) 1: it sleeps, and its acceleration is to be chosen
  /// too; the step then begins anew with those awake. Empty: none.
  virtual std::span<const std::uint8_t> wanted() const noexcept { return {}; }
  /// Marks (trees, 1) where what the control wants has begun, ended or changed since the last step:
  /// what sleeps there wakes. Whether there is such a tree.
  /// `before`, `now`: when the last step began, and this one does [s].
  virtual bool markChanged(const Model&, double /*before*/, double /*now*/,
                           std::span<std::uint8_t> /*trees*/) noexcept {
    return false;
  }

  /// What apply() has found has been done: keeps where the next solve may start, of these trees.
  virtual void keep(WarmStart& warmstart, const TreeSelection& trees) noexcept = 0;
};

}  // namespace softgauss
