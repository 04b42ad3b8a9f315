// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Actuators that drive joints through gears and couplings, as scene files list them
/// (docs/reference/scenes.md): force on a joint = coefficient · u, summed over the actuators (8.2).

#include <string>
#include <utility>
#include <vector>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::io {

struct SceneActuator {
  std::string name;
  std::vector<std::pair<std::string, double>> joints;  ///< and coefficients [N/[u] or N m/[u]]
  double lower = -kInfinity;                           ///< bounds of u
  double upper = kInfinity;
  SourceLocation where;
};

/// What these can do, and every actuated joint that none of them drives by itself. Throws
/// ModelError where a joint does not exist or has not one degree of freedom, or as
/// gdd::Transmission does.
gdd::ControlLimits controlLimits(const Model& model, const std::vector<SceneActuator>& actuators);

}  // namespace softgauss::io
