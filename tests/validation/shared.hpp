// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Numbers that several validations share.

#include "softgauss/engine/model/model.hpp"

namespace softgauss::test {

inline constexpr double kGravity = 9.81;
inline constexpr double kRadius = 0.1;  ///< of spheres [m]
inline constexpr Cone kCones[] = {Cone::pyramidal, Cone::elliptic};

// Relative errors that recorded numbers allow: as many digits as were recorded.
inline constexpr double kDigits12 = 2e-11;
inline constexpr double kDigits15 = 1e-12;

}  // namespace softgauss::test
