// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How the forces of joint limits and dry friction change with q and v.
///
/// A row is of one joint i, and its reference and stiffness are functions of r and ẋ of that joint,
///
///   ∂f/∂q_i = h ∂a_ref/∂q_i + f (∂D/∂q_i)/D,   h = s″                                     (D.5)
///
/// where h > 0, else 0, and likewise of v. The derivatives are taken where the law is, by making
/// the rows again with all joints a little farther and a little less far, so that a law that
/// changes changes nothing here.
///
/// A limit that carries more than it feels has D ∝ I of the inertia I that the joint bears (5.4),
/// and that depends on the joints beyond it. With M_ii of (2.3), for j below i,
///
///   ∂M_ii/∂q_j = 2 (S_i × S_j)·(I^c_j S_i)                                                 (D.2)

#include "softgauss/engine/constraints/constraints.hpp"
#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

class ScalarRowDerivative {
 public:
  explicit ScalarRowDerivative(const Model& model);

  /// Adds the part of ∂g/∂q and ∂g/∂v (nv × nv) of the rows of `rows`, evaluated at some a.
  void addTo(const Assembly& in, const Constraints& rows, const MassMatrix& inertia, MatrixX& Gq,
             MatrixX& Gv);

 private:
  template <class Rows>
  void add(const Assembly& in, const Rows& rows, Rows& more, Rows& less, bool ofPosition,
           MatrixX& G);
  void addBorneInertia(const Assembly& in, const JointLimit& rows, const MassMatrix& inertia,
                       MatrixX& Gq);
  /// gradient_ ← gradient_ + scale · ∂I/∂q of what the joint of `body` bears; returns I. What its
  /// own coordinate does to the slopes of couplings is left out: its rows are made with that.
  double addInertiaGradient(const Assembly& in, const MassMatrix& inertia, int body, double scale);

  State state_;
  InverseWeights weights_;
  JointLimit limitMore_, limitLess_;
  DryFriction frictionMore_, frictionLess_;
  ServoDrive servoMore_, servoLess_;
  VectorX gradient_;
};

}  // namespace softgauss
