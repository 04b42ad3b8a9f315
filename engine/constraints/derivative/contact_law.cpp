// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/derivative/contact_law.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss {
namespace {

/// By how much z is changed: of a distance [m], of a velocity and of an acceleration. Impedances
/// bend over a millimetre, slips over millimetres a second: the square of the ratio is what a
/// difference leaves out. Rounding is 1e-16 of accelerations of some hundred.
double stepOf(int input) {
  if (input < ContactLawDerivative::kVelocity) return 2e-8;
  return input < ContactLawDerivative::kBias ? 1e-7 : 1e-5;
}

/// Moves a point of a body at `r` from O by `linear`, and turns the body by `angular` about it.
void add(const Vector3& linear, const Vector3& angular, const Vector3& r, Motion& m) {
  m.angular += angular;
  m.linear += linear - angular.cross(r);
}

double turned(const Matrix3& from, const Matrix3& to) { return (from - to).cwiseAbs().maxCoeff(); }

/// Whether a frame that has turned by so much has done so at once: by far more than it does to the
/// other side. What slips at V > 0.5 (5.11) turns it to both, with steps of 1 ms by 1e-4 or less.
bool jumps(double turned, double toOtherSide) {
  constexpr double kJump = 1e-3, kTimes = 10.0;  // [rad]
  return turned > kJump && turned > kTimes * toOtherSide;
}

double stiffnessOf(const PyramidalContact& rows, int contact) {
  return rows.D[idx(rows.contactsWithRows()[idx(contact)].row)];
}
double stiffnessOf(const EllipticContact& rows, int contact) { return rows.cone(contact).D; }

/// Row e of a contact: what it takes of each of its directions.
ContactBlocks::FrameVector rowInFrame(const PyramidalContact& rows, const ContactRows& made,
                                      int e) {
  return rows.breakpointInFrame(made.row + e, 0);
}
ContactBlocks::FrameVector rowInFrame(const EllipticContact&, const ContactRows&, int e) {
  ContactBlocks::FrameVector frame{};
  frame[idx(e)] = 1.0;
  return frame;
}

}  // namespace

void ContactLaw::begin(const Assembly& in) {
  kinematics_ = in.kinematics;
  if (!kinematics_.hasMidstep) kinematics_.V_midstep = kinematics_.V;
  kinematics_.hasMidstep = true;
  pair_ = {};
  if (!in.state.hasAcceleration) return;
  last_.resize(in.model.bodies.size());
  moveBodies(in.model, in.kinematics, in.state.a, last_);
}

template <class Contacts>
bool ContactLaw::sample(const Assembly& in, const ContactRows& made, Contacts& rows,
                        const Inputs& by, Sample& out) {
  using L = ContactLawDerivative;
  contact_.clear();
  contact_.add(in.contacts.contacts[made.contact]);
  Contact& contact = contact_.contacts[0];
  contact.distance += by[0];
  const int body = contact.bodyB != 0 ? contact.bodyB : contact.bodyA;
  const double sign = contact.bodyB != 0 ? 1.0 : -1.0;
  Motion &V = kinematics_.V[body], &A = kinematics_.A_bias[body];
  const Motion keptV = V, keptA = A;
  const Vector3 r = contact.p_WC - kinematics_.p_WO[in.model.bodies[body].tree];
  const auto move = [&](int first, Motion& m) {
    add(sign * made.R_WC * by.template segment<3>(first),
        sign * made.R_WC * by.template segment<3>(first + 3), r, m);
  };
  move(L::kVelocity, V);
  move(L::kBias, A);
  const Assembly alone{in.model, in.state,           kinematics_,
                       contact_, in.weights,         in.tree,
                       in.input, in.midstepVelocity, in.load,
                       nullptr,  Columns::never,     in.state.hasAcceleration ? &last_ : nullptr};
  // How a contact touches that overlaps depends on its distance alone.
  const bool touchesSo = touch_ && touch_->distance < 0.0 && by[0] == 0.0;
  const std::optional<Touch> touch = touchesSo ? touch_ : touchAt(alone, 0, pair_);
  if (touch) rows.assembleOne(alone, pair_, *touch);
  V = keptV, A = keptA;
  if (!touch) return false;
  out.rows = rows.rowCount();
  if (out.rows == 0) return false;
  std::copy(rows.reference.begin(), rows.reference.end(), out.reference);
  out.D = stiffnessOf(rows, 0);
  out.R_WC = rows.contactsWithRows()[0].R_WC;
  return true;
}

template <class Contacts>
bool ContactLaw::isAffine(const Assembly& in, const Contacts& contacts, const ContactRows& made,
                          Contacts& rows, const Inputs& used) {
  using L = ContactLawDerivative;
  constexpr double kStep = 1e-6, kAlike = 1e-6;  // of rounding 1e-9 of the response
  const double* reference = contacts.reference.data() + made.row;
  Sample with;
  double gain[2] = {};  // β, γ
  for (const int which : {0, 1}) {
    Inputs by = Inputs::Zero();
    by[which == 0 ? L::kVelocity : L::kBias] = kStep;
    if (!sample(in, made, rows, by, with)) return false;
    gain[which] = (reference[0] - with.reference[0]) / kStep;
  }
  // All directions at once, none alike.
  Inputs by = Inputs::Zero();
  for (int i = L::kVelocity; i < L::kInputs; ++i)
    by[i] = used[i] * kStep * (i % 2 == 0 ? 1.0 : -1.0) * (1.0 + 0.1 * i);
  const double D = stiffnessOf(contacts, contacts.contactOfRow(made.row));
  if (!sample(in, made, rows, by, with) || std::abs(with.D - D) > 1e-12 * D ||
      (with.R_WC - made.R_WC).cwiseAbs().maxCoeff() > 1e-12)
    return false;
  L& d = derivative_;
  for (int e = 0; e < with.rows; ++e) {
    const auto row = rowInFrame(contacts, made, e);
    for (int k = 0; k < 6; ++k) {
      d.reference(e, L::kVelocity + k) = -gain[0] * row[idx(k)] * used[L::kVelocity + k];
      d.reference(e, L::kBias + k) = -gain[1] * row[idx(k)] * used[L::kBias + k];
    }
    const double expected = d.reference.row(e).dot(by), found = with.reference[e] - reference[e];
    if (!(std::abs(found - expected) <=
          kAlike * kStep * (std::abs(gain[0]) + std::abs(gain[1]) + 1.0)))
      return false;
  }
  d.rows = with.rows;
  return true;
}

void ContactLaw::difference(int input, const Sample& more, const Sample& less, double apart) {
  ContactLawDerivative& d = derivative_;
  for (int row = 0; row < more.rows; ++row)
    d.reference(row, input) = (more.reference[row] - less.reference[row]) / apart;
  d.stiffness[input] = 2.0 * (more.D - less.D) / (apart * (more.D + less.D));
  const Matrix3 turn = less.R_WC.transpose() * more.R_WC;
  d.turn.col(input) << turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1);
  d.turn.col(input) *= 0.5 / apart;
}

template <class Contacts>
const ContactLawDerivative& ContactLaw::of(const Assembly& in, const Contacts& contacts, int i,
                                           const Eigen::Matrix<double, 6, 1>& bias) {
  using L = ContactLawDerivative;
  Contacts& rows = [&]() -> Contacts& {
    if constexpr (std::same_as<Contacts, PyramidalContact>)
      return pyramid_;
    else
      return cone_;
  }();
  const ContactRows& made = contacts.contactsWithRows()[i];
  touch_ = touchAt(in, made.contact, pair_);
  L& d = derivative_;
  d.reference.setZero(), d.stiffness.setZero(), d.turn.setZero();
  const int linear = made.frictionDim > 0 ? 3 : 1, angular = std::max(0, made.frictionDim - 2);
  Inputs used = Inputs::Zero();
  used[0] = 1.0;
  for (const int first : {L::kVelocity, L::kBias})
    for (int axis = 0; axis < 6; ++axis)
      used[first + axis] = axis < 3 ? axis < linear : axis - 3 < angular;
  const int inputs = isAffine(in, contacts, made, rows, used) ? 1 : L::kInputs;
  if (inputs > 1) d.reference.setZero();
  Sample more, less;
  for (int input = 0; input < inputs; ++input) {
    if (used[input] == 0.0) continue;
    const double step = stepOf(input);
    const Inputs by = Inputs::Unit(input) * step;
    // Where the rows begin, or their frame begins to follow the slip, there is one side of it.
    bool ahead = sample(in, made, rows, by, more), behind = sample(in, made, rows, -by, less);
    const double turnsAhead = ahead ? turned(made.R_WC, more.R_WC) : 0.0,
                 turnsBehind = behind ? turned(made.R_WC, less.R_WC) : 0.0;
    ahead = ahead && !jumps(turnsAhead, turnsBehind);
    behind = behind && !jumps(turnsBehind, turnsAhead);
    if (!ahead && !behind) continue;
    if (!ahead && !sample(in, made, rows, Inputs::Zero(), more)) continue;
    if (!behind && !sample(in, made, rows, Inputs::Zero(), less)) continue;
    difference(input, more, less, (ahead ? step : 0.0) + (behind ? step : 0.0));
    d.rows = more.rows;
  }
  // A contact that is nearer has another bias, which is counted by itself.
  d.reference.col(0).noalias() -= d.reference.rightCols<6>() * bias;
  d.stiffness[0] -= d.stiffness.rightCols<6>().dot(bias);
  d.turn.col(0).noalias() -= d.turn.rightCols<6>() * bias;
  return d;
}

template const ContactLawDerivative& ContactLaw::of(const Assembly&, const PyramidalContact&, int,
                                                    const Eigen::Matrix<double, 6, 1>&);
template const ContactLawDerivative& ContactLaw::of(const Assembly&, const EllipticContact&, int,
                                                    const Eigen::Matrix<double, 6, 1>&);

}  // namespace softgauss
