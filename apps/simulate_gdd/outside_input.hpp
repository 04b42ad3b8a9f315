// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What acts on a run as a function of time alone: the controls of --torques and the wrenches of
/// the scene.

#include <optional>

#include "apps/simulate_gdd/scene.hpp"
#include "io/torque_table.hpp"

namespace softgauss::app {

class OutsideInput {
 public:
  /// Reads the table. Throws ModelError.
  OutsideInput(const SimulateOptions& options, const Scene& scene);

  /// Mean time between the rows of the table that begins at 0 and has several; else 0 [s].
  double rowSpacing() const;

  /// For the step of model.options.timestep from `state`. Controls are left as they are without a
  /// table. `kinematics` are worked out where there are wrenches.
  void at(const Model& model, const State& state, Kinematics& kinematics, Input& input) const;

 private:
  std::optional<io::TorqueTable> torques_;
  io::WrenchSchedule wrenches_;
};

}  // namespace softgauss::app
