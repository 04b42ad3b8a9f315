// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Lists of names in sentences.

#include <string>
#include <vector>

#include "softgauss/io/names.hpp"

namespace softgauss::app {

using io::nameText;

/// "a, b, c and 3 more": six at most.
std::string listed(const std::vector<std::string>& names);

/// "a; b": the parts that are not empty.
std::string joined(const std::vector<std::string>& parts);

}  // namespace softgauss::app
