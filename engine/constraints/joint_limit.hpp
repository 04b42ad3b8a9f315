// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joint limits  q_min ≤ q ≤ q_max, one row per end whose distance r < margin.
///
/// Distance r = q − q_min (lower) or q_max − q (upper), so J = ±eᵢ and a force ≥ 0 pushes inward:
///   x = ±aᵢ − a_ref,   a_ref = −b ṙ − k d (r − margin),   s(x) = ½ D min(x, 0)²           (4.1)
/// b, k, D: of the joint's Impedance, A of (5.4). Contract: f ≥ 0, f·max(x, 0) = 0.

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/joint_rows.hpp"

namespace softgauss {

class JointLimit : public JointRows<HalfQuadratic> {
 public:
  void assemble(const Assembly& in);
};

}  // namespace softgauss
