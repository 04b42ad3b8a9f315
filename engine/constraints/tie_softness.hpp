// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How soft connections, welds and couplings are. In the leapfrog they hold at the step's end
/// (T.137).

#include "engine/constraints/assembly.hpp"
#include "engine/constraints/impedance.hpp"

namespace softgauss {

/// softnessAt(), in the leapfrog as a spring and a damper at the step's end. A tie that bounces has
/// the spring of its reference on what it moves (T.117), else the one of its row.
Softness tieSoftness(const Impedance& p, double distance, double inverseInertia,
                     const Options& options);
/// The same of the options of `in`, which counts it.
Softness tieSoftness(const Assembly& in, const Impedance& p, double distance,
                     double inverseInertia);

}  // namespace softgauss
