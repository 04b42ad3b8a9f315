// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The joints of a URDF.
///
/// Where the URDF is silent or readers differ:
///  - <limit> without lower and upper, or no <limit> at all: no range, and a warning;
///    one of the two alone: the other is 0, as the URDF specification has it.
///  - no effort: no box on the control. Effort 0 is kept as 0; ModelBuilder decides what it means.
///  - a velocity limit that is negative or 0 is none, with a warning.
///  - fixed and floating joints have no axis: what is written there is not read.

#include <string>
#include <vector>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/detail/urdf_xml.hpp"

namespace softgauss::io::detail {

/// Throws ModelError on missing or unreadable parts, unknown types, links or mimicked joints.
std::vector<JointSpec> readJoints(const XmlElement& robot, const std::vector<std::string>& links,
                                  std::vector<std::string>& warnings);

}  // namespace softgauss::io::detail
