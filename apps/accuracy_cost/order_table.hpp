// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Orders of convergence that a study has seen, and what the solver's tolerance, its warm start and
/// the cones change, as Markdown.

#include <filesystem>
#include <optional>

#include "apps/accuracy_cost/study.hpp"

namespace softgauss::app {

/// p of e ~ hᵖ: the slope of log e over log h, by least squares over at least four step sizes.
/// Nothing where fewer errors count: those that references tell, above rounding (1e-13 m).
std::optional<double> orderOf(const std::vector<Result>& curve);
/// The same of steps up to the first at which a longer one errs half as much: there another way of
/// moving on takes over.
std::optional<double> orderBelowTheTurnOf(const std::vector<Result>& curve);
/// The same of Result::oneStep, which errs by one order more in smooth motion.
std::optional<double> oneStepOrderOf(const std::vector<Result>& curve);

/// accuracy_orders.md, of all methods of fixed steps; and accuracy_solver.md, at 2 ms, of
/// the leapfrog, the midpoint rule, Dormand–Prince to 1e-8 and MuJoCo's Euler. Throws
/// std::runtime_error where one cannot be written.
void writeOrderTables(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                      const std::vector<Result>& results);

}  // namespace softgauss::app
