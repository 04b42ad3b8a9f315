// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Shapes as FCL has them, and its answer whether two touch.

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <memory>
#include <vector>

#include "softgauss/collision/convex_hull.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss::test {

using FclGeometry = std::shared_ptr<fcl::CollisionGeometryd>;

inline FclGeometry fclHull(const collision::ConvexHull& hull) {
  auto vertices = std::make_shared<std::vector<Vector3>>(hull.vertices);
  auto faces = std::make_shared<std::vector<int>>();
  for (const collision::HullFace& face : hull.faces) {
    faces->push_back(static_cast<int>(face.vertices.size()));
    faces->insert(faces->end(), face.vertices.begin(), face.vertices.end());
  }
  return std::make_shared<fcl::Convexd>(vertices, static_cast<int>(hull.faces.size()), faces);
}

inline FclGeometry fclSurface(const Mesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> corners;
  for (const auto& t : mesh.triangles) corners.emplace_back(idx(t[0]), idx(t[1]), idx(t[2]));
  model->beginModel(static_cast<int>(corners.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, corners);
  model->endModel();
  return model;
}

/// `hull`: of a mesh.
inline FclGeometry toFcl(const Shape& s, const collision::ConvexHull* hull) {
  switch (s.kind) {
    case ShapeKind::plane:
      return std::make_shared<fcl::Halfspaced>(Vector3::UnitZ(), 0.0);
    case ShapeKind::sphere:
      return std::make_shared<fcl::Sphered>(s.radius);
    case ShapeKind::capsule:
      return std::make_shared<fcl::Capsuled>(s.radius, 2 * s.halfLength);
    case ShapeKind::cylinder:
      return std::make_shared<fcl::Cylinderd>(s.radius, 2 * s.halfLength);
    case ShapeKind::box:
      return std::make_shared<fcl::Boxd>(Vector3(2 * s.halfExtents));
    case ShapeKind::ellipsoid:
      return std::make_shared<fcl::Ellipsoidd>(s.halfExtents);
    case ShapeKind::mesh:
      return fclHull(*hull);
    case ShapeKind::triangles:
      return fclSurface(*s.mesh);
  }
  return nullptr;
}

inline bool touchInFcl(const fcl::CollisionGeometryd& a, const Transform& X_WA,
                       const fcl::CollisionGeometryd& b, const Transform& X_WB) {
  const auto pose = [](const Transform& X) {
    fcl::Transform3d T = fcl::Transform3d::Identity();
    T.linear() = X.R;
    T.translation() = X.p;
    return T;
  };
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(&a, pose(X_WA), &b, pose(X_WB), request, result) > 0;
}

}  // namespace softgauss::test
