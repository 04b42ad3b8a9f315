// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How the rows of one contact change with its distance and its motion, whatever their law is.
///
/// The rows of a contact are functions of z = (d, ẏ, J̇ v), its distance, velocity and bias
/// acceleration, the latter two in its frame: references a_ref, one stiffness D, and the frame,
/// which may follow the slip. Their derivatives are taken where the law is, by making the rows of
/// that contact alone again, with one entry of z a little more and a little less: a law that
/// changes changes nothing here. Where it jumps, as a pyramid that begins to follow its slip turns
/// at once, they are those of the side on which the contact is. What else a contact looks at, loads
/// and levers, is taken as constant.

#include "softgauss/engine/constraints/constraints.hpp"

namespace softgauss {

struct ContactLawDerivative {
  static constexpr int kInputs = 13;  ///< d; ẏ of six; J̇ v of six
  static constexpr int kVelocity = 1, kBias = 7;
  static constexpr int kRows = 10;

  int rows = 0;
  Eigen::Matrix<double, kRows, kInputs> reference;  ///< ∂a_ref/∂z
  Eigen::Matrix<double, 1, kInputs> stiffness;      ///< ∂D/∂z over D
  Eigen::Matrix<double, 3, kInputs> turn;           ///< of the frame, in its axes [rad]
};

class ContactLaw {
 public:
  explicit ContactLaw(const Model& model) : kinematics_(model) {}

  /// The contacts to come are those of `in`.
  void begin(const Assembly& in);
  /// Of contact i of `contacts`, in whose derivative by d the bias stays: `bias` is ∂J̇ v/∂d in the
  /// frame of the contact.
  template <class Contacts>
  const ContactLawDerivative& of(const Assembly& in, const Contacts& contacts, int i,
                                 const Eigen::Matrix<double, 6, 1>& bias);

 private:
  struct Sample {
    int rows = 0;
    double reference[ContactLawDerivative::kRows];
    double D = 0.0;
    Matrix3 R_WC;
  };
  using Inputs = Eigen::Matrix<double, ContactLawDerivative::kInputs, 1>;
  /// The rows with z more by `by`; false where there are none.
  template <class Contacts>
  bool sample(const Assembly& in, const ContactRows& made, Contacts& rows, const Inputs& by,
              Sample& out);
  /// Fills the columns of ẏ and J̇ v where they are those of a spring and damper alone; else false.
  template <class Contacts>
  bool isAffine(const Assembly& in, const Contacts& contacts, const ContactRows& made,
                Contacts& rows, const Inputs& used);
  /// Column `input` of the derivative, from two samples `apart`.
  void difference(int input, const Sample& more, const Sample& less, double apart);

  Kinematics kinematics_;
  std::vector<Motion> last_;  ///< (bodies) by State::a
  ContactSet contact_;
  PairSurface pair_;
  std::optional<Touch> touch_;  ///< of the contact in hand
  PyramidalContact pyramid_;
  EllipticContact cone_;
  ContactLawDerivative derivative_;
};

}  // namespace softgauss
