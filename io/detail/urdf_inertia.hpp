// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mass and inertia of links that a URDF gives none, from their shapes (--infer-inertia).
///
/// Links that fixed joints join are one body. Where all of a body's links together have no mass,
/// each that has collision shapes, or else visuals, has that of solids of 1000 kg/m³ of these
/// shapes. Where the only link of it that has mass has no inertia about some axis, it has that of
/// its shapes, scaled to its mass. Overlaps count twice. A mesh
/// that encloses no volume counts as the box around it. Bodies that are fixed to the world need
/// neither.

#include <functional>
#include <string>
#include <vector>

#include "softgauss/io/detail/urdf_description.hpp"

namespace softgauss::io::detail {

/// Completes the links of `urdf`. `baseIsFixed`: its root does not move. `solid`: a shape with its
/// mesh read; may throw. Returns what is to be told.
std::vector<std::string> inferInertia(UrdfDescription& urdf, bool baseIsFixed,
                                      const std::function<Shape(const UrdfShape&)>& solid);

}  // namespace softgauss::io::detail
