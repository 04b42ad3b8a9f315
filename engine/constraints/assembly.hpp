// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What an effect may read when it makes its rows.

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/constraints/inverse_weight.hpp"
#include "softgauss/engine/constraints/supported_mass.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/engine/dynamics/tree_matrix.hpp"

namespace softgauss {

struct Assembly {
  /// Whether friction is regularised less where it sticks.
  bool usesStiction() const { return model.options.uses(Mechanism::stiction) && !softFriction; }
  /// Whether rows may take a velocity sooner than their damping does: goals have to know what is
  /// answered within the step.
  bool mayCapDampingTime() const {
    return model.options.uses(Mechanism::contactDampingTime) && !softFriction &&
           model.options.integrator == Integrator::leapfrog;
  }
  /// The parts of a step are short for what the damping of contacts and limits is made for.
  bool isSubstep() const { return mayCapDampingTime() && model.options.outerTimestep > 0.0; }
  /// How far v lies behind q [s]: half a step where positions drift to mid-step first. A distance
  /// that changes by J v there has changed by J v − lag J̇ v where the step began (4.5).
  double velocityLag() const {
    return model.options.integrator == Integrator::leapfrog ? 0.5 * model.options.timestep : 0.0;
  }
  /// The velocity with which joints turn through the step (nv).
  const VectorX& coriolisVelocity() const { return midstepVelocity ? *midstepVelocity : state.v; }

  /// Counts where the mechanism `did` something.
  void count(Mechanism mechanism, bool did) const {
    if (acted) (*acted)[mechanism] += did;
  }

  const Model& model;
  const State& state;
  const Kinematics& kinematics;
  const ContactSet& contacts;
  const InverseWeights& weights;
  const TreeSparsity& tree;   ///< pattern of M: row i lists the dofs that move body(i)
  bool softFriction = false;  ///< Input::softFriction
  const VectorX* midstepVelocity = nullptr;  ///< null: State::v
  const SupportedMass* load = nullptr;       ///< null: no row knows of a load
  MechanismCounts* acted = nullptr;          ///< null: nobody counts
};

}  // namespace softgauss
