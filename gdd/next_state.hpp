// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The state at the step's end as a function of the acceleration, as goals see it.
///
/// Goals act where the solve is: in the leapfrog at q_m, half a step on. With D₂ = ½ h (h of joints
/// on stiff springs, and of integrators that drift after the kick alone),
///
///   v⁺ = v + h a,   q⁺ = q_m ⊕ D₂ v⁺,   δq⁺ = B δa,   δv⁺ = h δa                           (P.7)
///
/// B = D₂ h, but for rotations of floating joints D₂ h J_r(D₂ ω⁺) (P.1).

#include "softgauss/gdd/goal.hpp"

namespace softgauss::gdd {

class NextState {
 public:
  /// Of the step of the model, or of one of `timestep` [s] from the same state, where it is not 0.
  NextState(const GoalContext& context, double timestep = 0.0) { begin(context, timestep); }
  NextState() = default;
  /// The same, in the memory it has.
  void begin(const GoalContext& context, double timestep = 0.0);

  /// q⁺ and v⁺ of a, and B there.
  void set(const VectorX& a);
  const VectorX& q() const { return q_; }
  const VectorX& v() const { return v_; }
  /// (B; h 1)ᵀ y of y (2 nv).
  VectorX pulledBack(const VectorX& y) const;
  /// (B; h 1)ᵀ Y (B; h 1) of a symmetric Y (2 nv × 2 nv).
  MatrixX pulledBack(const MatrixX& Y) const;
  /// The same; `once` is work space.
  void pullBack(const VectorX& y, VectorX& x) const;
  void pullBack(const MatrixX& Y, MatrixX& once, MatrixX& X) const;

 private:
  struct Rotation {
    int dof;
    Matrix3 B = Matrix3::Identity();
  };
  /// X ← Y (B; h 1), Y (rows × 2 nv).
  template <class Matrix>
  void multiply(const Matrix& Y, MatrixX& X) const;

  const Model* model_ = nullptr;
  VectorX middle_, velocity_;
  double h_ = 0.0;
  VectorX D2_;
  std::vector<Rotation> rotations_;
  VectorX q_, v_, drift_;
};

}  // namespace softgauss::gdd
