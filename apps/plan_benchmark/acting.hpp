// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One plan acted out by three laws of control, in the simulator with its own finer steps: goal
/// directed dynamics with the value model as goal, (22) of the paper; the plan's controls with its
/// feedback, u + K δx; and with a spring and damper on each joint, u + k_p δq + k_d δv.
///
/// δx is the way from the plan, whose accelerations are constant between knots. The springs and
/// dampers are critically damped at 20 rad/s with the mass that a joint moves at the start, diag M.
/// A run is undisturbed, or starts at velocities of normal numbers times `disturbed`.

#include <filesystem>
#include <string>
#include <vector>

namespace softgauss::app {

struct ActingChoice {
  int runs = 8;  ///< disturbed ones
  unsigned seed = 1;
  double disturbed = 0.1;  ///< [rad/s or m/s]
  double timestep = 2e-3;  ///< of the simulator [s]
};

enum class ActingLaw { goalDirected, feedback, springs };
std::string actingLawName(ActingLaw law);

struct ActingRuns {
  std::string task;
  double planned = 0.0;       ///< cost of the plan
  double undisturbed = 0.0;   ///< cost of the run that is
  int carriedOut = 0;         ///< disturbed runs that did not lose the plan (PlanControl::isLost())
  std::vector<double> costs;  ///< of the disturbed runs, ascending
  ActingLaw law = ActingLaw::goalDirected;
};

/// Of all laws. Throws ModelError where the file is at fault, PlanError where there is no plan.
std::vector<ActingRuns> runActing(const std::filesystem::path& file, const ActingChoice& choice);

/// A table of all tasks, for people.
std::string actingTable(const std::vector<ActingRuns>& all);

}  // namespace softgauss::app
