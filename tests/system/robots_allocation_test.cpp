// SPDX-License-Identifier: Apache-2.0

/// Several robots in one scene: their islands allocate nothing in steady state either.

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "softgauss/io/urdf.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

// Robots of different numbers of joints, each with goals of its own, beside objects.
TEST(RobotsAllocation, NoneInStepsOfSeveralRobots) {
  if (!kAllocationHook) GTEST_SKIP() << "a sanitizer owns the allocator";
  const auto robot = [](const std::string& name) {
    return io::readUrdf(std::string(SOFTGAUSS_SOURCE_DIR) + "/data/robots/" + name + ".urdf");
  };
  ModelBuilder builder("robots");
  builder.geometry(groundSpec(0.8));
  ModelBuilder hand = robot("hand"), arm = robot("arm");
  hand.X_WRoot.p = Vector3(3.0, 0.0, 0.3);
  arm.X_WRoot.p = Vector3(0.0, 2.0, 0.0);
  builder.add(hand, "hand");
  builder.add(arm, "arm");
  for (int i = 0; i < 3; ++i) {
    ModelBuilder cube("cube");
    cube.base = BaseKind::floating;
    cube.X_WRoot.p = Vector3(-2.0, 0.5 * i, 0.15);
    cube.link(boxLink("cube", 1.0, Vector3::Constant(0.1)));
    cube.geometry(geometrySpec("cube", Shape::box(Vector3::Constant(0.1)), 0.8));
    builder.add(cube, "object" + std::to_string(i));
  }
  const Model model = builder.build();
  collision::SceneContacts contacts(model);
  State state(model);
  Data data(model);
  gdd::GoalDirectedController controller(model);
  const auto reach = [&](const char* link, const Vector3& place) {
    controller.goals.push_back(std::make_unique<gdd::Reach>(model, link, place));
  };
  reach("arm/hand", Vector3(0.5, 2.3, 0.5));
  reach("hand/index_tip", Vector3(3.2, 0.1, 0.1));
  controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  const auto steps = [&] {
    for (int i = 0; i < 150; ++i)
      EXPECT_FALSE(isRefused(controller.step(model, {}, state, data, &contacts)));
  };
  const State start = state;
  steps();
  EXPECT_GE(controller.islands().size(), 3);
  state = start;
  const AllocationGuard guard;
  steps();
  EXPECT_EQ(guard.count(), 0);
}

// After reserve(), from where they are apart to where they hold a box between them.
TEST(RobotsAllocation, NoneAfterReserve) {
  if (!kAllocationHook) GTEST_SKIP() << "a sanitizer owns the allocator";
  Simulation sim =
      Simulation::load(std::string(SOFTGAUSS_SOURCE_DIR) + "/data/scenes/two_arms.yaml");
  sim.reserve();
  const AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) EXPECT_FALSE(isRefused(sim.step()));
  EXPECT_EQ(guard.count(), 0);
}

}  // namespace
}  // namespace softgauss::test
