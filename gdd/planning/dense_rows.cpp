// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/dense_rows.hpp"

#include <cmath>

#include "softgauss/engine/core/vector_clones.hpp"

namespace softgauss::planning {
namespace {

SOFTGAUSS_VECTOR_CLONES void multiply(double scale, bool upper, const double* A, int strideA,
                                      const double* B, int strideB, int sum, int rows, int columns,
                                      double* C, int strideC) {
  for (int i = 0; i < rows; ++i) {
    const int from = upper ? i & ~3 : 0;
    addCombination(scale, A + i, strideA, B + from, strideB, sum, columns - from,
                   C + i * strideC + from);
  }
}

SOFTGAUSS_VECTOR_CLONES bool factor(double* A, int n, int stride) {
  for (int j = 0; j < n; ++j) {
    const int from = j & ~3;
    double* row = A + j * stride;
    addCombination(-1.0, A + j, stride, A + from, stride, j, stride - from, row + from);
    if (!(row[j] > 0.0)) return false;
    const double inverse = 1.0 / std::sqrt(row[j]);
    for (int i = from; i < j; ++i) row[i] = 0.0;
    for (int i = from; i < stride; ++i) row[i] *= inverse;
  }
  return true;
}

SOFTGAUSS_VECTOR_CLONES void solve(const double* A, int n, int stride, int first, double* X) {
  for (int k = n - 1; k >= 0; --k) {
    const double* row = A + k * stride;
    double* x = X + k * stride;
    for (int i = first; i < stride; ++i) x[i] = row[i];
    addCombination(-1.0, row + k + 1, 1, x + stride + first, stride, n - 1 - k, stride - first,
                   x + first);
    const double inverse = 1.0 / row[k];
    for (int i = first; i < stride; ++i) x[i] *= inverse;
  }
}

}  // namespace

void addProduct(const Block& A, const Block& B, int sum, int rows, int columns, double* C,
                int strideC) {
  multiply(1.0, false, A.data, A.stride, B.data, B.stride, sum, rows, columns, C, strideC);
}

void addUpperProduct(double scale, const Block& A, const Block& B, int sum, int rows, int columns,
                     double* C, int strideC) {
  multiply(scale, true, A.data, A.stride, B.data, B.stride, sum, rows, columns, C, strideC);
}

bool factorRows(DenseRows& rows, int n) { return factor(rows[0], n, rows.stride()); }

void solveRows(const DenseRows& factored, int n, int first, DenseRows& X) {
  solve(factored[0], n, factored.stride(), first, X[0]);
}

}  // namespace softgauss::planning
