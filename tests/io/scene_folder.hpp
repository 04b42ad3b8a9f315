// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes for tests.

#include "sample_urdf.hpp"
#include "softgauss/io/scene.hpp"
#include "temp_folder.hpp"

namespace softgauss::test {

/// A folder with the sample robot and a scene.
class SceneFolder {
 public:
  explicit SceneFolder(const std::string& scene, const std::string& urdf = io::kSampleUrdf) {
    folder_.write("sample.urdf", urdf);
    file = folder_.write("scene.yaml", scene);
  }
  io::SceneFile read() const { return io::readScene(file); }
  std::filesystem::path file;

 private:
  io::TempFolder folder_;
};

/// The message that the scene is refused with.
inline std::string refusal(const std::string& scene) {
  const SceneFolder folder(scene);
  try {
    folder.read().builder.build();
  } catch (const ModelError& error) {
    return error.what();
  }
  ADD_FAILURE() << "read without complaint:\n" << scene;
  return {};
}

}  // namespace softgauss::test
