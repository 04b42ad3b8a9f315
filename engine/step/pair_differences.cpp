// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/pair_differences.hpp"

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss {
namespace {

/// What is found by iterations has noise [m, rad].
constexpr double kStep = 1e-6;

bool isOfPair(const Contact& a, const Contact& b) {
  return a.geometryA == b.geometryA && a.geometryB == b.geometryB;
}

/// Of one pair, the contact that was the `place`-th of `count`: of others the nearest to it, null
/// where none is left.
const Contact* sameContact(const ContactSet& found, const Contact& c, int place, int count) {
  if (found.size() == count) return &found.contacts[place];
  const Contact* nearest = nullptr;
  for (const Contact& other : found.contacts)
    if (!nearest || (other.p_WC - c.p_WC).norm() < (nearest->p_WC - c.p_WC).norm())
      nearest = &other;
  return nearest;
}

}  // namespace

PairDifferences::PairDifferences(const Model& model) : kinematics_(model) {
  constexpr std::size_t kUsual = 8;
  for (ContactSet& found : found_) found.contacts.reserve(kUsual);
}

void PairDifferences::begin(const Kinematics& kinematics) {
  kinematics_ = kinematics;
  geometryA_ = geometryB_ = -1;
}

void PairDifferences::look(const Model& model, const Contact& c, ContactSource& source) {
  geometryA_ = c.geometryA, geometryB_ = c.geometryB;
  about_ = c.p_WC;
  const bool movesB = c.bodyB != 0;
  Transform& X = kinematics_.X_WB[movesB ? c.bodyB : c.bodyA];
  const Transform kept = X;
  for (int i = 0; i < 12; ++i) {
    const double by = (i % 2 == 0 ? kStep : -kStep) * (movesB ? 1.0 : -1.0);
    const Vector3 along = by * Vector3::Unit(i / 2 % 3);
    if (i < 6) {
      X.p = kept.p + along;
    } else {
      const Matrix3 R = quaternionExp(along).toRotationMatrix();
      X = {R * kept.R, about_ + R * (kept.p - about_)};
    }
    source.detectPair(model, kinematics_, geometryA_, geometryB_, found_[i]);
    X = kept;
  }
}

ContactShift::Measured PairDifferences::of(const Model& model, const ContactSet& contacts, int i,
                                           ContactSource& source) {
  const Contact& c = contacts.contacts[i];
  if (c.geometryA != geometryA_ || c.geometryB != geometryB_) look(model, c, source);
  int place = 0, count = 0;
  for (int other = 0; other < contacts.size(); ++other)
    if (isOfPair(contacts.contacts[other], c)) place += other < i, ++count;
  ContactShift::Measured measured;
  for (int k = 0; k < 6; ++k) {
    const Contact* more = sameContact(found_[2 * k], c, place, count);
    const Contact* less = sameContact(found_[2 * k + 1], c, place, count);
    const double apart = (more ? kStep : 0.0) + (less ? kStep : 0.0);
    if (!more) more = &c;
    if (!less) less = &c;
    measured.col(k) << more->distance - less->distance, more->n_W - less->n_W,
        more->p_WC - less->p_WC, more->tangent_W - less->tangent_W;
    if (apart > 0.0) measured.col(k) /= apart;
  }
  if (c.bodyB == 0) {  // A was moved back, and B stays behind
    for (int k = 0; k < 3; ++k) {
      const Vector3 axis = Vector3::Unit(k);
      measured.block<3, 1>(4, k) += axis;
      measured.block<3, 1>(1, 3 + k) += axis.cross(c.n_W);
      measured.block<3, 1>(4, 3 + k) += axis.cross(c.p_WC - about_);
      measured.block<3, 1>(7, 3 + k) += axis.cross(c.tangent_W);
    }
  }
  // Turns are about the point of this contact.
  for (int k = 0; k < 3; ++k)
    measured.col(3 + k) += measured.leftCols<3>() * Vector3::Unit(k).cross(about_ - c.p_WC);
  return measured;
}

}  // namespace softgauss
