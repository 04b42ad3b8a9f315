// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes of many trees, with goals or without.

#include <memory>
#include <string>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {

/// Objects sleep.
inline constexpr Sleep kSleep{.enabled = true};

/// A model with what steps it; with goals once its controller has some.
struct Crowd {
  explicit Crowd(ModelBuilder builder, const Sleep& sleep = {})
      : model(build(std::move(builder), sleep)),
        contacts(model),
        state(model),
        data(model),
        controller(model) {}

  SolveStatus step(const Input& input = {}) {
    return controller.goals.empty() ? softgauss::step(model, input, state, data, &contacts)
                                    : controller.step(model, input, state, data, &contacts);
  }
  /// Steps without input; whether all could be taken.
  bool steps(int count) {
    for (int i = 0; i < count; ++i)
      if (isRefused(step())) return false;
    return true;
  }
  const Body& body(const std::string& link) const {
    return model.bodies[idx(model.frames[idx(model.findFrame(link))].body)];
  }
  bool asleep(const std::string& link) const { return state.sleep.isAsleep(body(link).tree); }
  /// Trees of which the last step was.
  int awake() const { return static_cast<int>(model.trees.size()) - data.stats.asleepTrees; }
  gdd::Reach& reach(const std::string& link, const Vector3& place) {
    auto goal = std::make_unique<gdd::Reach>(model, link, place);
    gdd::Reach& added = *goal;
    controller.goals.push_back(std::move(goal));
    return added;
  }

  const Model model;
  collision::SceneContacts contacts;
  State state;
  Data data;
  gdd::GoalDirectedController controller;

 private:
  static Model build(ModelBuilder builder, const Sleep& sleep) {
    builder.options.sleep = sleep;
    return builder.build();
  }
};

/// A ground, and on it nothing yet.
ModelBuilder ground();

/// Adds a free cube of 0.2 m and 1 kg called `name`, its centre at p.
void addCube(ModelBuilder& builder, const std::string& name, const Vector3& p);

/// Adds an arm of three hinges on a floating base, capsules all, called `name`.
void addCreature(ModelBuilder& builder, const std::string& name, const Vector3& p);

/// Four stacks of two cubes, 1 m apart: cube00 and cube01 on it, to cube31.
ModelBuilder stacks();

/// Two creatures whose joints have motors, one on a table of two cubes, and a cube by itself.
ModelBuilder robotsAndCubes();

/// `count` cubes, balls, capsules and creatures that fall from a loose heap onto the ground.
ModelBuilder heap(int count, std::uint64_t seed);

}  // namespace softgauss::test
