// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is found of the islands of goal_islands.hpp, one after the other, as one solution.
///
/// Where a step's solve is repeated for trees whose prediction did not hold (6.2), islands of none
/// of these keep what they have: their problem is the same.

#include <cstdint>
#include <vector>

#include "softgauss/gdd/goal_islands.hpp"
#include "softgauss/gdd/report.hpp"
#include "softgauss/gdd/sequential_quadratic_solve.hpp"

namespace softgauss::gdd {

class IslandSolutions {
 public:
  explicit IslandSolutions(const Model& model);

  VectorX a;                                    ///< (nv) where no control acts, what it was last
  VectorX force;                                ///< (nv) within the limits, or before clamping
  WarmStart warm;                               ///< where the next solve starts from
  std::vector<std::uint8_t> controlled, known;  ///< (trees) StepControl

  /// Makes room for so many breakpoints.
  void reserve(int breakpoints);
  /// Begins with what no control acts on, or keeps what still holds.
  void begin(const Model& model, const State& state, const ControlLimits& limits,
             const GoalIslands& islands, const Data& data);
  /// Whether an island keeps what it has.
  bool keeps(int island) const { return keeps_[idx(island)] != 0; }
  /// It does; the rows, which are selected, are evaluated there. Returns how its solve has ended.
  GddReport keep(int island, Data& data);
  /// What `solved` has come to for an island, with what is left of the equation of motion (nv) if
  /// that is rounding, else null.
  void take(const Model& model, int island, const SequentialQuadraticSolve& solved,
            const VectorX* residual, const GddReport& report, Data& data);

 private:
  /// How an island's solve has ended, and its breakpoints in warm.breakpoints.
  struct Island {
    GddReport report;
    Segment breakpoints;
  };
  void reset(const Model& model, const State& state, const ControlLimits& limits, Segments dofs);
  void appendBreakpoints(int island, const std::vector<BreakpointKey>& from, Segment of);

  std::vector<Island> islands_, before_;
  std::vector<std::uint8_t> keeps_;  ///< (islands)
  std::vector<int> ofTree_;          ///< (trees) the island, of the last begin()
  std::vector<BreakpointKey> breakpointsBefore_;
  WarmStart found_;  ///< scratch
};

}  // namespace softgauss::gdd
