// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The passivity bound of a passive scene, at every step and against every step before:
///
///   E(t) − W(t) ≤ E(s) − W(s) + S(s) + Δ(s) + Δ(t) + Σ ε + Σ f |r|     for all s ≤ t
///                                                   steps   contacts that begin after s
///
/// E: of motion, weight and springs; W: what the applied forces have done. So what was dissipated
/// by s does not come back, but for what soft rows store, S; what the integrator is off by, Δ and
/// ε; and what a contact has when it is found.
///
/// *What rows store, S.* Let z = a₀ + b ẏ + k d r with a₀ = J M⁻¹ (the smooth forces). Rows push
/// with f(z), the maximiser of −½ fᵀ(A + R) f − fᵀz over their cone, A = J M⁻¹Jᵀ. −f is the
/// gradient of a convex function, so f·ẏ ≤ f₀·ẏ with f₀ = f(a₀ + k d r), the force in the same
/// place at rest, and f₀ has a potential in r: along a normal rows give back at most ∫ f₀ dr ≤ f₀
/// |r|, which for one contact under the load f_g lies between f_g |r| + ½ k d r²/(A + R) and twice
/// its second part more. Along a tangent there is no depth: what moves under the rows alone goes
/// ẏ/b farther, with the load held, and a step more. With edges of pyramids and components of
/// elliptic cones as rows
///   S = Σ f₀ (|r| + |ẏ| (1/b + h))
///
/// *What begins.* A contact that begins within a step is found at its end, at a depth r to which it
/// has come for nothing; its rows push over it with the force f of that step.
///
/// *The step, Δ and ε.* The leapfrog keeps an energy that is off from E by
/// h² (FᵀM⁻¹F/12 − vᵀ(∂²V)v/24) where M does not change, F = −∂V the forces of position: by no more
/// than Δ = ⅛ h² FᵀM⁻¹F + h² |vᵀ(∂²V)v|/24, F without the weight of free bodies, which is constant.
/// Where M turns, by less than kTurn = ½ (h ω)² of the velocity in a part of a step, 2 kTurn K
/// more, and ε = (h ω)³ K/12 of the third order in each part, K without the way of free bodies. A
/// tree that is followed by itself keeps its energy to the tolerance of its sub-steps: each may put
/// δ = 10⁻⁵ h/s of the tree's speed u = max_i (|v_i| + h |a_i|) √M_ii into a dof, and
/// |(M v)_i| ≤ √(2 K M_ii), so that ε = δ u √(2 K).

#include <cstdint>
#include <vector>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"

namespace softgauss::test {

class EnergyWatch {
 public:
  explicit EnergyWatch(const Model& model);

  // Measured over all steps so far: the most that E − W was above its least value before [J], and
  // what the law allowed there [J].
  double rose = 0.0, allowedThere = 0.0;

  /// Before the first step, which takes `input`.
  void begin(const State& state, const Input& input);
  /// After a step with `input` whose rows are in `data`: by how much the law is broken [J], ≤ 0
  /// where it holds. `work`: W so far; `perStep`: ε of other integrators [J].
  double check(const State& state, const Input& input, const Data& data, double work,
               double perStep = 0.0);

  double energy(const State& state);                      ///< E [J]
  double stored(const State& state, const Input& input);  ///< S [J]
  double offset(const State& state, const Input& input);  ///< Δ [J]

 private:
  /// −∂V at q, with τ (nv): forces of position, and what is applied.
  void forceAt(const VectorX& q, const Input& input, VectorX& force);
  double bend(const State& state, const Input& input);  ///< |vᵀ(∂²V)v| [W/s]
  double begun(const Data& data);
  double turning(const State& state);  ///< K where energy() was, but for the way of free bodies [J]

  const Model& model_;
  const bool leapfrog_;
  Kinematics kinematics_;
  Data data_;
  collision::SceneContacts contacts_;
  State back_;
  VectorX ahead_, behind_;    ///< forces of position at q ⊕ ε v and q ⊖ ε v (nv)
  double least_ = kInfinity;  ///< E − W so far
  double limit_ = kInfinity;  ///< of E − W: the least of the right side, but for Δ(t)
  int steps_ = 0;
  std::vector<RowKey> now_, before_;  ///< contacts
};

}  // namespace softgauss::test
