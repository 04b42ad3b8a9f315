// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How low a robot reaches, for standing a floating base on the ground.

#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss::collision {

/// World z [m] of the lowest point of a shape at pose X_WG; −∞ for a plane. A mesh counts with its
/// vertices.
double lowestPoint(const Shape& shape, const Transform& X_WG);

/// World z [m] of the lowest collision point of a kinematic tree; +∞ when it has no geometry.
double lowestPoint(const Model& model, const Kinematics& kinematics, int tree);

}  // namespace softgauss::collision
