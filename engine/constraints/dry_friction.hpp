// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Dry (Coulomb) friction of joints, one row for each dof that has it.
///
/// The row wants the joint to come to rest, with a force of at most f_max = Dof::dryFriction:
///   x = aᵢ − a_ref,   a_ref = −b vᵢ,   f = −D x clamped to ± f_max                         (4.2)
/// There is no distance: b, D come from the dof's Impedance at r = 0. While the joint slides, the
/// force is f_max against the motion. While it sticks under a load f, it would creep at R f/b, but
/// slower than 2 R f_max/b its row hardens (5.6), unless friction is asked
/// to stay soft (Options::constraintModel, Input::controlled). Contract: |f| ≤ f_max.

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/joint_rows.hpp"

namespace softgauss {

class DryFriction : public JointRows<Huber> {
 public:
  void assemble(const Assembly& in);
};

}  // namespace softgauss
