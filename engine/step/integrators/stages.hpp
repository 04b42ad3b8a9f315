// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Memory of an integrator that evaluates the dynamics more than once a step. The step's own Data
/// stay those of its start.

#include <algorithm>
#include <optional>
#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "softgauss/engine/step/integrators/tableau.hpp"

namespace softgauss {

struct IntegratorStages {
  explicit IntegratorStages(const Model& model)
      : data(model, Data::Evaluation{}), state(model), from(model), end(model) {
    if (model.options.stepDoubling && model.options.isSingleSolve()) part = model;
    phi = VectorX::Zero(model.nv);
    const Integrator integrator = model.options.integrator;
    const int stages = integrator == Integrator::rungeKutta4     ? kRungeKutta4.stages
                       : integrator == Integrator::dormandPrince ? kDormandPrince.stages
                                                                 : 1;
    rate.assign(static_cast<std::size_t>(stages), phi);
    acceleration = rate;
    if (integrator == Integrator::implicitMidpoint || part) kinematics = Kinematics(model);
  }

  Data data;    ///< of the stage
  State state;  ///< of the stage
  State from;   ///< where the part of the step begins
  State end;    ///< where it ends, of implicitMidpoint() and stepDoubling()
  Input input;
  VectorX phi;                              ///< displacement from there (nv)
  std::vector<VectorX> rate, acceleration;  ///< φ̇ and v̇ of the stages
  std::optional<Model>
      part;               ///< of stepDoubling(): the model with the length of a part as its step
  Kinematics kinematics;  ///< of implicitMidpoint(), at `end`; of stepDoubling(), at `from`

  void begin(const Input& held, const State& at) {
    input = held;
    from = at;
    state.time = at.time;
  }
};

/// Whether a part of a step may not be shortened. What is left of a step at its end is the shortest
/// part to rounding only.
inline bool isShortest(double length, double shortest) { return length <= shortest * (1.0 + 1e-9); }

/// Adds what the last solve of `data` has counted; false where its result is no acceleration.
inline bool countEvaluation(const Data& data, StepStats& stats) {
  ++stats.evaluations;
  stats.maxPenetration = std::max(stats.maxPenetration, data.stats.maxPenetration);
  return stats.count(data.forward.report);
}

}  // namespace softgauss
