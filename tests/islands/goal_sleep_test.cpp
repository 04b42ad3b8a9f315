// SPDX-License-Identifier: Apache-2.0

/// What rests beside goals sleeps, and goals wake what they are about.

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"

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

constexpr Sleep kAll{.enabled = true, .controlled = true};

/// Two cranes, the second on a table of two cubes, and a cube by itself.
ModelBuilder cranes() {
  ModelBuilder builder = ground();
  addCrane(builder, "first", Vector3(0.0, 0.0, 0.1));
  addCube(builder, "lower", Vector3(2.0, 0.0, 0.1));
  addCube(builder, "upper", Vector3(2.0, 0.0, 0.3));
  addCrane(builder, "second", Vector3(2.0, 0.0, 0.5));
  addCube(builder, "alone", Vector3(4.0, 0.0, 0.1));
  return builder;
}

// Of two modes: objects that no control acts on sleep, in reach of a robot or not; or robots too,
// with all that they touch, until a goal of theirs begins.
TEST(SleepUnderGoals, IsOfObjectsOrOfAll) {
  for (const Sleep& sleep : {kSleep, kAll}) {
    Crowd crowd(cranes(), sleep);
    crowd.reach("first_rod", Vector3(0.3, 0.0, 0.2));
    crowd.reach("second_rod", Vector3(2.3, 0.0, 0.6)).startTime = 6.0;
    crowd.controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
    ASSERT_TRUE(crowd.steps(2990));
    EXPECT_TRUE(crowd.asleep("alone"));
    for (const char* name : {"lower", "upper", "second_rod"})
      EXPECT_EQ(crowd.asleep(name), sleep.controlled) << name;
    EXPECT_EQ(crowd.asleep("first_rod"), sleep.controlled);
    int woken = 0;
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(crowd.steps(1));
      woken += crowd.data.stats.wokenTrees;
    }
    EXPECT_EQ(woken, sleep.controlled ? 3 : 0);  // the robot and its table
    EXPECT_FALSE(crowd.asleep("second_rod"));
    EXPECT_EQ(crowd.asleep("first_rod"), sleep.controlled);
    EXPECT_TRUE(crowd.asleep("alone"));
    EXPECT_NE(crowd.controller.control[crowd.body("second_rod").v], 0.0);
  }
}

// Sleepers change no bit of a robot that never touches them, nor of its control.
TEST(SleepUnderGoals, DoesNotChangeWhoIsAwake) {
  ModelBuilder few = ground(), many = ground();
  for (int i = 0; i < 4; ++i) addCube(many, "cube" + std::to_string(i), Vector3(i, 2.0, 0.1));
  for (ModelBuilder* builder : {&few, &many}) addCreature(*builder, "robot", {0.0, 0.0, 0.05});
  Crowd alone(few, kSleep), beside(many, kSleep);
  for (Crowd* crowd : {&alone, &beside}) {
    crowd->reach("robot_3", Vector3(0.3, 0.0, 0.3));
    crowd->controller.goals.push_back(std::make_unique<gdd::Posture>(crowd->model.q0));
    crowd->controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  }
  for (int i = 0; i < 800; ++i) {
    ASSERT_TRUE(alone.steps(1) && beside.steps(1));
    ASSERT_EQ(beside.state.q.tail(alone.model.nq), alone.state.q) << i;
    ASSERT_EQ(beside.controller.control.tail(alone.model.nv), alone.controller.control) << i;
  }
  EXPECT_EQ(beside.awake(), 1);
}

TEST(SleepUnderGoals, MayLetRobotsSleep) {
  for (const Sleep& sleep : {kSleep, kAll}) {
    ModelBuilder builder = ground();
    addCreature(builder, "robot", Vector3(0.0, 0.0, 0.05));
    Crowd crowd(builder, sleep);
    crowd.controller.goals.push_back(bent(crowd.model, "robot"));
    ASSERT_TRUE(crowd.steps(5000));
    ASSERT_EQ(crowd.asleep("robot_0"), sleep.controlled);
    if (!sleep.controlled) continue;
    const VectorX control = crowd.controller.control;
    EXPECT_GT(control.cwiseAbs().maxCoeff(), 0.0);  // it keeps what held it
    VectorX applied;
    ASSERT_TRUE(crowd.steps(1));
    EXPECT_EQ(crowd.controller.control, control);
    appliedForces(crowd.data, applied);
    EXPECT_EQ(applied, control);
    crowd.reach("robot_3", Vector3(0.0, 0.3, 0.5));
    wakeAll(crowd.state.sleep);
    ASSERT_TRUE(crowd.steps(1));
    EXPECT_FALSE(crowd.asleep("robot_0"));
    EXPECT_NE(crowd.controller.control, control);
  }
}

// A saved state, with what the controller and the Data keep of sleepers, goes on to the same bits,
// control included.
TEST(SleepUnderGoals, GoesOnFromASavedState) {
  Crowd unbroken(cranes(), kAll), resumed(cranes(), kAll);
  for (Crowd* crowd : {&unbroken, &resumed}) {
    crowd->reach("first_rod", Vector3(0.3, 0.0, 0.2));
    crowd->reach("second_rod", Vector3(2.3, 0.0, 0.6)).startTime = 6.0;
    crowd->controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  }
  ASSERT_TRUE(unbroken.steps(2990));
  ASSERT_EQ(unbroken.awake(), 0);
  ByteWriter writer;
  writer(unbroken.state, *unbroken.data.sleepers, unbroken.controller);
  ByteReader reader(writer.bytes());
  reader(resumed.state, *resumed.data.sleepers, resumed.controller);
  reader.expectEnd();
  std::vector<Snapshot::ContactForce> contacts, same;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(unbroken.steps(1) && resumed.steps(1));
    ASSERT_EQ(hash(unbroken.state), hash(resumed.state)) << i;
    ASSERT_EQ(unbroken.controller.control, resumed.controller.control);
    contactForces(unbroken.data, contacts);
    contactForces(resumed.data, same);
    ASSERT_EQ(contacts.size(), same.size());
  }
  EXPECT_EQ(unbroken.awake(), 3);
}

TEST(SleepUnderGoals, EndsForThoseThatAGoalConcerns) {
  ModelBuilder builder = ground();
  for (int i = 0; i < 4; ++i)
    addCreature(builder, "robot" + std::to_string(i), Vector3(2.0 * i, 0.0, 0.05));
  Crowd crowd(builder, kAll);
  for (int i = 0; i < 4; ++i)
    crowd.controller.goals.push_back(bent(crowd.model, "robot" + std::to_string(i)));
  ASSERT_TRUE(crowd.steps(6000));
  ASSERT_EQ(crowd.awake(), 0);
  static_cast<gdd::JointPosture&>(*crowd.controller.goals[2]).targets[0].value = -0.4;
  gdd::wake(crowd.model, *crowd.controller.goals[2], crowd.state.sleep);
  ASSERT_TRUE(crowd.steps(1));
  EXPECT_EQ(crowd.awake(), 1);
  EXPECT_FALSE(crowd.asleep("robot2_0"));
  ASSERT_TRUE(crowd.steps(6000));
  EXPECT_EQ(crowd.awake(), 0);
  const int joint = crowd.model.findJoint("robot2_1_joint");
  EXPECT_NEAR(crowd.state.q[crowd.model.bodies[idx(joint)].q], -0.4, 0.05);
}

TEST(SleepUnderGoals, EndsWhereATargetBeginsToMove) {
  ModelBuilder builder = ground();
  addCreature(builder, "robot", Vector3(0.0, 0.0, 0.05));
  Crowd crowd(builder, kAll);
  auto goal = bent(crowd.model, "robot");
  const double begins = 6000 * crowd.model.options.timestep;
  const MatrixX p = (MatrixX(1, 2) << 0.4, -0.4).finished();
  goal->targets[2].trajectory = std::make_shared<gdd::KnotTrajectory>(
      std::vector<double>{begins, begins + 1000 * crowd.model.options.timestep}, p);
  crowd.controller.goals.push_back(std::move(goal));
  ASSERT_TRUE(crowd.steps(5900));
  ASSERT_TRUE(crowd.asleep("robot_0"));
  ASSERT_TRUE(crowd.steps(200));
  ASSERT_FALSE(crowd.asleep("robot_0"));
  ASSERT_TRUE(crowd.steps(3000));
  const int body = crowd.model.findJoint("robot_3_joint");
  EXPECT_NEAR(crowd.state.q[crowd.model.bodies[idx(body)].q], -0.4, 0.05);
}

// A minimum-jerk line of 8 s starts with less than 1 mm/s; a robot that slept would never go.
TEST(SleepUnderGoals, IsNotForWhoFollowsALine) {
  ModelBuilder builder = ground();
  addCreature(builder, "robot", Vector3(0.0, 0.0, 0.05));
  Crowd crowd(builder, kAll);
  gdd::Reach& reach = crowd.reach("robot_3", Vector3::Zero());
  reach.minimumJerk = gdd::MinimumJerk{.startTime = 1.0, .duration = 8.0};
  EXPECT_TRUE(reach.steadyAt(0.9));
  EXPECT_FALSE(reach.steadyAt(1.0));
  EXPECT_FALSE(reach.steadyAt(9.0));
  EXPECT_TRUE(reach.steadyAt(9.1));
  ASSERT_TRUE(crowd.steps(1));
  EXPECT_TRUE(crowd.controller.letsSleep(crowd.model, 0, 0.9));
  EXPECT_FALSE(crowd.controller.letsSleep(crowd.model, 0, 2.0));
  reach.minimumJerk.reset();
  EXPECT_TRUE(crowd.controller.letsSleep(crowd.model, 0, 2.0));
}

// What the cost couples with who is awake wakes: a tendon between two robots, or a goal of
// functions, of which nobody knows whom it couples.
TEST(SleepUnderGoals, EndsForWhoIsCoupled) {
  const Model model = Crowd(cranes()).model;
  for (const bool byTendon : {true, false}) {
    Crowd crowd(cranes(), kAll);
    if (byTendon) {
      gdd::Actuator tendon{.name = "tendon"};
      tendon.pulls = {{crowd.body("first_rod").v, 1.0}, {crowd.body("second_rod").v, -1.0}};
      crowd.controller.limits = gdd::ControlLimits(crowd.model, {tendon});
    }
    crowd.controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
    ASSERT_TRUE(crowd.steps(4000));
    ASSERT_EQ(crowd.awake(), 0) << byTendon;
    Input push;
    push.wrenches = {{crowd.body("first_base").subtreeEnd - 2, {Vector3::Zero(), {0.0, 0.1, 0.0}}}};
    if (!byTendon)
      crowd.controller.goals.push_back(std::make_unique<gdd::ValueGoal>(
          [](const VectorX& q, const VectorX& v, VectorX& gradient, MatrixX& hessian) {
            gradient.setZero(2 * v.size());
            hessian.setZero(2 * v.size(), 2 * v.size());
            return 0.0 * q[0];
          }));
    ASSERT_EQ(crowd.step(push), SolveStatus::converged);
    EXPECT_FALSE(crowd.asleep("first_rod"));
    EXPECT_FALSE(crowd.asleep("second_rod"));
    EXPECT_EQ(crowd.asleep("alone"), byTendon);
  }
}

/// Two arms of three links that hang from the world.
ModelBuilder twoArms() {
  ModelBuilder builder("arms");
  for (const char* name : {"a", "b"}) builder.add(chain(3), name);
  return builder;
}

// A robot that sleeps stays where it is while another one moves, in Euler's step too, whose joint
// damping follows the solve.
TEST(SleepUnderGoals, HoldsStillInEulersStep) {
  ModelBuilder builder = twoArms();
  builder.options.useMujocoModel();
  Crowd crowd(builder, kAll);
  crowd.controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  crowd.controller.goals.push_back(std::make_unique<gdd::Posture>(crowd.model.q0));
  gdd::CircleTrajectory::Circle circle;
  circle.radius = 0.1, circle.frequency = 1.0;
  crowd.reach("a/link2", Vector3::Zero()).trajectory =
      std::make_shared<gdd::CircleTrajectory>(circle);
  int i = 0;
  while (!crowd.asleep("b/link2") && i++ < 5000) ASSERT_TRUE(crowd.steps(1));
  const Body& b = crowd.body("b/link2");
  const VectorX q = crowd.state.q;
  ASSERT_TRUE(crowd.steps(1000));
  EXPECT_TRUE(crowd.asleep("b/link2"));
  EXPECT_EQ(crowd.state.q[b.q], q[b.q]);
  EXPECT_NE(crowd.state.q[crowd.body("a/link2").q], q[crowd.body("a/link2").q]);
}

// A goal that begins is met whatever rounding makes of the times of steps.
TEST(SleepUnderGoals, EndsWhereAGoalBeginsBetweenRoundedTimes) {
  for (const auto& [h, start] :
       {std::pair(1.0 / 120.0, 2.85), {1.0 / 60.0, 2.85}, {1.0 / 240.0, 2.9875}, {0.0033, 2.244}}) {
    ModelBuilder builder = twoArms();
    builder.options.timestep = h;
    Crowd crowd(builder, kAll);
    crowd.controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
    crowd.reach("a/link2", Vector3(0.1, 0.1, 0.1)).startTime = start;
    for (int k = 1; crowd.state.time < start + 2.0 * h; ++k) {
      if (crowd.state.time > start - 2.0 * h && crowd.state.time < start) {
        EXPECT_TRUE(crowd.asleep("a/link2"));
      }
      ASSERT_TRUE(crowd.steps(1));
      crowd.state.time = k * h;  // as runs have it, on their grid
    }
    EXPECT_FALSE(crowd.asleep("a/link2")) << h;
    EXPECT_TRUE(crowd.asleep("b/link2")) << h;
  }
}

// What is to move, however slowly, is not at rest.
TEST(SleepUnderGoals, IsNotForWhatIsToMove) {
  Crowd crowd(twoArms(), kAll);
  auto turn = std::make_unique<gdd::JointVelocity>();
  const int joint = crowd.body("a/link2").v;
  turn->targets.push_back({crowd.model.dofs[idx(joint)].body, 0.01});
  crowd.controller.goals.push_back(std::move(turn));
  crowd.controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  const double q = crowd.state.q[crowd.body("a/link2").q];
  ASSERT_TRUE(crowd.steps(2000));
  EXPECT_NEAR(crowd.state.q[crowd.body("a/link2").q] - q, 0.04, 0.01);
  EXPECT_TRUE(crowd.asleep("b/link2"));
}

// Where all is one problem by the solver, nobody is left out of it.
TEST(SleepUnderGoals, IsNotWhereAllIsOneProblem) {
  Crowd crowd(cranes(), kAll);
  crowd.controller.solver = gdd::GddSolver::augmentedLagrangian;
  crowd.controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  for (int i = 0; i < 1500; ++i) {
    ASSERT_TRUE(crowd.steps(1));
    ASSERT_EQ(crowd.data.stats.wokenTrees, 0);
  }
  EXPECT_EQ(crowd.awake(), 5);
}

/// One goal of every kind that is of some trees, or of all.
std::vector<std::unique_ptr<gdd::Goal>> goalsOfEveryKind(const Model& model, Random& random) {
  std::vector<std::unique_ptr<gdd::Goal>> goals;
  const Vector3 place(0.3, 0.2, 0.6);
  goals.push_back(std::make_unique<gdd::Reach>(model, "lying_3", place));
  auto pose = std::make_unique<gdd::Reach>(model, "lifted_3", place);
  pose->R_WTarget = random.rotation();
  pose->metric = gdd::LinkMetric::consistent;
  goals.push_back(std::move(pose));
  goals.push_back(std::make_unique<gdd::Hold>(model, "lifted_0"));
  goals.push_back(std::make_unique<gdd::LookAt>(model, "lying_2", place));
  goals.push_back(std::make_unique<gdd::LinkAcceleration>(model, "lifted_2", Vector3(1, 2, 3)));
  auto acceleration = std::make_unique<gdd::JointAcceleration>();
  auto posture = std::make_unique<gdd::JointPosture>();
  auto velocity = std::make_unique<gdd::JointVelocity>();
  for (const char* joint : {"lying_1_joint", "lying_2_joint"}) {
    acceleration->targets.push_back(gdd::jointTarget(model, joint, 3.0));
    posture->targets.push_back(gdd::jointTarget(model, joint, 0.5));
    velocity->targets.push_back(gdd::jointTarget(model, joint, 0.5));
  }
  goals.push_back(std::move(acceleration));
  goals.push_back(std::move(posture));
  goals.push_back(std::move(velocity));
  goals.push_back(std::make_unique<gdd::Posture>(model.q0));
  goals.push_back(std::make_unique<gdd::VirtualDamping>());
  const int robot = model.bodies[idx(model.frames[idx(model.findFrame("lifted_0"))].body)].robot;
  goals.push_back(std::make_unique<gdd::CenterOfMass>(model, robot, place));
  goals.push_back(std::make_unique<gdd::MomentumGoal>(model, robot));
  goals.push_back(std::make_unique<gdd::CapturePoint>(model, robot, Vector3(0.1, 0.0, 0.0)));
  return goals;
}

// A goal costs nothing of trees that it does not concern: nobody misses it while others sleep.
TEST(Goals, CostWhatTheyConcern) {
  Random random(1);
  const Model model = robotsAndCubes().build();
  const auto goals = goalsOfEveryKind(model, random);
  State state(model);
  Data data(model);
  int apart = 0;
  for (int trial = 0; trial < 5; ++trial) {
    integratePosition(model, random.vector(model.nv, 0.2), 1.0, state.q);
    state.v = random.vector(model.nv, 1.0);
    ASSERT_NE(computeStages(model, {}, state, data, nullptr), SolveStatus::notFinite);
    const VectorX a = random.vector(model.nv, 10.0);
    for (const auto& goal : goals) {
      gdd::GoalCost cost(model.nv);
      cost.clear();
      goal->addCost({model, state, data}, cost);
      VectorX Ma(model.nv), slope(model.nv);
      data.inertia.M.multiply(a, Ma);
      cost.gradient(a, Ma, slope);
      EXPECT_GT(slope.cwiseAbs().maxCoeff(), 0.0) << goal->name();
      for (std::size_t t = 0; t < model.trees.size(); ++t) {
        const Tree& tree = model.trees[t];
        const bool costs = !slope.segment(tree.firstDof, tree.dofEnd - tree.firstDof).isZero(0.0);
        const bool concerns = goal->concerns(model, static_cast<int>(t));
        EXPECT_EQ(costs, concerns) << goal->name() << " " << t;
        apart += !concerns;
      }
    }
  }
  EXPECT_GT(apart, 100);
}

}  // namespace
}  // namespace softgauss::test
