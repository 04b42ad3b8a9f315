// SPDX-License-Identifier: Apache-2.0
/// Targets of a plan that are moved and switched while it is acted out.

#include "softgauss/io/simulation/plan_targets.hpp"

#include <gtest/gtest.h>

#include "softgauss/io/simulation/simulation.hpp"
#include "tests/io/temp_folder.hpp"
#include "tests/simulation/data_file.hpp"
#include "tests/simulation/quadruped.hpp"

namespace softgauss::test {
namespace {

/// A quadruped that goes ahead, with a foot that has a place.
struct Targets {
  explicit Targets(bool fixed = false) {
    folder.write("dog.urdf", quadruped());
    const std::string foot = "points: {FL_foot: {target: [0.3, 0.1, 0], weight: 7}}";
    const std::string file =
        folder.write("plan.yaml",
                     "robots: [{urdf: dog.urdf, on_ground: true}]\nplan:\n  knots: 4\n"
                     "  running: {position: {all: 1, base_position: 5}, " +
                         foot + "}\n  final: {position: 2, " + foot +
                         "}\n  target: {move: [0.4, 0, 0], steady: true}\n");
    scene = loadScene(file);
    task = io::readPlanTask(file, scene->model, scene->initial);
    targets.join(scene->model, task, fixed, goals);
  }
  io::TempFolder folder;
  std::unique_ptr<Scene> scene;
  io::PlanTask task;
  PlanTargets targets;
  std::vector<std::unique_ptr<gdd::Goal>> goals;
};

// A place that running and final terms have is one goal, beside that of the configuration.
TEST(PlanTargets, AreAGoalEach) {
  Targets t;
  ASSERT_EQ(t.goals.size(), 2u);
  EXPECT_EQ(t.goals[0]->name(), "plan");
  EXPECT_EQ(t.goals[1]->name(), "plan FL_foot");
  EXPECT_FALSE(t.targets.update(0.0, t.task));
  Data data(t.scene->model);
  computeKinematics(t.scene->model, t.scene->initial, data.kinematics);
  const gdd::GoalContext context{t.scene->model, t.scene->initial, data};
  const auto base = t.goals[0]->mark(context);
  ASSERT_TRUE(base);
  EXPECT_NEAR((base->p_WTarget - base->p_WPoint - Vector3(0.4, 0, 0)).norm(), 0.0, 1e-15);
}

TEST(PlanTargets, MoveBothTermsOfAPlace) {
  Targets t;
  const Vector3 place(0.1, 0.2, 0.3);
  std::copy_n(place.data(), 3, t.goals[1]->soughtPlace());
  const std::size_t knots = t.task.q.size();
  EXPECT_TRUE(t.targets.update(0.0, t.task));
  EXPECT_EQ(t.task.running.points[0].target, place);
  EXPECT_EQ(t.task.final.points[0].target, place);
  EXPECT_EQ(t.task.q.size(), knots);  // still steady
  EXPECT_FALSE(t.targets.update(0.0, t.task));
}

// The base's place and the configuration are one target, at rest.
TEST(PlanTargets, MoveTheBaseToRest) {
  Targets t;
  t.goals[0]->soughtPlace()[1] = 0.7;
  EXPECT_TRUE(t.targets.update(0.0, t.task));
  ASSERT_EQ(t.task.q.size(), 1u);
  EXPECT_EQ(t.task.q[0][t.scene->model.bodies[1].q + 1], 0.7);
  EXPECT_EQ(t.task.q[0], *t.goals[0]->soughtPositions());
  EXPECT_TRUE(t.task.v[0].isZero(0.0));
}

TEST(PlanTargets, WeighNothingWhileTheyAreOff) {
  Targets t;
  const VectorX position = t.task.running.position;
  for (const auto& goal : t.goals) goal->startTime = kInfinity;
  EXPECT_TRUE(t.targets.update(1.0, t.task));
  EXPECT_TRUE(t.task.running.position.isZero(0.0));
  EXPECT_EQ(t.task.final.points[0].weight, 0.0);
  for (const auto& goal : t.goals) goal->startTime = -kInfinity;
  EXPECT_TRUE(t.targets.update(2.0, t.task));
  EXPECT_EQ(t.task.running.position, position);
  EXPECT_EQ(t.task.final.points[0].weight, 7.0);
}

TEST(PlanTargets, StayWhereAPlanIsMadeOnce) {
  Targets t(true);
  for (const auto& goal : t.goals) {
    EXPECT_EQ(goal->soughtPlace(), nullptr);
    EXPECT_EQ(goal->soughtPositions(), nullptr);
  }
}

}  // namespace
}  // namespace softgauss::test
