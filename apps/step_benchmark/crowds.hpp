// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What islands and sleep save: pairs of scenes, timed in turn in one run.

#include <map>
#include <string>

namespace softgauss::app {

/// Figures of every pair whose name matches the regular expression, as sleep_name.key:
///   sleep_humanoids  100 humanoids that lie on the ground, asleep over awake
///   sleep_ball       a ball that rolls among 1,000 sleeping boxes, over the same ball alone
///   sleep_reacher    an arm that reaches among 1,000 sleeping boxes, over the arm alone
///   islands_humanoids  100 humanoids that fall, over one of them, per humanoid
///   parts_boxes      50 boxes at rest beside a rod that spins, whose steps go in parts, over the
///                    boxes alone and the rod alone together
///   parts_humanoid, parts_reach  the same of a humanoid that stands, and of one that reaches
///   goals_robots     8 humanoids that reach, over one, per humanoid
///   goals_boxes      one that reaches among 200 boxes, over both alone
/// `first.us` and `second.us` are medians of CPU time per step, `ratio` that of the medians.
std::map<std::string, double> crowdFigures(const std::string& robots, const std::string& filter);

}  // namespace softgauss::app
