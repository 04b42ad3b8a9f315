// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/derivative/contact_shift.hpp"

#include <cmath>

#include "softgauss/engine/constraints/contact_motion.hpp"
#include "softgauss/engine/constraints/ellipsoid_point.hpp"
#include "softgauss/engine/core/rotation.hpp"

namespace softgauss {
namespace {

/// Whether the surface of a box is a plane where its outward normal is ±n.
bool isFace(const Shape& shape, const Transform& X_WG, const Vector3& n_W) {
  constexpr double kAligned = 1.0 - 1e-12;
  return shape.kind == ShapeKind::box &&
         (X_WG.R.transpose() * n_W).cwiseAbs().maxCoeff() > kAligned;
}

bool isRound(ShapeKind kind) { return kind == ShapeKind::sphere || kind == ShapeKind::capsule; }

/// Shapes that touch a plane with a point of theirs, or of a rim or ball of theirs.
bool touchesPlanes(ShapeKind kind) {
  return kind != ShapeKind::plane && kind != ShapeKind::triangles && kind != ShapeKind::ellipsoid;
}

}  // namespace

void ContactShift::setTangent(const Contact& c, Wish carriedBy, const Vector3& wished) {
  constexpr double kSmallestSine = 1e-6;  // as contactFrame()
  const Vector3& n = c.n_W;
  contactNormal_ = n;
  wished_ = wished;
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

/// The core of a ball or capsule, and whether the contact slides along it.
ContactShift::Core ContactShift::coreOf(const Shape& shape, const Transform& X_WG,
                                        const Vector3& p_WC, const Vector3& fromContact) {
  constexpr double kInside = 1.0 - 1e-9;  // an end is met but for rounding
  Core core;
  core.centre = fromContact;
  if (shape.kind != ShapeKind::capsule) return core;
  core.axis = X_WG.R.col(2);
  const double along = core.axis.dot(p_WC + fromContact - X_WG.p);
  core.slides = std::abs(along) < kInside * shape.halfLength;
  return core;
}

bool ContactShift::setRound(const Geometry& A, const Transform& X_WA, const Geometry& B,
                            const Transform& X_WB, const Contact& c, const Vector3& wished) {
  constexpr double kAlongside = 0.02;  // sine²: beside each other they touch at more than a point
  round_ = true;
  n_ = c.n_W;
  radius_ = A.shape.radius;
  coreA_ = coreOf(A.shape, X_WA, c.p_WC, -(A.shape.radius + 0.5 * d_) * n_);
  coreB_ = coreOf(B.shape, X_WB, c.p_WC, (B.shape.radius + 0.5 * d_) * n_);
  apart_ = d_ + A.shape.radius + B.shape.radius;
  cosine_ = coreA_.axis.dot(coreB_.axis);
  const bool capsules = A.shape.kind == B.shape.kind && A.shape.kind == ShapeKind::capsule;
  if (capsules && 1.0 - cosine_ * cosine_ < kAlongside) return false;
  setTangent(c, Wish::world, wished);
  return true;
}

std::optional<ContactShift> ContactShift::of(const Model& model, const Kinematics& k,
                                             const Contact& c, bool alongGravity) {
  const Geometry &A = model.geometries[c.geometryA], &B = model.geometries[c.geometryB];
  const ShapeKind kindA = A.shape.kind, kindB = B.shape.kind;
  ContactShift s;
  s.d_ = c.distance;
  const Vector3& wished = alongGravity ? model.options.gravity : c.tangent_W;
  if (isRound(kindA) && isRound(kindB)) {
    if (!s.setRound(A, k.X_WB[A.body] * A.X_BG, B, k.X_WB[B.body] * B.X_BG, c, wished))
      return std::nullopt;
    return s;
  }
  const bool planeA = kindA == ShapeKind::plane, planeB = kindB == ShapeKind::plane;
  const bool faceA = kindB == ShapeKind::sphere && isFace(A.shape, k.X_WB[A.body] * A.X_BG, c.n_W);
  const bool faceB = kindA == ShapeKind::sphere && isFace(B.shape, k.X_WB[B.body] * B.X_BG, c.n_W);
  if (planeA ? !touchesPlanes(kindB) : planeB ? !touchesPlanes(kindA) : !faceA && !faceB)
    return std::nullopt;
  s.flatIsA_ = planeA || (!planeB && faceA);
  const int other = s.flatIsA_ ? c.geometryB : c.geometryA;
  s.setOther(model, k, c, other);
  const bool capsule = model.geometries[other].shape.kind == ShapeKind::capsule;
  const Wish ofCapsule = capsule == s.flatIsA_ ? Wish::ofB : Wish::ofA;
  s.setTangent(c, alongGravity ? Wish::world : ofCapsule, wished);
  return s;
}

ContactShift ContactShift::of(const Model& model, const Kinematics& k, const Contact& c,
                              bool alongGravity, const Measured& measured) {
  ContactShift s;
  s.measured_ = measured;
  s.d_ = c.distance;
  const std::optional<bool> flat = softgauss::flatIsA(model, posesOf(model, k, c), c);
  s.round_ = !flat;
  s.flatIsA_ = flat.value_or(true);
  s.setOther(model, k, c, s.flatIsA_ ? c.geometryB : c.geometryA);
  s.setTangent(c, alongGravity ? Wish::world : Wish::measured,
               alongGravity ? model.options.gravity : c.tangent_W);
  return s;
}

/// What touches the flat one.
void ContactShift::setOther(const Model& model, const Kinematics& k, const Contact& c,
                            int geometry) {
  n_ = flatIsA_ ? c.n_W : -c.n_W;
  const Shape& shape = model.geometries[geometry].shape;
  if (isRound(shape.kind)) radius_ = shape.radius;
  if (shape.kind == ShapeKind::cylinder) setRim(model, k, c, geometry);
  if (shape.kind == ShapeKind::ellipsoid)
    ellipsoid_ = ellipsoidTensor(
        k.X_WB[model.geometries[geometry].body].R * model.geometries[geometry].X_BG.R,
        shape.halfExtents);
}

Vector3 ContactShift::along(const Vector3& angular) const {
  if (ellipsoid_) return ellipsoidPointRate(*ellipsoid_, -n_, angular.cross(n_));
  if (!rim_) return radius_ * angular.cross(n_);
  const double slope2 = axis_.cross(n_).squaredNorm();
  if (slope2 == 0.0) return Vector3::Zero();
  return -axis_.dot(n_.cross(angular.cross(n_))) / slope2 * axis_.cross(fromCentre_);
}

Vector3 ContactShift::alongChange(const Vector3& angular, const Vector3& dAngular,
                                  const Vector3& dn, const PointMotion& moved, const Vector3& dp,
                                  double dDistance) const {
  const Vector3 de = dAngular.cross(n_) + angular.cross(dn);
  if (ellipsoid_) {
    const Matrix3 turned = skew(moved.angular) * *ellipsoid_;
    return ellipsoidPointRateChange(*ellipsoid_, turned + turned.transpose(), -n_, -dn,
                                    angular.cross(n_), de);
  }
  if (!rim_) return radius_ * de;
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

double ContactShift::spin(const Change& change, const Vector3& wishedMoves) const {
  return (wishedMoves.dot(t2_) - contactNormal_.dot(wished_) * change.n.dot(t2_)) / wishedLength_;
}

std::pair<Vector3, Vector3> ContactShift::centresMove(const PointMotion& A,
                                                      const PointMotion& B) const {
  const Vector3 &a = coreA_.axis, &b = coreB_.axis, g = apart_ * n_;
  Vector3 cA = A.linear + A.angular.cross(coreA_.centre),
          cB = B.linear + B.angular.cross(coreB_.centre);
  const double rA = A.angular.cross(a).dot(g) + a.dot(cB - cA),
               rB = B.angular.cross(b).dot(g) + b.dot(cB - cA);
  double s = coreA_.slides ? rA : 0.0, t = coreB_.slides ? -rB : 0.0;
  if (coreA_.slides && coreB_.slides) {
    const double sine2 = 1.0 - cosine_ * cosine_;
    s = (rA - cosine_ * rB) / sine2;
    t = (cosine_ * rA - rB) / sine2;
  }
  cA += s * a, cB += t * b;
  return {cA, cB};
}

ContactShift::Change ContactShift::measuredChange(const PointMotion& A,
                                                  const PointMotion& B) const {
  Eigen::Matrix<double, 6, 1> relative;
  relative << B.linear - A.linear, B.angular - A.angular;
  const Eigen::Matrix<double, 10, 1> x = *measured_ * relative;
  Change c;
  c.distance = x[0];
  c.n = A.angular.cross(contactNormal_) + x.segment<3>(1);
  c.p = A.linear + x.segment<3>(4);
  Vector3 wished = Vector3::Zero();
  if (wish_ == Wish::measured) wished = A.angular.cross(wished_) + x.tail<3>();
  c.turn = contactNormal_.cross(c.n) + spin(c, wished) * contactNormal_;
  return c;
}

ContactShift::Change ContactShift::change(const PointMotion& A, const PointMotion& B) const {
  if (measured_) return measuredChange(A, B);
  Change c;
  if (round_) {
    const auto [cA, cB] = centresMove(A, B);
    const Vector3 apart = cB - cA;
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
  Vector3 wished = Vector3::Zero();
  if (wish_ != Wish::world) wished = (wish_ == Wish::ofA ? A : B).angular.cross(wished_);
  c.turn = contactNormal_.cross(c.n) + spin(c, wished) * contactNormal_;
  return c;
}

}  // namespace softgauss
