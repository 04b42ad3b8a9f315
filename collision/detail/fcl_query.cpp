// SPDX-License-Identifier: Apache-2.0
#include "collision/detail/fcl_query.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <exception>
#include <vector>

#include "engine/core/check.hpp"

namespace softgauss::collision::detail {
namespace {

std::shared_ptr<fcl::CollisionGeometryd> convert(const Convex& convex) {
  const Shape& shape = *convex.shape;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return std::make_shared<fcl::Sphered>(0.0);
    case ShapeKind::capsule:
      return std::make_shared<fcl::Capsuled>(0.0, 2.0 * shape.halfLength);
    case ShapeKind::cylinder:
      return std::make_shared<fcl::Cylinderd>(shape.radius, 2.0 * shape.halfLength);
    case ShapeKind::box:
      return std::make_shared<fcl::Boxd>(Vector3(2.0 * shape.halfExtents));
    case ShapeKind::mesh: {
      const auto vertices = std::make_shared<std::vector<Vector3>>(convex.hull->vertices);
      const auto faces = std::make_shared<std::vector<int>>();
      for (const HullFace& face : convex.hull->faces) {
        faces->push_back(static_cast<int>(face.vertices.size()));
        faces->insert(faces->end(), face.vertices.begin(), face.vertices.end());
      }
      return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(convex.hull->faces.size()),
                                            faces);
    }
    case ShapeKind::plane:
      break;
  }
  SOFTGAUSS_ASSERT(shape.kind != ShapeKind::plane);
  return nullptr;
}

fcl::Transform3d toFcl(const Transform& X) {
  fcl::Transform3d T = fcl::Transform3d::Identity();
  T.linear() = X.R;
  T.translation() = X.p;
  return T;
}

}  // namespace

struct FclShape::Geometry {
  std::shared_ptr<fcl::CollisionGeometryd> shape;
};

FclShape::FclShape(const Convex& convex)
    : geometry_(std::make_shared<Geometry>(Geometry{convert(convex)})) {}

std::optional<CoreDirection> coreDirection(const FclShape& a, const Transform& X_WA,
                                           const FclShape& b, const Transform& X_WB,
                                           double size) noexcept {
  // Relative to A, so that the answer does not depend on where in the world the pair is.
  const fcl::Transform3d identity = fcl::Transform3d::Identity();
  const fcl::Transform3d X_AB = toFcl(X_WA.inverse() * X_WB);
  const fcl::CollisionGeometryd* shapeA = a.geometry()->shape.get();
  const fcl::CollisionGeometryd* shapeB = b.geometry()->shape.get();

  try {
    fcl::DistanceRequestd request(true, true);
    request.gjk_solver_type = fcl::GST_LIBCCD;
    request.distance_tolerance = 1e-7 * size;
    fcl::DistanceResultd result;
    fcl::distance(shapeA, identity, shapeB, X_AB, request, result);
    const Vector3 gap = result.nearest_points[1] - result.nearest_points[0];
    const double length = gap.norm();
    if (gap.allFinite() && length > 1e-6 * size) {
      const double sign = result.min_distance < 0.0 ? -1.0 : 1.0;
      return CoreDirection{X_WA.R * gap * (sign / length),
                           X_WA * (0.5 * (result.nearest_points[0] + result.nearest_points[1]))};
    }
  } catch (const std::exception&) {
    // A degenerate simplex or polytope: ask the other algorithm.
  }
  try {
    fcl::CollisionRequestd request(1, true);
    request.gjk_solver_type = fcl::GST_LIBCCD;
    fcl::CollisionResultd result;
    fcl::collide(shapeA, identity, shapeB, X_AB, request, result);
    if (result.numContacts() > 0) {
      const fcl::Contactd& contact = result.getContact(0);
      const double length = contact.normal.norm();
      if (contact.penetration_depth > 1e-6 * size && length > 0.5)
        return CoreDirection{X_WA.R * contact.normal / length, X_WA * contact.pos};
    }
  } catch (const std::exception&) {
    // Left to the caller.
  }
  return std::nullopt;
}

}  // namespace softgauss::collision::detail
