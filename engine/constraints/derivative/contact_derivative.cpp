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
}

void ContactDerivative::addTo(const Assembly& in, const Constraints& rows, const VectorX& a,
                              MatrixX& Gq, MatrixX& Gv) {
  unknown_.clear();
  if (rows.contact.rowCount() == 0 && rows.ellipticContact.rowCount() == 0) return;
  const Model& model = in.model;
  a_ = a;
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    W_[b] = W_[body.parent];
    for (int i = body.v; i < body.v + body.dofs; ++i) W_[b] += in.kinematics.S[i] * a[i];
  }
  law_.begin(in);
  rows.visitContacts([&](const auto& contacts) { addContacts(in, contacts, Gq, Gv); });
}

template <class Contacts>
void ContactDerivative::addContacts(const Assembly& in, const Contacts& contacts, MatrixX& Gq,
                                    MatrixX& Gv) {
  for (int i = 0; i < static_cast<int>(contacts.contactsWithRows().size()); ++i) {
    const ContactRows& made = contacts.contactsWithRows()[i];
    const Contact& c = in.contacts.contacts[made.contact];
    if (const auto shift = ContactShift::of(in.model, in.kinematics, c, made.alongGravity)) {
      addContact(in, contacts, i, *shift, Gq, Gv);
      continue;
    }
    const std::pair pair(made.geometryA, made.geometryB);
    if (std::find(unknown_.begin(), unknown_.end(), pair) == unknown_.end())
      unknown_.push_back(pair);
  }
}

void ContactDerivative::setSides(const Assembly& in, const ContactRows& made) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  const Vector3& p = in.contacts.contacts[made.contact].p_WC;
  dofs_.clear();
  for (const int o : {0, 1}) {
    Side& side = side_[o];
    side = {};
    side.body = o == 0 ? made.bodyA : made.bodyB;
    side.sign = o == 0 ? -1.0 : 1.0;
    if (side.body == 0) continue;
    side.r = p - k.p_WO[model.bodies[side.body].tree];
    side.V = k.V[side.body];
    side.turning = k.midstepVelocities()[side.body];
    side.W = W_[side.body];
    side.A = k.A_bias[side.body];
    side.velocity = at(side.V, side.r);
    side.turningVelocity = at(side.turning, side.r);
    side.wrench = {side.sign * (side.r.cross(force_) + moment_), side.sign * force_};
    for (int j = model.lastDof(side.body); j >= 0; j = model.dofs[j].parent) dofs_.push_back(j);
  }
  std::sort(dofs_.begin(), dofs_.end());
  dofs_.erase(std::unique(dofs_.begin(), dofs_.end()), dofs_.end());
  relativeVelocity_ = {side_[1].velocity - side_[0].velocity,
                       side_[1].V.angular - side_[0].V.angular};
  relativeAcceleration_ = {at(side_[1].W, side_[1].r) - at(side_[0].W, side_[0].r),
                           side_[1].W.angular - side_[0].W.angular};
}

void ContactDerivative::setColumn(const Assembly& in, int j, bool ofPosition,
                                  const ContactShift& shift) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  const Motion& S = k.S[j];
  column_ = {};
  const int b = model.dofs[j].body;
  const Body& body = model.bodies[b];
  const bool floats = body.joint == JointKind::floating, translates = floats && j - body.v < 3;
  const auto against = [&](const std::vector<Motion>& X, const VectorX& translation) {
    return motionAgainst(model, j, X, {}, translation);
  };
  for (const int o : {0, 1}) {
    const Side& side = side_[o];
    if (side.body < b || side.body >= body.subtreeEnd) continue;
    if (!ofPosition) {
      column_.V[o] = column_.turning[o] = S;
      column_.A[o] = coriolisRate(translates, floats && !translates, S, k.midstepVelocities()[b]) -
                     cross(side.turning, S);
      continue;
    }
    column_.moved[o] = {at(S, side.r), S.angular};
    if (floats) velocity_.segment<3>(body.v) = k.V[b].linear;
    column_.V[o] = cross(S, side.V - against(k.V, velocity_));
    column_.W[o] = cross(S, side.W - against(W_, a_));
    if (floats) velocity_.segment<3>(body.v) = k.midstepVelocities()[b].linear;
    const Motion turnsAgainst = against(k.midstepVelocities(), velocity_);
    // A floating joint's bias is that of its rotations.
    const Motion A = floats ? Motion{} : k.A_bias[body.parent];
    column_.turning[o] = cross(S, side.turning - turnsAgainst);
    column_.A[o] =
        cross(S, side.A - A) + cross(cross(turnsAgainst, S), side.turning - turnsAgainst);
  }
  if (ofPosition) column_.shift = shift.change(column_.moved[0], column_.moved[1]);
}

PointMotion ContactDerivative::biasChange(const ContactShift& shift, const Contact& c,
                                          const Column& change) const {
  const Side &A = side_[0], &B = side_[1];
  const int flat = shift.flatIsA() ? 0 : 1, other = 1 - flat;
  const Vector3 dp = change.shift.p, n = shift.normal();
  const double d = shift.distance(), sign = shift.flatIsA() ? 1.0 : -1.0;
  const Vector3 dn = sign * change.shift.n;
  Vector3 dv[2], da[2];
  for (const int o : {0, 1}) {
    dv[o] = at(change.turning[o], side_[o].r) + side_[o].turning.angular.cross(dp);
    da[o] = at(change.A[o], side_[o].r) + side_[o].A.angular.cross(dp);
  }
  const Vector3 turns = B.turning.angular - A.turning.angular,
                dTurns = change.turning[1].angular - change.turning[0].angular;
  const Vector3 slips = B.turningVelocity - A.turningVelocity, dSlips = dv[1] - dv[0];
  const Vector3 omega = sign * turns, dOmega = sign * dTurns;  // of O against F
  const double rate = c.n_W.dot(slips), dRate = change.shift.n.dot(slips) + c.n_W.dot(dSlips);
  const Vector3 pdot =
      side_[other].turningVelocity + shift.along(omega) + 0.5 * d * omega.cross(n) - 0.5 * rate * n;
  const Vector3 dPdot =
      dv[other] +
      shift.alongChange(omega, dOmega, dn, change.moved[other], dp, change.shift.distance) +
      0.5 * (change.shift.distance * omega.cross(n) + d * (dOmega.cross(n) + omega.cross(dn))) -
      0.5 * (dRate * n + rate * dn);
  const Vector3 &wF = side_[flat].turning.angular, &dwF = change.turning[flat].angular;
  PointMotion bias = {
      da[1] - da[0] + dTurns.cross(pdot) + turns.cross(dPdot) - dwF.cross(slips) - wF.cross(dSlips),
      change.A[1].angular - change.A[0].angular - dwF.cross(turns) - wF.cross(dTurns)};
  if (leftOut_)  // b − n (n·b)
    bias.linear -= *leftOut_ * change.shift.n +
                   (change.shift.n.dot(bias_.linear) + c.n_W.dot(bias.linear)) * c.n_W;
  return bias;
}

ContactDerivative::Response ContactDerivative::respond(const ContactShift& shift, const Contact& c,
                                                       bool hasBias) {
  const ContactShift::Change& s = column_.shift;
  const auto relative = [&](const Motion* change, const Motion& A, const Motion& B) {
    return PointMotion{
        at(change[1], side_[1].r) - at(change[0], side_[0].r) + (B.angular - A.angular).cross(s.p),
        change[1].angular - change[0].angular};
  };
  const auto inFrame = [&](const PointMotion& change, const PointMotion& of, const Vector3& turn) {
    Vector6 x;
    x << C_.transpose() * (change.linear - turn.cross(of.linear)),
        C_.transpose() * (change.angular - turn.cross(of.angular));
    return x;
  };
  Eigen::Matrix<double, ContactLawDerivative::kInputs, 1> z;
  z[0] = s.distance;
  z.segment<6>(ContactLawDerivative::kVelocity) =
      inFrame(relative(column_.V, side_[0].V, side_[1].V), relativeVelocity_, s.turn);
  z.tail<6>().setZero();
  if (hasBias) z.tail<6>() = inFrame(biasChange(shift, c, column_), bias_, s.turn);
  const Vector3 turn = s.turn + C_ * (turn_ * z);
  const Vector6 y =
      inFrame(relative(column_.W, side_[0].W, side_[1].W), relativeAcceleration_, turn);
  Vector6 phi = response_ * z;
  phi.noalias() -= H_ * y;
  return {C_ * phi.head<3>() + turn.cross(force_), C_ * phi.tail<3>() + turn.cross(moment_)};
}

void ContactDerivative::accumulate(const Assembly& in, int j, bool ofPosition,
                                   const Response& response, MatrixX& G) {
  const Model& model = in.model;
  const std::vector<Motion>& S = in.kinematics.S;
  const Body& body = model.bodies[model.dofs[j].body];
  for (const Side& side : side_) {
    if (side.body == 0) continue;
    Force change{side.sign * (side.r.cross(response.force) + response.moment),
                 side.sign * response.force};
    if (ofPosition) change.moment += side.sign * column_.shift.p.cross(force_);
    const bool moves = ofPosition && side.body >= model.dofs[j].body && side.body < body.subtreeEnd;
    const Force carried = moves ? change - crossForce(S[j], side.wrench) : change;
    for (int i = model.lastDof(side.body); i >= 0; i = model.dofs[i].parent)
      G(i, j) -= dot(S[i], moves && movesAxis(model, j, i) ? carried : change);
  }
}

template <class Contacts>
void ContactDerivative::addContact(const Assembly& in, const Contacts& contacts, int i,
                                   const ContactShift& shift, MatrixX& Gq, MatrixX& Gv) {
  const ContactRows& made = contacts.contactsWithRows()[i];
  const Contact& c = in.contacts.contacts[made.contact];
  double H[36];
  dim_ = contacts.frameCurvature(i, H);
  if (std::all_of(H, H + dim_ * dim_, [](double x) { return x == 0.0; })) return;
  H_.setZero();
  for (int row = 0; row < dim_; ++row)
    for (int col = 0; col < dim_; ++col) H_(row, col) = H[row * dim_ + col];
  C_ = made.R_WC;
  const auto phi = contacts.frameForce(i);
  force_ = contacts.linearInWorld(i, phi);
  moment_ = contacts.angularInWorld(i, phi);
  setSides(in, made);

  bias_ = {};
  leftOut_.reset();
  PointMotion byDistance;
  std::optional<ContactBias> bias;
  if (shift.hasFlat()) bias = contactBias(in.model, in.kinematics, c);
  if (bias) {
    bias_ = {bias->rate.linear, bias->rate.angular};
    leftOut_ = bias->leftOut;
    column_ = {};
    column_.shift.distance = 1.0;
    byDistance = biasChange(shift, c, column_);
  }
  Vector6 inFrame;
  inFrame << C_.transpose() * byDistance.linear, C_.transpose() * byDistance.angular;
  const ContactLawDerivative& law = law_.of(in, contacts, i, inFrame);
  response_ = pushed(contacts, made, dim_, H_, law.reference);
  for (int k = 0; k < dim_; ++k) response_.row(k) += phi[idx(k)] * law.stiffness;
  turn_ = law.turn;

  for (const int j : dofs_)
    for (const bool ofPosition : {true, false}) {
      setColumn(in, j, ofPosition, shift);
      accumulate(in, j, ofPosition, respond(shift, c, bias.has_value()), ofPosition ? Gq : Gv);
    }
}

}  // namespace softgauss
