// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Exact line search for the augmented Lagrangian Φ along a + α d (10.1).
///
/// Between two breakpoints of the rows g is affine in α, so Φ is convex there and piecewise
/// quadratic, its only pieces being those of the bounds, which are on y = C g. The search walks
/// from breakpoint to breakpoint: the rate dg/dα gains s″-jump · ẋ · Jᵀ at each, and the rates of
/// contact forces change alike. It ends at the first local minimum: inside an interval, or at a
/// breakpoint past which the slope is not negative (a kink).

#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/contact_force_cost.hpp"
#include "softgauss/gdd/control_cost_term.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

/// The penalty ψ of the bounds on y (10.1), and the price R + W of force.
struct BoundPenalty {
  const ControlLimits& limits;
  const VectorX& lambda;  ///< multipliers
  const VectorX& rho;
  const ControlCostTerm* controlCost = nullptr;  ///< null: M⁻¹ alone

  /// Rx ← (R + W) x.
  void multiplyR(const TreeFactor& massFactor, const VectorX& x, VectorX& Rx) const {
    if (controlCost) return controlCost->multiply(massFactor, x, Rx);
    Rx = x;
    massFactor.solve(Rx);
  }
  /// R ĝ, the part of the price's slope that does not depend on g; none where ĝ = 0.
  const VectorX* freeSlope() const {
    return controlCost && controlCost->hasFree() ? &controlCost->freeSlope() : nullptr;
  }
  double freeCost() const { return controlCost ? controlCost->freeCost() : 0.0; }  ///< ½ ĝᵀR ĝ
  /// ½ ρ (t − clamp t)², its slope and curvature in y_i. A bound just met has curvature 0.
  Jet at(Eigen::Index i, double y) const {
    const double t = y + lambda[i] / rho[i];
    const double lower = limits.lower[i], upper = limits.upper[i];
    const double over = t > upper ? t - upper : (t < lower ? t - lower : 0.0);
    const bool active = over != 0.0 || lower == upper;
    return {0.5 * rho[i] * over * over, rho[i] * over, active ? rho[i] : 0.0};
  }
};

struct RayResult {
  double alpha = 0.0;
  bool kink = false;  ///< ended at a breakpoint of a row, `last`
  bool bend = false;  ///< ended where the slope jumps at an elliptic cone
  int crossings = 0;  ///< breakpoints passed
  Breakpoint last;    ///< the last breakpoint passed
};

class Ray {
 public:
  explicit Ray(const Model& model)
      : g_(VectorX::Zero(model.nv)),
        rate_(VectorX::Zero(model.nv)),
        y_(VectorX::Zero(model.nv)),
        yRate_(VectorX::Zero(model.nv)),
        Rrate_(VectorX::Zero(model.nv)) {}

  /// g: inverse dynamics at α = 0; rate: P d; costSlope, costCurvature: of ℓ along d, without the
  /// cost of contact forces: `forces` has that, with its rate. The rows' ray must be set
  /// (Constraints::setRay).
  RayResult minimize(const Constraints& constraints, const TreeFactor& massFactor,
                     const BoundPenalty& bounds, const VectorX& g, const VectorX& rate,
                     double costSlope, double costCurvature, ContactForceTerms& forces);

 private:
  Jet slopeAt(const BoundPenalty& bounds, double tau) const;

  VectorX g_, rate_, y_, yRate_, Rrate_;
  double smoothSlope_ = 0.0,
         smoothCurvature_ = 0.0;  ///< of ½ gᵀ(R + W) g + ℓ at the interval's start
  std::vector<Crossing> crossings_;
};

}  // namespace softgauss::gdd
