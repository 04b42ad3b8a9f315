// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Memory of an integrator that evaluates the dynamics more than once a step. The step's own Data
/// stay those of its start.

#include <vector>

#include "engine/step/data.hpp"
#include "engine/step/integrators/tableau.hpp"

namespace softgauss {

struct IntegratorStages {
  explicit IntegratorStages(const Model& model)
      : data(model, Data::Evaluation{}),
        state(model),
        from(model),
        phi(VectorX::Zero(model.nv)),
        rate(Tableau::kMostStages, VectorX::Zero(model.nv)),
        acceleration(Tableau::kMostStages, VectorX::Zero(model.nv)) {}

  Data data;    ///< of the stage
  State state;  ///< of the stage
  State from;   ///< where the part of the step begins
  Input input;
  VectorX phi;                              ///< displacement from there (nv)
  std::vector<VectorX> rate, acceleration;  ///< φ̇ and v̇ of the stages
};

}  // namespace softgauss
