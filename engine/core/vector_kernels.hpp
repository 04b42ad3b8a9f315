// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Inner loops of dense algebra by blocks of four. Most are over rows whose length is a multiple of
/// four: they compile to whole vectors, without tails. Each element, or each fourth of a sum, is
/// treated apart, so that every instruction set gives the same bits. For functions marked with
/// SOFTGAUSS_VECTOR_CLONES, into which they are inlined.

namespace softgauss {

/// The least multiple of four that holds n.
constexpr int paddedSize(int n) { return (n + 3) & ~3; }

/// y ← y + c x.
[[gnu::always_inline]] inline void addScaled(double c, const double* __restrict x, int n,
                                             double* __restrict y) {
  for (int i = 0; i < n; i += 4)
    for (int k = 0; k < 4; ++k) y[i + k] += c * x[i + k];
}

/// x·y.
[[gnu::always_inline]] inline double dot(const double* x, const double* y, int n) {
  double sum[4] = {0.0, 0.0, 0.0, 0.0};
  for (int i = 0; i < n; i += 4)
    for (int k = 0; k < 4; ++k) sum[k] += x[i + k] * y[i + k];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// y ← y + c₀ x₀ + c₁ x₁ + c₂ x₂ + c₃ x₃ for rows x that lie `stride` apart.
[[gnu::always_inline]] inline void addScaledFour(double c0, double c1, double c2, double c3,
                                                 const double* __restrict x, int stride, int n,
                                                 double* __restrict y) {
  const double *x1 = x + stride, *x2 = x1 + stride, *x3 = x2 + stride;
  for (int i = 0; i < n; i += 4)
    for (int k = 0; k < 4; ++k)
      y[i + k] += c0 * x[i + k] + c1 * x1[i + k] + c2 * x2[i + k] + c3 * x3[i + k];
}

/// y ← y + scale · Σ_k c_k x_k for `count` rows x_k that lie `stride` apart, coefficients `step`
/// apart.
[[gnu::always_inline]] inline void addCombination(double scale, const double* c, int step,
                                                  const double* x, int stride, int count, int n,
                                                  double* y) {
  int k = 0;
  for (; k + 4 <= count; k += 4)
    addScaledFour(scale * c[k * step], scale * c[(k + 1) * step], scale * c[(k + 2) * step],
                  scale * c[(k + 3) * step], x + k * stride, stride, n, y);
  for (; k < count; ++k) addScaled(scale * c[k * step], x + k * stride, n, y);
}

}  // namespace softgauss
