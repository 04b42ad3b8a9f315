// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What holds for the whole scene.

#include <optional>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/io/detail/yaml.hpp"
#include "softgauss/io/scene.hpp"

namespace softgauss::io::detail {

/// The map `options` of a scene: how it is solved, and which effects. An `integration_tolerance`
/// where no integrator is named asks for dormand-prince; keys that change nothing are refused.
IntegrationKeys readOptions(const YamlMap& map, Options& options,
                            std::optional<gdd::GddSolver>& solver);

}  // namespace softgauss::io::detail
