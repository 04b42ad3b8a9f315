// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/run.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <cmath>
#include <optional>
#include <utility>

#include "apps/shared/wall_clock.hpp"
#include "apps/simulate_gdd/error_estimate.hpp"
#include "apps/simulate_gdd/island_run.hpp"
#include "apps/simulate_gdd/outside_input.hpp"
#include "apps/simulate_gdd/progress.hpp"
#include "apps/simulate_gdd/replay.hpp"
#include "apps/simulate_gdd/verdict.hpp"
#include "engine/engine.hpp"
#include "io/explain.hpp"
#include "io/log.hpp"
#include "io/summary.hpp"

namespace softgauss::app {
namespace {

volatile sig_atomic_t interruptRequested = 0;

/// Largest |g(q, v, a) − (u, 0)|: recomputed by inverse dynamics, not taken from the solver.
double physicsViolation(const Model& model, Data& data, VectorX& scratch) {
  inverseDynamics(model, data.forward.a, data, scratch);
  return model.nv == 0 ? 0.0 : (scratch - data.forces.tau).cwiseAbs().maxCoeff();
}

/// What went wrong, where, and what to try.
std::string failureMessage(const Model& model, const State& state, const Data& data) {
  std::string where = "the state";
  if (data.stats.badDof >= 0)
    where = fmt::format("joint '{}'", model.jointNames[model.dofs[data.stats.badDof].body]);
  std::string deepest;
  double depth = 0.0;
  for (const Contact& c : data.contacts.contacts) {
    if (!(-c.distance > depth)) continue;
    depth = -c.distance;
    deepest =
        fmt::format("; deepest contact: {} on {}, {:.3g} m", model.geometries[c.geometryA].name,
                    model.geometries[c.geometryB].name, depth);
  }
  return fmt::format(
      "the simulation became non-finite at t = {:.6g} s at {}{}. Try a smaller --timestep, more "
      "joint "
      "damping, or goals that ask for less",
      state.time, where, deepest);
}

/// The loop and all that it writes.
class Runner {
 public:
  Runner(const SimulateOptions& options, Scene& scene)
      : options_(options),
        model_(scene.model),
        contacts_(scene.source()),
        state_(scene.initial),
        data_(model_),
        controller_(model_),
        outside_(options, scene),
        kinematics_(model_),
        summary_(model_) {
    setUp(options, scene, controller_);
    if (!options.log.empty()) log_.emplace(options.log, model_);
    summary_.version = SOFTGAUSS_VERSION;
    summary_.massKg = scene.contents.mass;
    const std::vector<io::EffectNote> notes = io::effectNotes(model_, scene.wrenches);
    summary_.effects = io::effectsOn(notes);
    for (const io::EffectNote& note : notes)
      if (note.asked && !note.on)
        summary_.warnings.push_back(fmt::format("{} is not simulated: {}", note.name, note.reason));
    if (options.islands) islands_.emplace(model_, state_, options.sleep, controller_);
    if (options.reportError)
      errorEstimate_.emplace(model_, state_, outside_, !controller_.goals.empty());
    computeStages(model_, input_, state_, data_, &contacts_);
    for (const auto& goal : controller_.goals)
      if (const std::optional<double> error = goal->error({model_, state_, data_}))
        summary_.goals.push_back({goal->name(), *error, *error});
    replay_.emplace(options, scene, controller_.goals, gdd::GoalContext{model_, state_, data_});
  }

  ExitCode run() {
    const auto steps =
        static_cast<long>(std::ceil(options_.duration / model_.options.timestep - 1e-9));
    RunProgress progress(options_.duration, options_.quiet);
    Verdict verdict(model_, controller_.box);
    ExitCode code = kDone;
    // From here on an interrupt ends the run in order; a second one ends it at once.
    struct sigaction action = {};
    action.sa_handler = [](int) { interruptRequested = 1; };
    action.sa_flags = SA_RESETHAND;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    const Clock::time_point start = Clock::now();
    for (long i = 0; i < steps && code == kDone; ++i) {
      const auto takeStep = [&] {
        if (interruptRequested) {
          code = kInterrupted;
        } else if (!step()) {
          code = kCannotContinue;
        } else {
          record();
          verdict.observe(record_.u, controller_.commands, state_);
          progress.show(state_.time, secondsSince(start));
        }
        return code == kDone;
      };
      // An accuracy was found with steps that end where outside input changes.
      if (options_.accuracy)
        outside_.inParts(model_, state_, takeStep);
      else
        takeStep();
    }
    progress.clear();
    summary_.wallSeconds = secondsSince(start);
    std::string reason;
    if (code == kCannotContinue) {
      reason = failureMessage(model_, state_, data_);
      fmt::print(stderr, "simulate_gdd: {}\n", reason);
      summary_.outcome = "non-finite";
    } else if (code == kInterrupted) {
      reason = fmt::format("interrupted at t = {:.6g} s", state_.time);
      summary_.outcome = "interrupted";
    }
    finish(verdict, reason);
    if (!outputError_.empty()) throw OutputError(outputError_);
    return code;
  }

 private:
  /// One step; false when it could not be taken, the state then being the last good one.
  bool step() {
    record_.time = state_.time;
    record_.q = state_.q;
    record_.v = state_.v;
    computeKinematics(model_, state_, kinematics_);
    outside_.at(model_, state_, kinematics_, input_);
    if (errorEstimate_) before_ = state_;
    const Clock::time_point start = Clock::now();
    const SolveStatus status = islands_ ? islands_->step(input_)
                               : controller_.goals.empty()
                                   ? softgauss::step(model_, input_, state_, data_, &contacts_)
                                   : controller_.step(model_, input_, state_, data_, &contacts_);
    record_.stepUs = 1e6 * secondsSince(start);
    if (islands_) islands_->take(input_, state_, data_);
    if (errorEstimate_ && !isRefused(status)) estimateError();
    const bool cones =
        islands_ ? islands_->controlledCones() : !data_.constraints.piecewiseQuadratic();
    if (cones) ++stepsWithCones_;
    return !isRefused(status);
  }

  /// A control that goals have found is held over the step.
  void estimateError() {
    held_.wrenches = input_.wrenches;
    held_.tau = controller_.goals.empty() ? input_.tau : controller_.control;
    held_.softFriction = !controller_.goals.empty();
    errorEstimate_->observe(before_, held_, state_, model_.options.timestep);
  }

  void record() {
    const bool gdd = !controller_.goals.empty();
    const StepStats& stats = data_.stats;
    record_.a = data_.plan.drifts ? data_.acceleration : data_.forward.a;
    record_.u = data_.forces.tau;
    record_.contacts = stats.contacts;
    record_.constraints = stats.rows;
    record_.iterations = gdd ? controller_.report.iterations : stats.iterations;
    record_.dualUpdates = gdd ? controller_.report.dualUpdates : 0;
    record_.gddViolation = gdd ? controller_.report.violation : 0.0;
    record_.stationarity = gdd ? controller_.report.stationarity : 0.0;
    record_.realised = stats.realised;
    record_.gddUs = gdd ? 1e6 * controller_.solveTime : 0.0;
    record_.forwardUs = record_.stepUs - record_.gddUs;
    record_.physicsViolation =
        islands_ ? islands_->physicsViolation() : physicsViolation(model_, data_, scratch_);
    const Energy energy = computeEnergy(model_, kinematics_, record_.q, record_.v);
    record_.energy = energy.total();
    record_.kineticEnergy = energy.kinetic;
    record_.maxPenetration = stats.maxPenetration;
    writeLog(record_);
    summary_.addStep(record_);
    if (gdd) count(controller_.report);
    count(stats);
    for (Eigen::Index k = 0; k < controller_.commands.size(); ++k) {
      const gdd::Actuator& actuator =
          controller_.box.transmission->actuators()[static_cast<std::size_t>(k)];
      const double bound = std::max(-actuator.lower, actuator.upper);
      if (std::isfinite(bound) && bound > 0.0)
        summary_.addControlRatio(std::abs(controller_.commands[k]) / bound);
    }
    // What is seen is the step's start, where the record is of.
    std::swap(data_.kinematics, kinematics_);
    if (islands_)
      replay_->addStep(record_, data_, islands_->contacts());
    else
      replay_->addStep(record_, data_);
    std::swap(data_.kinematics, kinematics_);
  }

  void count(const StepStats& stats) {
    io::Fallbacks& f = summary_.fallbacks;
    f.shortSolves += stats.shortSolves;
    f.roundedSolves += stats.roundedSolves;
    f.refusedGuesses += stats.refusedGuesses;
    f.keptSlips += stats.keptSlips;
    f.abandonedTrees += stats.abandonedTrees;
    f.heldSwings += stats.swings;
    f.jumps += stats.jumps;
    f.unseen += stats.unseen;
    io::IntegrationCounts& i = summary_.integration;
    i.evaluations += stats.evaluations;
    i.substeps += stats.substeps;
    i.parts += data_.plan.drifts ? stats.parts : 0;
    i.repeats += stats.repeats;
    i.rejections += stats.rejections;
    i.glances += stats.glances;
  }

  void count(const gdd::GddReport& report) {
    io::GddOutcomes& outcomes = summary_.gdd;
    outcomes.restarts += report.restarts;
    switch (report.status) {
      case gdd::GddStatus::converged:
        ++outcomes.certified;
        break;
      case gdd::GddStatus::kink:
        ++outcomes.kinks;
        break;
      case gdd::GddStatus::iterationLimit:
        ++outcomes.iterationLimit;
        break;
      case gdd::GddStatus::bend:
        ++outcomes.bend;
        break;
      case gdd::GddStatus::undecided:
        ++outcomes.undecided;
        break;
      case gdd::GddStatus::badBox:
      case gdd::GddStatus::notFinite:
        break;
    }
  }

  /// A log that cannot be written does not keep the rest of the run from being reported.
  void writeLog(const io::StepRecord& row) {
    guardLog([&] { log_->write(row); });
  }
  void closeLog() {
    guardLog([&] { log_->close(); });
  }
  template <class F>
  void guardLog(F&& f) {
    if (!log_ || !outputError_.empty()) return;
    try {
      f();
    } catch (const std::exception& error) {
      outputError_ = error.what();
    }
  }

  /// The final state, in the log's last row and the summary.
  void finish(const Verdict& verdict, const std::string& reason) {
    computeStages(model_, input_, state_, data_, &contacts_);
    io::StepRecord last;
    last.time = state_.time;
    last.q = state_.q;
    last.v = state_.v;
    last.a = last.u = VectorX::Zero(model_.nv);
    last.contacts = data_.stats.contacts;
    last.constraints = data_.stats.rows;
    const Energy energy = computeEnergy(model_, data_.kinematics, state_.q, state_.v);
    last.energy = energy.total();
    last.kineticEnergy = energy.kinetic;
    last.maxPenetration = data_.stats.maxPenetration;
    writeLog(last);
    closeLog();
    std::size_t place = 0;
    for (const auto& goal : controller_.goals)
      if (const std::optional<double> error = goal->error({model_, state_, data_}))
        summary_.goals[place++].finalError = *error;
    for (std::string& unreached : verdict.unreached(summary_.goals))
      summary_.warnings.push_back(std::move(unreached));
    tellSolver();
    tellMinima();
    tellUnseen();
    if (islands_) summary_.islands = islands_->outcomes();
    if (errorEstimate_) summary_.error = errorEstimate_->outcome();
    summary_.finish(last);
    if (!options_.summary.empty()) summary_.write(options_.summary);
    const std::string error = replay_->finish(last, data_, summary_, reason);
    if (outputError_.empty()) outputError_ = error;
    if (!options_.quiet) fmt::print("{}{}", replay_->written(), summary_.table());
  }

  /// Which solver followed the goals. Steps in which cones touch are solver 1's.
  void tellSolver() {
    const bool cones = stepsWithCones_ > 0 && !controller_.goals.empty();
    const bool chosen = controller_.solver == gdd::GddSolver::activeSet;
    summary_.controlCost =
        controller_.controlCost == gdd::ControlCost::total ? "total" : "about_gravity";
    summary_.gddSolver = chosen && !cones ? "active-set" : "augmented-lagrangian";
    if (chosen && cones && options_.gddSolver)
      summary_.warnings.push_back(
          fmt::format("active-set does not know elliptic cones: {} steps with such contacts were "
                      "solved by augmented-lagrangian",
                      stepsWithCones_));
  }

  /// Controls without a certificate are the best that was found, and may be poor.
  void tellMinima() {
    const io::GddOutcomes& g = summary_.gdd;
    if (g.uncertified() == 0) return;
    summary_.warnings.push_back(fmt::format(
        "{} of {} steps took the best control that was found, without a certificate that it is a "
        "minimum: {} at the iteration limit, {} at a bend of an elliptic cone, {} undecided",
        g.uncertified(), g.all(), g.iterationLimit, g.bend, g.undecided));
  }

  /// A step that is not divided sees nothing of what begins and ends within it.
  void tellUnseen() {
    if (summary_.fallbacks.unseen == 0) return;
    summary_.warnings.push_back(fmt::format(
        "{} times shapes were so fast that they may have passed through each other between two "
        "looks: try a smaller --timestep, or dormand-prince, which divides such steps",
        summary_.fallbacks.unseen));
  }

  const SimulateOptions& options_;
  Model& model_;  ///< only its step changes, in parts of steps
  ContactSource& contacts_;
  State state_;
  Data data_;
  gdd::GoalDirectedController controller_;
  const OutsideInput outside_;
  Input input_;
  Kinematics kinematics_;  ///< at the step's start
  std::optional<IslandRun> islands_;
  std::optional<ErrorEstimate> errorEstimate_;
  State before_;  ///< the step, for that
  Input held_;    ///< over the step, for that
  std::optional<io::LogWriter> log_;
  std::optional<Replay> replay_;
  std::string outputError_;
  io::Summary summary_;
  long stepsWithCones_ = 0;
  io::StepRecord record_;
  VectorX scratch_;
};

}  // namespace

ExitCode run(const SimulateOptions& options, Scene& scene) { return Runner(options, scene).run(); }

}  // namespace softgauss::app
