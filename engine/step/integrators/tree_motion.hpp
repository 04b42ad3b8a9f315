// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Motion of one kinematic tree under forces that are held, followed within a step.
///
///   q̇ = v,   v̇ = M(q)⁻¹ (Q − b(q, v) − D v − K (q − q_s))                               (6.5)
///
/// b: gravity, Coriolis and gyroscopic forces; D: joint damping; K: joint springs; Q: all other
/// generalised forces. v̇ comes from the articulated-body algorithm
/// (dynamics/tree_acceleration.hpp). Orientation is followed by the rotation vector φ from where
/// the sub-step began, R = R₀ exp(φ), φ̇ = dexp⁻¹(ω) (6.6). Sub-steps are those of Dormand and
/// Prince (6.7); what they may be off by falls with the step.

#include <array>
#include <cstdint>

#include "softgauss/engine/dynamics/tree_acceleration.hpp"
#include "softgauss/engine/model/plan.hpp"
#include "softgauss/engine/model/state.hpp"

namespace softgauss {

class TreeMotion {
 public:
  enum class Outcome : std::uint8_t { done, limit, notFinite };

  TreeMotion() = default;
  /// Memory for the largest tree of the model.
  explicit TreeMotion(const Model& model);

  /// Moves the tree on from where it is in `state` by `duration` [s]. `held`: Q (nv), the root's
  /// moment about its own axes; `heldInWorld`: a moment about world axes on a floating root besides
  /// [N m]. `scale`: 1/√M_ii (nv), which makes velocities and their errors comparable. The result
  /// is in q() and v() after Outcome::done.
  Outcome run(const Model& model, const Plan& plan, const Tree& tree, const State& state,
              const VectorX& held, const Vector3& heldInWorld, const VectorX& scale,
              double duration);

  const VectorX& q() const { return q_; }  ///< (nq), of the tree moved
  const VectorX& v() const { return v_; }  ///< (nv), of the tree moved
  /// (nv) v̇ where it has ended, of the tree moved.
  const VectorX& vdot() const { return Kv_[6]; }
  int substeps() const { return substeps_; }
  std::size_t bytes() const;

  /// v̇ of (6.5) at (q, v) for the whole tree; for tests. `vdot` (nv).
  void acceleration(const Model& model, const Plan& plan, const Tree& tree, const State& at,
                    const VectorX& held, VectorX& vdot);

  /// What a sub-step may be off by, relative to the speed of the tree, for each second that the
  /// step is long [1/s].
  static const double kErrorRate;
  /// Sub-steps tried in one step before it is given up.
  static const int kMaxSubsteps;

 private:
  void start(const Model& model, const State& state, const Tree& tree, const VectorX& held);
  void derivative(const Model& model, const Plan& plan, const Tree& tree);
  double speed(const Model& model, const Plan& plan, const Tree& tree, const VectorX& scale,
               double duration) const;
  double errorOf(const Tree& tree, const VectorX& scale, double duration, double k) const;
  void rebase(const Model& model, const Tree& tree);

  TreeAcceleration acceleration_;
  const VectorX* held_ = nullptr;
  Vector3 heldInWorld_ = Vector3::Zero();
  VectorX q_, v_;                   ///< where the sub-step began (nq), (nv)
  VectorX u_, w_;                   ///< displacement and velocity at which derivative() works (nv)
  VectorX du_, dv_;                 ///< its result
  VectorX angle_, tau_;             ///< of joints, and forces on them, there (nv)
  std::array<VectorX, 7> Ku_, Kv_;  ///< stages
  int substeps_ = 0;
};

}  // namespace softgauss
