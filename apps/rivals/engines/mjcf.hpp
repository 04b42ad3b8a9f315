// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/rivals/scene.hpp"

namespace rivals {

/// A scene in MuJoCo's own format. A body's frame is that of the scene; its joint starts at 0.
/// `options` and `sizes` are attributes of <option> and <size>; `h` is the step [s].
std::string mjcf(const Scene& scene, double h, const std::string& options,
                 const std::string& sizes);

}  // namespace rivals
