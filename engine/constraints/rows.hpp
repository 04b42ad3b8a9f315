// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Rows of scalar penalties: the arrays that the solver walks, the same for every effect.
///
///   residual x = J a − a_ref,  cost Σ s(x),  force f = −s′(x),  curvature h = s″(x)
///
/// An effect fills `reference`, D and what else its penalty takes, and maps between rows and dofs;
/// everything else is here.

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "softgauss/engine/constraints/impedance.hpp"
#include "softgauss/engine/constraints/penalty.hpp"
#include "softgauss/engine/constraints/row_selection.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/memory.hpp"

namespace softgauss {

struct Assembly;

/// A row among all effects.
struct RowId {
  int kind = 0;  ///< place of its effect in Constraints::visit()
  int row = 0;
  auto operator<=>(const RowId&) const = default;
};

/// A breakpoint of a row's penalty.
struct Breakpoint {
  RowId row;
  int index = 0;  ///< among the breakpoints of the row, upwards
  auto operator<=>(const Breakpoint&) const = default;
};

/// A row that reaches a breakpoint of its penalty at α = alpha along the ray a + α d.
struct Crossing {
  double alpha = 0.0;
  double curvatureJump = 0.0;  ///< s″ after − before
  double rate = 0.0;           ///< dx of the row
  Breakpoint breakpoint;
};

template <ScalarPenalty Penalty>
class ScalarRows {
 public:
  std::vector<double> reference;   ///< a_ref
  std::vector<double> D;           ///< stiffness 1/R
  std::vector<double> perInertia;  ///< R per inverse inertia, Softness::perInertia
  std::vector<double> limit;       ///< of the force, where the penalty has one; else unused
  std::vector<double> x;           ///< residual at the present acceleration
  std::vector<double> dx;          ///< J d, rate of x along the search direction d
  std::vector<double> f;           ///< force −s′(x)
  std::vector<double> h;           ///< curvature s″(x)
  std::vector<double> df;          ///< −s″(x) dx, rate of f along the search direction
  RowSelection selection;          ///< what all that runs over rows walks

  int rowCount() const { return static_cast<int>(x.size()); }
  Penalty penalty(std::size_t i) const {
    if constexpr (Penalty::kLimited)
      return {D[i], limit[i]};
    else
      return {D[i]};
  }

  void pushSoftness(const Softness& softness) {
    D.push_back(1.0 / softness.R);
    perInertia.push_back(softness.perInertia);
  }
  /// Rows of one softness, with these a_ref.
  void pushRows(const Softness& softness, const double* references, std::size_t rows) {
    reference.insert(reference.end(), references, references + rows);
    D.insert(D.end(), rows, 1.0 / softness.R);
    perInertia.insert(perInertia.end(), rows, softness.perInertia);
  }
  /// Drops all rows; keeps the memory.
  void clearRows() {
    reference.clear();
    D.clear();
    perInertia.clear();
    limit.clear();
  }
  /// Fits the arrays that the solver writes to `rows`.
  void resizeRows(std::size_t rows) {
    for (std::vector<double>* column : {&reference, &D, &x, &dx, &f, &h, &df}) column->resize(rows);
    piece_.resize(rows);
    selection.reset(rows);
  }

  /// Force and curvature of the rows at x; returns the cost. `cellChanged` becomes true where a
  /// row is not in the piece of its penalty in which it was.
  double evaluate(bool& cellChanged) {
    double cost = 0.0;
    selection.forEach([&](std::size_t i) {
      const Penalty p = penalty(i);
      const Jet s = p.at(x[i]);
      const auto piece = static_cast<std::int8_t>(p.piece(x[i]));
      cost += s.value;
      f[i] = -s.slope;
      h[i] = s.curvature;
      cellChanged |= piece_[i] != piece;
      piece_[i] = piece;
    });
    return cost;
  }

  /// The same with every row in the piece in which it was, whatever x says.
  void evaluateInPlace() {
    selection.forEach([&](std::size_t i) {
      const Jet s = penalty(i).in(piece_[i], x[i]);
      f[i] = -s.slope;
      h[i] = s.curvature;
    });
  }

  /// Slope and curvature of Σ s(x + α dx) in α.
  void along(double alpha, Jet& sum) const {
    selection.forEach([&](std::size_t i) {
      const Jet s = penalty(i).at(x[i] + alpha * dx[i]);
      sum.value += s.value;
      sum.slope += s.slope * dx[i];
      sum.curvature += s.curvature * dx[i] * dx[i];
    });
  }

  /// Whether x + dx has every row in the piece in which it was.
  bool staysInCell() const {
    for (const Segment rows : selection.segments())
      for (std::size_t i = idx(rows.begin); i < idx(rows.end); ++i)
        if (penalty(i).piece(x[i] + dx[i]) != piece_[i]) return false;
    return true;
  }

  /// Appends the breakpoints that x + α dx meets at α ≥ 0.
  void findCrossings(int kind, std::vector<Crossing>& crossings) const {
    if constexpr (Penalty::kBreakpoints > 0) {
      selection.forEach([&](std::size_t i) {
        if (dx[i] == 0.0) return;
        const Penalty s = penalty(i);
        const bool up = dx[i] > 0.0;
        for (int k = up ? s.piece(x[i]) : s.piece(x[i]) - 1; 0 <= k && k < Penalty::kBreakpoints;
             up ? ++k : --k) {
          const double alpha = (s.breakpoint(k) - x[i]) / dx[i];
          if (!(alpha < kInfinity)) break;  // also NaN
          const double jump = up ? s.curvatureJump(k) : -s.curvatureJump(k);
          crossings.push_back({alpha, jump, dx[i], {{kind, static_cast<int>(i)}, k}});
        }
      });
    }
  }

  /// The first breakpoint that x + α dx meets if it is sooner than `next`, counted from the piece
  /// in which every row was; a row that is past its breakpoint by rounding meets it at once.
  void findNextCrossing(int kind, Crossing& next) const {
    if constexpr (Penalty::kBreakpoints > 0) {
      selection.forEach([&](std::size_t i) {
        if (dx[i] == 0.0) return;
        const bool up = dx[i] > 0.0;
        const int k = up ? piece_[i] : piece_[i] - 1;
        if (k < 0 || k >= Penalty::kBreakpoints) return;
        const Penalty s = penalty(i);
        const double alpha = std::max(0.0, (s.breakpoint(k) - x[i]) / dx[i]);
        if (!(alpha < next.alpha)) return;
        const double jump = up ? s.curvatureJump(k) : -s.curvatureJump(k);
        next = {alpha, jump, dx[i], {{kind, static_cast<int>(i)}, k}};
      });
    }
  }

  /// Puts a row at a breakpoint, in the piece above it or the one below.
  void enterPiece(int row, int breakpoint, bool above) {
    const Penalty s = penalty(row);
    piece_[row] = static_cast<std::int8_t>(above ? breakpoint + 1 : breakpoint);
    x[row] = s.breakpoint(breakpoint);
    h[row] = s.in(piece_[row], x[row]).curvature;
  }
  /// Whether a row is in the piece above a breakpoint, or in one that is higher.
  bool isAbove(int row, int breakpoint) const { return piece_[row] > breakpoint; }

  double curvatureJump(int row, int breakpoint) const {
    return penalty(row).curvatureJump(breakpoint);
  }
  /// Takes a row off the ray.
  void holdOnRay(int row) { dx[row] = 0.0; }

  /// x of a row above one of its breakpoints.
  double aboveBreakpoint(int row, int breakpoint) const {
    return x[row] - penalty(row).breakpoint(breakpoint);
  }

  /// Puts a row at a breakpoint, where it counts as free, or next to it on the stiff side.
  void placeAtBreakpoint(int row, int breakpoint, bool stiffSide) {
    constexpr double kSmallest = std::numeric_limits<double>::min();
    constexpr double kRelative = std::numeric_limits<double>::epsilon();
    const Penalty s = penalty(row);
    x[row] = s.breakpoint(breakpoint);
    if (!stiffSide) return;
    const double step = std::max(kSmallest, kRelative * std::abs(x[row]));
    x[row] += s.curvatureJump(breakpoint) > 0.0 ? step : -step;
  }

  /// Memory held [bytes].
  std::size_t bytes() const {
    return bytesOfAll(reference, D, perInertia, limit, x, dx, f, h, df, piece_) + selection.bytes();
  }

  void advance(double alpha) {
    selection.forEach([&](std::size_t i) { x[i] += alpha * dx[i]; });
  }
  void setForceRate() {
    selection.forEach([&](std::size_t i) { df[i] = -h[i] * dx[i]; });
  }

 private:
  std::vector<std::int8_t> piece_;
};

}  // namespace softgauss
