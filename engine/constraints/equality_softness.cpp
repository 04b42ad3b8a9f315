// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/equality_softness.hpp"

#include <algorithm>

#include "softgauss/engine/constraints/contact_softness.hpp"

namespace softgauss {

Softness equalitySoftness(const Impedance& p, double distance, double inverseInertia,
                          const Options& options) {
  const Softness s = softnessAt(p, distance, inverseInertia, options.rowTimestep());
  if (options.integrator != Integrator::leapfrog ||
      options.constraintModel == ConstraintModel::mujoco)
    return s;
  if (const auto bounces = bouncingSoftness(p, inverseInertia, options)) return *bounces;
  return implicitSpringDamper(s, timeToStepEnd(options), options);
}

}  // namespace softgauss
