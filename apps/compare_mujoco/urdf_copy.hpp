// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A copy of a URDF that MuJoCo reads as the file means it.
///
/// MuJoCo fixes the root link to its world and drops its mass; it knows neither package:// nor DAE,
/// and it makes up a mass for links that have none. The copy has links and joints as the file
/// writes them, and besides
///  - a link `world` above the old root, on a floating or fixed joint;
///  - collision meshes as binary STL files in one folder, scaled; no visuals;
///  - in MuJoCo's extension block: gravity, merging of fixed links, no mass from shapes, and the
///    least mass and inertia that it accepts where a moving link has none; a mean inertia where
///    it would refuse one.

#include <filesystem>
#include <string>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss::app {

/// Mass and inertia that massless moving links get in MuJoCo [kg], [kg m²].
inline constexpr double kLeastInertia = 1e-12;

struct UrdfCopy {
  std::string urdf;
  std::vector<std::pair<std::string, std::string>> meshes;  ///< file names and bytes
  /// What the file says and MuJoCo reads otherwise or not at all, for the report.
  std::vector<std::string> notRead;
};

/// `model` is that which was read from `file`: its meshes are written and its base is taken over.
/// Throws ModelError.
UrdfCopy copyUrdf(const std::filesystem::path& file, const Model& model);

/// Writes `robot.urdf` and the meshes into a folder, which is made if it is not there. Throws
/// ModelError.
void writeCopy(const UrdfCopy& copy, const std::filesystem::path& folder);

}  // namespace softgauss::app
