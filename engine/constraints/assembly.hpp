// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What an effect may read when it makes its rows.

#include "engine/constraints/carried_load.hpp"
#include "engine/constraints/contact_set.hpp"
#include "engine/constraints/inverse_weight.hpp"
#include "engine/constraints/nearby_poses.hpp"
#include "engine/dynamics/kinematics.hpp"
#include "engine/dynamics/tree_matrix.hpp"

namespace softgauss {

struct Assembly {
  /// Whether friction hardens where it sticks.
  bool sticks() const { return model.options.ownSoftness && !softFriction; }
  /// Whether contacts and limits hold at the step's end (T.137): in the parts of a step, which are
  /// short for what their damping is made for; but not where goals have to know what they answer.
  bool holdsAtEnd() const { return sticks() && model.options.wholeTimestep > 0.0; }
  bool drifts() const { return model.options.integrator == Integrator::leapfrog; }
  /// How far v lies behind q [s]: half a step where q is that of mid-step, or v that of half a step
  /// earlier (T.116).
  double lag() const {
    const Options& o = model.options;
    const bool euler = o.midpointCoriolis && !o.looksWithin();
    return drifts() || euler ? 0.5 * o.timestep : 0.0;
  }
  /// The velocity with which joints turn through the step (nv).
  const VectorX& turns() const { return turning ? *turning : state.v; }

  const Model& model;
  const State& state;
  const Kinematics& kinematics;
  const ContactSet& contacts;
  const InverseWeights& weights;
  const TreeSparsity& tree;             ///< pattern of M: row i lists the dofs that move body(i)
  bool softFriction = false;            ///< Input::softFriction
  const VectorX* turning = nullptr;     ///< null: State::v
  const CarriedLoad* load = nullptr;    ///< null: no row knows of a load
  const NearbyPoses* nearby = nullptr;  ///< null: no v that lags, no tie, or no turn
};

}  // namespace softgauss
