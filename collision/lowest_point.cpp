// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/lowest_point.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::collision {

double lowestPoint(const Shape& shape, const Transform& X_WG) {
  const Vector3 up = X_WG.R.row(2).transpose();  // world z in G
  switch (shape.kind) {
    case ShapeKind::plane:
      return -kInfinity;
    case ShapeKind::sphere:
      return X_WG.p.z() - shape.radius;
    case ShapeKind::capsule:
      return X_WG.p.z() - shape.radius - std::abs(up.z()) * shape.halfLength;
    case ShapeKind::cylinder:
      return X_WG.p.z() - std::hypot(up.x(), up.y()) * shape.radius -
             std::abs(up.z()) * shape.halfLength;
    case ShapeKind::box:
      return X_WG.p.z() - up.cwiseAbs().dot(shape.halfExtents);
    case ShapeKind::ellipsoid:
      return X_WG.p.z() - up.cwiseProduct(shape.halfExtents).norm();
    case ShapeKind::mesh:
    case ShapeKind::triangles:
      break;
  }
  double lowest = kInfinity;
  for (const Vector3& v : shape.mesh->vertices) lowest = std::min(lowest, X_WG.p.z() + up.dot(v));
  return lowest;
}

double lowestPoint(const Model& model, const Kinematics& kinematics, int tree) {
  double lowest = kInfinity;
  for (const Geometry& g : model.geometries) {
    if (g.body == 0 || model.bodies[static_cast<std::size_t>(g.body)].tree != tree) continue;
    const Transform& X_WB = kinematics.X_WB[static_cast<std::size_t>(g.body)];
    lowest = std::min(lowest, lowestPoint(g.shape, X_WB * g.X_BG));
  }
  return lowest;
}

}  // namespace softgauss::collision
