// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The keys `srdf` and `state` of a robot in a scene.

#include <filesystem>
#include <string>

#include "softgauss/io/detail/yaml.hpp"
#include "softgauss/io/scene.hpp"

namespace softgauss::io::detail {

/// Keeps links of the robot apart that never collide by its SRDF, and adds that to the scene's
/// SRDFs. Throws ModelError.
void readSrdfKeys(const YamlMap& map, const std::filesystem::path& urdf,
                  const UrdfContents& contents, const std::string& prefix, ModelBuilder& robot,
                  SceneFile& scene);

}  // namespace softgauss::io::detail
