// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/outside_input.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::app {

OutsideInput::OutsideInput(const SimulateOptions& options, const Scene& scene)
    : wrenches_(scene.schedule) {
  if (!options.torques.empty()) torques_ = io::TorqueTable::read(options.torques, scene.model);
}

double OutsideInput::rowSpacing() const {
  if (!torques_ || torques_->startTime() != 0.0 || torques_->rows() < 2) return 0.0;
  return torques_->endTime() / static_cast<double>(torques_->rows() - 1);
}

double OutsideInput::lengthFrom(double time, double most) const {
  constexpr double kRounding = 1e-6;  // of the step
  double next = wrenches_.nextChange(time);
  if (torques_) next = std::min(next, torques_->nextRow(time));
  const double length = next - time;
  return length < (1.0 - kRounding) * most ? length : most;
}

void OutsideInput::at(const Model& model, const State& state, Kinematics& kinematics,
                      Input& input) const {
  if (torques_) torques_->controlAt(state.time, input.tau);
  if (wrenches_.empty()) return;
  computeKinematics(model, state, kinematics);
  wrenches_.at(state.time, model.options.timestep, kinematics, input.wrenches);
}

}  // namespace softgauss::app
