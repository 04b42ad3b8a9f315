// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Numbers of a URDF that were probably written in other units than rad, m and kg m², each told
/// with the value that was probably meant. Nothing is changed.
///
///   rpy, range   more than a turn of a pose, tens of radians of a range: degrees
///   inertia      I > 20 m R², where all of the link's shapes are within R of its centre of mass,
///   or
///                R is the extent of the robot where it has none: no body of that mass and size has
///                more than m R², and shapes of collision may be somewhat smaller than the link;
///                one of kg cm², kg mm², g cm² or g mm²
///   mesh         tens of times larger than the robot: millimetres

#include <string>
#include <vector>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/io/detail/urdf_description.hpp"
#include "softgauss/io/detail/urdf_xml.hpp"

namespace softgauss::io::detail {

/// "0 0 1.5708 rad" for angles of a pose that are probably degrees, or nothing.
std::string radiansMeant(const std::vector<double>& angles);

/// " (0.5236 rad if it is in degrees)" for a position beyond the range of a hinge that degrees
/// would bring into it, or nothing.
std::string radiansMeant(const Model& model, const JointRange& range, double position);

/// One warning of each kind. Meshes of `urdf` count where they have been read.
std::vector<std::string> unitMistakes(const XmlElement& robot, const UrdfDescription& urdf);

}  // namespace softgauss::io::detail
