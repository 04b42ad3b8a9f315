// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/derivative/contact_shift.hpp"

#include <cmath>

namespace softgauss {
namespace {

/// Whether the surface of a box is a plane where its outward normal is ±n.
bool isFace(const Shape& shape, const Transform& X_WG, const Vector3& n_W) {
  constexpr double kAligned = 1.0 - 1e-12;
  return shape.kind == ShapeKind::box &&
         (X_WG.R.transpose() * n_W).cwiseAbs().maxCoeff() > kAligned;
}

/// Shapes that touch a plane with a point of theirs, or of a rim or ball of theirs.
bool touchesPlanes(ShapeKind kind) {
  return kind != ShapeKind::plane && kind != ShapeKind::triangles;
}

}  // namespace

void ContactShift::setTangent(const Contact& c, Wish carriedBy) {
  constexpr double kSmallestSine = 1e-6;  // as contactFrame()
  const Vector3& n = c.n_W;
  contactNormal_ = n;
  wished_ = c.tangent_W;
  wish_ = carriedBy;
  Vector3 u = wished_ - n * n.dot(wished_);
  if (!(u.norm() > kSmallestSine * wished_.norm())) {
    // As frameFromNormal().
    wished_ = std::abs(n.y()) < 0.5 ? Vector3::UnitY() : Vector3::UnitZ();
    wish_ = Wish::world;
    u = wished_ - n * n.dot(wished_);
  }
  wishedLength_ = u.norm();
  t2_ = n.cross(u) / wishedLength_;
}

void ContactShift::setRim(const Model& model, const Kinematics& k, const Contact& c, int geometry) {
  const Geometry& g = model.geometries[geometry];
  const Transform X = k.X_WB[g.body] * g.X_BG;
  rim_ = true;
  axis_ = X.R.col(2);
  centre_ = X.p - c.p_WC;
  fromCentre_ = 0.5 * d_ * n_ - centre_;
}

std::optional<ContactShift> ContactShift::of(const Model& model, const Kinematics& k,
                                             const Contact& c) {
  const Geometry &A = model.geometries[c.geometryA], &B = model.geometries[c.geometryB];
  const ShapeKind kindA = A.shape.kind, kindB = B.shape.kind;
  ContactShift s;
  s.d_ = c.distance;
  if (kindA == ShapeKind::sphere && kindB == ShapeKind::sphere) {
    s.spheres_ = true;
    s.n_ = c.n_W;
    s.radius_ = A.shape.radius;
    s.centreA_ = k.X_WB[A.body] * A.X_BG.p - c.p_WC;
    s.centreB_ = k.X_WB[B.body] * B.X_BG.p - c.p_WC;
    s.apart_ = (s.centreB_ - s.centreA_).norm();
    s.setTangent(c, Wish::world);
    return s;
  }
  const bool planeA = kindA == ShapeKind::plane, planeB = kindB == ShapeKind::plane;
  const bool faceA = kindB == ShapeKind::sphere && isFace(A.shape, k.X_WB[A.body] * A.X_BG, c.n_W);
  const bool faceB = kindA == ShapeKind::sphere && isFace(B.shape, k.X_WB[B.body] * B.X_BG, c.n_W);
  if (planeA ? !touchesPlanes(kindB) : planeB ? !touchesPlanes(kindA) : !faceA && !faceB)
    return std::nullopt;
  s.flatIsA_ = planeA || (!planeB && faceA);
  s.n_ = s.flatIsA_ ? c.n_W : -c.n_W;
  const int other = s.flatIsA_ ? c.geometryB : c.geometryA;
  const Shape& shape = model.geometries[other].shape;
  const bool capsule = shape.kind == ShapeKind::capsule;
  if (capsule || shape.kind == ShapeKind::sphere) s.radius_ = shape.radius;
  if (shape.kind == ShapeKind::cylinder) s.setRim(model, k, c, other);
  s.setTangent(c, capsule == s.flatIsA_ ? Wish::ofB : Wish::ofA);
  return s;
}

Vector3 ContactShift::along(const Vector3& angular) const {
  if (!rim_) return radius_ * angular.cross(n_);
  const double slope2 = axis_.cross(n_).squaredNorm();
  if (slope2 == 0.0) return Vector3::Zero();
  return -axis_.dot(n_.cross(angular.cross(n_))) / slope2 * axis_.cross(fromCentre_);
}

Vector3 ContactShift::alongChange(const Vector3& angular, const Vector3& dAngular,
                                  const Vector3& dn, const PointMotion& moved, const Vector3& dp,
                                  double dDistance) const {
  if (!rim_) return radius_ * (dAngular.cross(n_) + angular.cross(dn));
  const Vector3 &a = axis_, &n = n_, an = a.cross(n), w = angular.cross(n);
  const double slope2 = an.squaredNorm();
  if (slope2 == 0.0) return Vector3::Zero();
  const Vector3 da = moved.angular.cross(a), dw = dAngular.cross(n) + angular.cross(dn);
  const double turns = -a.dot(n.cross(w));
  const double dTurns = -da.dot(n.cross(w)) - a.dot(dn.cross(w)) - a.dot(n.cross(dw));
  const double dSlope2 = 2.0 * an.dot(da.cross(n) + a.cross(dn));
  const Vector3 ds =
      dp - (moved.linear + moved.angular.cross(centre_)) + 0.5 * (dDistance * n + d_ * dn);
  return (dTurns - turns * dSlope2 / slope2) / slope2 * a.cross(fromCentre_) +
         turns / slope2 * (da.cross(fromCentre_) + a.cross(ds));
}

double ContactShift::spin(const Change& change, const PointMotion& A, const PointMotion& B) const {
  Vector3 wished = Vector3::Zero();
  if (wish_ != Wish::world) wished = (wish_ == Wish::ofA ? A : B).angular.cross(wished_);
  return (wished.dot(t2_) - contactNormal_.dot(wished_) * change.n.dot(t2_)) / wishedLength_;
}

ContactShift::Change ContactShift::change(const PointMotion& A, const PointMotion& B) const {
  Change c;
  if (spheres_) {
    const Vector3 cA = A.linear + A.angular.cross(centreA_),
                  cB = B.linear + B.angular.cross(centreB_), apart = cB - cA;
    c.distance = n_.dot(apart);
    c.n = (apart - n_ * c.distance) / apart_;
    c.p = cA + (radius_ + 0.5 * d_) * c.n + 0.5 * c.distance * n_;
  } else {
    const PointMotion &flat = flatIsA_ ? A : B, &other = flatIsA_ ? B : A;
    const Vector3 turns = other.angular - flat.angular;
    const Vector3 nu = along(turns);
    c.distance = n_.dot(other.linear + nu - flat.linear);
    c.p = other.linear + nu + 0.5 * d_ * turns.cross(n_) - 0.5 * c.distance * n_;
    c.n = (flatIsA_ ? 1.0 : -1.0) * flat.angular.cross(n_);
  }
  c.turn = contactNormal_.cross(c.n) + spin(c, A, B) * contactNormal_;
  return c;
}

}  // namespace softgauss
