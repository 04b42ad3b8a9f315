// SPDX-License-Identifier: Apache-2.0
#pragma once

/// shellinertia: mass on the surface of a primitive alone.

#include "softgauss/engine/model/mass_properties.hpp"

namespace softgauss::io::mjcf {

/// Of a shell of 1 kg/m². A plane has no mass.
MassProperties shellOf(const Shape& shape);

}  // namespace softgauss::io::mjcf
