// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Robot descriptions of other kinds, which are told by name and with what to do.

#include <string>

namespace softgauss::io::detail {

/// Throws ModelError where the text that is to be a URDF is xacro that has not been expanded, MJCF,
/// SDF or COLLADA.
void refuseOtherFormats(const std::string& file, const std::string& text);

}  // namespace softgauss::io::detail
