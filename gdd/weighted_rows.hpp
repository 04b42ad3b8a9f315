// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace softgauss::gdd {

/// y ← y + Xᵀc = y + Σ_k c_k x_k for `count` rows x_k of X, one behind the other, of length n, a
/// multiple of four.
void addWeightedRows(const double* c, const double* X, int count, int n, double* y);

}  // namespace softgauss::gdd
