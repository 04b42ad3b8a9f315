// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Islands of goal directed dynamics: two trees are of one where rows couple them, or a term of the
/// cost, the price of force or an actuator does.
///
/// P, B, R and ∇²ℓ have no entry between two islands, so (8.1) is the sum of theirs and each is
/// solved by itself, in its own cells and its own number of iterations. A robot among a thousand
/// objects pays for those that it touches, two robots with a goal each are two problems, and what
/// one does depends on the other in no bit. Islands without a control have nothing to choose: they
/// are left to forward dynamics. Who sleeps (sleep.hpp) is of none; what the cost couples with who
/// is awake has to wake.

#include <cstdint>
#include <span>
#include <vector>

#include "softgauss/gdd/cost.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

class GoalIslands {
 public:
  explicit GoalIslands(const Model& model);

  /// Finds them, of the rows in `data`, of limits that fit the model. `together`: all are one.
  /// False where some have to wake first: wanted().
  bool find(const Model& model, const ControlLimits& limits, bool together, GoalCost& cost,
            Data& data);
  /// (trees) 1: it sleeps, and is of the problem; empty: none.
  std::span<const std::uint8_t> wanted() const { return wanted_; }

  int size() const { return static_cast<int>(controls_.size()); }
  /// Whether there is one, of all trees.
  bool isWhole() const { return isWhole_; }
  /// Whether that is so whatever couples them, of several trees: by the solver, or by functions.
  bool isOneProblem() const { return isOneProblem_; }
  /// (trees) the island of each, −1: none.
  const std::vector<int>& ofTree() const { return ofTree_; }
  /// Whether a control acts on an island, or there is no other.
  bool isSolved(int island) const { return isWhole_ || controls(island) > 0; }
  /// How many coordinates of force its box leaves a choice of.
  int controls(int island) const { return controls_[idx(island)]; }

  /// Gives the rows of islands with controls their columns, where they have none.
  void addColumns(const Model& model, Data& data) const;

  /// From here on `data` and `cost` are of this island alone, until selectAll().
  void select(const Model& model, int island, GoalCost& cost, Data& data) const;
  void selectAll(const Model& model, GoalCost& cost, Data& data) const;

 private:
  void findWanted(const Model& model, bool together, const Data& data);

  std::vector<int> ofTree_;
  std::vector<std::uint8_t> wanted_;
  bool isWhole_ = true, isOneProblem_ = false;
  std::vector<int> controls_;  ///< (islands)
};

}  // namespace softgauss::gdd
