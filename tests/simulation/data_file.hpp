// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace softgauss::test {

inline std::string robot(const std::string& name) {
  return std::string(SOFTGAUSS_SOURCE_DIR) + "/data/robots/" + name + ".urdf";
}

inline std::string sceneFile(const std::string& name) {
  return std::string(SOFTGAUSS_SOURCE_DIR) + "/data/scenes/" + name + ".yaml";
}

}  // namespace softgauss::test
