// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a run came to: statistics over its steps, as JSON for programs and as a table for people.
///
/// Percentiles are by nearest rank: p95 is the smallest value that at least 95 % of the steps do
/// not exceed; of more than 65,536 steps, of evenly spaced ones, half as many or more. Numbers that
/// are not finite are null in JSON.

#include <array>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/io/log.hpp"

namespace softgauss::io {

/// How far a goal was from being met, in its own unit, from where it began to act to its own end or
/// that of the run.
struct GoalOutcome {
  /// One of the things that hold it back.
  struct Cause {
    std::string what;    ///< e.g. "posture", "range of elbow"
    double share = 0.0;  ///< of all that hold it back
    template <class Archive>
    void archive(Archive& a) {
      a(what, share);
    }
  };
  std::string name;                     ///< e.g. "reach right_hand", "momentum (angular)"
  std::string unit = "m";               ///< of the errors
  double initialError = 0.0;            ///< where it began to act
  double finalError = 0.0;              ///< at its own end, or that of the run
  double bestError = 0.0;               ///< the least of all steps
  double bestTime = 0.0;                ///< [s]
  double judgedAt = 0.0;                ///< where its own end, or that of the run, was [s]
  double met = 0.01;                    ///< it is met where the error is at most this
  std::optional<double> metSince = {};  ///< met from here to its end, or last met until then [s]
  bool yields = false;                  ///< others may outweigh it by design, as a posture's
  bool began = true;                    ///< it has acted, and had a figure
  std::string reason = {};              ///< why it was not met; empty where it was
  std::vector<Cause> causes = {};       ///< the largest first, their shares add up to 1
  /// Where weights hold it back: one with which it was found to leave less, and how much.
  struct OtherWeight {
    double weight, error;
  };
  std::optional<OtherWeight> otherWeight = {};

  template <class Archive>
  void archive(Archive& a) {
    a(initialError, finalError, bestError, bestTime, judgedAt, met, metSince, began, reason,
      causes);
  }
  bool isMet() const { return began && finalError <= met; }
  bool wasMet() const { return began && bestError <= met; }
};

/// How the solves of goals ended, over the steps.
struct GddOutcomes {
  long certified = 0;        ///< minima of one cell, with a certificate
  long nonsmoothMinima = 0;  ///< minima at breakpoints, with a certificate
  long iterationLimit = 0;   ///< the best that was found, no certificate
  long nonsmoothStalls = 0;  ///< at a kink of an elliptic cone, no certificate
  long undecided = 0;  ///< rounding or too many rows at breakpoints kept it from a certificate
  long restarts = 0;   ///< solves that were begun again without their warm start
  template <class Archive>
  void archive(Archive& a) {
    a(certified, nonsmoothMinima, iterationLimit, nonsmoothStalls, undecided, restarts);
  }
  long all() const {
    return certified + nonsmoothMinima + iterationLimit + nonsmoothStalls + undecided;
  }
  long uncertified() const { return iterationLimit + nonsmoothStalls + undecided; }
};

/// What steps did in place of what was asked for (StepStats), over a run.
struct Fallbacks {
  long unconvergedSolves = 0;      ///< stalled or at the iteration limit
  long roundingLimitedSolves = 0;  ///< ended by rounding, within 10³ of the tolerance
  long invalidWarmStarts = 0;      ///< warm starts that were not finite
  long abandonedTrees = 0;         ///< not followed through the step
  long stabilisedBodies = 0;       ///< bodies that swing too fast between connections, held
  long minimumStepsAccepted = 0;   ///< shortest parts of a step, taken in spite of their estimate
  long possibleTunnelling = 0;  ///< parts in which shapes may have passed through each other unseen

  template <class Archive>
  void archive(Archive& a) {
    a(unconvergedSolves, roundingLimitedSolves, invalidWarmStarts, abandonedTrees, stabilisedBodies,
      minimumStepsAccepted, possibleTunnelling);
  }
};

/// What integrators that look within a step did there (StepStats), over a run.
struct IntegrationCounts {
  long evaluations = 0;       ///< of forward dynamics; 0 where a step is one solve
  long substeps = 0;          ///< parts that steps went in
  long rejections = 0;        ///< parts that were tried and shortened
  long tunnellingSplits = 0;  ///< parts cut short lest shapes pass through each other unseen
  long parts = 0;             ///< into which the leapfrog has divided steps, summed (6.3)
  long repeats = 0;  ///< solves of the leapfrog that were repeated, with another prediction

  template <class Archive>
  void archive(Archive& a) {
    a(evaluations, substeps, rejections, tunnellingSplits, parts, repeats);
  }
};

/// How often each mechanism of the step has acted over a run, in the order of Mechanism.
using MechanismActs = std::array<long, std::size(kMechanismNames)>;

/// Who has slept over the steps of a run, counted in trees: robots and objects, or parts of a robot
/// that stand on the world each.
struct SleepOutcomes {
  bool on = false;
  int trees = 0;  ///< of the model
  long steps = 0;
  long asleep = 0;  ///< sum over the steps
  long wakeups = 0;
  int most = 0;  ///< asleep in a step

  template <class Archive>
  void archive(Archive& a) {
    a(on, trees, steps, asleep, wakeups, most);
  }
  double asleepShare() const {
    const double all = static_cast<double>(trees) * static_cast<double>(steps);
    return all > 0.0 ? static_cast<double>(asleep) / all : 0.0;
  }
};

/// What the settings of a run leave as error, estimated beside it.
struct ErrorOutcome {
  bool estimated = false;
  bool ofSteps = false;      ///< the sum of what the steps err by; else of the whole run
  double position = 0.0;     ///< of link poses, root mean square [m]
  double orientation = 0.0;  ///< of links [rad]
};

/// What a run was made from, for who wants to make it again.
struct RunOrigin {
  struct File {
    std::string path;
    std::string sha256;  ///< hexadecimal; empty where it could not be read again
  };
  std::string commandLine;
  std::string commit;     ///< of the sources, with "+" where they had changes; empty: not known
  std::string compiler;   ///< with its version
  std::string processor;  ///< as it calls itself
  std::vector<File> files;
};

/// A joint or an actuator, and the largest share of its bound that was used.
struct ControlRatio {
  std::string name;
  double ratio = 0.0;

  template <class Archive>
  void archive(Archive& a) {
    a(name, ratio);
  }
};

/// Values of one quantity over the steps, in half a megabyte however long the run: beyond kMost
/// values every second one is dropped, and from there on every second of the new ones, again and
/// again; mean and maximum stay those of all.
struct Series {
  static constexpr std::size_t kMost = std::size_t{1} << 16;

  std::vector<double> values;
  long every = 1;  ///< how many values one that is kept stands for
  long skip = 0;   ///< how many of the next are dropped
  // Of those that were dropped:
  long dropped = 0;
  double droppedSum = 0.0, droppedMax = -kInfinity;

  void add(double value);
  template <class Archive>
  void archive(Archive& a) {
    a(values, every, skip, dropped, droppedSum, droppedMax);
    if constexpr (Archive::kReads)
      a.expect(values.size() < kMost && every >= 1 && skip >= 0 && skip < every && dropped >= 0);
  }

  double percentile(double share) const;  ///< nearest rank; 0 without values
  double max() const;
  double mean() const;
};

/// A plan, and what became of it (planning::MotionPlan).
struct PlanOutcome {
  std::string status, outcome;               ///< as planned; "carried out", "lost", …
  double planned = 0.0, finalPlanned = 0.0;  ///< cost, and of it that of the final terms
  int iterations = 0;
  double seconds = 0.0;  ///< of planning
  double rootForce = 0.0, gap = 0.0, certificate = 0.0;
  double cost = 0.0, running = 0.0, effort = 0.0, final = 0.0;  ///< of the motion, and its parts
  int ticks = 0, failedTicks = 0;                               ///< of one that recedes
  Series tickMs;
};

class Summary {
 public:
  explicit Summary(const Model& model);

  /// Every step's record, in order; then the final state's, of which time, energy and penetration
  /// are read.
  void addStep(const StepRecord& record);
  void finish(const StepRecord& finalState);
  /// A command of an actuator as a share of its bound.
  void addControlRatio(const std::string& name, double ratio);
  /// What the steps have come to, for a run that goes on later.
  template <class Archive>
  void archive(Archive& a) {
    a(gdd, fallbacks, integration, sleep, mechanismActs, wallSeconds, steps_, startTime_, endTime_,
      initialEnergy_, finalEnergy_, maxPenetration_, ratios_, forwardUs_, gddUs_, stepUs_,
      constraints_, iterations_, dualUpdates_, physicsViolation_, gddViolation_, stationarity_,
      realised_);
    if constexpr (Archive::kReads) a.expect(ratios_.size() >= bounded_.size());
  }
  /// Of all that have a bound, the largest first.
  std::vector<ControlRatio> controlRatios() const;

  std::string json() const;
  /// Throws ModelError if the file cannot be written.
  void write(const std::filesystem::path& file) const;
  /// For people, with units: what ran, warnings, and the verdict, which ends it. `details` adds
  /// what the solver did and what it took.
  std::string table(bool details = false) const;
  /// The same in a few pairs of a name and a value, the verdict first.
  std::vector<std::pair<std::string, std::string>> facts() const;

  // What only the caller knows.
  std::string version;
  std::string integrator;  ///< preset to the model's
  std::string gddSolver = "active-set";
  std::string controlCost = "about_gravity";  ///< or "total"
  std::string outcome = "completed";          ///< or "fell", "interrupted", "non-finite"
  /// What a person wants to know, in order: a word and a sentence each, e.g. "reached", "reach arm:
  /// 0.4 mm left". The first says how the run ended.
  std::vector<std::pair<std::string, std::string>> verdict;
  std::string stateHash;           ///< of the state at the end, hexadecimal
  std::vector<std::string> bases;  ///< how each robot meets the world
  RunOrigin origin;
  double wallSeconds = 0.0;
  double massKg = 0.0;  ///< of all links; preset to that of the moving bodies
  std::vector<std::string> effects;
  std::vector<GoalOutcome> goals;
  GddOutcomes gdd;
  Fallbacks fallbacks;
  IntegrationCounts integration;
  MechanismActs mechanismActs{};
  SleepOutcomes sleep;
  ErrorOutcome error;
  std::optional<PlanOutcome> plan;
  std::vector<std::string> warnings;  ///< preset to the model's

  double simulatedSeconds() const { return endTime_ - startTime_; }
  double realTimeFactor() const;  ///< simulated over wall time

 private:
  struct Bounded {
    int dof;
    double effort;
  };
  std::string detailsTable() const;

  std::string modelName_;
  int links_ = 0, dofs_ = 0, actuated_ = 0;
  double timestep_ = 0.0;
  std::string cone_;
  double impedanceRatio_ = 1.0;
  bool exactDiagonal_ = false, stepDoubling_ = false;
  std::vector<std::string> without_;          ///< mechanisms left out
  std::vector<std::size_t> mechanismsInUse_;  ///< in the order of Mechanism
  double tolerance_ = 0.0;
  std::vector<Bounded> bounded_;  ///< controls with a box
  std::size_t steps_ = 0;
  double startTime_ = 0.0, endTime_ = 0.0;
  double initialEnergy_ = 0.0, finalEnergy_ = 0.0;
  double maxPenetration_ = 0.0;
  std::vector<ControlRatio> ratios_;  ///< of bounded_, then of actuators
  Series forwardUs_, gddUs_, stepUs_, constraints_, iterations_, dualUpdates_;
  Series physicsViolation_, gddViolation_, stationarity_, realised_;
};

}  // namespace softgauss::io
