// SPDX-License-Identifier: Apache-2.0

/// What rests beside goals sleeps, and goals wake what they are about.

#include "tests/islands/goal_crowd.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// A robot that comes to rest by itself: a cube, and a rod that hangs beside it from a damped
/// motor.
void addCrane(ModelBuilder& builder, const std::string& name, const Vector3& p) {
  ModelBuilder one(name);
  one.base = BaseKind::floating;
  one.X_WRoot.p = p;
  one.link(boxLink(name + "_base", 1.0, Vector3::Constant(0.1)));
  one.geometry(geometrySpec(name + "_base", Shape::box(Vector3::Constant(0.1)), 0.8));
  LinkSpec rod = boxLink(name + "_rod", 0.1, Vector3(0.01, 0.01, 0.05));
  rod.com.z() = -0.05;
  one.link(rod);
  JointSpec motor = jointSpec(name + "_motor", JointType::revolute, name + "_base", name + "_rod",
                              {Matrix3::Identity(), Vector3(0.15, 0.0, 0.0)}, Vector3::UnitY());
  motor.damping = 0.02;
  one.joint(motor);
  builder.add(one, "");
}

/// The three joints of a creature bent by 0.4 rad.
std::unique_ptr<gdd::JointPosture> bent(const Model& model, const std::string& name) {
  auto goal = std::make_unique<gdd::JointPosture>();
  for (const char* joint : {"_1_joint", "_2_joint", "_3_joint"})
    goal->targets.push_back(gdd::jointTarget(model, name + joint, 0.4));
  return goal;
}

TEST(SleepUnderGoals, ObjectsSleepAndRobotsWakeThatGoalsBeginFor) {
  ModelBuilder builder = ground();
  addCrane(builder, "first", Vector3(0.0, 0.0, 0.1));
  addCube(builder, "lower", Vector3(2.0, 0.0, 0.1));
  addCube(builder, "upper", Vector3(2.0, 0.0, 0.3));
  addCrane(builder, "second", Vector3(2.0, 0.0, 0.5));
  addCube(builder, "alone", Vector3(4.0, 0.0, 0.1));
  GoalCrowd crowd(builder.build());
  crowd.reach("first_rod", Vector3(0.3, 0.0, 0.2));
  crowd.reach("second_rod", Vector3(2.3, 0.0, 0.6)).startTime = 6.0;
  crowd.controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  crowd.controller.goals.back()->endTime = 3.0;
  crowd.start(Sleep{.enabled = true});
  ASSERT_TRUE(crowd.steps(1490));
  EXPECT_EQ(crowd.islands->islandStats().controlled, 2);  // damping is of all robots
  EXPECT_TRUE(crowd.islands->asleep(crowd.body("alone")));
  EXPECT_FALSE(crowd.islands->asleep(crowd.body("lower")));  // a robot under control is on it
  ASSERT_TRUE(crowd.steps(1500));
  EXPECT_EQ(crowd.islands->islandStats().controlled, 1);
  EXPECT_TRUE(crowd.islands->asleep(crowd.body("second_rod")));
  EXPECT_TRUE(crowd.islands->asleep(crowd.body("lower")));
  EXPECT_FALSE(crowd.islands->asleep(crowd.body("first_rod")));
  int wakeups = 0;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(crowd.steps(1));
    wakeups += crowd.islands->islandStats().wakeups;
  }
  EXPECT_EQ(wakeups, 1);
  EXPECT_FALSE(crowd.islands->asleep(crowd.body("second_rod")));
  EXPECT_TRUE(crowd.islands->asleep(crowd.body("alone")));
  EXPECT_EQ(crowd.islands->islandStats().controlled, 2);
  const Body& rod = crowd.model.bodies[static_cast<std::size_t>(crowd.body("second_rod"))];
  EXPECT_NE(crowd.controller.control[rod.v], 0.0);
}

TEST(SleepUnderGoals, MayLetRobotsSleep) {
  for (const bool controlled : {false, true}) {
    ModelBuilder builder = ground();
    addCreature(builder, "robot", Vector3(0.0, 0.0, 0.05));
    GoalCrowd crowd(builder.build());
    crowd.controller.goals.push_back(bent(crowd.model, "robot"));
    crowd.start(Sleep{.enabled = true, .controlled = controlled});
    ASSERT_TRUE(crowd.steps(5000));
    ASSERT_EQ(crowd.islands->asleep(crowd.body("robot_0")), controlled);
    if (!controlled) continue;
    const VectorX control = crowd.controller.control;
    EXPECT_GT(control.cwiseAbs().maxCoeff(), 0.0);  // it keeps what held it
    ASSERT_TRUE(crowd.steps(1));
    EXPECT_EQ(crowd.controller.control, control);
    crowd.reach("robot_3", Vector3(0.0, 0.3, 0.5));
    crowd.controls->changed();
    ASSERT_TRUE(crowd.steps(1));
    EXPECT_FALSE(crowd.islands->asleep(crowd.body("robot_0")));
    EXPECT_NE(crowd.controller.control, control);
    crowd.controller.goals.clear();
    crowd.controls->changed();
    ASSERT_TRUE(crowd.steps(1));
    EXPECT_EQ(crowd.controller.control, VectorX::Zero(crowd.model.nv));
  }
}

TEST(SleepUnderGoals, WakeThoseThatTheyAreAbout) {
  ModelBuilder builder = ground();
  for (int i = 0; i < 4; ++i)
    addCreature(builder, "robot" + std::to_string(i), Vector3(2.0 * i, 0.0, 0.05));
  GoalCrowd crowd(builder.build());
  for (int i = 0; i < 4; ++i)
    crowd.controller.goals.push_back(bent(crowd.model, "robot" + std::to_string(i)));
  crowd.start(Sleep{.enabled = true, .controlled = true});
  ASSERT_TRUE(crowd.steps(6000));
  ASSERT_EQ(crowd.islands->islandStats().awake, 0);
  static_cast<gdd::JointPosture&>(*crowd.controller.goals[2]).targets[0].value = -0.4;
  crowd.controls->changed(2);
  ASSERT_TRUE(crowd.steps(1));
  EXPECT_EQ(crowd.islands->islandStats().awake, 1);
  EXPECT_FALSE(crowd.islands->asleep(crowd.body("robot2_0")));
  const int joint = crowd.model.findJoint("robot2_1_joint");
  ASSERT_TRUE(crowd.steps(6000));
  EXPECT_EQ(crowd.islands->islandStats().awake, 0);
  EXPECT_NEAR(crowd.islands->state().q[crowd.model.bodies[static_cast<std::size_t>(joint)].q], -0.4,
              0.05);
}

TEST(SleepUnderGoals, WakeWhereTheirTargetBeginsToMove) {
  ModelBuilder builder = ground();
  addCreature(builder, "robot", Vector3(0.0, 0.0, 0.05));
  GoalCrowd crowd(builder.build());
  auto goal = bent(crowd.model, "robot");
  const double begins = 6000 * crowd.model.options.timestep;
  const MatrixX p = (MatrixX(1, 2) << 0.4, -0.4).finished();
  goal->targets[2].trajectory = std::make_shared<gdd::KnotTrajectory>(
      std::vector<double>{begins, begins + 1000 * crowd.model.options.timestep}, p);
  crowd.controller.goals.push_back(std::move(goal));
  crowd.start(Sleep{.enabled = true, .controlled = true});
  ASSERT_TRUE(crowd.steps(5900));
  ASSERT_TRUE(crowd.islands->asleep(crowd.body("robot_0")));
  ASSERT_TRUE(crowd.steps(200));
  ASSERT_FALSE(crowd.islands->asleep(crowd.body("robot_0")));
  ASSERT_TRUE(crowd.steps(3000));
  const auto body = static_cast<std::size_t>(crowd.model.findJoint("robot_3_joint"));
  EXPECT_NEAR(crowd.islands->state().q[crowd.model.bodies[body].q], -0.4, 0.05);
}

TEST(SleepUnderGoals, FollowALineAwake) {
  // A minimum-jerk line of 8 s starts with less than 1 mm/s; a robot that slept would never go.
  ModelBuilder builder = ground();
  addCreature(builder, "robot", Vector3(0.0, 0.0, 0.05));
  GoalCrowd crowd(builder.build());
  gdd::Reach& reach = crowd.reach("robot_3", Vector3::Zero());
  reach.minimumJerk = gdd::MinimumJerk{.startTime = 1.0, .duration = 8.0};
  EXPECT_TRUE(reach.steadyAt(0.9));
  EXPECT_FALSE(reach.steadyAt(1.0));
  EXPECT_FALSE(reach.steadyAt(9.0));
  EXPECT_TRUE(reach.steadyAt(9.1));
  reach.minimumJerk.reset();
  EXPECT_TRUE(reach.steadyAt(2.0));

  crowd.start(Sleep{.enabled = true, .controlled = true});
  ASSERT_TRUE(crowd.steps(1));
  const SubModel whole = allOf(crowd.model);
  EXPECT_TRUE(crowd.controls->within(whole)->steady(2.0));
  reach.minimumJerk = gdd::MinimumJerk{.startTime = 1.0, .duration = 8.0};
  EXPECT_FALSE(crowd.controls->within(whole)->steady(2.0));
}

}  // namespace
}  // namespace softgauss::test
