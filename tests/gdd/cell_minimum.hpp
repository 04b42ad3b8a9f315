// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The least value of a small problem (8.1), cell by cell.
///
/// In a cell every row has one piece of its penalty: there P is constant, g affine, and (8.1) is a
/// convex quadratic program over the closed cell. All patterns of pieces are gone through, each
/// program is solved by itself, and the least of their minima is the minimum of the problem. No
/// start, no path, no multiplier of the solvers under test enters.

#include "tests/gdd/dense_gdd.hpp"
#include "tests/support/convex_qp.hpp"

namespace softgauss::test {

struct CellMinimum {
  VectorX a;
  double value = std::numeric_limits<double>::infinity();  ///< F
  int patterns = 0;                                        ///< gone through
  int programs = 0;                                        ///< solved, feasible
};

/// Patterns of pieces that the rows of `d` have: 2 for one breakpoint, 3 for two, 1 for none.
double patternCount(const DenseGdd& d);

/// The global minimum.
CellMinimum globalMinimum(const DenseGdd& d);

/// The minimum over |aᵢ − center_i| ≤ radius_i: that of the cells which this box meets.
CellMinimum minimumNear(const DenseGdd& d, const VectorX& center, const VectorX& radius);

}  // namespace softgauss::test
