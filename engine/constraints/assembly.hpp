// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What an effect may read when it makes its rows.

#include <algorithm>
#include <vector>

#include "softgauss/engine/constraints/block_jacobian.hpp"
#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/constraints/inverse_weight.hpp"
#include "softgauss/engine/constraints/supported_mass.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/engine/dynamics/tree_matrix.hpp"
#include "softgauss/engine/dynamics/tree_selection.hpp"

namespace softgauss {

struct Assembly {
  /// Input::controlled of the trees that a row holds, on a body or on two, the larger.
  std::uint8_t controlled(int bodyA, int bodyB = 0) const {
    if (!input || input->controlled.empty()) return 0;
    const auto of = [&](int body) -> std::uint8_t {
      const int t = model.bodies[static_cast<std::size_t>(body)].tree;
      return t >= 0 ? input->controlled[static_cast<std::size_t>(t)] : 0;
    };
    return std::max(of(bodyA), of(bodyB));
  }
  /// How far v lies behind q [s]: half a step where positions drift to mid-step first. A distance
  /// that changes by J v there has changed by J v − lag J̇ v where the step began (4.5).
  double velocityLag() const {
    return model.options.integrator == Integrator::leapfrog ? 0.5 * model.options.timestep : 0.0;
  }
  /// The velocity with which joints turn through the step (nv).
  const VectorX& coriolisVelocity() const { return midstepVelocity ? *midstepVelocity : state.v; }

  /// Whether rows of these bodies are wanted.
  bool takesPart(int bodyA, int bodyB = 0) const {
    return !trees || trees->holds(model, bodyA, bodyB);
  }

  /// Counts where the mechanism `did` something.
  void count(Mechanism mechanism, bool did) const {
    if (acted) (*acted)[mechanism] += did;
  }

  const Model& model;
  const State& state;
  const Kinematics& kinematics;
  const ContactSet& contacts;
  const InverseWeights& weights;
  const TreeSparsity& tree;      ///< pattern of M: row i lists the dofs that move body(i)
  const Input* input = nullptr;  ///< null: nothing is asked of the step
  const VectorX* midstepVelocity = nullptr;  ///< null: State::v
  const SupportedMass* load = nullptr;       ///< null: no row knows of a load
  MechanismCounts* acted = nullptr;          ///< null: nobody counts
  Columns columns = Columns::now;            ///< of blocks, the dofs that move them (BlockJacobian)
  const std::vector<Motion>* lastMotion = nullptr;  ///< (bodies) by State::a, without columns
  const TreeSelection* trees = nullptr;             ///< whose rows are made; null: of all
};

}  // namespace softgauss
