// SPDX-License-Identifier: Apache-2.0
/// compare_mujoco: one model in two engines, in one process.
///
/// Along the path that softgauss takes, with the same controls, both are put into every state:
/// their accelerations are compared with both solvers fully converged, each
/// with its own contact points and ours with MuJoCo's too, and their steps, forward and
/// inverse dynamics are timed in turns, at the tolerances that each has by default. At last both
/// run freely for a second from the same state. Whole runs of either are timed besides, of ours by
/// MuJoCo's model and by the default one. With --table many scenes are timed instead, by default.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "apps/compare_mujoco/mjcf.hpp"
#include "apps/compare_mujoco/mujoco.hpp"
#include "apps/compare_mujoco/report.hpp"
#include "apps/compare_mujoco/robot.hpp"
#include "apps/compare_mujoco/speed_table.hpp"
#include "apps/compare_mujoco/step_duel.hpp"
#include "apps/compare_mujoco/urdf_copy.hpp"
#include "apps/compare_mujoco/urdf_reading.hpp"
#include "apps/shared/wall_clock.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/io/nearest_rank.hpp"
#include "softgauss/io/simulation/time_grid.hpp"

namespace {

using namespace softgauss;
using app::Mujoco;
using Json = nlohmann::ordered_json;

constexpr double kFreeRun = 1.0;  ///< [s]

struct Arguments {
  app::RobotFile robot;
  std::string json, copy;
  double duration = 2.0;
  app::TableOptions speeds;
  std::string table, picture;  ///< files of --table
};

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[io::nearestRank(share, values.size())];
}

/// Times of the two engines for the same work, taken in turns [µs].
struct Duel {
  std::vector<double> ours, mujoco;

  template <class F>
  static void time(std::vector<double>& out, F&& work) {
    const auto start = app::Clock::now();
    work();
    out.push_back(1e6 * app::secondsSince(start));
  }
  Json json() const {
    const double a = percentile(ours, 0.5), b = percentile(mujoco, 0.5);
    return {{"ours", a}, {"mujoco", b}, {"ratio", a / b}};
  }
};

/// Largest difference, relative to the largest entry where that is above 1.
double difference(const VectorX& a, const VectorX& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1.0, b.cwiseAbs().maxCoeff());
}

class Comparison {
 public:
  explicit Comparison(const Arguments& arguments)
      : model_(app::loadRobot(arguments.robot, true)),
        contacts_(model_),
        data_(model_),
        mujoco_(app::mjcfOf(model_, contacts_.filter())),
        initial_(app::standingState(model_)) {
    if (mujoco_.nq() != model_.nq || mujoco_.nv() != model_.nv)
      throw std::runtime_error(
          fmt::format("MuJoCo has {} positions and {} velocities, ours {} and {}", mujoco_.nq(),
                      mujoco_.nv(), model_.nq, model_.nv));
  }

  const Model& model() const { return model_; }

  Json run(double duration) {
    const auto steps = static_cast<int>(stepsIn(duration, model_.options.timestep));
    State state = initial_;
    for (int i = 0; i < steps; ++i) {
      const VectorX tau = app::swingingControl(model_, state.time);
      compareAccelerations(state, tau);
      timeForwardAndInverse(state, tau);
      timeStep(state, tau);
    }
    const double freely = freeRun();
    return {{"mujoco_version", Mujoco::version()},
            {"model", model_.name},
            {"dof", model_.nv},
            {"step_us", step_.json()},
            {"forward_us", forward_.json()},
            {"inverse_us", inverse_.json()},
            {"acceleration_difference", spread(accelerations_)},
            {"acceleration_difference_same_contacts", spread(sameContacts_)},
            {"inverse_difference", spread(forces_)},
            {"inverse_difference_same_contacts", spread(sameContactForces_)},
            {"mujoco_imbalance", spread(imbalances_)},
            {"state_difference_after_1s", freely},
            {"contacts",
             {{"ours", percentile(ourContacts_, 0.5)},
              {"mujoco", percentile(theirContacts_, 0.5)},
              {"steps_with_equal_numbers", equalContacts_}}},
            {"steps", steps},
            {"mujoco_warning", mujoco_.firstWarning()}};
  }

 private:
  static Json spread(const std::vector<double>& values) {
    return {{"p50", percentile(values, 0.5)},
            {"p95", percentile(values, 0.95)},
            {"max", percentile(values, 1.0)}};
  }

  /// (1.1) and (1.2) against MuJoCo's, both converged.
  void compareAccelerations(const State& state, const VectorX& tau) {
    input_.tau = tau;
    computeStages(model_, input_, state, data_, &contacts_);
    forwardDynamics(model_, state, data_);
    mujoco_.setTolerance(0.0);
    mujoco_.set(state, tau);
    mujoco_.setWarmStart(data_.forward.a);
    mujoco_.forward();
    theirs_.points = mujoco_.contacts(model_);
    imbalances_.push_back(mujoco_.imbalance());
    accelerations_.push_back(difference(data_.forward.a, mujoco_.acceleration()));
    const VectorX a = mujoco_.acceleration();
    inverseDynamics(model_, a, data_, scratch_);
    mujoco_.inverse();
    forces_.push_back(difference(scratch_, mujoco_.inverseForce()));
    const int ours = data_.stats.contacts;
    ourContacts_.push_back(ours);
    theirContacts_.push_back(static_cast<double>(theirs_.points.size()));
    equalContacts_ += ours == static_cast<int>(theirs_.points.size()) ? 1 : 0;
    // The same contact points in both: what is left is dynamics and constraints alone.
    computeStages(model_, input_, state, data_, &theirs_);
    forwardDynamics(model_, state, data_);
    sameContacts_.push_back(difference(data_.forward.a, a));
    theirs_.points = mujoco_.contacts(model_);  // of inverse(), which finds its own
    computeStages(model_, input_, state, data_, &theirs_);
    inverseDynamics(model_, a, data_, scratch_);
    sameContactForces_.push_back(difference(scratch_, mujoco_.inverseForce()));
  }

  void timeForwardAndInverse(const State& state, const VectorX& tau) {
    mujoco_.setTolerance(kTheirTolerance);
    mujoco_.set(state, tau);
    if (theirWarmStart_.size() > 0) mujoco_.setWarmStart(theirWarmStart_);
    Duel::time(forward_.ours, [&] {
      computeBodyStages(model_, input_, state, data_, &contacts_);
      forwardDynamics(model_, state, data_);
    });
    Duel::time(forward_.mujoco, [&] { mujoco_.forward(); });
    const VectorX a = data_.forward.a;
    mujoco_.setAcceleration(a);
    Duel::time(inverse_.ours, [&] {
      computeBodyStages(model_, input_, state, data_, &contacts_);
      inverseDynamics(model_, a, data_, scratch_);
    });
    Duel::time(inverse_.mujoco, [&] { mujoco_.inverse(); });
  }

  /// Both from the same state; the path goes on with ours.
  void timeStep(State& state, const VectorX& tau) {
    mujoco_.set(state, tau);
    if (theirWarmStart_.size() > 0) mujoco_.setWarmStart(theirWarmStart_);
    Duel::time(step_.mujoco, [&] { mujoco_.step(); });
    theirWarmStart_ = mujoco_.acceleration();
    Duel::time(step_.ours, [&] {
      if (isRefused(step(model_, input_, state, data_, &contacts_)))
        throw app::NotFinite(fmt::format(
            "our simulation became non-finite at t = {:.6g} s; try a smaller --timestep",
            state.time));
    });
  }

  /// Largest difference of the configurations a second after the start, each on its own path.
  double freeRun() {
    State state = initial_;
    Mujoco& theirs = mujoco_;
    theirs.setTolerance(0.0);
    const auto steps = static_cast<int>(std::round(kFreeRun / model_.options.timestep));
    theirs.set(state, VectorX::Zero(model_.nv));
    theirs.setWarmStart(VectorX::Zero(model_.nv));
    for (int i = 0; i < steps; ++i) {
      input_.tau = app::swingingControl(model_, state.time);
      step(model_, input_, state, data_, &contacts_);
      theirs.setForce(input_.tau);
      theirs.step();
    }
    const VectorX other = theirs.q();
    return positionDifference(model_, state.q, other).cwiseAbs().maxCoeff();
  }

  static constexpr double kTheirTolerance = 1e-8;  ///< MuJoCo's default

  Model model_;
  collision::SceneContacts contacts_;
  Data data_;
  Mujoco mujoco_;
  State initial_;
  Input input_;
  VectorX scratch_, theirWarmStart_;
  Duel step_, forward_, inverse_;
  FixedContacts theirs_;
  std::vector<double> accelerations_, sameContacts_, forces_, sameContactForces_, ourContacts_,
      theirContacts_, imbalances_;
  int equalContacts_ = 0;
};

/// Whole runs by MuJoCo's model and by ours.
Json timeModes(const Arguments& arguments) {
  constexpr int kRounds = 7;
  Json modes;
  for (const bool likeMujoco : {true, false}) {
    const Model model = app::loadRobot(arguments.robot, likeMujoco);
    const app::StepTimes times =
        app::timeSteps(model, app::standingState(model), arguments.duration, kRounds,
                       [&](double time) { return app::swingingControl(model, time); });
    modes[likeMujoco ? "compatibility" : "default"] = {
        {"ours", times.ours}, {"mujoco", times.mujoco}, {"ratio", times.ours / times.mujoco}};
  }
  return modes;
}

Json compare(const Arguments& arguments) {
  Comparison comparison(arguments);
  const app::UrdfCopy copy = app::copyUrdf(arguments.robot.file, comparison.model());
  if (!arguments.copy.empty()) app::writeCopy(copy, arguments.copy);
  Json result = comparison.run(arguments.duration);
  result["mujoco_build"] = app::mujocoBuild();
  result["run_step_us"] = timeModes(arguments);
  result["urdf_reading"] = app::compareReading(comparison.model(), copy);
  return result;
}

void write(const std::string& file, const std::string& text) {
  if (!(std::ofstream(file) << text << std::flush))
    throw ModelError({file, 0}, "output", "cannot be written");
}

Json tableOfSpeeds(const Arguments& arguments) {
  Json speeds = app::measureSpeeds(arguments.speeds);
  const std::string text = app::speedMarkdown(speeds);
  fmt::print("{}", text);
  if (!arguments.table.empty()) write(arguments.table, text);
  if (!arguments.picture.empty()) app::drawSpeeds(speeds, arguments.picture);
  return speeds;
}

/// What is wrong with a regular expression, or nothing.
std::string checkPattern(const std::string& text) {
  try {
    const std::regex pattern(text);
    return {};
  } catch (const std::regex_error& error) {
    return fmt::format("'{}' is no regular expression: {}", text, error.what());
  }
}

void addTableOptions(CLI::App& app, bool& table, Arguments& arguments) {
  app::TableOptions& speeds = arguments.speeds;
  CLI::Option* const flag = app.add_flag("--table", table, "time many scenes in both engines");
  for (CLI::Option* option :
       {app.add_option("--out", arguments.table, "write the table to this Markdown file too"),
        app.add_option("--picture", arguments.picture,
                       "draw time against size into this .svg file, with gnuplot"),
        app.add_option("--only", speeds.filter, "regular expression of the rows that are measured")
            ->check(checkPattern),
        app.add_option("--rounds", speeds.rounds, "of which the least time counts, default 20")
            ->check(CLI::Range(1, 1000)),
        app.add_option("--robots", speeds.robots, "folder of humanoid.urdf, hand.urdf, arm.urdf")
            ->check(CLI::ExistingDirectory),
        app.add_option("--mujoco-flags", speeds.mujocoFlags,
                       "how MuJoCo was compiled, for the heading"),
        app.add_flag("--quick", speeds.quick, "one round, without the large scenes")})
    option->needs(flag);
}

/// Does what is asked for; the exit code.
int run(const Arguments& arguments, bool table) {
  try {
    const Json result = table ? tableOfSpeeds(arguments) : compare(arguments);
    if (!table) app::printComparison(result);
    if (!arguments.json.empty()) write(arguments.json, result.dump(2) + '\n');
  } catch (const ModelError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const app::NotFinite& error) {
    fmt::print(stderr, "compare_mujoco: {}\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "compare_mujoco: internal error: {}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  app::RobotFile& robot = arguments.robot;
  std::vector<std::string> models;
  bool table = false;
  CLI::App app("The same model in softgauss and in MuJoCo: differences and times");
  app.add_option("MODEL", models, "a .urdf file; with --table any number, timed besides");
  app.add_option("--base", robot.base, "fixed or floating")
      ->check(CLI::IsMember({"fixed", "floating"}));
  app.add_option("--duration", arguments.duration, "compared time [s], default 2")
      ->check(CLI::PositiveNumber);
  app.add_option("--timestep", robot.timestep, "step [s], default 0.002")
      ->check(CLI::Range(1e-6, 1.0));
  app.add_option("--json", arguments.json, "write the figures to this file too");
  app.add_option("--write-copy", arguments.copy,
                 "write the URDF as MuJoCo reads it, with its meshes, into this folder");
  app.add_option("--package-path", robot.packagePaths,
                 "where package://NAME/… is looked for first; repeatable");
  addTableOptions(app, table, arguments);
  try {
    app.parse(argc, argv);
    if (!table && models.size() != 1)
      throw CLI::ValidationError("MODEL", "expected one, unless there is --table");
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  for (const std::string& model : models) {
    robot.file = model;
    arguments.speeds.extra.push_back(robot);
  }
  return run(arguments, table);
}
