// SPDX-License-Identifier: Apache-2.0
/// --report-error and --accuracy of simulate_gdd, against runs that are far more accurate.

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/shared/pose_error.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/io/scene.hpp"
#include "softgauss/io/torque_table.hpp"
#include "softgauss/io/urdf.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using Json = nlohmann::json;

/// How a run is checked: which model, how accurately, under which controls.
struct Truth {
  ModelBuilder builder;
  Integrator integrator = Integrator::rungeKutta4;
  double step = 6.25e-5;  ///< at most [s]
  std::string torques{};  ///< a table
};

Truth passiveArmTruth() { return {.builder = io::readUrdf(dataFile("robots/arm.urdf"))}; }

/// Root mean square over links and steps of how far a logged run is from a far more accurate one.
/// Joints of one coordinate are read; a floating base by x, y, z and how they change alone, turned
/// as at the start. Nothing else moves there.
app::PoseError trueError(const std::string& log, Truth truth) {
  const Csv csv(readFile(log));
  truth.builder.options.integrator = truth.integrator;
  truth.builder.options.integrationTolerance = 1e-10;
  Model model = truth.builder.build();
  collision::SceneContacts contacts(model);
  Data data(model);
  State state(model), logged(model);
  std::optional<io::TorqueTable> torques;
  if (!truth.torques.empty()) torques = io::TorqueTable::read(truth.torques, model);
  const auto read = [&](int row, State& into) {
    for (int body = 1; body < model.bodyCount(); ++body) {
      if (model.bodies[body].joint == JointKind::floating)
        for (int i = 0; i < 3; ++i) {
          const std::string& name = model.jointNames[body];
          into.q[model.bodies[body].q + i] = csv.number(row, "q:" + name + "." + "xyz"[i]);
          into.v[model.bodies[body].v + i] = csv.number(row, "v:" + name + ".v" + "xyz"[i]);
        }
      if (model.bodies[body].dofs == 1)
        into.q[model.bodies[body].q] = csv.number(row, "q:" + model.jointNames[body]);
    }
  };
  read(0, state);
  app::LinkPoses a(model), b(model);
  app::PoseError sum;
  Input input;
  int count = 0;
  for (int row = 1; row < static_cast<int>(csv.rows.size()); ++row) {
    const double h = csv.number(row, "time_s") - csv.number(row - 1, "time_s");
    const int parts = static_cast<int>(std::ceil(h / truth.step - 1e-6));
    model.options.timestep = h / parts;
    for (int i = 0; i < parts; ++i) {
      if (torques) torques->controlAt(state.time, input.tau);
      step(model, input, state, data, &contacts);
    }
    read(row, logged);
    a.set(state);
    b.set(logged);
    const app::PoseError e = a.against(b);
    sum.total += e.total * e.total;
    sum.orientation += e.orientation * e.orientation;
    ++count;
  }
  return {std::sqrt(sum.total / count), std::sqrt(sum.orientation / count)};
}

// Half steps tell the error of whole ones up to terms of the next order in h.
TEST(ReportError, IsTheErrorOfTheRun) {
  for (const IntegratorName& name : kIntegratorNames) {
    const io::TempFolder folder;
    const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
    std::vector<std::string> arguments = passiveArm("0.2");
    for (const std::string& argument :
         {std::string("--integrator"), std::string(name.name), std::string("--timestep"),
          std::string("0.004"), std::string("--report-error"), std::string("--log"), log,
          std::string("--summary"), summary})
      arguments.push_back(argument);
    if (name.integrator == Integrator::dormandPrince)
      arguments.insert(arguments.end(), {"--integration-tolerance", "1e-5"});
    const Outcome outcome = simulate(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Json error = Json::parse(readFile(summary))["error"];
    EXPECT_EQ(error["of"], "the run");
    const app::PoseError exact = trueError(log, passiveArmTruth());
    EXPECT_GT(exact.total, 1e-12) << name.name;
    EXPECT_NEAR(error["position_m"].get<double>() / exact.total, 1.0, 0.3) << name.name;
    EXPECT_NEAR(error["orientation_rad"].get<double>() / exact.orientation, 1.0, 0.3) << name.name;
  }
}

/// A run with --report-error: what it says, and what is true.
struct Estimate {
  double told = 0.0, exact = 0.0;  ///< [m]
};

Estimate estimate(std::vector<std::string> arguments, const io::TempFolder& folder, Truth truth) {
  const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
  for (const std::string& more : {std::string("--quiet"), std::string("--report-error"),
                                  std::string("--log"), log, std::string("--summary"), summary})
    arguments.push_back(more);
  const Outcome outcome = simulate(arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  return {Json::parse(readFile(summary))["error"]["position_m"],
          trueError(log, std::move(truth)).total};
}

// A table is a function of time: steps of 6 ms take rows of 10 ms up to 4 ms late, their halves up
// to 2 ms: an error of first order on average, for every method.
TEST(ReportError, SeesWhatATableChangesWithinAStep) {
  const io::TempFolder folder;
  const std::string table = folder.path() / "torques.csv";
  std::ofstream out(table);
  out << "time_s,u:shoulder_pitch,u:elbow_pitch\n";
  for (int row = 0; row <= 40; ++row)
    out << 0.01 * row << "," << 8.0 * std::sin(0.4 * row) << "," << 3.0 * std::cos(0.3 * row)
        << "\n";
  out.close();
  for (const char* integrator : {"semi-implicit-euler", "runge-kutta-4", "dormand-prince"}) {
    Truth truth = passiveArmTruth();
    truth.torques = table;
    const Estimate e = estimate({dataFile("robots/arm.urdf"), "--torques", table, "--duration",
                                 "0.36", "--timestep", "0.006", "--integrator", integrator},
                                folder, truth);
    EXPECT_GT(e.exact, 1e-4) << integrator;
    EXPECT_GT(e.told / e.exact, 0.7) << integrator;
    EXPECT_LT(e.told / e.exact, 2.0) << integrator;
  }
}

// A ball that falls on the ground touches it within a step. Where in the step decides over the
// error, so that estimates of the other methods are worth a factor of two and a half; what divides
// the step there is compared with a finer division, and is told to 15 %.
TEST(ReportError, SeesTheTouchDown) {
  const io::TempFolder folder;
  const std::string urdf = folder.path() / "ball.urdf";
  std::ofstream(urdf)
      << R"(<robot name="ball"><link name="b"><inertial><mass value="1"/><inertia ixx="0.004"
  iyy="0.004" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>
  <sphere radius="0.1"/></geometry></collision></link></robot>)";
  for (const IntegratorName& name : kIntegratorNames)
    for (const char* height : {"0.45", "0.5"})
      for (const char* h : {"0.004", "0.001"}) {
        Truth truth{
            .builder = io::readUrdf(urdf), .integrator = Integrator::dormandPrince, .step = 5e-5};
        truth.builder.base = BaseKind::floating;
        GeometrySpec ground;
        ground.name = "ground";
        ground.link = "world";
        ground.shape = Shape::plane();
        truth.builder.geometry(ground);
        const Estimate e =
            estimate({urdf, "--passive", "--base-height", height, "--duration", "0.4", "--timestep",
                      h, "--integrator", std::string(name.name)},
                     folder, truth);
        const bool divides = name.integrator == Integrator::implicitMidpoint ||
                             name.integrator == Integrator::dormandPrince;
        EXPECT_GT(e.exact, 1e-6) << name.name << height << h;
        EXPECT_GT(e.told / e.exact, divides ? 0.85 : 0.7) << name.name << " " << height << " " << h;
        EXPECT_LT(e.told / e.exact, divides ? 1.15 : 2.5) << name.name << " " << height << " " << h;
      }
}

/// A ball of radius 1 cm that flies at a wall of 5 mm, 0.97 m or more away: at 15 m/s and more it
/// is beyond it within a step.
struct Shot {
  std::string scene;
  Truth truth;
};

Shot shotAtAWall(const io::TempFolder& folder, double speed, double place) {
  const std::string scene = folder.path() / "shot.yaml";
  std::ofstream(scene) << "ground: none\ngravity: [0, 0, 0]\nobjects:\n"
                       << "  - {name: wall, fixed: true, box: {size: [0.005, 1, 1]}, position: ["
                       << place << ", 0, 0]}\n"
                       << "  - {name: ball, sphere: {radius: 0.01}, mass: 0.05, velocity: ["
                       << speed << ", 0, 0]}\n";
  return {scene,
          {.builder = io::readScene(scene).builder,
           .integrator = Integrator::dormandPrince,
           .step = 5e-5}};
}

// Half steps see no more of such a wall than whole ones, unless they are shortened. (At other
// speeds whole and half steps of order 1, of which one or two touch, may err alike:
// docs/accuracy.md.)
TEST(ReportError, SeesWhatPassesWithinAStep) {
  for (const IntegratorName& name : kIntegratorNames)
    for (const double speed : {20.0, 40.0})
      for (const char* h : {"0.008", "0.002"}) {
        const io::TempFolder folder;
        const Shot shot = shotAtAWall(folder, speed, 1.0);
        const Estimate e = estimate({shot.scene, "--duration", speed > 10.0 ? "0.05" : "0.25",
                                     "--timestep", h, "--integrator", std::string(name.name)},
                                    folder, shot.truth);
        // Steps that are divided until they err by 1e-6 may err by less.
        const bool controlled = name.integrator == Integrator::dormandPrince;
        EXPECT_GT(e.exact, controlled ? 1e-7 : 1e-6) << name.name << speed << h;
        EXPECT_GT(e.told / e.exact, 0.5) << name.name << " " << speed << " " << h;
      }
}

// Where damping is so stiff that dormand-prince does not come to an end the midpoint rule's own
// halves tell its error.
TEST(ReportError, OutlivesStiffDamping) {
  const io::TempFolder folder;
  const std::string urdf = folder.path() / "stiff.urdf";
  std::ofstream(urdf) << R"(<robot name="stiff"><link name="world"/><link name="a"><inertial>
  <origin xyz="0 0 -0.25"/><mass value="1"/><inertia ixx="0.02" iyy="0.02" izz="0.002" ixy="0" ixz="0"
  iyz="0"/></inertial></link><joint name="j" type="continuous"><parent link="world"/><child link="a"/>
  <axis xyz="0 1 0"/><dynamics damping="1e6"/></joint></robot>)";
  Truth truth{.builder = io::readUrdf(urdf), .integrator = Integrator::implicitMidpoint};
  const Estimate e = estimate({urdf, "--passive", "--q0", "j=1", "--duration", "0.1", "--timestep",
                               "0.002", "--integrator", "implicit-midpoint"},
                              folder, truth);
  EXPECT_TRUE(std::isfinite(e.told));
}

// With goals it is of the steps: half the step makes half the error in all, at order 1. At 4 ms
// goals still answer to the step.
TEST(ReportError, WithGoalsAddsUpItsSteps) {
  double errors[2];
  int k = 0;
  for (const char* h : {"0.001", "0.0005"}) {
    const io::TempFolder folder;
    const std::string summary = folder.path() / "summary.json";
    const Outcome outcome = simulate({dataFile("robots/arm.urdf"), "--reach", "tool=0.4,0.1,0.5",
                                      "--duration", "0.4", "--integrator", "semi-implicit-euler",
                                      "--timestep", h, "--report-error", "--summary", summary});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("local errors of the steps"), std::string::npos);
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
    EXPECT_LE(trueError(log, passiveArmTruth()).total, accuracy);
  }
}

// Over 10 s, of which the first two tell less than a quarter of the error.
TEST(Accuracy, IsKeptOverTheWholeRun) {
  const io::TempFolder folder;
  const std::string urdf = folder.path() / "pendulum.urdf", log = folder.path() / "log.csv";
  std::ofstream(urdf) << R"(<robot name="double"><link name="world"/>
  <link name="a"><inertial><origin xyz="0 0 -0.25"/><mass value="1"/><inertia ixx="0.02" iyy="0.02"
  izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="b"><inertial><origin xyz="0 0 -0.25"/><mass value="1"/><inertia ixx="0.02" iyy="0.02"
  izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="j1" type="continuous"><parent link="world"/><child link="a"/><axis xyz="0 1 0"/></joint>
  <joint name="j2" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0 0 -0.5"/>
  <axis xyz="0 1 0"/></joint></robot>)";
  const Outcome outcome = simulate({urdf, "--passive", "--q0", "j1=1.5,j2=0.5", "--duration", "10",
                                    "--accuracy", "1e-4", "--log", log});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("over the whole run of 10 s"), std::string::npos) << outcome.out;
  const double exact = trueError(log, {.builder = io::readUrdf(urdf), .step = 5e-4}).total;
  EXPECT_LE(exact, 1e-4);
  EXPECT_GE(exact, 1e-5);
}

// Controls of a table jump at its rows. Steps of the trial and of the run end there, so that
// methods keep their orders and an accuracy that needs them is found, and kept.
TEST(Accuracy, IsKeptUnderATable) {
  const io::TempFolder folder;
  const std::string table = folder.path() / "torques.csv", log = folder.path() / "log.csv";
  for (const int rate : {100, 1000}) {  // [Hz]
    std::ofstream out(table);
    out << "time_s,u:shoulder_pitch,u:elbow_pitch\n";
    for (int row = 0; row <= rate; ++row) {
      const double t = static_cast<double>(row) / rate;
      out << t << "," << 8.0 * std::sin(6.0 * t) << "," << 3.0 * std::cos(5.0 * t) << "\n";
    }
    out.close();
    const Outcome outcome = simulate({dataFile("robots/arm.urdf"), "--torques", table, "--duration",
                                      "1", "--accuracy", "1e-5", "--log", log});
    ASSERT_EQ(outcome.exitCode, 0) << rate << ": " << outcome.err;
    Truth truth = passiveArmTruth();
    truth.torques = table;
    // The arm runs against its limits, where Runge-Kutta 4 with steps of 1/16 ms is off by 2e-5 m.
    truth.integrator = Integrator::dormandPrince;
    EXPECT_LE(trueError(log, truth).total, 1e-5) << rate;
  }
}

// Rows that come as they like, from later than 0 on, and a run that ends between two: steps of the
// trial and of the run end on them all the same. Held steps of 8 ms would take rows that late.
TEST(Accuracy, IsKeptUnderATableOfIrregularRows) {
  const io::TempFolder folder;
  const std::string table = folder.path() / "torques.csv", log = folder.path() / "log.csv";
  std::ofstream out(table);
  out << "time_s,u:shoulder_pitch,u:elbow_pitch\n";
  for (int row = 0; row <= 200; ++row) {
    const double t = 0.0013 + 0.005 * row + 0.002 * std::sin(7.0 * row);
    out << t << "," << 8.0 * std::sin(6.0 * t) << "," << 3.0 * std::cos(5.0 * t) << "\n";
  }
  out.close();
  const std::vector<std::string> arguments{dataFile("robots/arm.urdf"),
                                           "--torques",
                                           table,
                                           "--duration",
                                           "0.7071",
                                           "--accuracy",
                                           "1e-5",
                                           "--log",
                                           log};
  const Outcome outcome = simulate(arguments);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  // The logged steps end on rows, so that steps of the truth do.
  Truth truth = passiveArmTruth();
  truth.torques = table;
  truth.integrator = Integrator::dormandPrince;
  EXPECT_LE(trueError(log, truth).total, 1e-5) << outcome.out;
  const Csv csv(readFile(log));
  EXPECT_NEAR(csv.number(static_cast<int>(csv.rows.size()) - 1, "time_s"), 0.7071, 1e-9);

  // What sleeps is not followed.
  std::vector<std::string> asleep = arguments;
  asleep.insert(asleep.end(), {"--sleep", "objects"});
  const Outcome refused = simulate(asleep);
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_NE(refused.err.find("expected sleep: none"), std::string::npos) << refused.err;
}

// What begins and ends within a step, seen by none of two references, is promised by nothing.
TEST(Accuracy, IsKeptWhereWallsArePassedWithinAStep) {
  for (const double speed : {25.0, 40.0, 55.0, 60.0})
    for (const double place : {0.97, 1.0, 1.03}) {
      const io::TempFolder folder;
      const Shot shot = shotAtAWall(folder, speed, place);
      const std::string log = folder.path() / "log.csv";
      const Outcome outcome =
          simulate({shot.scene, "--duration", "0.3", "--accuracy", "1e-2", "--log", log});
      ASSERT_EQ(outcome.exitCode, 0) << speed << " " << place << outcome.err;
      EXPECT_LE(trueError(log, shot.truth).total, 1e-2) << speed << " " << place << outcome.out;
    }
}

}  // namespace
}  // namespace softgauss::test
