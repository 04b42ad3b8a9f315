// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Sums over parts of vectors: what they come to does not depend on where in the vector these are.

#include <algorithm>

#include "softgauss/engine/core/segment.hpp"
#include "softgauss/engine/core/types.hpp"

namespace softgauss {

/// What of x is of these entries.
inline auto part(VectorX& x, Segment s) { return x.segment(s.begin, s.end - s.begin); }
inline auto part(const VectorX& x, Segment s) { return x.segment(s.begin, s.end - s.begin); }

inline double dot(Segments entries, const VectorX& x, const VectorX& y) {
  double sum = 0.0;
  for (const Segment s : entries) sum += part(x, s).dot(part(y, s));
  return sum;
}

/// xᵀ diag(d) y.
inline double dot(Segments entries, const VectorX& x, const VectorX& d, const VectorX& y) {
  double sum = 0.0;
  for (const Segment s : entries) sum += part(x, s).dot(part(d, s).cwiseProduct(part(y, s)));
  return sum;
}

/// max |x_i| of finite entries.
inline double largest(Segments entries, const VectorX& x) {
  double most = 0.0;
  for (const Segment s : entries) most = std::max(most, part(x, s).cwiseAbs().maxCoeff());
  return most;
}

/// max |x_i| scale_i; NaN stays.
inline double largest(Segments entries, const VectorX& x, const VectorX& scale) {
  double most = 0.0;
  for (const Segment s : entries) {
    const double of =
        part(x, s).cwiseProduct(part(scale, s)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (!(of <= most)) most = of;
  }
  return most;
}

/// y ← x, of these entries.
inline void copy(Segments entries, const VectorX& x, VectorX& y) {
  for (const Segment s : entries) part(y, s) = part(x, s);
}

inline void setZero(Segments entries, VectorX& y) {
  for (const Segment s : entries) part(y, s).setZero();
}

inline bool allFinite(Segments entries, const VectorX& x) {
  for (const Segment s : entries)
    if (!part(x, s).allFinite()) return false;
  return true;
}

/// y ← x of these entries, 0 elsewhere; y has the size of x.
inline void copyOnly(Segments entries, const VectorX& x, VectorX& y) {
  y.setZero(x.size());
  copy(entries, x, y);
}

}  // namespace softgauss
