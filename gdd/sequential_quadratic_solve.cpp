// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/sequential_quadratic_solve.hpp"

#include <algorithm>

namespace softgauss::gdd {

VectorX SequentialQuadraticSolve::freeAcceleration(const Data& data) {
  VectorX a = -data.forces.c;
  TreeFactor factor;
  if (factor.compute(data.inertia.hat())) factor.solve(a);
  return a;
}

double SequentialQuadraticSolve::boundsPull(const ControlLimits& limits, const VectorX& g,
                                            const Data& data) const {
  const double close = 1e-8 * std::max(1.0, data.forces.c.cwiseAbs().maxCoeff());
  double sum = 0.0;
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const double lambda = next_.multipliers[i];
    const double past =
        limits.coordinate(i, g) - (lambda > 0.0 ? limits.upper[i] : limits.lower[i]);
    if (std::abs(past) * limits.forcePerUnit(i) <= close) sum += lambda * past;
  }
  return sum;
}

}  // namespace softgauss::gdd
