// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Rows of scalar penalties: the arrays that the solver walks, the same for every effect.
///
///   residual x = J a − a_ref,  cost Σ s(x),  force f = −s′(x),  curvature h = s″(x)
///
/// An effect fills `reference` and D, and maps between rows and dofs; everything else is here.

#include <compare>
#include <cstddef>
#include <vector>

#include "engine/constraints/penalty.hpp"
#include "engine/core/check.hpp"

namespace softgauss {

/// A row among all effects.
struct RowId {
  int kind = 0;  ///< place of its effect in Constraints::visit()
  int row = 0;
  auto operator<=>(const RowId&) const = default;
};

/// A row that reaches a knot of its penalty at α = alpha along the ray a + α d.
struct Crossing {
  double alpha = 0.0;
  double curvatureJump = 0.0;  ///< s″ after − before
  double rate = 0.0;           ///< dx of the row
  RowId id;
};

template <ScalarPenalty Penalty>
class ScalarRows {
 public:
  std::vector<double> reference;  ///< a_ref
  std::vector<double> D;          ///< stiffness 1/R
  std::vector<double> x;          ///< residual at the present acceleration
  std::vector<double> dx;         ///< J d, rate of x along the search direction d
  std::vector<double> f;          ///< force −s′(x)
  std::vector<double> h;          ///< curvature s″(x)

  int rowCount() const { return static_cast<int>(x.size()); }

  /// Keeps the memory of earlier steps.
  void resizeRows(std::size_t rows) {
    for (std::vector<double>* column : {&reference, &D, &x, &dx, &f, &h}) column->resize(rows);
  }

  /// Force and curvature of every row at x; returns the cost. `cellChanged` becomes true where a
  /// row's curvature is not what it was.
  double evaluate(bool& cellChanged) {
    double cost = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Jet s = Penalty::at(x[i], D[i]);
      cost += s.value;
      f[i] = -s.slope;
      cellChanged |= h[i] != s.curvature;
      h[i] = s.curvature;
    }
    return cost;
  }

  /// Slope and curvature of Σ s(x + α dx) in α.
  void along(double alpha, Jet& sum) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Jet s = Penalty::at(x[i] + alpha * dx[i], D[i]);
      sum.value += s.value;
      sum.slope += s.slope * dx[i];
      sum.curvature += s.curvature * dx[i] * dx[i];
    }
  }

  /// Appends the knots that x + α dx meets at α ≥ 0.
  void findCrossings(int kind, std::vector<Crossing>& crossings) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double alpha = Penalty::knotAhead(x[i], dx[i]);
      if (!(alpha < kInfinity)) continue;
      const double jump = Penalty::curvatureJump(dx[i], D[i]);
      crossings.push_back({alpha, jump, dx[i], {kind, static_cast<int>(i)}});
    }
  }

  /// Puts a row exactly at its knot, on the side of the larger or of the smaller curvature.
  void placeAtKnot(int row, bool stiffSide) { x[row] = Penalty::knot(stiffSide); }

  void advance(double alpha) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += alpha * dx[i];
  }
};

}  // namespace softgauss
