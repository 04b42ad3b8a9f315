// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How near two shapes can ever come, whatever the joints do: pairs that stay apart are not tested.
///
/// A sphere that a hinge carries stays in the sphere about its orbit: the centre's foot on the axis
/// and, added to the radius, its distance from the axis. Going up from both bodies to what carries
/// both gives two spheres that never move against each other, so
///   distance ≥ |c_A − c_B| − r_A − r_B                                                    (7.8)
/// Sliders and free bodies have no bound. Ranges are soft and do not count.

#include "softgauss/engine/model/model.hpp"

namespace softgauss::collision {

/// A sphere in the axes of a body [m].
struct Ball {
  Vector3 centre = Vector3::Zero();
  double radius = 0.0;
};

/// A bound on the distance [m] of two geometries from below, over all configurations; −∞ if there
/// is none. `ballA`, `ballB` hold them, in their bodies' axes; that of a plane is not read.
double leastDistance(const Model& model, const Geometry& a, const Ball& ballA, const Geometry& b,
                     const Ball& ballB);

}  // namespace softgauss::collision
