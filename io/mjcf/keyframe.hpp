// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <keyframe>: states by name.

#include <optional>

#include "softgauss/io/mjcf/xml.hpp"

namespace softgauss::io::mjcf {

struct Keyframe {
  std::string name;  ///< or its number, from 0, where it has none
  SourceLocation where;
  std::optional<std::vector<double>> qpos, qvel, ctrl;
};

/// <key>, the index-th of the file.
Keyframe readKeyframe(const Element& element, std::size_t index);

}  // namespace softgauss::io::mjcf
