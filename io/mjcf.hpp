// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Reads MJCF files, the format of MuJoCo 3.12, as far as the engine can express them exactly.
///
/// What it cannot express, and would change the motion, ends in a ModelError `file:line: element:
/// what was found, what was expected`: ball joints, tendons with forces, flex, plugins, muscles,
/// attach and more (docs/limits.md). What changes no motion (sensors, cameras,
/// lights, textures, statistics) is read past, and told in one line of SceneFile::notes.
///
/// A body is a link of its name, a site with a name a link without mass fixed to it. Several joints
/// of a body are a chain of links without mass. Generalised coordinates are MuJoCo's, in its order.

#include "softgauss/io/mjcf/keyframe.hpp"
#include "softgauss/io/mjcf/servo.hpp"
#include "softgauss/io/scene.hpp"

namespace softgauss::io {

struct MjcfFile {
  SceneFile scene;
  std::vector<mjcf::Keyframe> keyframes;
  std::vector<std::optional<mjcf::JointServo>> servos;  ///< (actuators)
  /// In MuJoCo's word: of the file, where `namesIntegrator`, or its default.
  std::string integrator = "Euler";
  bool namesIntegrator = false;
  bool givesSoftness = false;  ///< a solref or a solimp is in the file

  /// At the start, or in a keyframe by name. Throws ModelError where there is none.
  State initialState(const Model& model, const std::string& keyframe = {}) const;
  /// Gives the model its servos, with the set points of a ctrl of zeros or of that keyframe's.
  /// Throws ModelError.
  void setServos(Model& model, const std::string& keyframe = {}) const;

 private:
  const mjcf::Keyframe* find(const std::string& keyframe) const;
};

/// Of the options, the meshes' are read. Throws ModelError.
MjcfFile readMjcf(const std::filesystem::path& file, const UrdfOptions& options = {});

/// Whether a file that is no scene is an MJCF, by its outermost element. Throws ModelError where it
/// cannot be read.
bool isMjcf(const std::filesystem::path& file);

}  // namespace softgauss::io
