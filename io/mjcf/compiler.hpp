// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <compiler>: how the file is meant.

#include <array>
#include <filesystem>
#include <string>

#include "softgauss/io/mjcf/xml.hpp"

namespace softgauss::io::mjcf {

struct Compiler {
  bool degrees = true;
  std::string eulerseq = "xyz";
  std::filesystem::path meshdir, texturedir;
  bool strippath = false;  ///< names of files are taken without their folders
  bool autolimits = true;
  Choice inertiaFromGeom = Choice::automatic;
  std::array<double, 2> inertiaGroups{0, 5};
  double boundMass = 0.0, boundInertia = 0.0;
  bool balanceInertia = false;
  double totalMass = -1.0;  ///< > 0: all masses are scaled to it
  bool fitToBox = false;    ///< fitaabb

  double radians(double angle) const;
  void read(const Element& element);
  /// A file of an asset, as MuJoCo looks for it: beside the model, in meshdir.
  std::filesystem::path meshFile(const std::filesystem::path& model, const std::string& name) const;
};

}  // namespace softgauss::io::mjcf
