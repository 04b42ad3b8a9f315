// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How the leapfrog's step from (q, v) by a given a changes with all three: exact, for (6.2) is
/// linear but for rotations.
///
///   q_m = q ⊕ D₁ v,   v⁺ = v + h a,   q⁺ = q_m ⊕ D₂ v⁺,   D₁ = D₂ = ½ h
///
/// (joints on stiff springs do not drift before the solve: D₁ = 0, D₂ = h). By tangents,
///
///   δq⁺ = A_q δq + A_v δv + B δa,   δv⁺ = δv + h δa                                        (P.1)
///
/// with the scalars 1, h, D₂ h, but for the rotations of floating joints, where with φ₁ = D₁ ω,
/// φ₂ = D₂ ω⁺, E(φ) the rotation by φ and J_r its right Jacobian
///
///   A_q = E(−φ₂) E(−φ₁),   A_v = E(−φ₂) D₁ J_r(φ₁) + D₂ J_r(φ₂),   B = D₂ h J_r(φ₂)
///   δq_m = E(−φ₁) δq + D₁ J_r(φ₁) δv                                                       (P.2)
///
/// So products with A and B cost O(n²).

#include <vector>

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// J_r(φ): exp(φ + δ) = exp(φ) exp(J_r δ) to first order.
Matrix3 rightJacobian(const Vector3& phi);

class Transition {
 public:
  struct Rotation {
    int dof = 0;  ///< the first of three
    Matrix3 A_q, A_v, B;
    Matrix3 middleByPosition, middleByVelocity;  ///< of (P.2)
  };

  explicit Transition(const Data& data, const Model& model);

  /// At the velocity v and the acceleration a (nv).
  void set(const VectorX& v, const VectorX& a);

  double timestep() const { return h_; }
  const std::vector<Rotation>& rotations() const { return rotations_; }
  const VectorX& drift() const { return D1_; }          ///< D₁ of each dof (nv) [s]
  const VectorX& byAcceleration() const { return B_; }  ///< D₂ h (nv) [s²]

  /// (δq⁺, δv⁺) of (δq, δv) and δa; x, next (2 nv), da (nv); next is not x.
  void next(const VectorX& x, const VectorX& da, VectorX& next) const;
  /// VA ← V A and VB ← V B of V (rows × 2 nv).
  template <class In, class OutA, class OutB>
  void multiply(const In& V, OutA& VA, OutB& VB) const {
    const Eigen::Index n = D1_.size();
    VA.leftCols(n) = V.leftCols(n);
    VA.rightCols(n) = V.rightCols(n) + h_ * V.leftCols(n);
    VB.noalias() = V.leftCols(n) * B_.asDiagonal();
    VB += h_ * V.rightCols(n);
    for (const Rotation& r : rotations_) {
      const auto v = V.template middleCols<3>(r.dof);
      VA.template middleCols<3>(r.dof).noalias() = v * r.A_q;
      VA.template middleCols<3>(n + r.dof) = V.template middleCols<3>(n + r.dof);
      VA.template middleCols<3>(n + r.dof).noalias() += v * r.A_v;
      VB.template middleCols<3>(r.dof) = h_ * V.template middleCols<3>(n + r.dof);
      VB.template middleCols<3>(r.dof).noalias() += v * r.B;
    }
  }
  /// AX ← Aᵀ X of X (2 nv × columns).
  template <class In, class Out>
  void multiplyByATransposed(const In& X, Out& AX) const {
    const Eigen::Index n = D1_.size();
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      const auto q = X.col(j).head(n), v = X.col(j).tail(n);
      AX.col(j).head(n) = q;
      AX.col(j).tail(n) = v + h_ * q;
      for (const Rotation& r : rotations_) {
        const Vector3 rq = q.template segment<3>(r.dof), rv = v.template segment<3>(r.dof);
        AX.col(j).template segment<3>(r.dof) = r.A_q.transpose() * rq;
        AX.col(j).template segment<3>(n + r.dof) = rv + r.A_v.transpose() * rq;
      }
    }
  }
  /// BX ← Bᵀ X of X (2 nv × columns).
  template <class In, class Out>
  void multiplyByBTransposed(const In& X, Out& BX) const {
    const Eigen::Index n = D1_.size();
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      const auto q = X.col(j).head(n), v = X.col(j).tail(n);
      BX.col(j) = B_.cwiseProduct(q) + h_ * v;
      for (const Rotation& r : rotations_) {
        const Vector3 rq = q.template segment<3>(r.dof), rv = v.template segment<3>(r.dof);
        BX.col(j).template segment<3>(r.dof) = r.B.transpose() * rq + h_ * rv;
      }
    }
  }
  /// Derivatives by q_m and v → by q and v: Gq ← Gq ∂q_m/∂q, Gv ← Gv + Gq ∂q_m/∂v (rows × nv).
  template <class Q, class V>
  void fromMiddle(Q& Gq, V& Gv) const {
    Gv.noalias() += Gq * D1_.asDiagonal();
    for (const Rotation& r : rotations_) {
      const Matrix3 byVelocity = r.middleByVelocity - D1_[r.dof] * Matrix3::Identity();
      for (Eigen::Index i = 0; i < Gq.rows(); ++i) {
        const Eigen::RowVector3d g = Gq.row(i).template segment<3>(r.dof);
        Gv.row(i).template segment<3>(r.dof) += g * byVelocity;
        Gq.row(i).template segment<3>(r.dof) = g * r.middleByPosition;
      }
    }
  }
  /// (q, v) moved on by a: q to q_m and on to q⁺, v to v⁺.
  void toMiddle(const Model& model, const VectorX& v, VectorX& q) const;
  void move(const Model& model, const VectorX& a, VectorX& q, VectorX& v) const;

 private:
  double h_;
  VectorX D1_, B_;
  mutable VectorX scaled_;
  std::vector<Rotation> rotations_;
};

}  // namespace softgauss
