// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/derivative/contact_derivative.hpp"

#include <algorithm>

#include "softgauss/engine/constraints/contact_motion.hpp"
#include "softgauss/engine/dynamics/coriolis_matrix.hpp"
#include "softgauss/engine/dynamics/motion_derivative.hpp"

namespace softgauss {
namespace {

Vector3 at(const Motion& m, const Vector3& r) { return m.linear + m.angular.cross(r); }

/// ∂a_ref/∂z of a pyramid's edges or a cone's rows → ∂φ/∂z at fixed y and D.
template <class Contacts, class Reference>
Eigen::Matrix<double, 6, ContactLawDerivative::kInputs> pushed(const Contacts& contacts,
                                                               const ContactRows& made, int dim,
                                                               const Eigen::Matrix<double, 6, 6>& H,
                                                               const Reference& reference) {
  Eigen::Matrix<double, 6, ContactLawDerivative::kInputs> response;
  response.setZero();
  if constexpr (std::same_as<Contacts, EllipticContact>) {
    response.topRows(dim).noalias() = H.topLeftCorner(dim, dim) * reference.topRows(dim);
  } else {
    const int edges = std::max(1, 2 * made.frictionDim);
    for (int e = 0; e < edges; ++e) {
      const double curvature = contacts.h[idx(made.row + e)];
      if (curvature == 0.0) continue;
      const auto frame = contacts.breakpointInFrame(made.row + e, 0);
      for (int k = 0; k < dim; ++k)
        if (frame[idx(k)] != 0.0) response.row(k) += curvature * frame[idx(k)] * reference.row(e);
    }
  }
  return response;
}

}  // namespace

ContactDerivative::ContactDerivative(const Model& model)
    : law_(model),
      W_(model.bodies.size()),
      velocity_(VectorX::Zero(model.nv)),
      a_(VectorX::Zero(model.nv)) {
  dofs_.reserve(2 * model.dofs.size());
  columns_.reserve(2 * model.dofs.size());
}

void ContactDerivative::addTo(const Assembly& in, const Constraints& rows, const VectorX& a,
                              const Measure& measure, MatrixX& Gq, MatrixX& Gv) {
  if (rows.contact.rowCount() == 0 && rows.ellipticContact.rowCount() == 0) return;
  const Model& model = in.model;
  a_ = a;
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    W_[b] = W_[body.parent];
    for (int i = body.v; i < body.v + body.dofs; ++i) W_[b] += in.kinematics.S[i] * a[i];
  }
  law_.begin(in);
  rows.visitContacts([&](const auto& contacts) { addContacts(in, contacts, measure, Gq, Gv); });
}

template <class Contacts>
void ContactDerivative::addContacts(const Assembly& in, const Contacts& contacts,
                                    const Measure& measure, MatrixX& Gq, MatrixX& Gv) {
  const auto& made = contacts.contactsWithRows();
  for (int i = 0; i < static_cast<int>(made.size()); ++i) {
    const auto isOfPair = [&](int other) {
      return made[other].bodyA == made[i].bodyA && made[other].bodyB == made[i].bodyB;
    };
    if (i == 0 || !isOfPair(i - 1)) beginPair(in, made[i].bodyA, made[i].bodyB);
    const int contact = made[i].contact;
    const Contact& c = in.contacts.contacts[contact];
    auto shift = ContactShift::of(in.model, in.kinematics, c, made[i].alongGravity);
    if (!shift)
      shift = ContactShift::of(in.model, in.kinematics, c, made[i].alongGravity, measure(contact));
    addContact(in, contacts, i, *shift);
    if (i + 1 == static_cast<int>(made.size()) || !isOfPair(i + 1)) endPair(in, Gq, Gv);
  }
}

void ContactDerivative::beginPair(const Assembly& in, int bodyA, int bodyB) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  dofs_.clear();
  for (const int o : {0, 1}) {
    Side& side = side_[o];
    side = {};
    side.body = o == 0 ? bodyA : bodyB;
    side.sign = o == 0 ? -1.0 : 1.0;
    if (side.body == 0) continue;
    side.V = k.V[side.body];
    side.turning = k.midstepVelocities()[side.body];
    side.W = W_[side.body];
    side.A = k.A_bias[side.body];
    for (int j = model.lastDof(side.body); j >= 0; j = model.dofs[j].parent) dofs_.push_back(j);
  }
  std::sort(dofs_.begin(), dofs_.end());
  dofs_.erase(std::unique(dofs_.begin(), dofs_.end()), dofs_.end());
  columns_.clear();
  for (const int j : dofs_)
    for (const bool ofPosition : {true, false}) {
      Column& column = columns_.emplace_back();
      column.dof = j, column.ofPosition = ofPosition;
      setColumn(in, column);
    }
}

void ContactDerivative::setColumn(const Assembly& in, Column& column) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  const int j = column.dof;
  const Motion& S = k.S[j];
  const int b = model.dofs[j].body;
  const Body& body = model.bodies[b];
  const bool floats = body.joint == JointKind::floating, translates = floats && j - body.v < 3;
  const auto against = [&](const std::vector<Motion>& X, const VectorX& translation) {
    return motionAgainst(model, j, X, {}, translation);
  };
  for (const int o : {0, 1}) {
    const Side& side = side_[o];
    if (side.body < b || side.body >= body.subtreeEnd) continue;
    if (!column.ofPosition) {
      column.V[o] = column.turning[o] = S;
      column.A[o] = coriolisRate(translates, floats && !translates, S, k.midstepVelocities()[b]) -
                    cross(side.turning, S);
      continue;
    }
    column.moves[o] = true;
    if (floats) velocity_.segment<3>(body.v) = k.V[b].linear;
    column.V[o] = cross(S, side.V - against(k.V, velocity_));
    column.W[o] = cross(S, side.W - against(W_, a_));
    if (floats) velocity_.segment<3>(body.v) = k.midstepVelocities()[b].linear;
    const Motion turnsAgainst = against(k.midstepVelocities(), velocity_);
    // A floating joint's bias is that of its rotations.
    const Motion A = floats ? Motion{} : k.A_bias[body.parent];
    column.turning[o] = cross(S, side.turning - turnsAgainst);
    column.A[o] = cross(S, side.A - A) + cross(cross(turnsAgainst, S), side.turning - turnsAgainst);
  }
}

void ContactDerivative::endPair(const Assembly& in, MatrixX& Gq, MatrixX& Gv) {
  const Model& model = in.model;
  const std::vector<Motion>& S = in.kinematics.S;
  for (const Column& column : columns_) {
    const int j = column.dof;
    MatrixX& G = column.ofPosition ? Gq : Gv;
    for (const int o : {0, 1}) {
      const Side& side = side_[o];
      if (side.body == 0) continue;
      const Force& change = column.change[o];
      const Force carried = column.moves[o] ? change - crossForce(S[j], side.wrench) : change;
      for (int i = model.lastDof(side.body); i >= 0; i = model.dofs[i].parent)
        G(i, j) -= dot(S[i], column.moves[o] && movesAxis(model, j, i) ? carried : change);
    }
  }
}

PointMotion ContactDerivative::biasChange(const ContactShift& shift, const Contact& c,
                                          const Column& column, const Seen& seen) const {
  const Side &A = side_[0], &B = side_[1];
  const int flat = shift.flatIsA() ? 0 : 1, other = 1 - flat;
  const Vector3 dp = seen.shift.p, n = shift.normal();
  const double d = shift.distance(), sign = shift.flatIsA() ? 1.0 : -1.0;
  const Vector3 dn = sign * seen.shift.n;
  Vector3 dv[2], da[2];
  for (const int o : {0, 1}) {
    dv[o] = at(column.turning[o], side_[o].r) + side_[o].turning.angular.cross(dp);
    da[o] = at(column.A[o], side_[o].r) + side_[o].A.angular.cross(dp);
  }
  const Vector3 turns = B.turning.angular - A.turning.angular,
                dTurns = column.turning[1].angular - column.turning[0].angular;
  const Vector3 slips = B.turningVelocity - A.turningVelocity, dSlips = dv[1] - dv[0];
  const Vector3 omega = sign * turns, dOmega = sign * dTurns;  // of O against F
  const double rate = c.n_W.dot(slips), dRate = seen.shift.n.dot(slips) + c.n_W.dot(dSlips);
  const Vector3 pdot =
      side_[other].turningVelocity + shift.along(omega) + 0.5 * d * omega.cross(n) - 0.5 * rate * n;
  const Vector3 dPdot =
      dv[other] + shift.alongChange(omega, dOmega, dn, seen.moved[other], dp, seen.shift.distance) +
      0.5 * (seen.shift.distance * omega.cross(n) + d * (dOmega.cross(n) + omega.cross(dn))) -
      0.5 * (dRate * n + rate * dn);
  const Vector3 &wF = side_[flat].turning.angular, &dwF = column.turning[flat].angular;
  PointMotion bias = {
      da[1] - da[0] + dTurns.cross(pdot) + turns.cross(dPdot) - dwF.cross(slips) - wF.cross(dSlips),
      column.A[1].angular - column.A[0].angular - dwF.cross(turns) - wF.cross(dTurns)};
  if (leftOut_)  // b − n (n·b)
    bias.linear -= *leftOut_ * seen.shift.n +
                   (seen.shift.n.dot(bias_.linear) + c.n_W.dot(bias.linear)) * c.n_W;
  return bias;
}

ContactDerivative::Response ContactDerivative::respond(const ContactShift& shift, const Contact& c,
                                                       const Column& column,
                                                       const Seen& seen) const {
  const ContactShift::Change& s = seen.shift;
  const auto relative = [&](const Motion* change, const Motion& A, const Motion& B) {
    return PointMotion{
        at(change[1], side_[1].r) - at(change[0], side_[0].r) + (B.angular - A.angular).cross(s.p),
        change[1].angular - change[0].angular};
  };
  const auto against = [](const PointMotion& change, const PointMotion& of, const Vector3& turn) {
    Vector6 x;
    x << change.linear - turn.cross(of.linear), change.angular - turn.cross(of.angular);
    return x;
  };
  Eigen::Matrix<double, ContactLawDerivative::kInputs, 1> z;
  z[0] = s.distance;
  z.segment<6>(ContactLawDerivative::kVelocity) =
      against(relative(column.V, side_[0].V, side_[1].V), relativeVelocity_, s.turn);
  z.tail<6>().setZero();
  if (hasBias_) z.tail<6>() = against(biasChange(shift, c, column, seen), bias_, s.turn);
  Vector3 turn = s.turn;
  if (isTurned_) turn.noalias() += turn_ * z;
  const Vector6 y =
      against(relative(column.W, side_[0].W, side_[1].W), relativeAcceleration_, turn);
  Vector6 phi;
  phi.noalias() = response_ * z;
  phi.noalias() -= H_ * y;
  return {phi.head<3>() + turn.cross(force_), phi.tail<3>() + turn.cross(moment_)};
}

void ContactDerivative::setPlace(const Assembly& in, const Vector3& p_WC) {
  for (Side& side : side_) {
    if (side.body == 0) continue;
    side.r = p_WC - in.kinematics.p_WO[in.model.bodies[side.body].tree];
    side.velocity = at(side.V, side.r);
    side.turningVelocity = at(side.turning, side.r);
    side.wrench += {side.sign * (side.r.cross(force_) + moment_), side.sign * force_};
  }
  relativeVelocity_ = {side_[1].velocity - side_[0].velocity,
                       side_[1].V.angular - side_[0].V.angular};
  relativeAcceleration_ = {at(side_[1].W, side_[1].r) - at(side_[0].W, side_[0].r),
                           side_[1].W.angular - side_[0].W.angular};
}

template <class Contacts>
void ContactDerivative::setLaw(const Assembly& in, const Contacts& contacts, int i, int dim,
                               const ContactShift& shift) {
  using L = ContactLawDerivative;
  const ContactRows& made = contacts.contactsWithRows()[i];
  const Contact& c = in.contacts.contacts[made.contact];
  const auto phi = contacts.frameForce(i);
  bias_ = {};
  leftOut_.reset();
  PointMotion byDistance;
  std::optional<ContactBias> bias;
  if (shift.hasFlat()) bias = contactBias(in.model, in.kinematics, c);
  hasBias_ = bias.has_value();
  if (bias) {
    bias_ = {bias->rate.linear, bias->rate.angular};
    leftOut_ = bias->leftOut;
    Seen nearer;
    nearer.shift.distance = 1.0;
    byDistance = biasChange(shift, c, {}, nearer);
  }
  const Matrix3& C = made.R_WC;
  Vector6 inFrame;
  inFrame << C.transpose() * byDistance.linear, C.transpose() * byDistance.angular;
  const L& law = law_.of(in, contacts, i, inFrame);
  response_ = pushed(contacts, made, dim, H_, law.reference);
  for (int k = 0; k < dim; ++k) response_.row(k) += phi[idx(k)] * law.stiffness;
  // Into world axes.
  Matrix6 R = Matrix6::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = C;
  H_ = R * H_ * R.transpose();
  response_ = R * response_;
  isTurned_ = !law.turn.isZero(0.0);
  turn_ = C * law.turn;
  for (const int first : {L::kVelocity, L::kBias}) {
    response_.middleCols<6>(first) = response_.middleCols<6>(first) * R.transpose();
    turn_.middleCols<6>(first) = turn_.middleCols<6>(first) * R.transpose();
  }
}

template <class Contacts>
void ContactDerivative::addContact(const Assembly& in, const Contacts& contacts, int i,
                                   const ContactShift& shift) {
  const Contact& c = in.contacts.contacts[contacts.contactsWithRows()[i].contact];
  double H[36];
  const int dim = contacts.frameCurvature(i, H);
  H_.setZero();
  for (int row = 0; row < dim; ++row)
    for (int col = 0; col < dim; ++col) H_(row, col) = H[row * dim + col];
  if (H_.isZero(0.0)) return;
  const auto phi = contacts.frameForce(i);
  force_ = contacts.linearInWorld(i, phi);
  moment_ = contacts.angularInWorld(i, phi);
  setPlace(in, c.p_WC);
  setLaw(in, contacts, i, dim, shift);
  for (Column& column : columns_) {
    const Motion& S = in.kinematics.S[column.dof];
    Seen seen;
    for (const int o : {0, 1})
      if (column.moves[o]) seen.moved[o] = {at(S, side_[o].r), S.angular};
    if (column.ofPosition) seen.shift = shift.change(seen.moved[0], seen.moved[1]);
    const Response response = respond(shift, c, column, seen);
    for (const int o : {0, 1}) {
      const Side& side = side_[o];
      const Vector3 lever = column.ofPosition ? seen.shift.p : Vector3(Vector3::Zero());
      column.change[o] +=
          {side.sign * (side.r.cross(response.force) + response.moment + lever.cross(force_)),
           side.sign * response.force};
    }
  }
}

}  // namespace softgauss
