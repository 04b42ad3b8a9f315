// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A model with all that a step needs, and random scenes by seed.

#include <memory>

#include "softgauss/engine/engine.hpp"
#include "tests/support/sample_contacts.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {

struct Scene {
  Model model;
  State state;
  Input input;
  std::shared_ptr<ContactSource> contacts;  ///< may be null
  std::unique_ptr<Data> data;

  explicit Scene(Model m, std::shared_ptr<ContactSource> source = nullptr)
      : model(std::move(m)),
        state(model),
        contacts(std::move(source)),
        data(std::make_unique<Data>(model)) {
    input.tau = VectorX::Zero(model.nv);
  }

  SolveStatus step() {
    renew();
    return softgauss::step(model, input, state, *data, contacts.get());
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  /// Everything up to the rows, at the present state.
  SolveStatus stages() {
    renew();
    return computeStages(model, input, state, *data, contacts.get());
  }
  SolveStatus forward() { return forwardDynamics(model, state, *data); }

 private:
  /// Tests change options of a scene; then its data are made for another model.
  void renew() {
    if (!data->plan.fits(model)) data = std::make_unique<Data>(model);
  }
};

/// A configuration anywhere on the manifold: joints with a range within 0.01 of one of its ends as
/// often as inside it, the others within ±1.
State randomState(const Model& model, Random& random, double speed = 2.0);

/// randomForest(seed) in a random state, with random applied forces, wrenches and `contacts`
/// random contacts, its stages computed.
Scene randomScene(std::uint64_t seed, int contacts = 8, const RandomTreeOptions& options = {});

/// randomScene(seed, contacts), with the other soft effects for odd seeds.
Scene lawScene(std::uint64_t seed, int contacts = 8);

/// The convex problem of the scene's stages, dense.
struct ConvexProblem;
ConvexProblem denseProblem(const Data& data);

}  // namespace softgauss::test
