// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/random_scenes/small_scene.hpp"

namespace softgauss::fuzz {

/// Steps the scene and holds it against laws: what Run looks at, the same bits when repeated, and
/// no energy from nowhere. Throws Finding.
void holdScene(const SmallScene& scene);

}  // namespace softgauss::fuzz
