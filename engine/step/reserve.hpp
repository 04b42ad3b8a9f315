// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Memory for steps to come, so that a controller's loop allocates none.
///
/// What a step needs grows with its rows, in many arrays. So the largest step is made once: rows of
/// so many contacts between each two geometries alone and of one between each of all, with every
/// joint beyond its range, and their solve. What it finds is dropped.

#include <span>
#include <utility>

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Makes room in `data` for steps from any state with at most `contacts` contacts, each between two
/// of these geometries. Steps with more work, too, and allocate. Leaves the stages of that step in
/// `data`.
void reserveRows(const Model& model, std::span<const std::pair<int, int>> geometries, int contacts,
                 Data& data);

}  // namespace softgauss
