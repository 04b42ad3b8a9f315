// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which elements and attributes of a URDF are read, and a list of those that are not.

#include <string>
#include <string_view>
#include <vector>

#include "softgauss/io/detail/urdf_xml.hpp"

namespace softgauss::io::detail {

/// Is <child> below <parent> read?
bool isReadElement(std::string_view parent, std::string_view child);

/// Is that attribute of <tag> read?
bool isReadAttribute(std::string_view tag, std::string_view attribute);

/// What is in the file but not read, with counts, e.g. "3 <gazebo>", "1 attribute 'x' of <joint>".
/// Throws ModelError where that is a pose other than zero, but for those of visuals.
std::vector<std::string> ignoredParts(const XmlElement& robot);

}  // namespace softgauss::io::detail
