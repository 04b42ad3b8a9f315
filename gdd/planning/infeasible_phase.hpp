// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Phase I: a plan over accelerations.
///
/// Accelerations are the controls, so that the dynamics (23) are linear but for rotations and their
/// errors do not add up; forces are costs, whoever may cause them. Root forces z, which nobody
/// does, and forces beyond their bounds are driven out by an augmented Lagrangian,
///
///   L = J + h Σ_t Σ_i [λ z + ½ μ z²]      of a bounded u: ½ (max(0, λ + μ (u − u_max))² − λ²)/μ
///
/// and likewise below. An iteration expands g about the trajectory, finds a direction by (P.4) and
/// the exact linear rollout, and goes along it as far as L falls: α = 1, ½, … . ρ follows by how
/// much the model has promised. Every `inner` iterations, or where L hardly falls, λ ← λ + μ z, and
/// μ grows where z has not fallen to a quarter.

#include "softgauss/gdd/planning/trajectory.hpp"

namespace softgauss::planning {

struct InfeasibleOptions {
  int halvings = 7;     ///< of α, at most
  int inner = 5;        ///< iterations from one update of λ to the next, at most
  double growth = 5.0;  ///< of μ
  double mu = 0.1;      ///< μ at the start, over the root forces' cost
  double muMost = 1e9;  ///< μ at most, over the same
  double rho = 0.0;     ///< at the start
};

class InfeasiblePhase {
 public:
  InfeasiblePhase(const Problem& problem, KnotThreads& threads);

  /// From knots[0] by the accelerations of `x`, with λ = 0. False where that is not finite.
  bool start(const Trajectory& x, const InfeasibleOptions& options = {});
  /// One iteration; false where no step was found, which raises ρ for the next.
  bool iterate();

  const Trajectory& trajectory() const { return x_; }
  const std::vector<ValueModel>& values() const { return values_; }  ///< of N + 1 knots
  double lagrangian() const { return L_; }
  double stepLength() const { return alpha_; }  ///< α of the last iteration
  double rho() const { return rho_; }
  /// The knot at which the last start() or iterate() has found a force, a cost or a model of it
  /// that is not finite; −1: none.
  int refusedKnot() const { return refusedKnot_; }

 private:
  struct ForceCost {
    double value, slope, curvature;
  };
  ForceCost forceCost(int t, int dof, double f) const;
  double evaluate(Trajectory& x);
  bool linearise();
  bool backward();
  bool refuse(int knot);
  void findDirection();
  bool search();
  void updateMultipliers();

  const Problem& problem_;
  KnotThreads& threads_;
  InfeasibleOptions options_;
  TrajectoryCost cost_;
  BackwardPass pass_;
  Trajectory x_, trial_;
  std::vector<ValueModel> values_;
  std::vector<Feedback> feedback_;
  std::vector<VectorX> lambda_, direction_;
  ValueModel knotCost_;
  VectorX mu_, w_, W_, dx_, dxNext_;
  double L_ = 0.0, rho_ = 0.0, alpha_ = 0.0, lastViolation_ = kInfinity;
  int sinceUpdate_ = 0, refusedKnot_ = -1;
  bool fresh_ = true;
};

}  // namespace softgauss::planning
