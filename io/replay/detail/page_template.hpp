// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace softgauss::io::detail {

/// The replay page with places for a title and a run (docs/reference/replay.md).
std::string_view pageTemplate();

}  // namespace softgauss::io::detail
