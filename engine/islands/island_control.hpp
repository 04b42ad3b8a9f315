// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How islands take their step where it is not the ordinary one: goals do this (gdd/).

#include <memory>
#include <vector>

#include "softgauss/engine/islands/sub_model.hpp"
#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// What controls one island.
class IslandControl {
 public:
  virtual ~IslandControl() = default;

  /// Whether it acts at this time [s]; while it does not, the step is the ordinary one.
  virtual bool acts(double time) const noexcept = 0;
  /// Whether what it wants stays where it is at this time: only then may the island rest.
  virtual bool steady(double time) const noexcept = 0;
  /// It does not act in this step.
  virtual void release() noexcept = 0;

  /// Instead of step(), where data.kinematics is that of the state.
  virtual SolveStatus step(const Input& input, State& state, Data& data,
                           ContactSource* contacts) noexcept = 0;
};

class IslandControls {
 public:
  virtual ~IslandControls() = default;

  /// What controls an island, which outlives the result.
  virtual std::unique_ptr<IslandControl> within(const SubModel& island) = 0;

  /// A step begins. Appends the trees for which what controls them has begun, ended or changed
  /// since the last one: what sleeps there wakes.
  virtual void begin(double time, std::vector<int>& trees) noexcept = 0;
};

}  // namespace softgauss
