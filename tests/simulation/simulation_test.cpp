// SPDX-License-Identifier: Apache-2.0
/// A Simulation is what simulate_gdd runs: here against the engine put together by hand; the
/// programs' own bits are compared in tests/apps.
#include "softgauss/io/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "softgauss/engine/engine.hpp"
#include "tests/io/temp_folder.hpp"
#include "tests/simulation/data_file.hpp"

namespace softgauss::test {
namespace {

template <class Action>
std::string nameError(Action&& action) {
  try {
    action();
  } catch (const NameError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no NameError";
  return {};
}

TEST(Simulation, IsTheEngineUnderTheSameGoals) {
  Simulation sim = Simulation::load(robot("arm"));
  const Vector3 target(0.5, 0.2, 0.4);
  sim.goals.reach("hand", target);
  EXPECT_EQ(sim.model().options.integrator, Integrator::leapfrog);

  Model model = sim.model();
  collision::SceneContacts contacts(model);
  Data data(model);
  State state(model);
  gdd::GoalDirectedController controller(model);
  controller.motionLimits.emplace();
  controller.goals.push_back(std::make_unique<gdd::Reach>(model, "hand", target));
  for (auto& goal : regularisers(state.q, std::nullopt))
    controller.goals.push_back(std::move(goal));
  gdd::weighDefaults(model, controller.goals);
  for (int k = 1; k <= 100; ++k) {
    ASSERT_FALSE(isRefused(sim.step()));
    ASSERT_FALSE(isRefused(controller.step(model, {}, state, data, &contacts)));
    state.time = k * model.options.timestep;
  }
  EXPECT_EQ(hash(sim.state()), hash(state));
}

// Whichever comes first; a weight that is given stays, and the posture that nobody asked for is
// then weak.
TEST(Simulation, GoalsWithoutAWeightFollowThePosture) {
  const Vector3 target(0.5, 0.2, 0.4);
  Simulation first = Simulation::load(robot("arm")), second = Simulation::load(robot("arm"));
  const double alone = gdd::Reach(first.model(), "hand", target).weight;
  gdd::Reach& reach = first.goals.reach("hand", target);
  EXPECT_EQ(reach.weight, gdd::Posture::kDefaultWeight * alone);
  first.goals.posture(300.0);
  EXPECT_EQ(reach.weight, 300.0 * alone);
  second.goals.posture(300.0);
  EXPECT_EQ(second.goals.reach("hand", target).weight, 300.0 * alone);
  EXPECT_EQ(second.goals.reach("hand", target, Vector3::Zero(), 7.0).weight, 7.0);
  EXPECT_EQ(second.goals.reach("hand", target).weight, 7.0);
  Simulation given = Simulation::load(robot("arm"));
  EXPECT_EQ(given.goals.reach("hand", target, Vector3::Zero(), 51.0).weight, 51.0);
  EXPECT_LT(dynamic_cast<gdd::Posture&>(given.goals[1]).weight, 0.1);
  given.run(2.0);
  EXPECT_LT((given.pose("hand").p - target).norm(), 1e-3);
}

// failure() tells what does not fit, under goals and without.
TEST(Simulation, TellsWhatOfItsInputIsBad) {
  for (const bool controlled : {false, true}) {
    Simulation sim = Simulation::load(robot("humanoid"));
    if (controlled) sim.goals.reach("right_hand", {0.4, -0.2, 1.1});
    const State good = sim.state();
    sim.state().q.segment<4>(3).setZero();
    EXPECT_EQ(sim.step(), SolveStatus::badInput);
    EXPECT_EQ(
        sim.failure(),
        "the step at t = 0 s was refused: State::q: found the quaternion (0, 0, 0, 0) at joint "
        "'pelvis', expected length 1");
    EXPECT_EQ(sim.solve().status, SolveStatus::badInput);
    sim.state() = good;
    sim.input().tau = VectorX::Zero(2);
    EXPECT_EQ(sim.step(), SolveStatus::badInput);
    EXPECT_EQ(sim.failure(),
              "the step at t = 0 s was refused: Input::tau: found 2 numbers, expected " +
                  std::to_string(sim.model().nv));
    EXPECT_EQ(sim.solve().status, SolveStatus::badInput);
    sim.input().tau.resize(0);
    EXPECT_FALSE(isRefused(sim.step()));
  }
}

TEST(Simulation, WithoutGoalsItIsLeftToItself) {
  Simulation sim = Simulation::load(robot("arm"));
  EXPECT_EQ(sim.model().options.integrator, Integrator::leapfrog);
  sim.run(0.1);
  EXPECT_DOUBLE_EQ(sim.time(), 0.1);
  EXPECT_EQ(sim.torque("elbow_pitch"), 0.0);
}

TEST(Simulation, MovesWithTheObject) {
  Simulation first = Simulation::load(robot("arm"));
  first.goals.reach("hand", {0.4, 0.1, 0.5});
  first.run(0.02);
  Simulation moved = std::move(first);
  moved.goals.reach("hand", {0.4, 0.1, 0.5});
  EXPECT_EQ(moved.goals.size(), 3u) << "the same point: no second goal";
  moved.run(0.02);
  EXPECT_DOUBLE_EQ(moved.time(), 0.04);
}

TEST(Simulation, ReachesWhatItIsAskedFor) {
  Simulation sim = Simulation::load(robot("arm"));
  const Vector3 target(0.45, 0.2, 0.5);
  sim.goals.reach("hand", target);
  sim.run(2.0);
  EXPECT_LT((sim.pose("hand").p - target).norm(), 0.002);
  const Vector3 other(0.4, -0.2, 0.4);
  sim.goals.reach("hand", other);  // the same goal, elsewhere
  sim.run(2.0);
  EXPECT_LT((sim.pose("hand").p - other).norm(), 0.002);
}

TEST(Simulation, AStandingRobotIsCarriedByItsFeet) {
  Simulation sim = Simulation::load(robot("humanoid"));
  sim.goals.posture();
  sim.run(1.0);
  // At rest what the ground carries is the weight; the posture still swings by less than 2 %.
  const double weight = sim.model().totalMass() * 9.81;
  const Vector3 carried = sim.contactForceOn("left_foot") + sim.contactForceOn("right_foot");
  EXPECT_NEAR(carried.z(), weight, 0.02 * weight);
}

TEST(Simulation, StandsOnTheGroundAgain) {
  Simulation sim = Simulation::load(robot("humanoid"));
  const VectorX start = sim.state().q;
  sim.state().q[2] += 1.0;
  sim.standOnGround();
  EXPECT_NEAR(sim.state().q[2], start[2], 1e-12);
  Simulation arm = Simulation::load(robot("arm"));
  EXPECT_NE(nameError([&] { arm.standOnGround(); }).find("no ground"), std::string::npos);
}

TEST(Simulation, UnknownNamesAreToldWithTheNearest) {
  Simulation sim = Simulation::load(robot("arm"));
  const auto tells = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  tells(nameError([&] { sim.goals.reach("hnd", Vector3::Zero()); }), "did you mean 'hand'");
  tells(nameError([&] { sim.goals.hold("forarm"); }), "did you mean 'forearm'");
  tells(nameError([&] { sim.torque("elbow_pich"); }), "did you mean 'elbow_pitch'");
  tells(nameError([&] { sim.contactForceOn("hnd"); }), "did you mean 'hand'");
  tells(nameError([&] { sim.position("elbw_pitch"); }), "did you mean 'elbow_pitch'");
  tells(nameError([&] { sim.setPosition("nose", 1.0); }), "nose");
  tells(nameError([&] { sim.pose("hnd"); }), "did you mean 'hand'");
  EXPECT_TRUE(sim.goals.empty());
}

TEST(Simulation, OptionsAreThoseOfTheCommandLine) {
  SimulationOptions options;
  options.base = BaseKind::fixed;
  options.timestep = 0.001;
  options.q0 = {{"elbow_pitch", 0.3}};
  Simulation sim = Simulation::load(robot("arm"), options);
  EXPECT_EQ(sim.position("elbow_pitch"), 0.3);
  EXPECT_EQ(sim.model().options.timestep, 0.001);
  options.q0 = {{"elbw_pitch", 0.3}};
  try {
    Simulation::load(robot("arm"), options);
    ADD_FAILURE() << "an unknown joint was placed";
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'elbow_pitch'"), std::string::npos);
  }
}

TEST(Simulation, SolvingLeavesTheStateAlone) {
  Simulation sim = Simulation::load(robot("humanoid"));
  sim.goals.reach("right_hand", {0.4, -0.2, 1.1});
  sim.run(0.05);
  const std::uint64_t before = hash(sim.state());
  const ControlSolution answer = sim.solve();
  EXPECT_FALSE(isRefused(answer.status));
  EXPECT_EQ(hash(sim.state()), before);
  // What it answers is a motion of the physics: inverse dynamics of a gives back the control. The
  // bound is the solver's tolerance on forces of some 100 N m.
  VectorX tau;
  inverseDynamics(sim.model(), answer.a, sim.data(), tau);
  EXPECT_LT((tau - answer.tau).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_FALSE(answer.contacts.empty());
}

// The robot is another simulation, without goals: what the controller answers to its states drives
// it. Where both have the same model the hand arrives.
TEST(Simulation, AnswersToMeasuredStatesDriveARobot) {
  Simulation controller = Simulation::load(robot("arm")), real = Simulation::load(robot("arm"));
  const Vector3 target(0.5, 0.2, 0.4);
  controller.goals.reach("hand", target);
  for (int k = 0; k < 1000; ++k) {
    const ControlSolution& answer = controller.solve(real.state().q, real.state().v);
    ASSERT_FALSE(isRefused(answer.status));
    real.input().tau = answer.tau;
    ASSERT_FALSE(isRefused(real.step()));
  }
  EXPECT_LT((real.pose("hand").p - target).norm(), 1e-3);
}

// Contacts of the caller, as a robot feels them with its feet, stand in for those of the shapes.
TEST(Simulation, SolvesWithTheContactsOfTheCaller) {
  Simulation sim = Simulation::load(robot("humanoid"));
  sim.goals.reach("right_hand", {0.4, -0.2, 1.1});
  sim.run(0.1);
  const VectorX q = sim.state().q, v = sim.state().v;
  const State start = sim.state();
  const ControlSolution own = sim.solve(q, v);
  EXPECT_FALSE(own.contacts.empty());
  FixedContacts felt;
  felt.points = sim.data().contacts.contacts;
  sim.state() = start;
  EXPECT_EQ(sim.solve(q, v, &felt).tau, own.tau);
  felt.points.clear();
  sim.state() = start;
  const ControlSolution& flying = sim.solve(q, v, &felt);
  EXPECT_TRUE(flying.contacts.empty());
  EXPECT_NE(flying.tau, own.tau);
}

// Nothing but the budget bounds the work; what is found within it is feasible, and not worse than
// what fewer iterations find.
TEST(Simulation, AnIterationBudgetBoundsTheSolve) {
  Simulation sim = Simulation::load(robot("humanoid"));
  sim.goals.reach("right_hand", {0.5, -0.4, 1.3}).weight = 1e4;
  // Its terms count or do not, so that objectives with different ones cannot be compared.
  sim.controller().motionLimits.reset();
  sim.controller().limits.lower *= 0.1;  // many controls at their bounds
  sim.controller().limits.upper *= 0.1;
  const State start = sim.state();
  double last = kInfinity;
  int limited = 0;
  for (const int budget : {0, 1, 2, 4, 8, 1000}) {
    sim.state() = start;
    sim.controller().iterationBudget = budget;
    const ControlSolution& answer = sim.solve(start.q, start.v);
    ASSERT_FALSE(isRefused(answer.status));
    EXPECT_LE(answer.report.iterations, budget);
    EXPECT_LE(answer.report.objective, last);
    last = answer.report.objective;
    for (int i = 0; i < sim.model().nv; ++i) {
      EXPECT_GE(answer.tau[i], sim.controller().limits.lower[i]);
      EXPECT_LE(answer.tau[i], sim.controller().limits.upper[i]);
    }
    if (answer.report.status == gdd::GddStatus::iterationLimit) {
      ++limited;
      EXPECT_GT(answer.report.stationarity, 1e-12);
    }
  }
  EXPECT_GE(limited, 2);
  EXPECT_LE(sim.solve(start.q, start.v).report.stationarity, 1e-12);
}

// No time is no iteration; enough of it changes nothing.
TEST(Simulation, ATimeBudgetBoundsTheSolve) {
  const auto answerOf = [](double seconds, int iterations) {
    Simulation sim = Simulation::load(robot("humanoid"));
    sim.goals.reach("right_hand", {0.5, -0.4, 1.3}).weight = 1e4;
    sim.controller().limits.upper *= 0.1;
    sim.controller().limits.lower *= 0.1;
    sim.controller().timeBudget = seconds;
    sim.controller().iterationBudget = iterations;
    const State start = sim.state();
    return sim.solve(start.q, start.v);
  };
  const int many = std::numeric_limits<int>::max();
  const ControlSolution none = answerOf(0.0, many), all = answerOf(100.0, many);
  EXPECT_EQ(none.report.iterations, 0);
  EXPECT_EQ(none.report.status, gdd::GddStatus::iterationLimit);
  EXPECT_EQ(none.tau, answerOf(kInfinity, 0).tau);
  EXPECT_GT(all.report.iterations, 1);
  EXPECT_EQ(all.tau, answerOf(kInfinity, many).tau);
}

TEST(Simulation, RefusesMeasurementsOfAnotherSize) {
  Simulation sim = Simulation::load(robot("humanoid"));
  sim.goals.reach("right_hand", {0.4, -0.2, 1.1});
  sim.run(0.05);
  const std::uint64_t before = hash(sim.state());
  const VectorX q = sim.state().q, v = sim.state().v;
  EXPECT_EQ(sim.solve(q, q).status, SolveStatus::badInput);
  EXPECT_NE(sim.failure().find("State::v: found 28 numbers, expected 27"), std::string::npos)
      << sim.failure();
  EXPECT_EQ(sim.solve(v, v).status, SolveStatus::badInput);
  VectorX none = q;
  none.segment<4>(3).setZero();
  EXPECT_EQ(sim.solve(none, v).status, SolveStatus::badInput);
  EXPECT_EQ(hash(sim.state()), before);
}

TEST(Simulation, GoalsOfATextAreThoseOfAFile) {
  const io::TempFolder folder;
  const std::string text =
      "goals:\n  - reach: {link: hand, target: [0.5, 0.2, 0.4]}\n  - damping: {}\n";
  Simulation sim = Simulation::load(robot("arm")), other = Simulation::load(robot("arm"));
  const auto read = sim.goals.read(folder.write("goals.yaml", text));
  const auto given = other.goals.readText(text);
  ASSERT_EQ(read.size(), 2u);
  ASSERT_EQ(given.size(), 2u);
  EXPECT_EQ(given[0], &other.goals[0]);
  EXPECT_EQ(given[1]->name(), read[1]->name());
  sim.run(0.1);
  other.run(0.1);
  EXPECT_EQ(hash(sim.state()), hash(other.state()));
  try {
    other.goals.readText("goals:\n  - reach: {link: hnd, target: [0, 0, 0]}\n", "wishes");
    ADD_FAILURE() << "a link that does not exist was taken";
  } catch (const ModelError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("wishes:2: goal 1 'reach': key 'link': ", 0), 0u)
        << error.what();
  }
  EXPECT_EQ(other.goals.size(), 2u);
}

TEST(Simulation, ASceneBringsItsGoalsAndWrenches) {
  Simulation sim = Simulation::load(sceneFile("hand_and_ball"));
  EXPECT_EQ(sim.goals.size(), 1u);
  const double height = sim.pose("ball").p.z();
  sim.run(0.2);  // something else carries the ball until 0.6 s
  EXPECT_NEAR(sim.pose("ball").p.z(), height, 0.01);
}

TEST(Simulation, ResetGivesTheSameRunAgain) {
  Simulation sim = Simulation::load(robot("humanoid"));
  sim.goals.posture();
  sim.run(0.1);
  const std::uint64_t first = hash(sim.state());
  sim.reset();
  EXPECT_EQ(sim.time(), 0.0);
  sim.run(0.1);
  EXPECT_EQ(hash(sim.state()), first);
}

TEST(Simulation, ARefusedStepTellsWhy) {
  Simulation sim = Simulation::load(robot("arm"));
  sim.input().tau = VectorX::Constant(sim.model().nv, kNaN);
  EXPECT_THROW(sim.run(0.01), StepError);
  EXPECT_EQ(sim.time(), 0.0);
  EXPECT_NE(sim.failure().find("shoulder_yaw"), std::string::npos) << sim.failure();
}

}  // namespace
}  // namespace softgauss::test
