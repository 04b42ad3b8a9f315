// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/contact_rotation.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss {
namespace {

/// Rate at which a surface turns against what it touches: that about the normal leaves both as they
/// are, and a sphere has nothing to turn.
double tiltRate(const Geometry& g, const Kinematics& k, const Vector3& n_W) {
  if (g.body == 0 || g.shape.kind == ShapeKind::sphere) return 0.0;
  const Vector3& omega = k.midstepVelocities()[g.body].angular;
  return (omega - n_W * n_W.dot(omega)).norm();
}

/// Rate at which the place where a cylinder's rim touches goes round it.
double rimRate(const Geometry& g, const Kinematics& k, const Vector3& n_W) {
  if (g.body == 0 || g.shape.kind != ShapeKind::cylinder) return 0.0;
  const Vector3 axis = k.X_WB[g.body].R * g.X_BG.R.col(2);
  const Vector3 omega = k.midstepVelocities()[g.body].angular;
  const double turns = std::abs(axis.dot(n_W.cross(omega.cross(n_W))));
  const double slope2 = axis.cross(n_W).squaredNorm();
  // Lying flat it has no such place.
  constexpr double kFlat = 1e-12;
  return slope2 > kFlat && turns > 0.0 ? turns / slope2 : 0.0;
}

}  // namespace

double contactRotationRate(const Model& model, const Kinematics& kinematics,
                           const Contact& contact) {
  constexpr double kOfRim = 0.2;
  double rate = 0.0;
  for (const int i : {contact.geometryA, contact.geometryB}) {
    const Geometry& g = model.geometries[static_cast<std::size_t>(i)];
    rate = std::max(
        {rate, tiltRate(g, kinematics, contact.n_W), kOfRim * rimRate(g, kinematics, contact.n_W)});
  }
  return rate;
}

}  // namespace softgauss
