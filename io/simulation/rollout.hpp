// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Many runs of one scene on all cores: other starts, controls, goals, parameters and seeds.
///
///   Rollout rollout(sim.scene(), options, threads);
///   RolloutInputs in{.runs = 1000, .steps = 500, .q0 = starts};      // (1000 × nq)
///   RolloutOutputs out{.q = ends};                                   // (1000 × 500 × nq)
///   std::vector<RunOutcome> outcomes = rollout.run(in, out);
///
/// Threads take the next run when they are done with one. The results are the same bits for any
/// number of threads, whoever takes which run: a run depends on its own inputs alone. Each thread
/// has a Simulation of its own, kept from call to call; a run adds nothing to that but its arrays.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "softgauss/io/simulation/parameter.hpp"
#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss {

/// Arrays are the caller's, one run after the other (row-major), and may be left empty.
struct RolloutInputs {
  long runs = 0;
  long steps = 0;
  std::span<const double> q0 = {};   ///< (runs × nq) where they start; else as the scene does
  std::span<const double> v0 = {};   ///< (runs × nv)
  std::span<const double> tau = {};  ///< (runs × steps × nv) forces besides the goals [N m or N]
  std::vector<std::string> parameters = {};  ///< names, as of Parameter
  std::span<const double> values = {};       ///< (runs × parameters)
  std::span<const std::uint64_t> seeds =
      {};  ///< (runs) for the caller's hooks; else the run's number
};

/// Arrays of the caller's that are filled; rows = steps / every, one after each `every` steps. What
/// comes after the step that failed is NaN.
struct RolloutOutputs {
  long every = 1;
  std::span<double> q = {};              ///< (runs × rows × nq) after the step
  std::span<double> v = {};              ///< (runs × rows × nv) after the step
  std::span<double> a = {};              ///< (runs × rows × nv) of the step
  std::span<double> tau = {};            ///< (runs × rows × nv) applied in the step [N m or N]
  std::span<double> contactForces = {};  ///< (runs × rows × links × 3), links as contactLinks() [N]
};

/// A run as hooks see it.
struct RolloutRun {
  long index = 0;
  long step = 0;  ///< that is next, or has been taken
  std::uint64_t seed = 0;
  std::span<const double> values = {};  ///< of the parameters
  Simulation& sim;
};

struct RunOutcome {
  enum class Status { completed, ended, failed, interrupted };
  Status status = Status::interrupted;
  long steps = 0;       ///< that were taken
  std::string failure;  ///< why it failed
};

/// Called in the thread of the run. What one throws fails that run alone.
struct RolloutHooks {
  std::function<void(RolloutRun&)> begin;   ///< before the first step: gives goals, say
  std::function<void(RolloutRun&)> before;  ///< before each step: a policy, say
  std::function<bool(RolloutRun&)> after;   ///< after each step: costs, sensors; false ends the run
  std::function<void(RolloutRun&)> end;     ///< after the last step, also of a run that failed
  /// A run that is over and how it ended, and how many are; in any thread, one call at a time.
  std::function<void(long run, const RunOutcome&)> finished;
  std::function<void(long done, long all)> progress;
  const std::atomic<bool>* stop = nullptr;  ///< set: no further step is taken
};

/// "completed", "ended", "failed", "interrupted".
const char* statusName(RunOutcome::Status status);

class Rollout {
 public:
  /// `threads` 0: as many as the machine has. Throws ModelError.
  explicit Rollout(const Scene& scene, const SimulationOptions& options = {}, int threads = 0);
  ~Rollout();
  Rollout(const Rollout&) = delete;
  Rollout& operator=(const Rollout&) = delete;

  /// Throws std::invalid_argument where an array has another size than the inputs say, NameError
  /// where a parameter does not exist.
  std::vector<RunOutcome> run(const RolloutInputs& inputs, const RolloutOutputs& outputs,
                              const RolloutHooks& hooks = {});

  int threads() const;
  const Model& model() const;
  const std::vector<std::string>& contactLinks() const;  ///< that move and can touch
  /// What a run holds while it runs, its State [bytes]. What it needs besides is the caller's
  /// arrays.
  std::size_t bytesPerRun() const;
  /// What a thread holds: model, contacts, Data and controller [bytes], as measured when the first
  /// was made; 0 where the C library does not count.
  std::size_t bytesPerThread() const;

 private:
  struct Worker;
  struct Task;
  Worker& worker(int thread);
  void work(Task& task, int thread);

  const Scene& scene_;
  SimulationOptions options_;
  int threads_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::size_t bytesPerThread_ = 0;
};

/// One call with threads of its own.
std::vector<RunOutcome> rollout(const Scene& scene, const RolloutInputs& inputs,
                                const RolloutOutputs& outputs, const RolloutHooks& hooks = {},
                                int threads = 0);

}  // namespace softgauss
