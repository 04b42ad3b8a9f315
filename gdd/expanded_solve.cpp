// SPDX-License-Identifier: Apache-2.0
#include "gdd/expanded_solve.hpp"

#include <algorithm>

namespace softgauss::gdd {

VectorX ExpandedSolve::freeAcceleration(const Data& data) {
  VectorX a = -data.forces.c;
  TreeFactor factor;
  if (factor.compute(data.inertia.hat())) factor.solve(a);
  return a;
}

double ExpandedSolve::boundsPull(const ControlBox& box, const VectorX& g, const Data& data) const {
  const double close = 1e-8 * std::max(1.0, data.forces.c.cwiseAbs().maxCoeff());
  double sum = 0.0;
  for (Eigen::Index i = 0; i < g.size(); ++i) {
    const double lambda = next_.multipliers[i];
    const double past = box.coordinate(i, g) - (lambda > 0.0 ? box.upper[i] : box.lower[i]);
    if (std::abs(past) * box.size(i) <= close) sum += lambda * past;
  }
  return sum;
}

}  // namespace softgauss::gdd
