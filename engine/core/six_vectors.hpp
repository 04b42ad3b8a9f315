// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Six-vectors and 6 × 6 matrices as plain numbers, for inner loops. A Motion or a Force is its six
/// numbers, the angular part first; a row of a matrix is six numbers and two zeros, so that it is
/// two whole vectors of four. For functions marked with SOFTGAUSS_VECTOR_CLONES, into which all but
/// the first four are inlined.

#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"

namespace softgauss {

static_assert(sizeof(Motion) == 6 * sizeof(double) && sizeof(Force) == sizeof(Motion));

inline const double* numbers(const Motion& V) { return reinterpret_cast<const double*>(&V); }
inline double* numbers(Motion& V) { return reinterpret_cast<double*>(&V); }
inline const double* numbers(const Force& F) { return reinterpret_cast<const double*>(&F); }
inline double* numbers(Force& F) { return reinterpret_cast<double*>(&F); }

inline constexpr int kSixRow = 8;               ///< numbers of a row
inline constexpr int kSixMatrix = 6 * kSixRow;  ///< numbers of a matrix

/// Two numbers that are treated apart.
using Two [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;

/// Six numbers in registers. What is stored as six is loaded as six: other loads would wait for the
/// memory.
struct Six {
  Four low;
  Two high;
};

[[gnu::always_inline]] inline Six loadSix(const double* x) {
  return {*reinterpret_cast<const Four*>(x), *reinterpret_cast<const Two*>(x + 4)};
}

[[gnu::always_inline]] inline void storeSix(const Six& x, double* y) {
  *reinterpret_cast<Four*>(y) = x.low;
  *reinterpret_cast<Two*>(y + 4) = x.high;
}

/// y ← y + c x.
[[gnu::always_inline]] inline void addSix(double c, const Six& x, Six& y) {
  y.low += c * x.low;
  y.high += c * x.high;
}

/// x·y of six.
[[gnu::always_inline]] inline double dotSix(const Six& x, const Six& y) {
  const Four low = x.low * y.low;
  const Two high = x.high * y.high;
  return ((low[0] + low[2]) + high[0]) + ((low[1] + low[3]) + high[1]);
}

/// x·y of six.
[[gnu::always_inline]] inline double dotSix(const double* x, const double* y) {
  return ((x[0] * y[0] + x[2] * y[2]) + x[4] * y[4]) + ((x[1] * y[1] + x[3] * y[3]) + x[5] * y[5]);
}

/// y ← y + c x of six.
[[gnu::always_inline]] inline void addSix(double c, const double* __restrict x,
                                          double* __restrict y) {
  for (int k = 0; k < 6; ++k) y[k] += c * x[k];
}

/// A row of eight.
struct Row {
  Four low, high;
};

[[gnu::always_inline]] inline Row loadRow(const double* x) {
  return {*reinterpret_cast<const Four*>(x), *reinterpret_cast<const Four*>(x + 4)};
}

[[gnu::always_inline]] inline void storeRow(const Row& x, double* y) {
  *reinterpret_cast<Four*>(y) = x.low;
  *reinterpret_cast<Four*>(y + 4) = x.high;
}

/// c x.
[[gnu::always_inline]] inline Row scaled(double c, const Row& x) { return {c * x.low, c * x.high}; }

/// y ← y + c x.
[[gnu::always_inline]] inline void addRow(double c, const Row& x, Row& y) {
  y.low += c * x.low;
  y.high += c * x.high;
}

/// y ← Aᵀ s, a row of eight.
[[gnu::always_inline]] inline void combineRows(const double* s, const double* A, double* y) {
  Row sum = scaled(s[0], loadRow(A));
  for (int r = 1; r < 6; ++r) addRow(s[r], loadRow(A + kSixRow * r), sum);
  storeRow(sum, y);
}

/// A ← A + c x yᵀ; y is a row of eight.
[[gnu::always_inline]] inline void addOuter(double c, const double* x, const double* y, double* A) {
  const Row row = loadRow(y);
  for (int r = 0; r < 6; ++r) {
    Row sum = loadRow(A + kSixRow * r);
    addRow(c * x[r], row, sum);
    storeRow(sum, A + kSixRow * r);
  }
}

/// A ← A + B + c x xᵀ; x is a row of eight.
[[gnu::always_inline]] inline void addUpdated(const double* B, double c, const double* x,
                                              double* A) {
  const Row row = loadRow(x);
  for (int r = 0; r < 6; ++r) {
    Row sum = loadRow(B + kSixRow * r);
    addRow(c * x[r], row, sum);
    addRow(1.0, loadRow(A + kSixRow * r), sum);
    storeRow(sum, A + kSixRow * r);
  }
}

/// A ← A + B.
[[gnu::always_inline]] inline void addMatrix(const double* __restrict B, double* __restrict A) {
  addScaled(1.0, B, kSixMatrix, A);
}

/// A ← A + Bᵀ.
[[gnu::always_inline]] inline void addTransposedMatrix(const double* __restrict B,
                                                       double* __restrict A) {
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) A[kSixRow * r + c] += B[kSixRow * c + r];
}

/// A ← the matrix of an inertia.
[[gnu::always_inline]] inline void setInertia(const Inertia& I, double* A) {
  const double x = I.h.x(), y = I.h.y(), z = I.h.z(), m = I.mass;
  for (int i = 0; i < kSixMatrix; ++i) A[i] = 0.0;
  const auto set = [A](int r, int c, double value) {
    A[kSixRow * r + c] = A[kSixRow * c + r] = value;
  };
  set(0, 0, I.I_O.xx), set(0, 1, I.I_O.xy), set(0, 2, I.I_O.xz);
  set(1, 1, I.I_O.yy), set(1, 2, I.I_O.yz), set(2, 2, I.I_O.zz);
  set(0, 4, -z), set(0, 5, y), set(1, 3, z), set(1, 5, -x), set(2, 3, -y), set(2, 4, x);
  set(3, 3, m), set(4, 4, m), set(5, 5, m);
}

/// y ← a × b of three.
[[gnu::always_inline]] inline void crossThree(const double* a, const double* b, double* y) {
  y[0] = a[1] * b[2] - a[2] * b[1];
  y[1] = a[2] * b[0] - a[0] * b[2];
  y[2] = a[0] * b[1] - a[1] * b[0];
}

}  // namespace softgauss
