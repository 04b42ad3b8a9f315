// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/equality_softness.hpp"

#include <algorithm>

#include "softgauss/engine/constraints/contact_softness.hpp"

namespace softgauss {
namespace {

bool holdsAtStepsEnd(const Options& options) {
  return options.integrator == Integrator::leapfrog && options.uses(Mechanism::implicitEqualities);
}

}  // namespace

Softness equalitySoftness(const Impedance& p, double distance, double inverseInertia,
                          const Options& options) {
  const Softness s = softnessAt(p, distance, inverseInertia, options);
  if (!holdsAtStepsEnd(options)) return s;
  if (const auto bounces = bouncingSoftness(p, inverseInertia, options)) return *bounces;
  return implicitSpringDamper(s, timeToStepEnd(options), options);
}

Softness equalitySoftness(const Assembly& in, const Impedance& p, double distance,
                          double inverseInertia) {
  const Softness s = equalitySoftness(p, distance, inverseInertia, in.model.options);
  in.count(Mechanism::implicitEqualities, holdsAtStepsEnd(in.model.options));
  in.count(Mechanism::referenceClamp, s.bounded);
  return s;
}

}  // namespace softgauss
