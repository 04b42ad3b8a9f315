// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/padded_cholesky.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/vector_clones.hpp"

namespace softgauss::gdd {
namespace {

/// The lower triangle of A ← L, by columns; false where a pivot is not positive.
SOFTGAUSS_VECTOR_CLONES bool factor(double* A, int n, int stride, double* inverse) {
  for (int j = 0; j < n; ++j) {
    const int from = j & ~3;
    double* column = A + j * stride;
    addCombination(-1.0, A + j, stride, A + from, stride, j, stride - from, column + from);
    if (!(column[j] > 0.0)) return false;
    inverse[j] = 1.0 / std::sqrt(column[j]);
    for (int i = from; i < j; ++i) column[i] = 0.0;
    for (int i = from; i < stride; ++i) column[i] *= inverse[j];
  }
  return true;
}

SOFTGAUSS_VECTOR_CLONES void solveLower(const double* L, int first, int n, int stride,
                                        const double* inverse, double* x) {
  for (int j = first; j < n; ++j) {
    const int from = j & ~3;
    const double xj = x[j] * inverse[j];
    addScaled(-xj, L + j * stride + from, stride - from, x + from);
    x[j] = xj;
  }
}

SOFTGAUSS_VECTOR_CLONES void solveTransposed(const double* L, int n, int stride,
                                             const double* inverse, double* x) {
  for (int j = n - 1; j >= 0; --j) {
    const int from = j & ~3;
    const double xj = x[j];
    x[j] = 0.0;
    x[j] = inverse[j] * (xj - dot(L + j * stride + from, x + from, stride - from));
  }
}

}  // namespace

bool PaddedCholesky::compute(const Eigen::Ref<const MatrixX>& K) {
  n_ = static_cast<int>(K.cols());
  L_.resize(static_cast<std::size_t>(n_) * stride());
  inverse_.resize(static_cast<std::size_t>(n_));
  for (int j = 0; j < n_; ++j) {
    double* column = L_.data() + j * stride();
    std::copy_n(K.col(j).data() + j, n_ - j, column + j);
    std::fill(column, column + j, 0.0);
    std::fill(column + n_, column + stride(), 0.0);
  }
  return factor(L_.data(), n_, stride(), inverse_.data());
}

void PaddedCholesky::solveLower(double* x, int first) const {
  gdd::solveLower(L(), first, n_, stride(), inverse(), x);
}

void PaddedCholesky::solveTransposed(double* x) const {
  gdd::solveTransposed(L(), n_, stride(), inverse(), x);
}

}  // namespace softgauss::gdd
