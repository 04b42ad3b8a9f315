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

#include <functional>
#include <vector>

#include "softgauss/engine/constraints/derivative/contact_law.hpp"
#include "softgauss/engine/constraints/derivative/contact_shift.hpp"

namespace softgauss {

class ContactDerivative {
 public:
  explicit ContactDerivative(const Model& model);

  /// How a contact of in.contacts moves whose pair of shapes has no closed form.
  using Measure = std::function<ContactShift::Measured(int contact)>;

  /// Adds the contacts' part of ∂g/∂q and ∂g/∂v (nv × nv) at a, at which `rows` were evaluated.
  void addTo(const Assembly& in, const Constraints& rows, const VectorX& a, const Measure& measure,
             MatrixX& Gq, MatrixX& Gv);

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using ByInputs = Eigen::Matrix<double, 6, ContactLawDerivative::kInputs>;
  /// One body of the contact. Spatial vectors are about O of its tree.
  struct Side {
    int body = 0;
    double sign = 0.0;        ///< of the force on it
    Motion V, turning, W, A;  ///< V, that of turning, Σ S a, J̇ v
    Force wrench;             ///< on it, by all contacts of the pair
    // Of the contact in hand.
    Vector3 r = Vector3::Zero();                                            ///< p from O
    Vector3 velocity = Vector3::Zero(), turningVelocity = Vector3::Zero();  ///< of its point at p
  };
  /// How the motions of the two bodies change with q or v of one dof, and how the forces on them.
  struct Column {
    int dof = 0;
    bool ofPosition = true, moves[2] = {false, false};
    Motion V[2], W[2], A[2], turning[2];
    Force change[2];
  };
  /// A change as a contact sees it.
  struct Seen {
    PointMotion moved[2];
    ContactShift::Change shift;
  };
  struct Response {
    Vector3 force, moment;  ///< δF, δM
  };

  template <class Contacts>
  void addContacts(const Assembly& in, const Contacts& contacts, const Measure& measure,
                   MatrixX& Gq, MatrixX& Gv);
  /// The bodies of the contacts to come, and their columns.
  void beginPair(const Assembly& in, int bodyA, int bodyB);
  void setColumn(const Assembly& in, Column& column);
  /// Adds what the contacts of the pair make of its columns to G.
  void endPair(const Assembly& in, MatrixX& Gq, MatrixX& Gv);
  template <class Contacts>
  void addContact(const Assembly& in, const Contacts& contacts, int i, const ContactShift& shift);
  void setPlace(const Assembly& in, const Vector3& p_WC);
  /// What the law of a contact of `dim` directions gives, in world axes: H_ becomes so too.
  template <class Contacts>
  void setLaw(const Assembly& in, const Contacts& contacts, int i, int dim,
              const ContactShift& shift);
  /// δ(J̇ v), world axes.
  PointMotion biasChange(const ContactShift& shift, const Contact& c, const Column& column,
                         const Seen& seen) const;
  Response respond(const ContactShift& shift, const Contact& c, const Column& column,
                   const Seen& seen) const;

  ContactLaw law_;
  std::vector<Motion> W_;
  std::vector<int> dofs_;        ///< that move the pair
  std::vector<Column> columns_;  ///< of each of them by q and by v
  VectorX velocity_, a_;         ///< (nv) translations of floating joints
  Side side_[2];
  // Of the contact in hand.
  bool isTurned_ = false, hasBias_ = false;
  Vector3 force_, moment_;                                      ///< on body B, world
  PointMotion relativeVelocity_, relativeAcceleration_, bias_;  ///< world axes
  std::optional<double> leftOut_;                               ///< ContactBias::leftOut
  // In world axes: H, ∂φ/∂z at fixed y, and what the frame turns by with z.
  Matrix6 H_;
  ByInputs response_;
  Eigen::Matrix<double, 3, ContactLawDerivative::kInputs> turn_;
};

}  // namespace softgauss
