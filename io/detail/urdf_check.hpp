// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A second opinion on a URDF: urdfdom's.
///
/// urdfdom leaves out numbers and shapes that it cannot read, with a message on the console at
/// most. So the file is read strictly from its XML, parsed by urdfdom as well, and the two must
/// agree in every link, joint, inertia and collision shape.

#include <string>
#include <vector>

#include "softgauss/io/detail/urdf_description.hpp"
#include "softgauss/io/detail/urdf_xml.hpp"

namespace softgauss::io::detail {

/// What urdfdom found wrong, if it refused the file; nothing printed. Otherwise compares its model
/// with `urdf` and throws ModelError where they differ. Of more than 20,000 links nothing is
/// compared.
///
/// urdfdom sees a copy in URDF 1.0 without the parts that softgauss does not read, and with the
/// attributes that urdfdom demands and softgauss does not (effort, velocity; a limit on every
/// revolute and prismatic joint), and single spaces between numbers, as urdfdom knows no other
/// blank.
std::string compareWithUrdfdom(const XmlFile& file, const UrdfDescription& urdf);

}  // namespace softgauss::io::detail
