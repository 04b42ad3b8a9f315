// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The command line of simulate_gdd.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/io/simulation/options.hpp"
#include "softgauss/io/simulation/plan_control.hpp"
#include "softgauss/io/simulation/scene.hpp"

namespace softgauss::app {

/// `--reach LINK[:ox,oy,oz]=x,y,z[@WEIGHT]`
struct ReachArgument {
  std::string link;
  Vector3 p_FP = Vector3::Zero();  ///< point in the link's frame [m]
  Vector3 p_WTarget = Vector3::Zero();
  std::optional<double> weight;  ///< absent: the goal's own [kg]
};

/// Where pages find a live run, which stays when its files are read anew.
struct LivePlace {
  unsigned short port = 0;  ///< 0: any that is free, until one is found
  std::string token;        ///< that pages need; empty: none
  int loads = 0;            ///< how often the files were read
  bool reload = false;      ///< they are to be read again: the run ends for that
};

/// What is loaded how, and what is done with it.
struct SimulateOptions : SimulationOptions {
  std::filesystem::path model;
  double duration = 2.0;  ///< ∞: until it is interrupted, or as long as what is played [s]
  std::vector<ReachArgument> reach;
  std::vector<std::string> hold;  ///< links
  std::optional<double> posture;  ///< weight of a posture about the start [-]

  /// Goals on the command line itself.
  bool hasOwnGoals() const { return !reach.empty() || !hold.empty() || posture; }
  bool hasGoals() const { return hasOwnGoals() || !goals.empty(); }  ///< or of --goals
  bool passive = false;
  bool servos = false;
  bool plan = false, mpc = false;  ///< what the scene's key plan asks for
  int planThreads = 1;
  std::shared_ptr<PlanControl> planControl;  ///< of it, once it is read
  bool hasDuration = false;                  ///< it was typed
  std::filesystem::path goals, torques;
  bool reportError = false;
  std::optional<double> accuracy;  ///< that a setting is to be chosen for [m]
  bool explain = false;
  bool quiet = false;
  bool details = false;  ///< what the solver did, in the table at the end
  long logEvery = 1;     ///< steps from one row of the log to the next
  std::filesystem::path log, contacts, summary, view, plot;
  std::filesystem::path viewWith;   ///< a page whose run the page shows too
  std::shared_ptr<LivePlace> live;  ///< a live run
  std::string liveAddress = "127.0.0.1";
  std::filesystem::path record, play;  ///< what is done to a live run, to a file and from one
  bool acted() const { return live || !play.empty(); }  ///< somebody acts on the run
  std::filesystem::path checkpoint, resume;             ///< written, and gone on from
  double checkpointEvery = 1.0;                         ///< simulated time [s]
  /// What was asked for, as it was typed, but for what makes no other run.
  std::vector<std::pair<std::string, std::string>> settings;
  std::string commandLine;  ///< as it was typed
  /// Called with the goals once they are made: a sweep moves their places.
  std::function<void(gdd::GoalDirectedController&)> changeGoals;

  /// MODEL is a scene file, not a URDF. Standard input is looked at. Throws ModelError.
  bool isScene() const { return isSceneFile(model); }
  /// Some output is standard output, which then holds nothing else.
  bool writesToStandardOutput() const;
};

/// A command line that cannot be run: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An output that could not be written: exit code 2 too.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An output may not overwrite an input or another output, and must be possible to make; all of
/// them are looked at before any is. `read`: files that the model named. Throws UsageError and
/// ModelError.
void checkOutputs(const SimulateOptions& options, const std::vector<std::filesystem::path>& read);

/// Throws when the step is too long, or the run has too many of them: ModelError where a file says
/// so in the line `where`, UsageError without one.
void checkSteps(const SimulateOptions& options, double timestep, const SourceLocation& where);

/// Parses argv. Returns nothing when the program is done already (--help, --version), which it
/// has printed. Throws UsageError.
std::optional<SimulateOptions> parseCommandLine(int argc, char** argv);

}  // namespace softgauss::app
