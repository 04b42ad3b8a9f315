// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/dataset.hpp"

#include <fmt/format.h>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/io/urdf.hpp"

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

std::unique_ptr<Robot> loadRobot(const std::string& folder, const std::string& name,
                                 std::uint8_t mark) {
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
  gdd::ControlLimits(robot->model).markControlled(robot->model, robot->input.controlled, mark);
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
  datasetDamping().addCost(context, cost);
}

gdd::VirtualDamping datasetDamping() {
  gdd::VirtualDamping damping;
  damping.weight = 0.1;
  return damping;
}

namespace {

/// Puts the scripted goals of an operator to a solver, step after step, and records what it
/// finds. What is solved again is recorded as it was solved last.
class Recording final : public StepControl {
 public:
  Recording(const Robot& robot, SolverUnderTest& recorder, double weight, std::uint64_t seed,
            Dataset& dataset)
      : recorder_(recorder),
        dataset_(dataset),
        scripted_(robot.model, robot.deviate, robot.lowest, weight, seed),
        cost_(robot.model.nv),
        limits_(robot.model) {}

  void begin() { begins_ = true; }

  const VectorX* apply(const Model& model, const State& state, Data& data) noexcept override {
    if (begins_ && dataset_.records.size() >= kStepsPerGoal * dataset_.goals.size())
      dataset_.goals.push_back(scripted_.nextGoal(data.kinematics));
    poseProblem(dataset_.goals.back(), {model, state, data}, cost_);
    const gdd::GddReport report = recorder_.solve(model, cost_, limits_, data, state.warmstart);
    if (report.status == gdd::GddStatus::notFinite) {
      data.stats.status = SolveStatus::notFinite;
      return nullptr;
    }
    begins_ = false;
    auto& records = dataset_.records;
    while (!records.empty() && records.back().state.time >= state.time) records.pop_back();
    const Options& o = model.options;
    records.push_back({state, o.timestep, o.outerTimestep, o.nextTimestep,
                       limits_.clamp(recorder_.force()), recorder_.acceleration(), report.status,
                       data.stats.contacts, static_cast<int>(dataset_.goals.size()) - 1});
    setAppliedForce(records.back().control, data.forces);
    return &recorder_.acceleration();
  }
  void keep(WarmStart& warmstart, const TreeSelection&) noexcept override {
    recorder_.keepWarmStart(warmstart);
  }

 private:
  SolverUnderTest& recorder_;
  Dataset& dataset_;
  ScriptedOperator scripted_;
  gdd::GoalCost cost_;
  const gdd::ControlLimits limits_;
  bool begins_ = true;
};

}  // namespace

Dataset recordRun(const Robot& robot, SolverUnderTest& recorder, int records, double weight,
                  std::uint64_t seed, Progress& progress) {
  const Model& model = robot.model;
  Dataset dataset;
  dataset.recorder = recorder.name();
  dataset.weight = weight * robot.weightScale;
  dataset.records.reserve(records);
  Recording recording(robot, recorder, dataset.weight, seed, dataset);
  State state = robot.initial;
  Data data(model);
  const auto wanted = static_cast<std::size_t>(records);
  while (dataset.records.size() < wanted && !interrupted()) {
    progress.show(static_cast<long>(dataset.records.size()), records);
    recording.begin();
    if (isRefused(step(model, robot.input, state, data, robot.contacts.get(), &recording)))
      throw std::runtime_error(
          fmt::format("{}, goal weight {:g} kg: the recording became non-finite at t = {:.6g} s",
                      robot.name, dataset.weight, state.time));
  }
  if (dataset.records.size() > wanted) dataset.records.resize(wanted);
  return dataset;
}

}  // namespace softgauss::app
