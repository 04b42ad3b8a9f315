// SPDX-License-Identifier: Apache-2.0
/// In steady state the engine's step allocates nothing: proved by counting every allocation of the
/// thread, in whatever build type this is.

#include <gtest/gtest.h>

#include <set>

#include "apps/control_latency/loops.hpp"
#include "softgauss/collision/clearance.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/sample_surfaces.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

#define SKIP_WITHOUT_HOOK() \
  if (!kAllocationHook) GTEST_SKIP() << "a sanitizer owns the allocator"

/// Runs `count` steps once, so that every buffer has its size, then the same steps again; returns
/// the allocations of the second run.
std::int64_t allocationsOfSteadySteps(Scene& s, int count) {
  const State start = s.state;
  s.steps(count);
  s.state = start;
  const AllocationGuard guard;
  s.steps(count);
  return guard.count();
}

TEST(AllocationGuard, CatchesEveryKindOfAllocation) {
  SKIP_WITHOUT_HOOK();
  const auto count = [](auto&& allocate) {
    const AllocationGuard guard;
    allocate();
    return guard.count();
  };
  // Volatile, or the optimiser would leave the allocations out.
  void* volatile memory = nullptr;
  volatile std::size_t size = 100;
  EXPECT_EQ(count([] {}), 0);
  EXPECT_EQ(count([&] { memory = std::malloc(size); }), 1);
  EXPECT_EQ(count([&] { std::free(memory); }), 0);
  EXPECT_EQ(count([&] { memory = ::operator new(size); }), 1);
  ::operator delete(memory);
  EXPECT_GE(count([&] { memory = std::calloc(size, 2); }), 1);
  EXPECT_GE(count([&] { memory = std::realloc(memory, 1000 * size); }), 1);
  std::free(memory);
  EXPECT_GE(count([&] { memory = std::aligned_alloc(64, 64 * size); }), 1);
  std::free(memory);
  EXPECT_GE(count([&] {
              const VectorX x = VectorX::Zero(static_cast<Eigen::Index>(size));
              memory = const_cast<double*>(x.data());
            }),
            1);
}

TEST(AllocationGuard, CatchesAGrowingStep) {
  SKIP_WITHOUT_HOOK();
  Scene s(boxOnPlane({0.1, 0.1, 0.1}, 1.0, 1.0).build(), std::make_shared<SampleContacts>());
  s.state.q[2] = 0.0999;
  const AllocationGuard guard;
  s.step();  // the first step with contacts makes room for them
  EXPECT_GT(guard.count(), 0);
}

/// A humanoid thrown on the ground, arms against its sides.
Scene thrownHumanoid() {
  ModelBuilder builder = humanoid();
  // The hands touch the thighs.
  for (const char* side : {"left_", "right_"}) {
    GeometrySpec g = geometrySpec(side + std::string("thigh"), Shape::sphere(0.09), 1.0,
                                  {Matrix3::Identity(), Vector3(0, 0, -0.15)});
    builder.geometry(g);
  }
  Scene s(builder.build(), std::make_shared<SampleContacts>());
  s.state.v = Random(2).vector(s.model.nv, 0.3);
  s.state.v[4] = 2.0;  // topples
  return s;
}

TEST(Allocation, NoneInTheStepOfAHumanoidWithContactsBetweenBranches) {
  SKIP_WITHOUT_HOOK();
  Scene s = thrownHumanoid();
  int coupled = 0, contacts = 0, limits = 0;
  const State start = s.state;
  for (int i = 0; i < 600; ++i) {
    s.step();
    coupled += !s.data->bodies.pairs.empty();
    contacts = std::max(contacts, s.data->stats.contacts);
    limits += s.data->constraints.jointLimit.rowCount() > 0;
  }
  // The scene does what its name says.
  EXPECT_GT(coupled, 20);
  EXPECT_GT(contacts, 5);
  EXPECT_GT(limits, 20);
  s.state = start;
  EXPECT_EQ(allocationsOfSteadySteps(s, 600), 0);
}

/// 100 links that fall on the ground and on themselves.
Scene longChain() {
  ModelBuilder builder = chain(100);
  const Matrix3 R = Eigen::AngleAxisd(M_PI / 2, Vector3::UnitY()).toRotationMatrix();
  builder.geometry(geometrySpec("world", Shape::plane(), 0.8, {Matrix3::Identity(), {0, 0, -0.3}}));
  for (int i = 0; i < 100; ++i)
    builder.geometry(geometrySpec("link" + std::to_string(i), Shape::sphere(0.105), 0.8,
                                  {R, Vector3(0, 0, -0.1)}));
  Scene s(builder.build(), std::make_shared<SampleContacts>());
  // Stretched out and curled up, so that distant links meet.
  for (int i = 0; i < 100; ++i) s.state.q[i] = i == 0 ? M_PI / 2 : (i % 2 == 0 ? 0.05 : 0.15);
  return s;
}

TEST(Allocation, NoneInTheStepOfAHundredLinkChainWithContacts) {
  SKIP_WITHOUT_HOOK();
  Scene s = longChain();
  int contacts = 0, rows = 0;
  const State start = s.state;
  for (int i = 0; i < 100; ++i) {
    s.step();
    contacts = std::max(contacts, s.data->stats.contacts);
    rows = std::max(rows, s.data->stats.rows);
  }
  EXPECT_GT(contacts, 30);
  EXPECT_GT(rows, 120);
  s.state = start;
  EXPECT_EQ(allocationsOfSteadySteps(s, 100), 0);
}

// Dry friction, springs, connections, welds, couplings, contacts of every condim.
TEST(Allocation, NoneInTheStepWithEveryEffect) {
  SKIP_WITHOUT_HOOK();
  for (const int seed : {1, 3, 5}) {
    Scene s = lawScene(seed, 6);
    EXPECT_GT(s.data->constraints.dryFriction.rowCount(), 0);
    EXPECT_GT(s.data->constraints.weld.rowCount(), 0);
    s.state.connectionForces = State(s.model).connectionForces;  // it was made before them
    EXPECT_EQ(allocationsOfSteadySteps(s, 20), 0) << "seed " << seed;
  }
}

// A box that lies, beside one that spins about its middle.
TEST(Allocation, NoneInStepsThatIslandsTakeInPartsOfTheirOwn) {
  SKIP_WITHOUT_HOOK();
  ModelBuilder builder = boxOnPlane({0.1, 0.1, 0.1}, 1.0, 1.0), other("spinner");
  other.base = BaseKind::floating;
  other.X_WRoot.p = Vector3(5.0, 0.0, 2.0);
  other.link(boxLink("spinning", 1.0, {0.1, 0.2, 0.3}));
  ConnectSpec corner;
  corner.linkA = "spinning", corner.linkB = "world";
  corner.p_LBP = other.X_WRoot.p;
  other.connect(corner);
  builder.add(other, "");
  Scene s(builder.build(), std::make_shared<SampleContacts>());
  s.state.v.tail<3>() << 20.0, 30.0, 40.0;
  s.steps(2);
  EXPECT_GT(s.data->stats.parts, 1);
  EXPECT_TRUE(s.data->parts->leavesAny());
  EXPECT_EQ(allocationsOfSteadySteps(s, 100), 0);
}

/// A chair at rest on hills, a ring through which a ball lies on them, and a box, a capsule, a
/// cylinder and a hull: every pair of a shape with triangles.
Scene restOnHills() {
  const auto height = [](double x, double y) { return 0.02 * std::sin(3 * x) * std::cos(2 * y); };
  ModelBuilder builder("hills");
  builder.geometry(geometrySpec("world", Shape::surface(gridMesh(40, 40, 0.1, 0.0, height))));
  std::vector<BoxPart> parts = {{{0.2, 0.2, 0.02}, {0, 0, 0.2}}};
  for (const double x : {-0.18, 0.18})
    for (const double y : {-0.18, 0.18}) parts.push_back({{0.02, 0.02, 0.1}, {x, y, 0.1}});
  const std::pair<Shape, Vector3> bodies[] = {
      {Shape::surface(boxesSurface(parts)), {0, 0, 0.03}},
      {Shape::surface(ringSurface(0.1, 0.02, 24, 12)), {0.8, 0, 0.06}},
      {Shape::surface(ringSurface(0.1, 0.02, 24, 12)), {0.84, 0, 0.12}},
      {Shape::sphere(0.05), {0.8, 0, 0.15}},
      {Shape::box({0.1, 0.08, 0.05}), {-0.8, 0, 0.08}},
      {Shape::hull(boxSurface({0.1, 0.08, 0.05})), {-0.8, 0.02, 0.2}},
      {Shape::capsule(0.05, 0.1), {0, 0.8, 0.15}},
      {Shape::cylinder(0.05, 0.1), {0, -0.8, 0.15}},
  };
  int count = 0;
  for (const auto& [shape, p] : bodies) {
    ModelBuilder one = freeBody(boxLink("body", 1.0, {0.1, 0.1, 0.05}));
    one.X_WRoot.p = p;
    one.geometry(geometrySpec("body", shape, 0.8));
    builder.add(one, "object" + std::to_string(count++));
  }
  Scene s(builder.build());
  s.contacts = std::make_shared<collision::SceneContacts>(s.model);
  return s;
}

TEST(Allocation, NoneInTheStepOfMeshesOfTrianglesOnATerrain) {
  SKIP_WITHOUT_HOOK();
  Scene s = restOnHills();
  s.steps(400);
  // All of them touch triangles: the chair and both rings with triangles of their own.
  std::set<int> touching;
  bool twoRings = false;
  for (const ContactRows& made : s.data->constraints.contact.contactsWithRows()) {
    if (made.bodyA == 0 || made.bodyB == 0) touching.insert(made.bodyA + made.bodyB);
    twoRings |= made.bodyA == 2 && made.bodyB == 3;
  }
  EXPECT_GE(touching.size(), 6u);
  EXPECT_EQ(touching.count(1), 1u);
  EXPECT_TRUE(twoRings);
  EXPECT_EQ(allocationsOfSteadySteps(s, 100), 0);
}

/// A humanoid that stands, with a goal of every kind that is quadratic.
void addEveryQuadraticGoal(RobotScene& r) {
  const auto add = [&](auto goal) {
    r.controller.goals.push_back(std::make_unique<decltype(goal)>(std::move(goal)));
  };
  const Model& model = r.model;
  const int robot = gdd::drivenRobot(model);
  r.addDamping();
  r.addPosture();
  r.addReach("right_hand", Vector3(0.45, -0.25, 1.1));
  gdd::Reach pose(model, "left_hand", Vector3(0.4, 0.25, 1.0));
  pose.R_WTarget = Matrix3::Identity();
  add(pose);
  pose.metric = gdd::LinkMetric::consistent;
  pose.weight = pose.rotationWeight = 10.0;
  pose.minimumJerk = gdd::MinimumJerk{};
  const MatrixX knots = (MatrixX(3, 3) << 0.4, 0.5, 0.4, 0.2, 0.25, 0.2, 1.0, 1.1, 1.0).finished();
  pose.trajectory = std::make_shared<gdd::KnotTrajectory>(std::vector<double>{0, 1, 9}, knots);
  add(pose);
  gdd::Hold foot(model, "left_foot"), toe(model, "right_foot");
  toe.wholeLink = false;
  add(foot);
  add(toe);
  add(gdd::LookAt(model, "head", Vector3(2.0, 0.5, 1.0)));
  const auto distances = std::make_shared<collision::Clearance>(model);
  add(gdd::KeepClear(model, "right_hand", "pelvis", 0.3, distances));
  add(gdd::KeepClear(model, "left_hand", "world", 0.05, distances));
  add(gdd::CenterOfMass(model, robot, Vector3(0.0, 0.0, 0.9)));
  add(gdd::MomentumGoal(model, robot));
  add(gdd::CapturePoint(model, robot, Vector3::Zero()));
  const std::vector<int> driven = gdd::Effort::actuatedDofs(model);
  const gdd::JointTarget joint{model.dofs[driven.front()].body, 0.3};
  gdd::JointAcceleration acceleration;
  acceleration.targets = {joint};
  acceleration.weight = 1.0;
  add(acceleration);
  gdd::JointPosture posture;
  posture.targets = {joint};
  posture.targets[0].trajectory = pose.trajectory;
  add(posture);
  gdd::JointVelocity velocity;
  velocity.targets = {joint};
  velocity.weight = 1.0;
  add(velocity);
  add(gdd::Effort(driven));
  gdd::ContactForce force(model, "left_foot", Vector3(0.0, 0.0, 200.0));
  force.countOnly(model, "world");
  add(force);
  add(gdd::CenterOfPressure(model, robot, Vector3::Zero()));
}

TEST(Allocation, NoneInTheGoalDirectedStepWithEveryQuadraticGoal) {
  SKIP_WITHOUT_HOOK();
  RobotScene r("humanoid");
  addEveryQuadraticGoal(r);
  const State start = r.state;
  int contacts = 0;
  const auto run = [&] {
    for (int i = 0; i < 300; ++i) {
      EXPECT_NE(r.step(), SolveStatus::notFinite);
      contacts = std::max(contacts, r.data.stats.contacts);
    }
  };
  run();
  EXPECT_GT(contacts, 4);
  r.state = start;
  const AllocationGuard guard;
  run();
  EXPECT_EQ(guard.count(), 0);
}

// Nor in one that is refused for vectors of another size.
TEST(Allocation, NoneInAStepThatIsRefused) {
  SKIP_WITHOUT_HOOK();
  RobotScene r("humanoid");
  addEveryQuadraticGoal(r);
  ASSERT_FALSE(isRefused(r.step()));
  State small = r.state, none = r.state;
  small.q.conservativeResize(3);
  none.q.segment<4>(3).setZero();
  Input bad;
  bad.tau.setZero(r.model.nv + 20);
  const AllocationGuard guard;
  for (State* state : {&small, &none, &r.state}) {
    EXPECT_EQ(r.controller.step(r.model, bad, *state, r.data, &r.contacts), SolveStatus::badInput);
    EXPECT_EQ(step(r.model, bad, *state, r.data, &r.contacts), SolveStatus::badInput);
  }
  EXPECT_EQ(guard.count(), 0);
}

// Gears, differentials and a tendon in the place of the joints' own motors, and another price.
TEST(Allocation, NoneInTheGoalDirectedStepWithCoupledActuators) {
  SKIP_WITHOUT_HOOK();
  for (const gdd::GddSolver solver :
       {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian}) {
    RobotScene r("humanoid");
    addEveryQuadraticGoal(r);
    const std::vector<int> driven = gdd::Effort::actuatedDofs(r.model);
    r.controller.solver = solver;
    r.controller.limits = gdd::ControlLimits(
        r.model,
        {{.name = "left", .pulls = {{driven[0], 30.0}, {driven[1], 30.0}}, .lower = -3, .upper = 3},
         {.name = "right", .pulls = {{driven[0], 30.0}, {driven[1], -30.0}}},
         {.name = "gear", .pulls = {{driven[2], 50.0}}, .lower = -2, .upper = 2},
         {.name = "tendon", .pulls = {{driven[3], 1.0}, {driven[4], 0.5}}}});
    r.controller.goals.push_back(
        std::make_unique<gdd::Effort>(gdd::Effort::rootForces(r.model, r.controller.limits)));
    const State start = r.state;
    const auto run = [&] {
      for (int i = 0; i < 100; ++i) EXPECT_NE(r.step(), SolveStatus::notFinite);
    };
    run();
    r.state = start;
    EXPECT_NE(r.step(), SolveStatus::notFinite);  // its warm start has another size than the last
    const AllocationGuard guard;
    run();
    EXPECT_EQ(guard.count(), 0);
  }
}

// A humanoid reaches; the states that it comes through are measured again.
TEST(Allocation, NoneInTheControllerOfMeasuredStates) {
  SKIP_WITHOUT_HOOK();
  Simulation sim =
      Simulation::load(std::string(SOFTGAUSS_SOURCE_DIR) + "/data/robots/humanoid.urdf");
  sim.goals.reach("right_hand", {0.4, -0.2, 1.1});
  std::vector<VectorX> q, v;
  for (int k = 0; k < 200; ++k) {
    q.push_back(sim.state().q);
    v.push_back(sim.state().v);
    ASSERT_FALSE(isRefused(sim.step()));
  }
  const auto answerAll = [&] {
    for (std::size_t k = 0; k < q.size(); ++k)
      EXPECT_FALSE(isRefused(sim.solve(q[k], v[k]).status));
  };
  // The first time each state is met from another one; the solver has room for the longest path of
  // corrections that it has followed.
  answerAll();
  answerAll();
  const AllocationGuard guard;
  answerAll();
  EXPECT_EQ(guard.count(), 0);
}

/// Controls and steps of robots that are pushed, fall, hold and let go, after one reserve().
void expectNoneInControlLoops(int cycles) {
  for (const std::string& name : app::loopNames()) {
    const app::LoopTimes times = app::runLoop(name, SOFTGAUSS_SOURCE_DIR, {}, cycles,
                                              [] { return static_cast<long>(allocationCount()); });
    EXPECT_EQ(times.counted, 0) << name;
  }
}

TEST(Allocation, NoneInControlLoops) {
  SKIP_WITHOUT_HOOK();
  expectNoneInControlLoops(2000);
}

TEST(AllocationLong, NoneInControlLoops) {
  SKIP_WITHOUT_HOOK();
  expectNoneInControlLoops(100000);
}

TEST(Allocation, NoneInInverseDynamics) {
  SKIP_WITHOUT_HOOK();
  Scene s = thrownHumanoid();
  s.steps(300);
  VectorX tau(s.model.nv);
  const VectorX a = s.data->forward.a;
  TreeMatrix P;
  EXPECT_FALSE(inverseDynamicsJacobian(*s.data, P));  // the step was on bodies
  s.stages();
  inverseDynamics(s.model, a, *s.data, tau);
  ASSERT_TRUE(inverseDynamicsJacobian(*s.data, P));
  const AllocationGuard guard;
  inverseDynamics(s.model, a, *s.data, tau);
  inverseDynamicsJacobian(*s.data, P);
  EXPECT_EQ(guard.count(), 0);
}

}  // namespace
}  // namespace softgauss::test
