// SPDX-License-Identifier: Apache-2.0
#include "gdd/expanded_solve.hpp"

namespace softgauss::gdd {

VectorX ExpandedSolve::freeAcceleration(const Data& data) {
  VectorX a = -data.forces.c;
  TreeFactor factor;
  if (factor.compute(data.inertia.M)) factor.solve(a);
  return a;
}

}  // namespace softgauss::gdd
