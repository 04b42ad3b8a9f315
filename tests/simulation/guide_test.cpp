// SPDX-License-Identifier: Apache-2.0
/// The C++ of docs/guide/cpp.md, line by line: tests/system/guide_test.cpp compares the two.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "softgauss/engine/engine.hpp"
#include "softgauss/io/io.hpp"
#include "softgauss/io/simulation/rollout.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/simulation/data_file.hpp"

namespace softgauss::test {
namespace {

/// The page's files are named from the root of the repository.
class Guide : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(SOFTGAUSS_SOURCE_DIR);
  }
  void TearDown() override { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_;
};

int firstProgram() {
  // clang-format off
  softgauss::Simulation sim = softgauss::Simulation::load("data/robots/humanoid.urdf");
  sim.goals.reach("right_hand", {0.4, -0.2, 1.1}).weight = 1e5;
  sim.goals.posture(1000);
  while (sim.time() < 2.0)
    if (softgauss::isRefused(sim.step())) {
      std::puts(sim.failure().c_str());
      return 1;
    }
  const softgauss::Vector3 hand = sim.pose("right_hand").p;            // [m], world
  const softgauss::Vector3 foot = sim.contactForceOn("left_foot");     // [N], world
  std::printf("hand at %.3f %.3f %.3f, foot carries %.0f N, knee %.1f N m\n", hand.x(), hand.y(),
              hand.z(), foot.z(), sim.torque("right_knee"));
  // clang-format on
  EXPECT_GT(hand.z(), 0.9) << "it stands and lifts its hand";
  sim.run(28.0);
  EXPECT_GT(sim.pose("pelvis").p.z(), 0.9) << "and goes on standing";
  EXPECT_GT(foot.z(), 0.0);
  return 0;
}

/// One joint follows a sine.
class Sway final : public softgauss::gdd::Goal {
 public:
  Sway(const softgauss::Model& model, const std::string& joint)
      : body_(softgauss::gdd::jointTarget(model, joint, 0.0).body) {}
  std::string name() const override { return "sway"; }
  void addCost(const softgauss::gdd::GoalContext& context,
               softgauss::gdd::GoalCost& cost) const override {
    const softgauss::Body& body = context.model.bodies[body_];
    const double target = 0.3 * std::sin(2.0 * context.state.time);  // [rad]
    const double q = context.state.q[body.q], v = context.state.v[body.v];
    const double inertia = context.data.inertia.M.row(body.v)[body.v];
    // The squared error of the acceleration, times a weight.
    cost.addDof(body.v, 100.0 * inertia, 100.0 * (target - q) - 20.0 * v);
  }

 private:
  int body_;
};

TEST_F(Guide, FirstProgramRuns) { EXPECT_EQ(firstProgram(), 0); }

TEST_F(Guide, OptionsGoalsControlAndRollouts) {
  // clang-format off
  softgauss::SimulationOptions options;
  options.base = softgauss::BaseKind::fixed;
  options.timestep = 0.001;
  options.q0 = {{"elbow_pitch", 0.3}};
  softgauss::Simulation arm = softgauss::Simulation::load("data/robots/arm.urdf", options);
  arm.setVelocity("shoulder_yaw", 0.5);
  const double elbow = arm.position("elbow_pitch");  // [rad]
  EXPECT_EQ(elbow, 0.3);

  arm.goals.add(std::make_unique<Sway>(arm.model(), "shoulder_yaw"));
  arm.goals.posture(0.1);
  arm.run(1.0);
  // A target that moves at up to 0.6 rad/s is followed with a lag of 20/100 s.
  EXPECT_NEAR(arm.position("shoulder_yaw"), 0.3 * std::sin(2.0), 0.13);

  // The robot is another simulation, which the torques drive.
  softgauss::Simulation real = softgauss::Simulation::load("data/robots/arm.urdf", options);
  real.state() = arm.state();
  const auto measure = [&](VectorX& measuredQ, VectorX& measuredV) {
    measuredQ = real.state().q;
    measuredV = real.state().v;
  };
  const auto send = [&](const VectorX& tau) {
    real.input().tau = tau;
    EXPECT_FALSE(isRefused(real.step()));
  };
  arm.controller().iterationBudget = 20;
  arm.reserve();
  softgauss::VectorX q(arm.model().nq), v(arm.model().nv);
  auto next = std::chrono::steady_clock::now();
  for (int cycle = 0; cycle < 100; ++cycle) {
    measure(q, v);  // your sensors, in the order of the model
    const softgauss::ControlSolution& answer = arm.solve(q, v);
    if (!softgauss::isRefused(answer.status)) send(answer.tau);  // your motors, (nv) [N m or N]
    arm.state().time += 1e-3;  // goals may depend on time
    next += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(next);
  }
  EXPECT_NEAR(real.position("shoulder_yaw"), 0.3 * std::sin(2.2), 0.13);

  softgauss::Rollout rollout(arm.scene(), options);
  const std::vector<double> frictions = {0.3, 0.6, 1.0};
  softgauss::RolloutInputs in{.runs = 3, .steps = 100};
  in.parameters = {"friction:*"};
  in.values = frictions;
  std::vector<double> ends(3 * arm.model().nq);
  softgauss::RolloutOutputs out{.every = 100, .q = ends};
  const std::vector<softgauss::RunOutcome> outcomes = rollout.run(in, out);
  // clang-format on
  for (const RunOutcome& outcome : outcomes)
    EXPECT_EQ(outcome.status, RunOutcome::Status::completed) << outcome.failure;
}

TEST_F(Guide, PartsAreUsedAlone) {
  // clang-format off
  const softgauss::Model model = softgauss::io::loadUrdf("data/robots/humanoid.urdf");
  softgauss::collision::SceneContacts contacts(model);
  softgauss::State state(model);
  softgauss::Data data(model);
  const softgauss::SolveStatus status = softgauss::step(model, {}, state, data, &contacts);
  // clang-format on
  EXPECT_FALSE(isRefused(status));
}

}  // namespace
}  // namespace softgauss::test
