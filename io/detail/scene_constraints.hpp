// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The parts of a scene that tie things together or change what a URDF says of its joints.

#include "engine/model/model_builder.hpp"
#include "io/detail/yaml.hpp"

namespace softgauss::io::detail {

/// One item of `constraints`: `connect`, `weld` or `couple` with its keys. Names are those of the
/// scene; the builder checks that they exist.
void readConstraint(const std::string& file, const YamlValue& item, std::size_t number,
                    ModelBuilder& builder);

/// `joint_parameters: {joint: {friction: …}}` of a robot: replaces what its URDF says.
void readJointParameters(const YamlMap& joints, ModelBuilder& robot);

}  // namespace softgauss::io::detail
