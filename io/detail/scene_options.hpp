// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What holds for the whole scene.

#include "engine/model/model.hpp"
#include "io/detail/yaml.hpp"

namespace softgauss::io::detail {

/// The map `options` of a scene: how it is solved, and which effects.
void readOptions(const YamlMap& map, Options& options);

}  // namespace softgauss::io::detail
