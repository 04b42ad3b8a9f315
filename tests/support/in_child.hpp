// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Runs what may abort or never end in a process of its own, with a time limit.

#include <functional>
#include <string>

namespace softgauss::test {

/// Runs `body` in a child of this process. Returns what it returned; where the child ends otherwise
/// or is not done in `seconds`, a text that says so and begins with "child: ". An empty text means
/// all is well.
std::string inChild(const std::function<std::string()>& body, double seconds);

}  // namespace softgauss::test
