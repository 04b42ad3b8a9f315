// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What acts on a run as a function of time alone: the controls of --torques and the wrenches of
/// the scene.

#include <optional>

#include "apps/simulate_gdd/scene.hpp"
#include "softgauss/io/torque_table.hpp"

namespace softgauss::app {

class OutsideInput {
 public:
  /// Reads the table. Throws ModelError.
  OutsideInput(const SimulateOptions& options, const Scene& scene);

  /// Mean time between the rows of the table that begins at 0 and has several; else 0 [s].
  double rowSpacing() const;

  /// Takes a step of model.options.timestep from `state` in parts that end on the rows of the
  /// table, and where wrenches begin or end, by calls of take(), each of which moves the state on
  /// by the model's step of that time. False where one of them did not; the model's step is then
  /// what it was.
  template <class Take>
  bool inParts(Model& model, const State& state, Take&& take) const {
    const double h = model.options.timestep;
    bool taken = true;
    for (double left = h; taken && left > 1e-9 * h;) {
      model.options.timestep = lengthFrom(state.time, left);
      left -= model.options.timestep;
      taken = take();
    }
    model.options.timestep = h;
    return taken;
  }

  /// For the step of model.options.timestep from `state`. Controls are left as they are without a
  /// table. `kinematics` are worked out where there are wrenches.
  void at(const Model& model, const State& state, Kinematics& kinematics, Input& input) const;

 private:
  /// `most`, or up to the next row or change of a wrench [s]; those within a millionth of it after
  /// its end do not count.
  double lengthFrom(double time, double most) const;

  std::optional<io::TorqueTable> torques_;
  io::WrenchSchedule wrenches_;
};

}  // namespace softgauss::app
