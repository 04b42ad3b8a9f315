// SPDX-License-Identifier: Apache-2.0
/// softgauss's own part in the study beside other engines: it starts as the scene says, and moves
/// as physics says. The other engines are looked at by the gate of ./dev rivals.

#include <gtest/gtest.h>

#include "apps/rivals/engine.hpp"
#include "apps/rivals/judge/measures.hpp"

namespace rivals {
namespace {

/// A floating box that carries a hinged one with a stop and a sliding one that is pushed, turned
/// and moving: every kind of frame is in it. Nothing else acts, so that momentum stays.
const char* const kScene =
    R"({"name": "two", "measure": "smooth", "gravity": [0, 0, 0], "friction": 0.5,
  "ground": false, "collide": false, "duration": 0.5, "sample": 0.05, "bodies": [
  {"name": "a", "mass": 2, "inertia": [0.02, 0.03, 0.04], "position": [0.1, 0.2, 0.3],
   "orientation": [0.8, 0.6, 0, 0], "velocity": [0.3, -0.1, 0.2], "angular_velocity": [0.5, 0.2, -0.4], "shapes": []},
  {"name": "b", "mass": 1, "inertia": [0.01, 0.02, 0.03], "position": [0.1, 0.2, 0.8],
   "orientation": [0.6, 0, 0, 0.8], "velocity": [0.55, -0.45, 0.2], "angular_velocity": [0.5, 1.0, -0.4], "shapes": []}],
  "joints": [{"kind": "hinge", "parent": 0, "child": 1, "anchor": [0.1, 0.2, 0.55], "axis": [0, 1, 0],
   "range": [-3, 3], "force": 0}]})";

Scene hinged() {
  Scene scene = parseScene(kScene);
  // b as a point of a, and from the hinge on with its own spin.
  BodyState& b = scene.bodies[1].start;
  const BodyState& a = scene.bodies[0].start;
  const Vector3d anchor = scene.joints[0].anchor;
  b.velocity = a.velocity + a.angularVelocity.cross(anchor - a.position) +
               b.angularVelocity.cross(b.position - anchor);
  return scene;
}

std::unique_ptr<Engine> engineFor(const Scene& scene, double h,
                                  const std::vector<std::string>& given) {
  Settings settings(given);
  std::unique_ptr<Engine> engine = makeEngine(scene, h, settings);
  settings.expectAllTaken();
  return engine;
}

TEST(RivalsOurs, StartsAsTheSceneSaysAndKeepsItsMomentum) {
  const Scene scene = hinged();
  const auto engine = engineFor(scene, 0.01, {"integrator=runge-kutta-4"});
  EXPECT_NEAR(engine->mass(), scene.mass(), 1e-12);
  Trajectory run{engine->state()};
  EXPECT_LT(startError(scene, run), 1e-7);  // an angle of rounding: its cosine is off by 1e-15
  const Energies start = energiesOf(scene, run.front());
  EXPECT_NEAR(*engine->kineticEnergy(), start.kinetic, 1e-12);
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(engine->step(5));
    run.push_back(engine->state());
  }
  const Energies end = energiesOf(scene, run.back());
  EXPECT_LT((end.linear - start.linear).norm(), 1e-9);
  EXPECT_LT((end.angular - start.angular).norm(), 1e-7);  // Runge and Kutta's, of order h⁴
  EXPECT_LT(measure(scene, run).at("energy_percent"), 1e-5);
}

// A force in the world on a free body that spins, and friction of the ground that is another than
// that of bodies: F t/m in the air, (F - mu m g) t/m on the ground.
TEST(RivalsOurs, PushesAFreeBodyOverTheGround) {
  Scene scene = hinged();
  scene.joints.clear();
  scene.bodies.resize(1);
  scene.bodies[0].start.velocity.setZero();
  scene.bodies[0].force = Vector3d(3, -1, 2);
  const auto flying = engineFor(scene, 0.01, {});
  ASSERT_TRUE(flying->step(50));
  const Vector3d gained = 0.5 * scene.bodies[0].force / scene.bodies[0].mass;
  EXPECT_LT((flying->state()[0].velocity - gained).norm(), 1e-9);

  Body& box = scene.bodies[0];
  box.start = {Vector3d(0, 0, 0.1), Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero()};
  box.shapes = {{ShapeKind::box, Vector3d(0.3, 0.3, 0.1)}};
  box.force = Vector3d(12, 0, 0);
  scene.gravity = Vector3d(0, 0, -10);
  scene.ground = scene.collide = true;
  scene.friction = 0.9, scene.groundFriction = 0.4;
  const auto pushed = engineFor(scene, 0.01, {});
  ASSERT_TRUE(pushed->step(50));
  EXPECT_NEAR(pushed->state()[0].velocity[0], 0.5 * (12.0 - 8.0) / 2.0, 1e-2);
}

// A slider between two bodies that is pushed for 0.1 s, and pulled back for 0.1 s: they rest again,
// apart by a t² of what they gain on one another, and their common centre is where it was.
TEST(RivalsOurs, DrivesByAProgram) {
  Scene scene = hinged();
  scene.joints[0].kind = JointKind::slider;
  scene.joints[0].range.reset();
  for (Body& b : scene.bodies) b.start.velocity = b.start.angularVelocity = Vector3d::Zero();
  scene.joints[0].axis = Vector3d::UnitZ();  // through both centres
  scene.joints[0].program = {{0.1, 6.0}, {0.2, -6.0}, {0.3, 0.0}};
  const auto engine = engineFor(scene, 0.01, {"integrator=semi-implicit-euler"});
  ASSERT_TRUE(engine->step(50));
  const std::vector<BodyState> end = engine->state();
  const double gain = 6.0 / scene.bodies[1].mass + 6.0 / scene.bodies[0].mass;
  EXPECT_NEAR(end[1].position[2] - end[0].position[2] - 0.5, gain * 0.01, 1e-9);
  EXPECT_LT(end[0].velocity.norm() + end[1].velocity.norm(), 1e-9);
  const double middle = (2.0 * 0.3 + 1.0 * 0.8) / 3.0;
  EXPECT_NEAR((2.0 * end[0].position[2] + end[1].position[2]) / 3.0, middle, 1e-9);
}

// A ball that falls by 1 m is up again by e² of it: the recipe is good to 0.025 of e.
TEST(RivalsOurs, BouncesByTheRecipe) {
  Scene scene =
      parseScene(R"({"name": "ball", "measure": "bounce", "gravity": [0, 0, -9.81], "friction": 0.5,
    "ground": true, "collide": false, "duration": 1.2, "sample": 0.002, "restitution": 0.8, "bodies": [
    {"name": "ball", "mass": 1, "inertia": [0.004, 0.004, 0.004], "position": [0, 0, 1.1], "orientation": [1, 0, 0, 0],
     "velocity": [0, 0, 0], "angular_velocity": [0, 0, 0], "shapes": [{"kind": "sphere", "size": [0.1, 0, 0],
     "position": [0, 0, 0], "orientation": [1, 0, 0, 0]}]}], "joints": []})");
  const auto engine = engineFor(scene, 0.002, {});
  Trajectory run{engine->state()};
  for (int k = 0; k < 600; ++k) {
    ASSERT_TRUE(engine->step(1));
    run.push_back(engine->state());
  }
  EXPECT_NEAR(measure(scene, run).at("top1_mm"), 640.0, 2.0 * 0.8 * 25.0);
}

TEST(RivalsOurs, RefusesSettingsThatItDoesNotHave) {
  EXPECT_THROW(engineFor(hinged(), 0.01, {"iterations=50"}), std::invalid_argument);
  EXPECT_THROW(Settings({"exact_diagonal"}), std::invalid_argument);
}

}  // namespace
}  // namespace rivals
