// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What an effect may read when it makes its rows.

#include "engine/constraints/carried_load.hpp"
#include "engine/constraints/contact_set.hpp"
#include "engine/constraints/inverse_weight.hpp"
#include "engine/dynamics/kinematics.hpp"
#include "engine/dynamics/tree_matrix.hpp"

namespace softgauss {

struct Assembly {
  /// Whether friction hardens where it sticks.
  bool sticks() const { return model.options.uses(Mechanism::sticking) && !softFriction; }
  /// Whether rows may take a velocity sooner than their damping does: goals have to know what is
  /// answered within the step.
  bool mayShorten() const {
    return model.options.uses(Mechanism::contactHorizon) && !softFriction &&
           model.options.integrator == Integrator::leapfrog;
  }
  /// The parts of a step are short for what the damping of contacts and limits is made for.
  bool isPart() const { return mayShorten() && model.options.wholeTimestep > 0.0; }
  /// How far v lies behind q [s]: half a step where positions drift to mid-step first. A distance
  /// that changes by J v there has changed by J v − lag J̇ v where the step began (T.116).
  double lag() const {
    return model.options.integrator == Integrator::leapfrog ? 0.5 * model.options.timestep : 0.0;
  }
  /// The velocity with which joints turn through the step (nv).
  const VectorX& turns() const { return turning ? *turning : state.v; }

  /// Counts where the mechanism `did` something.
  void count(Mechanism mechanism, bool did) const {
    if (acted) (*acted)[mechanism] += did;
  }

  const Model& model;
  const State& state;
  const Kinematics& kinematics;
  const ContactSet& contacts;
  const InverseWeights& weights;
  const TreeSparsity& tree;           ///< pattern of M: row i lists the dofs that move body(i)
  bool softFriction = false;          ///< Input::softFriction
  const VectorX* turning = nullptr;   ///< null: State::v
  const CarriedLoad* load = nullptr;  ///< null: no row knows of a load
  MechanismCounts* acted = nullptr;   ///< null: nobody counts
};

}  // namespace softgauss
