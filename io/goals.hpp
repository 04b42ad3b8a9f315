// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Reads goals from YAML files; the schema, with an example of every kind, is
/// docs/reference/goals.md.
///
/// Strict: a key that is unknown or written twice, a value of another type or count than expected,
/// a number that is not finite, beyond 10¹² or out of range, a link or joint that the model lacks
/// end in a ModelError `file:line: goal 2 'reach': key 'weight': found '-1', expected …`.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "softgauss/engine/model/shape_distances.hpp"
#include "softgauss/engine/model/state.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss::io {

struct GoalFile {
  std::vector<std::unique_ptr<gdd::Goal>> goals;  ///< in the order of the file; none is added
  std::optional<gdd::ControlCost> controlCost;    ///< where the file has the key `control_cost`

  /// Makes them the goals of the controller, in place of those it has.
  void giveTo(gdd::GoalDirectedController& controller) &&;
};

/// Who tells how far shapes of a model are apart, for goals that ask for it (keep_clear).
using DistancesMaker = std::function<std::shared_ptr<ShapeDistances>(const Model&)>;

/// A file of goals, or a scene, of which the goals are taken. `initial` is the state from which the
/// simulation starts: the reference of a posture and the start of a minimum-jerk reach.
/// Without `distances` goals that ask for them are refused. Throws ModelError.
GoalFile readGoalFile(const std::filesystem::path& file, const Model& model, const State& initial,
                      const DistancesMaker& distances = nullptr);

/// The same from the text of such a file; messages call it `name`.
GoalFile parseGoals(const std::string& text, const std::string& name, const Model& model,
                    const State& initial, const DistancesMaker& distances = nullptr);

/// The goals alone.
std::vector<std::unique_ptr<gdd::Goal>> readGoals(const std::filesystem::path& file,
                                                  const Model& model, const State& initial,
                                                  const DistancesMaker& distances = nullptr);

}  // namespace softgauss::io
