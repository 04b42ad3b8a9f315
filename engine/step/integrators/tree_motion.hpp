// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Motion of one kinematic tree under forces that are held, followed within a step.
///
///   q̇ = v,   v̇ = M(q)⁻¹ (Q − b(q, v) − D v − K (q − q_s))                               (6.5)
///
/// b: gravity, Coriolis and gyroscopic forces; D: joint damping; K: joint springs; Q: all other
/// generalised forces.
/// The tree's accelerations come from the articulated-body algorithm [Featherstone 2008, section
/// 7.3] in O(n), in world axes about the tree's root body. Orientation is followed by the rotation
/// vector φ from where the sub-step began, R = R₀ exp(φ), φ̇ = dexp⁻¹(ω) (6.6).

#include <array>
#include <cstdint>
#include <vector>

#include "softgauss/engine/model/plan.hpp"
#include "softgauss/engine/model/state.hpp"

namespace softgauss {

class TreeMotion {
 public:
  enum class Outcome : std::uint8_t { done, limit, notFinite };

  TreeMotion() = default;
  /// Memory for the largest tree of the model.
  explicit TreeMotion(const Model& model);

  /// Where the motion begins.
  void start(const Model& model, const State& state, const Tree& tree);
  /// √(2 K) of the tree where it begins, by its links' motion, and what the forces give it from
  /// rest in `duration` [s], max_i |v̇_i| √M_ii: by it the errors of sub-steps are judged. Near a
  /// singular place joints that turn against each other have speeds that say nothing.
  double speed(const Model& model, const Plan& plan, const Tree& tree, const VectorX& held,
               const Vector3& heldInWorld, const VectorX& scale, double duration);
  /// Moves the tree on by `duration` [s]. `held`: Q (nv), the root's moment about its own axes;
  /// `heldInWorld`: a moment about world axes on a floating root besides [N m]. `scale`: 1/√M_ii
  /// (nv), which makes velocities and their errors comparable; `speed`: of the tree, in that
  /// measure. `firstStep`: the first sub-step that is tried. The result is in q() and v() after
  /// Outcome::done.
  Outcome run(const Model& model, const Plan& plan, const Tree& tree, const VectorX& held,
              const Vector3& heldInWorld, const VectorX& scale, double speed, double duration,
              double firstStep);

  const VectorX& q() const { return q_; }  ///< (nq), of the tree moved
  const VectorX& v() const { return v_; }  ///< (nv), of the tree moved
  /// (nv) v̇ where it has ended, of the tree moved.
  const VectorX& vdot() const { return Kv_[6]; }
  int substeps() const { return substeps_; }
  std::size_t bytes() const;

  /// v̇ of (6.5) at (q, v) for the whole tree; for tests. `vdot` (nv).
  void acceleration(const Model& model, const Plan& plan, const Tree& tree, const State& at,
                    const VectorX& held, VectorX& vdot);

  /// Error of a sub-step, relative to the speed of the tree, that is accepted.
  static const double kTolerance;
  /// Sub-steps tried in one step before it is given up.
  static const int kMaxSubsteps;

 private:
  struct Node {
    Matrix3 R;   ///< R_WB
    Vector3 r;   ///< origin from O [m]
    Motion S;    ///< of a joint of one dof
    Motion V;    ///< velocity about O
    Motion c;    ///< Ṡ v of the joint
    Vector6 A;   ///< acceleration less that of gravity
    Matrix6 IA;  ///< articulated inertia
    Vector6 pA;  ///< articulated bias
    Vector6 U;
    double inverse = 0.0, u = 0.0;
  };

  void derivative(const Model& model, const Plan& plan, const Tree& tree);
  void poses(const Model& model, const Tree& tree, bool coriolis);
  void rebase(const Model& model, const Tree& tree);
  void root(const Model& model, const Body& body);

  const VectorX* held_ = nullptr;
  Vector3 heldInWorld_ = Vector3::Zero();
  VectorX q_, v_;                   ///< where the sub-step began (nq), (nv)
  VectorX u_, w_;                   ///< displacement and velocity at which derivative() works (nv)
  VectorX du_, dv_;                 ///< its result
  std::array<VectorX, 7> Ku_, Kv_;  ///< stages
  std::vector<Node> nodes_;
  int substeps_ = 0;
};

}  // namespace softgauss
