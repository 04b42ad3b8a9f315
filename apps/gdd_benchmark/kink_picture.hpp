// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a kink is: the objective F(u) of (10.7) along two lines of controls through a minimum that
/// sits at the breakpoint of a contact's row.
///
///   across   p = K⁻¹n / |K⁻¹n|,   n = ∂x/∂u = Bᵀ P⁻¹Jᵀ    the cheapest way over the breakpoint
///   along    p ⟂ n, as near to u as that allows           the row stays at its breakpoint
///
/// P and K are those of the cell in which the row is free. Every point is a forward solve of its
/// own, (1.1) to rounding: nothing is taken from the solver but the minimum.

#include <filesystem>

#include "apps/gdd_benchmark/dataset.hpp"

namespace softgauss::app {

/// Draws the sharpest of the recorded minima with one row at its breakpoint, as an .svg file.
/// Sharpness: the lesser of the two slopes that lead up from the minimum across the breakpoint.
/// Throws std::runtime_error when there is none, or when it cannot be drawn or written.
void drawKink(const Robot& robot, const Dataset& dataset, const std::filesystem::path& file);

}  // namespace softgauss::app
