// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/dataset.hpp"

#include <fmt/format.h>

#include "collision/lowest_point.hpp"
#include "gdd/goals/virtual_damping.hpp"
#include "io/urdf.hpp"

namespace softgauss::app {

namespace {

constexpr double kHumanoidMass = 40.9;    // [kg]
constexpr double kHeldHandHeight = 0.15;  // of the forearm's axis above the ground [m]

void standOnGround(const Model& model, State& state) {
  const Body& root = model.bodies[model.trees.front().rootBody];
  Kinematics kinematics(model);
  computeKinematics(model, state, kinematics);
  state.q[root.q + 2] -= collision::lowestPoint(model, kinematics, 0);
}

}  // namespace

std::vector<std::string> robotNames() { return {"humanoid", "hand", "held_hand"}; }

std::unique_ptr<Robot> loadRobot(const std::string& folder, const std::string& name) {
  const bool held = name == "held_hand";
  const bool hand = held || name == "hand";
  auto robot = std::make_unique<Robot>();
  robot->name = name;
  io::UrdfOptions options;
  if (held) options.base = BaseKind::fixed;
  ModelBuilder builder = io::readUrdf(folder + (hand ? "/hand.urdf" : "/humanoid.urdf"), options);
  GeometrySpec plane;
  plane.name = "ground";
  plane.link = "world";
  plane.shape = Shape::plane();
  const double ground = held ? -kHeldHandHeight : 0.0;
  plane.X_LG.p.z() = ground;
  robot->model = builder.geometry(plane).build();
  robot->contacts = std::make_unique<collision::SceneContacts>(robot->model);
  robot->initial = State(robot->model);
  if (!held) standOnGround(robot->model, robot->initial);
  if (hand) {  // lengths by the sizes, 0.37 m against 1.58 m
    robot->deviate = 0.12;
    robot->lowest = ground + 0.025;
    robot->weightScale = robot->model.totalMass() / kHumanoidMass;
  }
  return robot;
}

void poseProblem(const gdd::Reach& reach, const gdd::GoalContext& context, gdd::GoalCost& cost) {
  cost.clear();
  reach.addCost(context, cost);
  gdd::VirtualDamping().addCost(context, cost);
}

Dataset recordRun(const Robot& robot, Contestant& recorder, int records, double weight,
                  std::uint64_t seed, Progress& progress) {
  const Model& model = robot.model;
  Dataset dataset;
  dataset.recorder = recorder.name();
  dataset.weight = weight * robot.weightScale;
  dataset.records.reserve(records);
  ScriptedOperator scripted(model, robot.deviate, robot.lowest, dataset.weight, seed);
  State state = robot.initial;
  Data data(model);
  gdd::GoalCost cost(model.nv);
  const gdd::ControlBox box(model);
  const auto fail = [&] {
    throw std::runtime_error(
        fmt::format("{}, goal weight {:g} kg: the recording became non-finite at t = {:.6g} s",
                    robot.name, dataset.weight, state.time));
  };
  for (int i = 0; i < records && !interrupted(); ++i) {
    progress.show(i, records);
    if (computeStages(model, {}, state, data, robot.contacts.get()) == SolveStatus::notFinite)
      fail();
    if (i % kStepsPerGoal == 0) dataset.goals.push_back(scripted.nextGoal(data.kinematics));
    poseProblem(dataset.goals.back(), {model, state, data}, cost);
    const gdd::GddReport report = recorder.solve(model, cost, box, data, state.warmstart);
    if (report.status == gdd::GddStatus::notFinite) fail();
    dataset.records.push_back({state, box.clamp(recorder.force()), recorder.acceleration(),
                               report.status, data.stats.contacts,
                               static_cast<int>(dataset.goals.size()) - 1});
    setAppliedForce(dataset.records.back().control, data.forces);
    if (advance(model, {}, robot.contacts.get(), &recorder.acceleration(), data, state) ==
        SolveStatus::notFinite)
      fail();
    recorder.keepWarmStart(state.warmstart);
  }
  return dataset;
}

}  // namespace softgauss::app
