// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The list `actuators` of a scene.

#include <set>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/actuators.hpp"
#include "softgauss/io/detail/yaml.hpp"

namespace softgauss::io::detail {

/// One item of `actuators`. `joints` are those of one degree of freedom that may be named; those
/// that it drives lose the effort limit of their own, and are actuated even if that was 0. `names`
/// are taken, and gain this one.
SceneActuator readActuator(const YamlMap& map, const std::set<std::string>& joints,
                           ModelBuilder& builder, std::set<std::string>& names);

/// Throws ModelError, naming file, line and actuators, where they are not linearly independent.
void expectIndependent(const std::vector<SceneActuator>& actuators);

}  // namespace softgauss::io::detail
