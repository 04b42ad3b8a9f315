// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes of many units, with goals.

#include <memory>
#include <numeric>
#include <optional>

#include "softgauss/gdd/gdd.hpp"
#include "tests/islands/crowd.hpp"

namespace softgauss::test {

/// Two creatures whose joints have motors, one on a table of two cubes, and a cube by itself.
inline ModelBuilder robotsAndCubes() {
  ModelBuilder builder = ground();
  addCreature(builder, "lying", Vector3(0.0, 0.0, 0.05));
  addCube(builder, "lower", Vector3(2.0, 0.0, 0.1));
  addCube(builder, "upper", Vector3(2.0, 0.0, 0.3));
  addCreature(builder, "lifted", Vector3(2.0, 0.0, 0.5));
  addCube(builder, "alone", Vector3(4.0, 0.0, 0.1));
  return builder;
}

/// All trees of a model, as an island.
inline SubModel allOf(const Model& model) {
  std::vector<int> trees(model.trees.size());
  std::iota(trees.begin(), trees.end(), 0);
  return SubModel(model, trees);
}

/// A scene with goals that is stepped in islands.
struct GoalCrowd {
  explicit GoalCrowd(Model m) : model(std::move(m)), controller(model), contacts(model) {}

  /// To be called when the controller has its goals.
  void start(Sleep sleep = {}) {
    controls.emplace(model, controller);
    islands.emplace(model, &contacts, sleep, &*controls);
  }
  bool steps(int count) {
    for (int i = 0; i < count; ++i)
      if (islands->step({}) == SolveStatus::notFinite) return false;
    return true;
  }
  int body(const std::string& name) const {
    return model.frames[static_cast<std::size_t>(model.findFrame(name))].body;
  }
  gdd::Reach& reach(const std::string& link, const Vector3& place) {
    auto goal = std::make_unique<gdd::Reach>(model, link, place);
    gdd::Reach& added = *goal;
    controller.goals.push_back(std::move(goal));
    return added;
  }

  const Model model;
  gdd::GoalDirectedController controller;
  collision::UnitContacts contacts;
  std::optional<gdd::GoalDirectedIslands> controls;
  std::optional<Islands> islands;
};

}  // namespace softgauss::test
