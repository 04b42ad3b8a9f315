// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Loading into MuJoCo. Only what calls MuJoCo itself includes this.

#include <mujoco/mujoco.h>

#include <string>
#include <utility>
#include <vector>

namespace softgauss::app {

/// Loads a description, MJCF or URDF, from memory; `files` are the meshes that it names, each with
/// its bytes. Throws ModelError with MuJoCo's own message when it refuses. To be freed by
/// mj_deleteModel().
mjModel* loadMujoco(const std::string& name, const std::string& text,
                    const std::vector<std::pair<std::string, std::string>>& files = {});

}  // namespace softgauss::app
