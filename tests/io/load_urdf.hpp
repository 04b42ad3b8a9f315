// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Models of URDF texts for tests.

#include "softgauss/io/urdf.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {

inline Model load(const std::string& text, const UrdfOptions& options = {}) {
  const TempFolder folder;
  return loadUrdf(folder.write("robot.urdf", text), options);
}

inline bool hasWarning(const Model& model, const std::string& part) {
  for (const std::string& warning : model.warnings)
    if (warning.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace softgauss::io
