// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a URDF says, read strictly from its raw XML; meshes are named but not yet read.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/detail/urdf_xml.hpp"

namespace softgauss::io::detail {

/// A <collision> or <visual>.
struct UrdfShape {
  Transform X_LG;
  Shape shape;                          ///< kind mesh: without its Mesh
  std::string meshUri;                  ///< as the file writes it
  Vector3 scale = Vector3::Ones();      ///< of the mesh
  std::string material;                 ///< name, of a visual
  std::optional<Eigen::Vector4d> rgba;  ///< written in place, of a visual
  XmlElement element;
  bool isPoint = false;              ///< all its sizes are zero
  std::optional<ModelError> defect;  ///< why it is no solid: unknown geometry, a size of zero
};

struct UrdfLink {
  LinkSpec spec;
  bool hasInertial = false;
  std::optional<double> friction;  ///< of <gazebo>: mu1, mu2
  std::vector<UrdfShape> collisions;
  std::vector<UrdfShape> visuals;
};

struct UrdfDescription {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<JointSpec> joints;
  std::map<std::string, Eigen::Vector4d> colours;  ///< by material name
  std::vector<std::string> warnings;
};

/// Throws ModelError where a number, a name or an element is missing or cannot be read.
/// The result refers to the XmlFile of `robot`.
UrdfDescription describeUrdf(const XmlElement& robot);

}  // namespace softgauss::io::detail
