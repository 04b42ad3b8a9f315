// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The controller that goal directed dynamics is compared with: one convex quadratic program over
/// accelerations a, controls u and contact forces f, as it is widely written.
///
///   min  ℓ(a) + ½ (u, 0)ᵀM⁻¹(u, 0) + ½ ε |f|²
///   s.t. M a + c = (u, 0) + Jᵀf,   f ≥ 0 along the edges of the friction pyramids,   u in its box
///
/// ℓ and the price of u are those of (8.1), so nothing but the physics differs. What is missing is
/// complementarity: f is free in its cone, whatever the contact would answer to a. Where `stance`
/// is set, contacts are asked not to accelerate, in the sense of least squares:
///   + ½ κ |J_C a|²,   κ large
/// as controllers do that keep their feet where they are.

#include "softgauss/gdd/cost.hpp"
#include "softgauss/gdd/problem.hpp"
#include "tests/support/convex_qp.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {

struct ConvexControl {
  VectorX a;
  VectorX u;  ///< (nv), 0 on unactuated dofs
  VectorX f;  ///< of all rows, those of limits first [N or N m]
};

/// The stages of `data` must be computed; the rows must be limits and pyramidal contacts.
ConvexControl convexControl(const Data& data, const gdd::GoalCost& cost,
                            const gdd::ControlLimits& limits, bool stance = false);

}  // namespace softgauss::test
