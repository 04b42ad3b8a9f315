// SPDX-License-Identifier: Apache-2.0

/// The one solve of a step minimises each island by itself.

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// A scene that is stepped as one.
struct Joint {
  explicit Joint(const ModelBuilder& builder)
      : model(builder.build()), contacts(model), state(model), data(model) {}

  void step() {
    ASSERT_EQ(softgauss::step(model, {}, state, data, &contacts), SolveStatus::converged);
  }
  /// q, v of a free body.
  std::pair<VectorX, VectorX> of(const std::string& name) const {
    const auto found = std::find(model.bodyNames.begin(), model.bodyNames.end(), name);
    const Body& body = model.bodies[static_cast<std::size_t>(found - model.bodyNames.begin())];
    return {state.q.segment(body.q, 7), state.v.segment(body.v, 6)};
  }

  const Model model;
  collision::SceneContacts contacts;
  State state;
  Data data;
};

// What falls beside, rolls and collides changes no bit, nor how many iterations are taken.
TEST(SolveIslands, DoNotFeelWhoElseIsThere) {
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
    ModelBuilder few = ground(), many = ground(), others = ground();
    for (ModelBuilder* builder : {&few, &many, &others}) {
      builder->options.cone = cone;
      if (builder != &few)
        for (int i = 0; i < 5; ++i)
          addCube(*builder, "crowd" + std::to_string(i),
                  Vector3(3.0 + 0.1 * i, 0.0, 0.2 + 0.3 * i));
      if (builder != &others) {
        addCube(*builder, "lower", Vector3(0.0, 0.0, 0.15));
        addCube(*builder, "upper", Vector3(0.05, 0.0, 0.45));
      }
      if (builder != &few) addCreature(*builder, "other", Vector3(-2.0, 0.0, 1.0));
    }
    Joint alone(few), together(many), beside(others);
    int differ = 0;
    for (int i = 0; i < 600; ++i) {
      for (Joint* scene : {&alone, &together, &beside}) scene->step();
      for (const char* name : {"lower", "upper"}) ASSERT_EQ(alone.of(name), together.of(name));
      ASSERT_EQ(beside.of("crowd4"), together.of("crowd4"));
      const int a = alone.data.stats.iterations, b = beside.data.stats.iterations;
      // A solve that is repeated for one is, for the other, at its end.
      if (together.data.stats.repeats == 0 && together.data.stats.parts == 1) {
        ASSERT_EQ(together.data.stats.iterations, std::max(a, b));
      }
      differ += a != b;
    }
    EXPECT_GT(differ, 20);
  }
}

}  // namespace
}  // namespace softgauss::test
