// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How the force of a contact on the joints, −Jᵀφ in g (1.2), changes with q and v.
///
/// Per dof j, which moves one body of the contact or both: with W the accelerations Σ S a of bodies
/// and (D.1), the bodies' motions change by δV, δW, δA, the contact's place and frame by δp and w
/// (D.6). What its rows look at, y and z = (d, ẏ, J̇ v), changes in its frame C as
///
///   δy = Cᵀ(δW(p) + W_ω × δp − w × y_W),   δẏ likewise,   δ(J̇ v) from (4.10)
///   δφ = −H (δy − ∂a_ref/∂z δz) + φ ∂D/∂z δz/D                                            (D.7)
///
/// H the curvature of its penalty, ∂/∂z from contact_law.hpp. With F the force and M the moment
/// that φ is in the world, δF = C δφ + w × F, δM likewise, and for dof i of body B (− for body A)
///
///   ∂τ_i/∂q_j = −[S_i · (δp × F + r × δF + δM, δF) + (S_j × S_i) · (r × F + M, F)]        (D.8)
///
/// the second term where j moves S_i; r is p from O. With v_j, nothing moves: δV = S_j and
/// δA_b = E_j − V_b × S_j of (2.9).

#include <utility>
#include <vector>

#include "softgauss/engine/constraints/derivative/contact_law.hpp"
#include "softgauss/engine/constraints/derivative/contact_shift.hpp"

namespace softgauss {

class ContactDerivative {
 public:
  explicit ContactDerivative(const Model& model);

  /// Adds the contacts' part of ∂g/∂q and ∂g/∂v (nv × nv) at a, at which `rows` were evaluated.
  /// Contacts of shapes that are not known here are left out and told by unknown().
  void addTo(const Assembly& in, const Constraints& rows, const VectorX& a, MatrixX& Gq,
             MatrixX& Gv);
  /// Pairs of geometries whose contacts were left out, each once.
  const std::vector<std::pair<int, int>>& unknown() const { return unknown_; }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  /// One body of the contact.
  struct Side {
    int body = 0;
    double sign = 0.0;            ///< of the force on it
    Vector3 r = Vector3::Zero();  ///< p from O
    Motion V, turning, W, A;      ///< V, that of turning, Σ S a, J̇ v
    Vector3 velocity = Vector3::Zero(), turningVelocity = Vector3::Zero();  ///< of its point at p
    Force wrench;                                                           ///< on it, about O
  };
  /// A change of the bodies' motions, and of where they touch.
  struct Column {
    PointMotion moved[2];
    Motion V[2], W[2], A[2], turning[2];
    ContactShift::Change shift;
  };
  struct Response {
    Vector3 force, moment;  ///< δF, δM
  };

  template <class Contacts>
  void addContacts(const Assembly& in, const Contacts& contacts, MatrixX& Gq, MatrixX& Gv);
  template <class Contacts>
  void addContact(const Assembly& in, const Contacts& contacts, int i, const ContactShift& shift,
                  MatrixX& Gq, MatrixX& Gv);
  void setSides(const Assembly& in, const ContactRows& made);
  void setColumn(const Assembly& in, int j, bool ofPosition, const ContactShift& shift);
  /// δ(J̇ v), world axes.
  PointMotion biasChange(const ContactShift& shift, const Contact& c, const Column& change) const;
  Response respond(const ContactShift& shift, const Contact& c, bool hasBias);
  void accumulate(const Assembly& in, int j, bool ofPosition, const Response& response, MatrixX& G);

  ContactLaw law_;
  std::vector<Motion> W_;
  std::vector<int> dofs_;  ///< that move the contact
  std::vector<std::pair<int, int>> unknown_;
  VectorX velocity_, a_;  ///< (nv) translations of floating joints
  Side side_[2];
  Column column_;
  // Of the contact in hand.
  int dim_ = 0;
  Matrix3 C_;
  Vector3 force_, moment_;                                      ///< on body B, world
  PointMotion relativeVelocity_, relativeAcceleration_, bias_;  ///< world axes
  std::optional<double> leftOut_;                               ///< ContactBias::leftOut
  Eigen::Matrix<double, 6, 6> H_;
  Eigen::Matrix<double, 6, ContactLawDerivative::kInputs> response_;  ///< ∂φ/∂z at fixed y
  Eigen::Matrix<double, 3, ContactLawDerivative::kInputs> turn_;
};

}  // namespace softgauss
