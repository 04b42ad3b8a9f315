// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Reads goals from YAML files; the schema, with an example of every kind, is docs/goals.md.
///
/// Strict: a key that is unknown or written twice, a value of another type or count than expected,
/// a number that is not finite, beyond 10¹² or out of range, a link or joint that the model lacks
/// end in a ModelError `file:line: goal 2 'reach': key 'weight': found '-1', expected …`.

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/model/state.hpp"
#include "gdd/goal.hpp"

namespace softgauss::io {

/// The goals of the file, in its order; none is added. `initial` is the state from which the
/// simulation starts: the reference of a posture and the start of a minimum-jerk reach.
/// Throws ModelError.
std::vector<std::unique_ptr<gdd::Goal>> readGoals(const std::filesystem::path& file,
                                                  const Model& model, const State& initial);

}  // namespace softgauss::io
