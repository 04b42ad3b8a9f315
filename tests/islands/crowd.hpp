// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes of many units.

#include "softgauss/collision/unit_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {

/// A model with what steps it in islands.
struct Crowd {
  explicit Crowd(Model m, Sleep sleep = {})
      : model(std::move(m)), contacts(model), islands(model, &contacts, sleep) {}

  /// Steps without input; whether all could be taken.
  bool steps(int count) {
    for (int i = 0; i < count; ++i)
      if (islands.step({}) == SolveStatus::notFinite) return false;
    return true;
  }
  int body(const std::string& name) const;

  const Model model;
  collision::UnitContacts contacts;
  Islands islands;
};

/// A ground, and on it nothing yet.
ModelBuilder ground();

/// Adds a free cube of 0.2 m and 1 kg called `name`, its centre at p.
void addCube(ModelBuilder& builder, const std::string& name, const Vector3& p);

/// Adds an arm of three hinges on a floating base, capsules all, called `name`.
void addCreature(ModelBuilder& builder, const std::string& name, const Vector3& p);

/// `count` cubes, balls, capsules and creatures that fall from a loose heap onto the ground.
ModelBuilder heap(int count, std::uint64_t seed);

}  // namespace softgauss::test
