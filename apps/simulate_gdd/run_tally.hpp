// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the steps of a run add to its summary.

#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss::app {

/// Fallbacks and parts of a step.
void tally(const StepStats& stats, bool countsParts, io::Summary& summary);
/// How the solve of the goals ended.
void tally(const gdd::GddReport& report, io::GddOutcomes& outcomes);
/// Commands of actuators as shares of their bounds.
void tallyCommands(const gdd::GoalDirectedController& controller, io::Summary& summary);

}  // namespace softgauss::app
