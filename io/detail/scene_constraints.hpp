// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The parts of a scene that tie things together, act on them, or change what a URDF says of them.

#include "engine/model/model_builder.hpp"
#include "io/detail/scene_parts.hpp"
#include "io/detail/yaml.hpp"
#include "io/wrenches.hpp"

namespace softgauss::io::detail {

/// One item of `constraints`: `connect`, `weld` or `couple` with its keys. Names are those of the
/// scene; the builder checks that they exist.
void readConstraint(const std::string& file, const YamlValue& item, std::size_t number,
                    ModelBuilder& builder);

/// One item of `pairs`. `surfaces` are those of the links and shapes that may be named; a key that
/// the pair does not have is as they mix.
void readPair(const YamlMap& map, const Materials& materials,
              const std::map<std::string, Material>& surfaces, ModelBuilder& builder);

/// One item of `wrenches`. `links` are those that may be named.
TimedWrench readWrench(const YamlMap& map, const std::vector<std::string>& links);

/// `joint_parameters: {joint: {friction: …}}` of a robot: replaces what its URDF says.
void readJointParameters(const YamlMap& joints, ModelBuilder& robot);

}  // namespace softgauss::io::detail
