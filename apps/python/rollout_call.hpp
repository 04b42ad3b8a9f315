// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One call of Rollout.run(): what Python gave, as inputs, outputs and hooks.

#include <atomic>
#include <map>
#include <memory>

#include "apps/python/states.hpp"
#include "softgauss/io/simulation/rollout.hpp"

namespace softgauss::python {

/// Arguments of Rollout.run() but for the number of steps; None where they were not given.
struct RolloutArguments {
  py::object runs, q0, v0, tau, parameters, goals, targets, pushes;
  States* states = nullptr;
  std::vector<std::string> outputs;
  long every = 1;
  py::object progress;
};

/// What a rollout gave.
struct Runs {
  std::map<std::string, py::array> arrays;  ///< by name of the output
  std::vector<std::string> status, failure;
  py::array_t<long> steps;
};

class RolloutCall {
 public:
  /// Throws ValueError where arrays do not fit each other or the model, ModelError where goals are
  /// at fault.
  RolloutCall(const Simulation& sim, const Rollout& rollout, long steps,
              const RolloutArguments& arguments);

  /// Without the interpreter's lock. Raises KeyboardInterrupt, and what `progress` raises.
  Runs run(Rollout& rollout);

 private:
  struct Push {
    std::string link;
    Numbers force;  ///< (runs, 3)
  };

  void readInputs(const RolloutArguments& arguments);
  void readParameters(const py::object& parameters);
  void readGoals(const py::object& goals, const py::object& targets);
  void readPushes(const Simulation& sim, const py::object& pushes);
  void makeOutputs(const Rollout& rollout, const RolloutArguments& arguments);
  void begin(RolloutRun& run);
  void end(RolloutRun& run);
  RolloutHooks hooks();

  const Scene& scene_;
  const Model& model_;
  long runs_, steps_;
  py::object progress_;
  States* states_;
  std::string goals_;  ///< text
  Numbers q0_, v0_, tau_, held_, values_, targets_;
  py::ssize_t targetCount_ = 0;
  std::vector<std::string> parameters_;
  std::vector<Push> pushes_;
  std::vector<Pushes> acting_;  ///< (runs), where something pushes
  RolloutOutputs out_;
  Runs result_;
};

}  // namespace softgauss::python

SOFTGAUSS_MADE_ONLY(softgauss::python::Runs)
