// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The parts of a scene that tie things together, act on them, or change what a URDF says of them.

#include <set>
#include <string>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/detail/scene_parts.hpp"
#include "softgauss/io/detail/yaml.hpp"
#include "softgauss/io/wrenches.hpp"

namespace softgauss::io::detail {

/// What items may name.
struct SceneNames {
  std::set<std::string> links;
  std::set<std::string> joints;  ///< of one degree of freedom
};

/// One item of `constraints`: `connect`, `weld` or `couple` with its keys.
void readConstraint(const std::string& file, const YamlValue& item, std::size_t number,
                    const SceneNames& names, ModelBuilder& builder);

/// One item of `pairs`. `surfaces` are those of the links that may be named, `links`; a key that
/// the pair does not have is as they mix.
void readPair(const YamlMap& map, const Materials& materials,
              const std::map<std::string, Material>& surfaces, const std::set<std::string>& links,
              ModelBuilder& builder);

/// One item of `wrenches`. `links` are those that may be named.
TimedWrench readWrench(const YamlMap& map, const std::set<std::string>& links);

/// `joint_parameters: {joint: {friction: …}}` of a robot: replaces what its URDF says.
void readJointParameters(const YamlMap& joints, ModelBuilder& robot);

}  // namespace softgauss::io::detail
