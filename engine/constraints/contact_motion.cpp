// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/contact_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "softgauss/engine/constraints/ellipsoid_point.hpp"

namespace softgauss {
namespace {

/// From where on the rate at its start tells little of a step: by what a body tilts and by what the
/// place on a rim goes round [rad].
constexpr double kMaxTilt = 0.3, kMaxRimAngle = 1.0;

/// Whether the surface is a plane where its outward normal is ±n.
bool isFlat(const Shape& shape, const Transform& X_WG, const Vector3& n_W) {
  if (shape.kind == ShapeKind::plane) return true;
  constexpr double kAligned = 1.0 - 1e-12;
  return shape.kind == ShapeKind::box &&
         (X_WG.R.transpose() * n_W).cwiseAbs().maxCoeff() > kAligned;
}

/// How far p lies within the face of a flat shape that it is on [m]: 0 at its edges.
double insetOf(const Shape& shape, const Transform& X_WG, const Vector3& n_W, const Vector3& p_W) {
  if (shape.kind == ShapeKind::plane) return std::numeric_limits<double>::infinity();
  const Vector3 n = X_WG.R.transpose() * n_W, p = X_WG.R.transpose() * (p_W - X_WG.p);
  Vector3 inset = shape.halfExtents - p.cwiseAbs();
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  inset[axis] = std::numeric_limits<double>::infinity();
  return inset.minCoeff();
}

/// ν of (4.10) [m/s], of the place whose outward normal is −n, and the depths of ContactBias; ω of
/// the shape against n.
struct ContactPointVelocity {
  Vector3 along;
  double biasDepth = std::numeric_limits<double>::infinity(), loadedBiasDepth = biasDepth;
};

std::optional<ContactPointVelocity> alongSurface(const Shape& shape, const Transform& X_WG,
                                                 const Vector3& n, const Vector3& omega,
                                                 const Contact& c, double timestep) {
  switch (shape.kind) {
    case ShapeKind::sphere:
    case ShapeKind::capsule:
      return ContactPointVelocity{shape.radius * omega.cross(n), 0.3 * shape.radius,
                                  0.3 * shape.radius};
    case ShapeKind::box:
    case ShapeKind::mesh:
    case ShapeKind::triangles:
      return ContactPointVelocity{Vector3::Zero()};
    case ShapeKind::ellipsoid: {
      // Its curvature changes within angles of least/most.
      const double least = shape.halfExtents.minCoeff(), most = shape.halfExtents.maxCoeff();
      const Vector3 e = omega.cross(n);
      if (!(timestep * e.norm() * most < kMaxRimAngle * least)) return std::nullopt;
      const Matrix3 W = ellipsoidTensor(X_WG.R, shape.halfExtents);
      const double depth = 0.3 * least * least / most;
      return ContactPointVelocity{ellipsoidPointRate(W, -n, e), depth, depth};
    }
    case ShapeKind::cylinder: {
      const Vector3 a = X_WG.R.col(2);
      const double slope2 = a.cross(n).squaredNorm(), turns = -a.dot(n.cross(omega.cross(n)));
      if (!(timestep * std::abs(turns) < kMaxRimAngle * slope2)) return std::nullopt;
      const double height = shape.radius * std::sqrt(slope2);  // of its middle above the place
      return ContactPointVelocity{turns / slope2 * a.cross(c.p_WC - X_WG.p + 0.5 * c.distance * n),
                                  0.1 * height, 0.3 * height};
    }
    case ShapeKind::plane:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

GeometryPoses posesOf(const Model& model, const Kinematics& k, const Contact& c) {
  return {k.X_WB[c.bodyA] * model.geometries[c.geometryA].X_BG,
          k.X_WB[c.bodyB] * model.geometries[c.geometryB].X_BG};
}

std::optional<bool> flatIsA(const Model& model, const GeometryPoses& at, const Contact& c) {
  const Geometry &A = model.geometries[c.geometryA], &B = model.geometries[c.geometryB];
  const Transform &X_WA = at.X_WA, &X_WB = at.X_WB;
  const bool flatA = isFlat(A.shape, X_WA, c.n_W), flatB = isFlat(B.shape, X_WB, c.n_W);
  if (!flatA && !flatB) return std::nullopt;
  if (flatA != flatB) return flatA;
  if (A.shape.kind == ShapeKind::plane) return true;
  // Of two faces the one that has its corner or edge here is carried along with it.
  return insetOf(A.shape, X_WA, c.n_W, c.p_WC) >= insetOf(B.shape, X_WB, c.n_W, c.p_WC);
}

std::optional<ContactBias> contactBias(const Model& model, const Kinematics& k,
                                       const GeometryPoses& at, const Contact& c) {
  // What looks within the step asks for the rate at each of its places.
  const double h = model.options.isMultiStage() ? 0.0 : model.options.timestep;
  const Motion &V_A = k.midstepVelocities()[c.bodyA], &V_B = k.midstepVelocities()[c.bodyB];
  if (!(h * std::max(c.n_W.cross(V_A.angular).norm(), c.n_W.cross(V_B.angular).norm()) <= kMaxTilt))
    return std::nullopt;
  const std::optional<bool> flat = flatIsA(model, at, c);
  if (!flat) return std::nullopt;
  const bool flatA = *flat;
  const Geometry& other = model.geometries[flatA ? c.geometryB : c.geometryA];

  const Motion &V_flat = flatA ? V_A : V_B, &V_other = flatA ? V_B : V_A;
  const Vector3 n = flatA ? c.n_W : -c.n_W, turns = V_other.angular - V_flat.angular;
  const std::optional<ContactPointVelocity> moves =
      alongSurface(other.shape, flatA ? at.X_WB : at.X_WA, n, turns, c, h);
  if (!moves) return std::nullopt;

  const MidstepPoint A = midstepPoint(model, k, c.bodyA, c.p_WC),
                     B = midstepPoint(model, k, c.bodyB, c.p_WC);
  const Vector3 &v_A = A.velocity, &v_B = B.velocity;
  const Vector3 slips = v_B - v_A;
  const Vector3 v_P = (flatA ? v_B : v_A) + moves->along + 0.5 * c.distance * turns.cross(n) -
                      0.5 * c.n_W.dot(slips) * n;
  ContactBias bias;
  bias.biasDepth = moves->biasDepth;
  bias.loadedBiasDepth = moves->loadedBiasDepth;
  bias.rate.angular = k.A_bias[c.bodyB].angular - k.A_bias[c.bodyA].angular -
                      V_flat.angular.cross(V_B.angular - V_A.angular);
  bias.rate.linear = B.bias - A.bias + V_B.angular.cross(v_P - v_B) - V_A.angular.cross(v_P - v_A) -
                     V_flat.angular.cross(slips);
  // A wheel of many faces would be lifted by ω² r of each of its corners.
  const ShapeKind kind = other.shape.kind;
  if (kind == ShapeKind::mesh || kind == ShapeKind::triangles) {
    bias.leftOut = c.n_W.dot(bias.rate.linear);
    bias.rate.linear -= *bias.leftOut * c.n_W;
  }
  return bias;
}

}  // namespace softgauss
