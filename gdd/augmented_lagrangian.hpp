// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Solver 1, the paper's: augmented Lagrangian, primal–dual, Gauss–Newton.
///
/// The constraints of (8.1) enter through multipliers λ and a quadratic penalty ρ (10.1):
///   Φ(a) = ½ gᵀR g + ℓ(a) + Σᵢ ½ ρᵢ (tᵢ − clamp(tᵢ))²,   tᵢ = gᵢ + λᵢ/ρᵢ
/// clamp is onto [lowerᵢ, upperᵢ]; with lower = upper = 0 the term is λ g + ½ ρ g² + const. With
/// w = R g + ψ′(g), ψ′ᵢ = ρᵢ (tᵢ − clamp tᵢ), and P = ∂g/∂a (1.3), gradient and Gauss–Newton
/// Hessian are those of (17) and (18) (10.2); with actuators of any kind bounds are on y = C g, and
/// Cᵀψ′(y), Cᵀψ″ C stand for ψ′, ψ″ (10.3):
///   ∇Φ = P w + ∇ℓ,   H = P (R + ψ″) P + ∇²ℓ
/// Iterate: H d = −∇Φ; exact line search along d (ray.hpp); when the gradient has vanished, update
/// λ ← ψ′(g) until the constraints hold. H is factored anew only where a row or a bound has
/// changed its piece: a dual update in the same cell costs two triangular solves.
///
/// Where the minimum along a ray is the breakpoint of a row (a kink), the gradient never vanishes:
/// that row is held at its breakpoint and the iteration goes on within the kink (held_rows.hpp).

#include "softgauss/gdd/cost.hpp"
#include "softgauss/gdd/curved_ray.hpp"
#include "softgauss/gdd/deadline.hpp"
#include "softgauss/gdd/held_rows.hpp"
#include "softgauss/gdd/hessian.hpp"
#include "softgauss/gdd/problem.hpp"
#include "softgauss/gdd/ray.hpp"
#include "softgauss/gdd/report.hpp"

namespace softgauss::gdd {

struct AugmentedLagrangianOptions {
  double penalty = 1e5;  ///< ρᵢ = penalty · 1/(1/(M⁻¹)ᵢᵢ + added), M⁻¹ at q0 [-]
  double gradientTolerance = 1e-8;    ///< scaled ∇Φ, see Report::stationarity
  double violationTolerance = 1e-10;  ///< distance of y from its limits, as force, over max(1, |c|)
  int maxIterations = 150;
  Deadline deadline;  ///< past it, as past maxIterations
  int maxDualUpdates = 100;
};

class AugmentedLagrangian {
 public:
  explicit AugmentedLagrangian(const Model& model);

  AugmentedLagrangianOptions options;

  /// Reads the stages of `data` up to the rows and leaves the rows evaluated at the result.
  GddReport solve(const Model& model, GoalCost& cost, const ControlLimits& limits, Data& data,
                  const WarmStart& warm);
  /// Writes the solution where the next solve starts from.
  void keepWarmStart(WarmStart& warm) const;

  /// After GddStatus::notFinite: the first dof whose gradient is not finite, or −1. After
  /// badLimits: the coordinate whose bounds are none.
  int badDof() const;
  const VectorX& acceleration() const { return a_; }
  const VectorX& force() const { return g_; }  ///< g(a): the control, before clamping

 private:
  GddReport minimizeFrom(const Model& model, GoalCost& cost, const ControlLimits& limits,
                         Data& data, const WarmStart& warm);
  void setPenalties(const GoalCost& cost, const ControlLimits& limits, const Data& data);
  void start(const GoalCost& cost, const ControlLimits& limits, Data& data, const WarmStart& warm);
  double gap(const ControlLimits& limits) const;
  void evaluate(Data& data);
  bool gradient(const BoundPenalty& bounds, const GoalCost& cost, Data& data);
  double direction();
  double stationarity(const VectorX& forceScale);

  VectorX a_, g_, Ma_, Rg_;
  VectorX y_;  ///< C g
  VectorX lambda_, rho_;
  VectorX slope_, curvature_;  ///< ψ′, ψ″ at y (nv)
  VectorX w_, gradient_, costGradient_, direction_, Md_, scratch_;
  TreeFactor massFactor_;  ///< of M
  GaussNewtonHessian hessian_;
  HeldRows held_;
  ContactForceTerms forces_;
  Ray ray_;
  CurvedRay curvedRay_;
  double penalty_ = 0.0;       ///< Σ ψ
  int badBound_ = -1;          ///< ControlLimits::firstBad()
  bool rowsChanged_ = true;    ///< a row changed its piece: P is out of date
  bool stale_ = true;          ///< P changed since H was factored
  bool boundsChanged_ = true;  ///< a bound changed its piece since H was factored
};

}  // namespace softgauss::gdd
