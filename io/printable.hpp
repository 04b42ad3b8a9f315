// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Messages on their way to a terminal.

#include <string>

namespace softgauss::io {

/// The message with long words cut, bytes that are no UTF-8 replaced, and without characters that
/// move a terminal's cursor; lines stay lines. A path, which begins with '/', is not cut.
std::string printable(const std::string& text);

}  // namespace softgauss::io
