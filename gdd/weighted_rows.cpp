// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/weighted_rows.hpp"

#include "softgauss/engine/core/vector_clones.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"

namespace softgauss::gdd {
namespace {

SOFTGAUSS_VECTOR_CLONES void add(const double* c, const double* X, int count, int n, double* y) {
  addCombination(1.0, c, 1, X, n, count, n, y);
}

}  // namespace

void addWeightedRows(const double* c, const double* X, int count, int n, double* y) {
  add(c, X, count, n, y);
}

}  // namespace softgauss::gdd
