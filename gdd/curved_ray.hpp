// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Line search for the augmented Lagrangian Φ along a + α d (10.1) where cones bend (4.13).
///
/// With elliptic cones g is not affine between breakpoints, so no interval has a closed form. But
/// Φ(α) and its slope are known exactly at any α,
///   g(α) = g₀ + α M d − Jᵀ(f(x + α dx) − f(x)),    Φ′ = wᵀġ + ∇ℓᵀd,    ġ = M d + Jᵀ∇²s dx
/// with w of (10.2). The search brackets the first sign change of the slope below which Φ is no
/// higher than at the start, and closes in by secants and bisection. Where the slope jumps across
/// zero the bracket shrinks to a kink.

#include "softgauss/gdd/ray.hpp"

namespace softgauss::gdd {

class CurvedRay {
 public:
  explicit CurvedRay(const Model& model);

  /// g: inverse dynamics at α = 0; Md: M d; costSlope, costCurvature: of ℓ along d, without the
  /// cost of contact forces: `forces` has that. The rows must be evaluated and their ray set; they
  /// are left somewhere on the ray.
  RayResult minimize(Constraints& constraints, const TreeFactor& massFactor,
                     const BoundPenalty& bounds, const VectorX& g, const VectorX& Md,
                     double costSlope, double costCurvature, ContactForceTerms& forces);

 private:
  VectorX base_, g_, rate_, y_, yRate_, Rg_;
  std::vector<Crossing> crossings_;
};

}  // namespace softgauss::gdd
