// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Lists of names in sentences.

#include <string>
#include <vector>

namespace softgauss::app {

/// A name as it stands in a sentence: quoted where it reads as a number, as of a joint called 3.
std::string nameText(const std::string& name);

/// "a, b, c and 3 more": six at most.
std::string listed(const std::vector<std::string>& names);

/// "a; b": the parts that are not empty.
std::string joined(const std::vector<std::string>& parts);

}  // namespace softgauss::app
