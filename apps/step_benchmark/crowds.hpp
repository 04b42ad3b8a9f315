// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What islands and sleep save: pairs of scenes, timed in turn in one run.

#include <map>
#include <string>

namespace softgauss::app {

/// Figures of every pair whose name matches the regular expression, as islands_name.key:
///   islands_asleep   100 humanoids that lie on the ground, asleep over awake
///   islands_mover    a ball that rolls among 1,000 sleeping boxes, over the same ball alone
///   islands_robots   100 humanoids that fall, over one of them, per humanoid
///   islands_few      16 of them, over one, per humanoid
///   islands_none     100 without islands, over one, per humanoid
///   islands_joint    those 100 in islands, over the joint solve of all
///   islands_reacher  an arm that reaches among 1,000 sleeping boxes, over the arm alone
///   islands_goals    8 humanoids that reach, each with its goals, over one, per humanoid
///   islands_goals_joint  those 8 in islands, over the joint solve of all
///   parts_boxes      50 boxes at rest beside a rod that spins, whose steps go in parts, over the
///                    boxes alone and the rod alone together
///   parts_humanoid, parts_reach  the same of a humanoid that stands, and of one that reaches
/// `first.us` and `second.us` are medians of CPU time per step, `ratio` that of the medians.
std::map<std::string, double> crowdFigures(const std::string& robots, const std::string& filter);

}  // namespace softgauss::app
