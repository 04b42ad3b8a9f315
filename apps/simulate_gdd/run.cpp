// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "apps/shared/interrupt.hpp"
#include "apps/shared/run_origin.hpp"
#include "apps/shared/standard_streams.hpp"
#include "apps/shared/wall_clock.hpp"
#include "apps/simulate_gdd/checkpoint.hpp"
#include "apps/simulate_gdd/company.hpp"
#include "apps/simulate_gdd/error_estimate.hpp"
#include "apps/simulate_gdd/outside_input.hpp"
#include "apps/simulate_gdd/progress.hpp"
#include "apps/simulate_gdd/replay.hpp"
#include "apps/simulate_gdd/run_tables.hpp"
#include "apps/simulate_gdd/run_tally.hpp"
#include "apps/simulate_gdd/start_check.hpp"
#include "apps/simulate_gdd/verdict.hpp"
#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "softgauss/io/explain.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss::app {
namespace {

constexpr std::size_t kMostRefusals = 20;  // of steps of a live run that the summary tells

/// Largest |g(q, v, a) − (u, 0)| of who is awake: recomputed by inverse dynamics, not taken from
/// the solver.
double physicsViolation(const Model& model, Data& data, VectorX& scratch) {
  inverseDynamics(model, data.forward.a, data, scratch);
  scratch -= data.forces.tau;
  return largest(data.active.dofs(), scratch);
}

/// The loop and all that it writes.
class Runner {
 public:
  Runner(const SimulateOptions& options, Scene& scene)
      : options_(options),
        model_(scene.model),
        contacts_(scene.source()),
        state_(scene.initial),
        stages_(std::in_place, model_),
        data_(*stages_),
        controller_(model_),
        outside_(options, scene),
        kinematics_(model_),
        tables_(options, outputErrors_),
        contactLinks_(model_),
        summary_(model_) {
    setUp(options, scene, controller_);
    const bool passive = controller_.goals.empty() && options.torques.empty() &&
                         scene.wrenches.empty() &&
                         std::none_of(scene.model.dofs.begin(), scene.model.dofs.end(),
                                      [](const Dof& dof) { return dof.servo.exists(); });
    data_.timed = true;
    company_.emplace(options, scene, state_, stages_, controller_);
    tellOrigin(scene);
    const std::vector<io::EffectNote> notes = io::effectNotes(model_, scene.wrenches);
    summary_.effects = io::effectsOn(notes);
    for (const io::EffectNote& note : notes)
      if (note.asked && !note.on)
        summary_.warnings.push_back(fmt::format("{} is not simulated: {}", note.name, note.reason));
    summary_.sleep.on = model_.options.sleep.enabled;
    summary_.sleep.trees = static_cast<int>(model_.trees.size());
    if (options.reportError)
      errorEstimate_.emplace(model_, state_, outside_, !controller_.goals.empty());
    computeStages(model_, input_, state_, data_, &contacts_);
    for (std::string& told : startWarnings(model_, state_, controller_, data_))
      summary_.warnings.push_back(std::move(told));
    computeStages(model_, input_, state_, data_, &contacts_);
    const gdd::GoalContext start{model_, state_, data_};
    verdict_.emplace(controller_, start, passive, scene.bases);
    replay_.emplace(options, scene, controller_.goals, start);
    summary_.warnings.insert(summary_.warnings.end(), replay_->warnings().begin(),
                             replay_->warnings().end());
    company_->join(scene, start);
    checkpoints_.emplace(options, model_, summary_.origin);
    if (checkpoints_->restore(*this)) computeStages(model_, input_, state_, data_, &contacts_);
    checkpoints_->beginAt(state_.time);
    // Last, for nothing else can be refused any more.
    tables_.open(model_, verdict_->goals().columns());
  }

  /// All that the run has come to, between two steps.
  template <class Archive>
  void archive(Archive& a) {
    a(state_);
    if constexpr (Archive::kReads) expectStateOf(model_, state_);
    if (data_.sleepers) a(*data_.sleepers, controller_);
    a(tables_, *company_, *verdict_, *replay_, summary_, stepsWithCones_);
    if (errorEstimate_) a(*errorEstimate_);
  }

  ExitCode run() {
    // Before anything is told, for who reads it may interrupt at once.
    catchInterrupts();
    RunProgress progress(options_.duration, options_.quiet || options_.acted());
    progress_ = &progress;
    const double wallBefore = summary_.wallSeconds;
    tellBases();
    print(told(), company_->announcement());
    std::fflush(told());
    ExitCode code = kDone;
    const Clock::time_point start = Clock::now();
    while (code == kDone) {
      const Company::Next next = company_->next([&](double time) { replay_->rewind(time); });
      if (next == Company::Next::interrupted) code = kInterrupted;
      if (next != Company::Next::step) break;
      bool refused = false;
      const auto takeStep = [&] {
        if (interrupted()) {
          code = kInterrupted;
        } else if (!step()) {
          refused = true;
        } else {
          record();
          progress.show(state_.time, secondsSince(start));
          if (!outputErrors_.none()) code = kBadInput;
        }
        return code == kDone && !refused;
      };
      if (options_.live) whole_ = state_;
      // An accuracy was found with steps that end where outside input changes.
      if (options_.accuracy)
        outside_.inParts(model_, state_, takeStep);
      else
        takeStep();
      if (refused && options_.live) {
        state_ = whole_;
        tellRefused();
        continue;
      }
      if (refused) code = kCannotContinue;
      if (code != kDone) break;
      company_->countStep();
      isWhole_ = true;
      summary_.wallSeconds = wallBefore + secondsSince(start);
      if (checkpoints_->isDue(state_.time)) writeCheckpoint();
      if (!outputErrors_.none()) code = kBadInput;
    }
    progress.clear();
    summary_.wallSeconds = wallBefore + secondsSince(start);
    if (isWhole_ && checkpoints_->asked() && outputErrors_.none()) writeCheckpoint();
    std::string reason;
    if (code == kCannotContinue) {
      reason = failureText(model_, state_, data_);
      if (data_.stats.status != SolveStatus::badInput)
        reason += ". Try a smaller --timestep, more joint damping, or goals that ask for less";
      tell("simulate_gdd: " + reason);
      summary_.outcome = "non-finite";
    } else if (code == kInterrupted) {
      reason = fmt::format("interrupted at t = {:.6g} s", state_.time);
      summary_.outcome = "interrupted";
    } else if (!outputErrors_.none()) {
      reason =
          fmt::format("stopped at t = {:.6g} s, as an output could not be written", state_.time);
      summary_.outcome = "stopped";
    }
    finish(reason);
    if (outputErrors_.none()) return code;
    throw OutputError(outputErrors_.text(code == kBadInput ? reason : ""));
  }

 private:
  /// One step; false when it could not be taken, the state then being the last good one.
  bool step() {
    isWhole_ = false;
    record_.time = state_.time;
    record_.q = state_.q, record_.v = state_.v;
    computeKinematics(model_, state_, kinematics_);
    company_->beginWrenches(input_);
    outside_.at(model_, state_, kinematics_, input_);
    company_->addWrenches(kinematics_, input_);
    if (errorEstimate_) before_ = state_;
    const Clock::time_point start = Clock::now();
    const SolveStatus status = controller_.goals.empty()
                                   ? softgauss::step(model_, input_, state_, data_, &contacts_)
                                   : controller_.step(model_, input_, state_, data_, &contacts_);
    record_.stepUs = 1e6 * secondsSince(start);
    if (errorEstimate_ && !isRefused(status)) estimateError();
    if (!data_.constraints.piecewiseQuadratic()) ++stepsWithCones_;
    return !isRefused(status);
  }

  /// A control that goals have found is held over the step.
  void estimateError() {
    held_.wrenches = input_.wrenches;
    held_.setPoint = input_.setPoint;
    held_.setPointRate = input_.setPointRate;
    held_.tau = controller_.goals.empty() ? input_.tau : controller_.control;
    held_.controlled.clear();
    if (!controller_.goals.empty()) controller_.markControlled(model_, held_.controlled);
    errorEstimate_->observe(before_, held_, state_, model_.options.timestep);
  }

  void record() {
    const bool gdd = !controller_.goals.empty();
    const StepStats& stats = data_.stats;
    recordSolve(data_, controller_, record_.stepUs, record_);
    record_.physicsViolation = physicsViolation(model_, data_, scratch_);
    measure(record_, kinematics_);
    contactForces(data_, touching_);
    if (tables_.hasLog()) {
      record_.centerOfPressure = centerOfPressure(model_, touching_);
      contactLinks_.forces(touching_, record_.linkForces);
    }
    summary_.addStep(record_);
    if (gdd) tally(controller_.report, summary_.gdd);
    tally(stats, data_.plan.drifts, summary_);
    tallyCommands(controller_, summary_);
    // What is seen is the step's start, where the record is of.
    std::swap(data_.kinematics, kinematics_);
    const SeenStep seen{record_, data_,    touching_, state_, model_.options.timestep,
                        input_,  contacts_};
    for (const std::string& message : verdict_->observe(seen)) tellNow(message);
    record_.goalErrors = verdict_->goals().errors();
    replay_->addStep(record_, data_, touching_);
    company_->after(seen, *verdict_);
    std::swap(data_.kinematics, kinematics_);
    tables_.write(record_, touching_);
  }

  void writeCheckpoint() {
    outputErrors_.attempt([&] { checkpoints_->write(*this, state_.time); });
  }

  void measure(io::StepRecord& record, const Kinematics& kinematics) const {
    const Energy energy = computeEnergy(model_, kinematics, record.q, record.v);
    record.energy = energy.total();
    record.kineticEnergy = energy.kinetic;
    if (tables_.hasLog()) io::measureWhole(model_, kinematics, record);
  }

  /// A live run goes no further by itself: who looks on finds it paused before the step.
  void tellRefused() {
    isWhole_ = true;
    const std::string message = failureText(model_, state_, data_) +
                                "; the run is paused: go back, or let go what asks for it";
    tellNow(message);
    if (summary_.warnings.size() < kMostRefusals) summary_.warnings.push_back(message);
  }

  /// A line on stderr while the run goes on, not below a progress bar.
  void tellNow(const std::string& message) {
    company_->tell(message);
    if (options_.quiet) return;
    progress_->clear();
    fmt::print(stderr, "simulate_gdd: t = {:.4g} s: {}\n", record_.time, message);
  }

  /// Where what the run tells goes.
  std::FILE* told() const { return options_.writesToStandardOutput() ? stderr : stdout; }

  /// How the robots meet the world, before the first step.
  void tellBases() {
    if (options_.quiet) return;
    for (const std::string& line : summary_.bases) print(told(), line + "\n");
    for (const std::string& warning : baseWarnings_)
      fmt::print(stderr, "simulate_gdd: warning: {}\n", warning);
    if (!checkpoints_->warning().empty())
      fmt::print(stderr, "simulate_gdd: warning: {}\n", checkpoints_->warning());
    std::fflush(told());
  }

  /// What the run is made from.
  void tellOrigin(const Scene& scene) {
    summary_.version = SOFTGAUSS_VERSION;
    summary_.massKg = scene.contents.mass;
    std::vector<std::filesystem::path> files = {options_.model, options_.goals, options_.torques};
    files.insert(files.end(), scene.contents.files.begin(), scene.contents.files.end());
    summary_.origin = runOrigin(options_.commandLine, std::move(files));
    summary_.bases = scene.bases.lines;
    baseWarnings_ = scene.bases.warnings;
  }

  /// The final state, in the log's last row and the summary.
  void finish(const std::string& reason) {
    summary_.stateHash = fmt::format("{:016x}", hash(state_));
    outputErrors_.attempt([&] { company_->finish(); });
    const VectorX acceleration = data_.forward.a;
    computeStages(model_, input_, state_, data_, &contacts_);
    data_.forward.a = acceleration;
    io::StepRecord last;
    last.isEnd = true;
    last.time = state_.time;
    last.q = state_.q;
    last.v = state_.v;
    last.a = last.u = VectorX::Zero(model_.nv);
    last.contacts = data_.stats.contacts;
    last.constraints = data_.stats.rows;
    last.maxPenetration = data_.stats.maxPenetration;
    measure(last, data_.kinematics);
    verdict_->finish({last, data_, touching_, state_, model_.options.timestep, input_, contacts_});
    last.goalErrors = verdict_->goals().errors();
    tables_.write(last, touching_);
    tables_.close();
    summary_.finish(last);
    tellSolver();
    tellUnseen();
    if (errorEstimate_) summary_.error = errorEstimate_->outcome();
    verdict_->tell(reason, baseWarnings_, summary_);
    company_->conclude(summary_);
    if (!options_.summary.empty()) outputErrors_.attempt([&] { summary_.write(options_.summary); });
    for (std::string& error : replay_->finish(last, data_, summary_, reason))
      outputErrors_.add(std::move(error));
    if (!options_.quiet) print(told(), replay_->written() + summary_.table(options_.details));
    if (!options_.quiet && company_->acts())
      print(told(), fmt::format("state hash: {}\n", summary_.stateHash));
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

  /// A step that is not divided sees nothing of what begins and ends within it.
  void tellUnseen() {
    if (summary_.fallbacks.possibleTunnelling == 0) return;
    summary_.warnings.push_back(
        fmt::format("{} times shapes may have tunnelled through each other between two collision "
                    "checks: try a smaller --timestep, or dormand-prince, which divides such steps",
                    summary_.fallbacks.possibleTunnelling));
  }

  const SimulateOptions& options_;
  Model& model_;  ///< only its step changes, in parts of steps
  ContactSource& contacts_;
  State state_;
  std::optional<Data> stages_;  ///< made anew by who changes the model's options
  Data& data_;                  ///< those
  gdd::GoalDirectedController controller_;
  const OutsideInput outside_;
  Input input_;
  Kinematics kinematics_;  ///< at the step's start
  std::optional<ErrorEstimate> errorEstimate_;
  State before_;  ///< the step, for that
  Input held_;    ///< over the step, for that
  OutputErrors outputErrors_;
  RunTables tables_;
  std::optional<Checkpoints> checkpoints_;
  State whole_;          ///< before the step, of a live run
  bool isWhole_ = true;  ///< the state is one between whole steps, as a checkpoint has it
  io::ContactLinks contactLinks_;
  std::vector<Snapshot::ContactForce> touching_;  ///< contacts of the last step
  std::vector<std::string> baseWarnings_;
  std::optional<Verdict> verdict_;
  RunProgress* progress_ = nullptr;
  std::optional<Replay> replay_;
  io::Summary summary_;
  long stepsWithCones_ = 0;
  io::StepRecord record_;
  VectorX scratch_;
  std::optional<Company> company_;
};

}  // namespace

ExitCode run(const SimulateOptions& options, Scene& scene) { return Runner(options, scene).run(); }

}  // namespace softgauss::app
