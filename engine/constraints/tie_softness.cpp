// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/tie_softness.hpp"

#include <algorithm>

#include "engine/constraints/contact_softness.hpp"

namespace softgauss {
namespace {

bool holdsAtStepsEnd(const Options& options) {
  return options.integrator == Integrator::leapfrog && options.uses(Mechanism::endOfStepTies);
}

}  // namespace

Softness tieSoftness(const Impedance& p, double distance, double inverseInertia,
                     const Options& options) {
  const Softness s = softnessAt(p, distance, inverseInertia, options);
  if (!holdsAtStepsEnd(options)) return s;
  const std::optional<ReferenceSpring> reference = bouncing(p, options);
  const double rest = restOfStep(options);
  if (!reference) return atStepsEnd(s, rest, options);
  const double K = reference->stiffness, B = std::max(0.0, reference->damping - rest * K);
  return atStepsEnd(K / inverseInertia, B / inverseInertia, rest, options);
}

Softness tieSoftness(const Assembly& in, const Impedance& p, double distance,
                     double inverseInertia) {
  const Softness s = tieSoftness(p, distance, inverseInertia, in.model.options);
  in.count(Mechanism::endOfStepTies, holdsAtStepsEnd(in.model.options));
  in.count(Mechanism::stepBounds, s.bounded);
  return s;
}

}  // namespace softgauss
