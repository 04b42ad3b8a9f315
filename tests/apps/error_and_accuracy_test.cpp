// SPDX-License-Identifier: Apache-2.0
/// --report-error and --accuracy of simulate_gdd, against runs that are far more accurate.

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/shared/pose_error.hpp"
#include "collision/scene_contacts.hpp"
#include "engine/engine.hpp"
#include "io/urdf.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using Json = nlohmann::json;

/// Root mean square over links and steps of how far a logged run of the arm, passive from its
/// start, is from 16 Runge–Kutta steps a millisecond.
app::PoseError trueError(const std::string& log) {
  const Csv csv(readFile(log));
  ModelBuilder builder = io::readUrdf(dataFile("robots/arm.urdf"));
  builder.options.integrator = Integrator::rungeKutta4;
  Model model = builder.build();
  collision::SceneContacts contacts(model);
  Data data(model);
  State state(model), logged(model);
  app::LinkPoses a(model), b(model);
  app::PoseError sum;
  int count = 0;
  for (int row = 1; row < static_cast<int>(csv.rows.size()); ++row) {
    const double h = csv.number(row, "time_s") - csv.number(row - 1, "time_s");
    const int parts = static_cast<int>(std::ceil(h / 6.25e-5));
    model.options.timestep = h / parts;
    for (int i = 0; i < parts; ++i) step(model, {}, state, data, &contacts);
    for (int body = 1; body < model.bodyCount(); ++body)
      if (model.bodies[body].dofs == 1)
        logged.q[model.bodies[body].q] = csv.number(row, "q:" + model.jointNames[body]);
    a.set(state);
    b.set(logged);
    const app::PoseError e = a.against(b);
    sum.total += e.total * e.total;
    sum.orientation += e.orientation * e.orientation;
    ++count;
  }
  return {std::sqrt(sum.total / count), std::sqrt(sum.orientation / count)};
}

std::vector<std::string> passiveArm(const std::string& duration) {
  return {dataFile("robots/arm.urdf"), "--passive", "--quiet", "--duration", duration};
}

// Half steps tell the error of whole ones up to terms of the next order in h.
TEST(ReportError, IsTheErrorOfTheRun) {
  for (const IntegratorName& name : kIntegratorNames) {
    const io::TempFolder folder;
    const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
    std::vector<std::string> arguments = passiveArm("0.2");
    for (const std::string& argument :
         {std::string("--integrator"), std::string(name.name), std::string("--timestep"),
          std::string("0.004"), std::string("--integration-tolerance"), std::string("1e-5"),
          std::string("--report-error"), std::string("--log"), log, std::string("--summary"),
          summary})
      arguments.push_back(argument);
    const Outcome outcome = simulate(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Json error = Json::parse(readFile(summary))["error"];
    EXPECT_EQ(error["of"], "the run");
    const app::PoseError exact = trueError(log);
    EXPECT_GT(exact.total, 1e-12) << name.name;
    EXPECT_NEAR(error["position_m"].get<double>() / exact.total, 1.0, 0.3) << name.name;
    EXPECT_NEAR(error["orientation_rad"].get<double>() / exact.orientation, 1.0, 0.3) << name.name;
  }
}

// With goals it is of the steps: half the step makes half the error in all, at order 1. At 4 ms
// goals still answer to the step.
TEST(ReportError, WithGoalsAddsUpItsSteps) {
  double errors[2];
  int k = 0;
  for (const char* h : {"0.001", "0.0005"}) {
    const io::TempFolder folder;
    const std::string summary = folder.path() / "summary.json";
    const Outcome outcome =
        simulate({dataFile("robots/arm.urdf"), "--reach", "tool=0.4,0.1,0.5", "--duration", "0.4",
                  "--timestep", h, "--report-error", "--summary", summary});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("what the steps err by"), std::string::npos);
    const Json error = Json::parse(readFile(summary))["error"];
    EXPECT_EQ(error["of"], "steps, added up");
    errors[k++] = error["position_m"];
  }
  EXPECT_NEAR(errors[0] / errors[1], 2.0, 0.2);
}

TEST(Accuracy, IsKept) {
  for (const double accuracy : {1e-3, 1e-5}) {
    const io::TempFolder folder;
    const std::string log = folder.path() / "log.csv";
    const Outcome outcome = simulate({dataFile("robots/arm.urdf"), "--passive", "--duration", "0.2",
                                      "--accuracy", std::to_string(accuracy), "--log", log});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("estimated error"), std::string::npos);
    EXPECT_LE(trueError(log).total, accuracy);
  }
}

TEST(Accuracy, ChoosesTheSettingItself) {
  for (const std::vector<std::string>& given : {std::vector<std::string>{"--timestep", "0.001"},
                                                {"--integrator", "runge-kutta-4"},
                                                {"--step-doubling"}}) {
    std::vector<std::string> arguments = passiveArm("0.1");
    arguments.insert(arguments.end(), {"--accuracy", "1e-3"});
    arguments.insert(arguments.end(), given.begin(), given.end());
    EXPECT_EQ(simulate(arguments).exitCode, 2) << given[0];
  }
}

// No two runs of a humanoid that falls on the ground agree to a nanometre: it says so.
TEST(Accuracy, DoesNotPromiseWhatCannotBeKept) {
  const Outcome outcome = simulate({dataFile("robots/humanoid.urdf"), "--passive", "--duration",
                                    "0.1", "--base-height", "0.91", "--accuracy", "1e-14"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("cannot be promised"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace softgauss::test
