// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/equality_softness.hpp"

#include <algorithm>

#include "softgauss/engine/constraints/contact_softness.hpp"

namespace softgauss {

Softness equalitySoftness(const Impedance& p, double distance, double inverseInertia,
                          const Options& options) {
  Softness s = softnessAt(p, distance, inverseInertia, options.rowTimestep());
  if (options.integrator != Integrator::leapfrog ||
      options.constraintModel == ConstraintModel::mujoco)
    return s;
  if (const auto bounces = bouncingSoftness(p, inverseInertia, options)) return *bounces;
  // A reference swings by at most a radian in a step, or it would ring for long, and stops once.
  const double h = options.rowTimestep();
  const ReferenceSpring asked = referenceOf(p, h);
  s.stiffness *= std::min(1.0, 1.0 / (h * h * asked.stiffness));
  s.damping *= std::min(1.0, 1.0 / (h * asked.damping));
  return implicitSpringDamper(s, timeToStepEnd(options), options);
}

}  // namespace softgauss
