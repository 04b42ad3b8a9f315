// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How soft connections, welds and couplings are. In the leapfrog they hold at the step's end
/// (3.14).

#include "softgauss/engine/constraints/impedance.hpp"

namespace softgauss {

/// softnessAt(), in the leapfrog as a spring and a damper at the step's end. An equality constraint
/// that bounces has the spring of its reference on what it moves (3.11), else the one of its row.
Softness equalitySoftness(const Impedance& p, double distance, double inverseInertia,
                          const Options& options);

}  // namespace softgauss
