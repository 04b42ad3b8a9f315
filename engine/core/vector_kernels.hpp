// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Inner loops of dense algebra by blocks of four. Most are over rows whose length is a multiple of
/// four: they compile to whole vectors, without tails. Each element, or each fourth of a sum, is
/// treated apart, so that every instruction set gives the same bits. For functions marked with
/// SOFTGAUSS_VECTOR_CLONES, into which they are inlined.

#include <cstddef>

namespace softgauss {

/// The least multiple of four that holds n.
constexpr int paddedSize(int n) { return (n + 3) & ~3; }

/// Four numbers that are treated apart: the same bits on every processor.
using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;

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

/// `tiles` fours of y gain Σ_k c(k) x(k), of which x(k) points at as many. They stay in registers
/// while k runs over all `count`.
template <int tiles, class Coefficients, class Rows>
[[gnu::always_inline]] inline void addToTiles(int count, Coefficients&& c, Rows&& x, double* y) {
  Four sum[static_cast<std::size_t>(tiles)];
  for (int t = 0; t < tiles; ++t) sum[t] = *reinterpret_cast<const Four*>(y + 4 * t);
  for (int k = 0; k < count; ++k) {
    const double ck = c(k), *xk = x(k);
    for (int t = 0; t < tiles; ++t) sum[t] += ck * *reinterpret_cast<const Four*>(xk + 4 * t);
  }
  for (int t = 0; t < tiles; ++t) *reinterpret_cast<Four*>(y + 4 * t) = sum[t];
}

/// y ← y + Σ_k c(k) x(k), n numbers each, for functions c and x of k in [0, count).
template <class Coefficients, class Rows>
[[gnu::always_inline]] inline void addSum(int count, Coefficients&& c, Rows&& x, int n, double* y) {
  int i = 0;
  const auto from = [&](int k) { return x(k) + i; };
  for (; i + 16 <= n; i += 16) addToTiles<4>(count, c, from, y + i);
  if (i + 8 <= n) addToTiles<2>(count, c, from, y + i), i += 8;
  if (i + 4 <= n) addToTiles<1>(count, c, from, y + i);
}

/// y ← y + scale · Σ_k c_k x_k for `count` rows x_k that lie `stride` apart, coefficients `step`
/// apart.
[[gnu::always_inline]] inline void addCombination(double scale, const double* c, int step,
                                                  const double* x, int stride, int count, int n,
                                                  double* y) {
  addSum(
      count, [=](int k) { return scale * c[k * step]; }, [=](int k) { return x + k * stride; }, n,
      y);
}

}  // namespace softgauss
