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
  const std::optional<ReferenceSpring> reference = underdampedReference(p, options);
  const double rest = timeToStepEnd(options);
  if (!reference) return implicitSpringDamper(s, rest, options);
  const double K = reference->stiffness, B = std::max(0.0, reference->damping - rest * K);
  return implicitSpringDamper(K / inverseInertia, B / inverseInertia, rest, options);
}

Softness equalitySoftness(const Assembly& in, const Impedance& p, double distance,
                          double inverseInertia) {
  const Softness s = equalitySoftness(p, distance, inverseInertia, in.model.options);
  in.count(Mechanism::implicitEqualities, holdsAtStepsEnd(in.model.options));
  in.count(Mechanism::referenceClamp, s.bounded);
  return s;
}

}  // namespace softgauss
