// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Times of several kinds of steps, pieces of each in turn: where the machine changes its speed,
/// all feel it, and ratios keep their meaning.

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace softgauss::app {

struct Timed {
  std::function<void()> begin;  ///< before a piece, not timed
  std::function<void()> step;
  int steps = 1;  ///< in a piece
};

/// Of each, the median over pieces of the mean CPU time of this thread per step [µs].
std::vector<double> timeInTurn(const std::vector<Timed>& all);

/// Of all rungs of the ladder whose name matches the regular expression, and of what they are
/// compared with:
///   ladder_base_effect.in_turn.us   a step, from the rung's state
///   ladder_base_effect.added.us     that less the one of `nothing`
///   ladder_arm_bare.in_turn.us      the algorithms that a step of the arm cannot do without:
///                                   kinematics, M, bias forces, factor, solve
///   ladder_arm_bare_midpoint.in_turn.us  with those that the integrator adds, at mid-step
///   ladder_arm_effect.over_bare     the step over them; plainarm: over those without mid-step
std::map<std::string, double> ladderInTurn(const std::string& robots, const std::string& filter);

/// Of all counts of every kind whose name matches: scaling_what_count.in_turn.us.
std::map<std::string, double> scalingInTurn(const std::string& robots, const std::string& filter);

}  // namespace softgauss::app
