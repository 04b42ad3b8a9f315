// SPDX-License-Identifier: Apache-2.0
/// A referee that is not ours: MuJoCo's forward dynamics at the controls that goal directed
/// dynamics has found gives the accelerations that it has found.
///
/// data/gdd_states holds states of the humanoid, recorded by gdd_benchmark --states at three goal
/// weights; data/reference/gdd_*.json what MuJoCo says to them (docs/mujoco_parity.md).

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/urdf.hpp"
#include "tests/parity/comparison.hpp"
#include "tests/parity/json_vector.hpp"
#include "tests/parity/reference_log.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

namespace fs = std::filesystem;

constexpr double kFound = 1e-6;  // two solvers, each at its own tolerance, and the clamp between
constexpr double kStays = 1e-6;  // of a control, where multipliers start at 0
constexpr double kSmallForce = 1.0;  // controls below this count as 0 [N m]

Json jsonOf(const fs::path& file) {
  std::ifstream in(file);
  return Json::parse(in);
}

/// A file of states, beside what MuJoCo says to it.
struct Trial {
  std::string name;
  Json recorded, judged;
  Model model;

  explicit Trial(const fs::path& file) : name(file.stem().string()), recorded(jsonOf(file)) {
    const fs::path data = file.parent_path().parent_path();
    judged = jsonOf(data / "reference" / ("gdd_" + name + ".json")).at("states");
    ModelBuilder builder = io::readUrdf(
        (data / "robots" / (recorded.at("model").get<std::string>() + ".urdf")).string());
    builder.options.timestep = recorded.at("timestep_s");
    builder.options.useMujocoModel();
    GeometrySpec ground;
    ground.name = "ground";
    ground.link = "world";
    ground.shape = Shape::plane();
    model = builder.geometry(ground).build();
    recorded = recorded.at("states");
  }

  State state(std::size_t i) const {
    State state(model);
    state.q = vectorOf(recorded[i].at("q"));
    state.v = vectorOf(recorded[i].at("v"));
    return state;
  }
};

const std::vector<Trial>& trials() {
  static const std::vector<Trial> all = [] {
    std::vector<fs::path> files;
    for (const auto& entry :
         fs::directory_iterator(fs::path(SOFTGAUSS_SOURCE_DIR) / "data" / "gdd_states"))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return std::vector<Trial>(files.begin(), files.end());
  }();
  return all;
}

TEST(GddReferee, EveryLogIsCompared) {
  std::vector<std::string> recorded;
  for (const Trial& trial : trials()) recorded.push_back("gdd_" + trial.name);
  EXPECT_EQ(recorded, gddLogNames());
}

TEST(GddReferee, MujocoMovesAsGddFound) {
  int states = 0, kinks = 0;
  for (const Trial& trial : trials()) {
    ASSERT_EQ(trial.recorded.size(), trial.judged.size());
    const gdd::ControlLimits limits(trial.model);
    for (std::size_t i = 0; i < trial.recorded.size(); ++i) {
      const Json& state = trial.recorded[i];
      EXPECT_GT(state.at("contacts"), 0);
      EXPECT_EQ(state.at("contacts"), trial.judged[i].at("contacts"));
      EXPECT_EQ(limits.violation(vectorOf(state.at("control"))), 0.0);
      EXPECT_SMALL(
          relativeDifference(vectorOf(state.at("acceleration")),
                             vectorOf(trial.judged[i].at("acceleration")), kSmallAcceleration),
          kFound)
          << trial.name << ", state " << i;
      ++states;
      kinks += state.at("status") == "kink";
    }
  }
  EXPECT_GE(states, 200);
  EXPECT_GE(kinks, 50);
}

TEST(GddReferee, MujocoMovesAsOurForwardStep) {
  for (const Trial& trial : trials()) {
    Data data(trial.model);
    collision::SceneContacts contacts(trial.model);
    for (std::size_t i = 0; i < trial.recorded.size(); ++i) {
      const State state = trial.state(i);
      ASSERT_EQ(computeStages(trial.model, {}, state, data, &contacts), SolveStatus::converged);
      setAppliedForce(vectorOf(trial.recorded[i].at("control")), data.forces);
      ASSERT_EQ(forwardDynamics(trial.model, nullptr, data), SolveStatus::converged);
      EXPECT_SMALL(relativeDifference(data.forward.a, vectorOf(trial.judged[i].at("acceleration")),
                                      kSmallAcceleration),
                   kForward)
          << trial.name << ", state " << i;
    }
  }
}

// The states are those of the present code: a solve that starts at what was found stays there, and
// calls it a minimum.
template <class Solver>
class GddFound : public testing::Test {};
using Solvers = testing::Types<gdd::AugmentedLagrangian, gdd::ActiveSet>;
TYPED_TEST_SUITE(GddFound, Solvers);

TYPED_TEST(GddFound, StaysWhatItWas) {
  for (const Trial& trial : trials()) {
    const Model& model = trial.model;
    Data data(model);
    collision::SceneContacts contacts(model);
    TypeParam solver(model);
    gdd::GoalCost cost(model.nv);
    const gdd::ControlLimits limits(model);
    for (std::size_t i = 0; i < trial.recorded.size(); ++i) {
      const Json& recorded = trial.recorded[i];
      if (recorded.at("status") == "iterationLimit") continue;
      const State state = trial.state(i);
      ASSERT_EQ(computeStages(model, {}, state, data, &contacts), SolveStatus::converged);
      const Json& goal = recorded.at("goal");
      gdd::Reach reach(model, goal.at("link"), vectorOf(goal.at("target")),
                       vectorOf(goal.at("point")));
      reach.weight = goal.at("weight");
      cost.clear();
      reach.addCost({model, state, data}, cost);
      gdd::VirtualDamping damping;
      damping.weight = 0.1;  // as it was recorded
      damping.addCost({model, state, data}, cost);
      WarmStart warm;
      warm.gddA = vectorOf(recorded.at("acceleration"));
      warm.multipliers = VectorX::Zero(model.nv);
      warm.control = vectorOf(recorded.at("control"));
      warm.gddSearchAge.assign(model.trees.size(), 0);
      warm.gddSearchWait.assign(model.trees.size(), 2);  // not in this solve
      warm.gddValid = true;
      const gdd::GddStatus status = solver.solve(model, cost, limits, data, warm).status;
      EXPECT_TRUE(status == gdd::GddStatus::converged || status == gdd::GddStatus::nonsmoothMinimum)
          << trial.name << ", state " << i;
      EXPECT_SMALL(relativeDifference(limits.clamp(solver.force()),
                                      vectorOf(recorded.at("control")), kSmallForce),
                   kStays)
          << trial.name << ", state " << i;
    }
  }
}

}  // namespace
}  // namespace softgauss::test
