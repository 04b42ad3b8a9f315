// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/support.hpp"

#include <cmath>

namespace softgauss::collision {
namespace {

/// A face counts as facing d when its normal is nearer to d than about 84°.
constexpr double kFacing = 0.1;
/// A round shape shows its end cap to directions within 45° of its axis, else its side.
constexpr double kEndCap = 0.70710678118654752;
/// Corners of the polygon that stands for a cylinder's disc.
constexpr int kDiscCorners = 8;

/// Unit vector along the part of d across the unit vector axis; `fallback` when there is none.
Vector3 radialDirection(const Vector3& d, const Vector3& axis, const Vector3& fallback) {
  const Vector3 radial = d - axis * axis.dot(d);
  const double length = radial.norm();
  return length < 1e-12 ? fallback : Vector3(radial / length);
}

int boxFaceAxis(const Vector3& d_G) {
  int axis = 0;
  d_G.cwiseAbs().maxCoeff(&axis);
  return axis;
}

SupportFace boxFace(const Vector3& h, const Transform& X_WG, const Vector3& d_G) {
  const int k = boxFaceAxis(d_G);
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  Vector3 corner;
  corner[k] = std::copysign(h[k], d_G[k]);
  SupportFace face;
  for (int s = 0; s < 4; ++s) {
    corner[i] = (s == 0 || s == 3) ? -h[i] : h[i];
    corner[j] = s < 2 ? -h[j] : h[j];
    face.add(X_WG * corner);
  }
  return face;
}

SupportFace cylinderFace(const Shape& shape, const Transform& X_WG, const Vector3& d_W) {
  const Vector3 axis = X_WG.R.col(2);
  const double along = axis.dot(d_W);
  const Vector3 radial = radialDirection(d_W, axis, X_WG.R.col(0));
  SupportFace face;
  if (std::abs(along) < kEndCap) {
    face.add(X_WG.p + radial * shape.radius + axis * shape.halfLength);
    face.add(X_WG.p + radial * shape.radius - axis * shape.halfLength);
    return face;
  }
  const Vector3 c = X_WG.p + axis * std::copysign(shape.halfLength, along);
  const Vector3 sideways = axis.cross(radial);
  for (int k = 0; k < kDiscCorners; ++k) {
    const double angle = 2.0 * M_PI * k / kDiscCorners;
    face.add(c + shape.radius * (std::cos(angle) * radial + std::sin(angle) * sideways));
  }
  return face;
}

SupportFace capsuleFace(const Shape& shape, const Transform& X_WG, const Vector3& d_W) {
  const Vector3 reach = X_WG.R.col(2) * shape.halfLength;
  const Vector3 c = X_WG.p + d_W * shape.radius;
  SupportFace face;
  if (std::abs(X_WG.R.col(2).dot(d_W)) < kEndCap) {
    face.add(c + reach);
    face.add(c - reach);
  } else {
    face.add(c + reach * std::copysign(1.0, reach.dot(d_W)));
  }
  return face;
}

SupportFace hullFace(const ConvexHull& hull, const Transform& X_WG, const Vector3& d_G) {
  const HullFace& best = hull.faces[static_cast<std::size_t>(hull.supportFace(d_G))];
  SupportFace face;
  if (best.normal.dot(d_G) < kFacing) {
    face.add(X_WG * hull.support(d_G));
    return face;
  }
  // A rim of many vertices is thinned evenly.
  const std::size_t n = best.vertices.size();
  const std::size_t kept = std::min<std::size_t>(n, SupportFace::kCapacity);
  for (std::size_t k = 0; k < kept; ++k)
    face.add(X_WG * hull.vertices[static_cast<std::size_t>(best.vertices[k * n / kept])]);
  return face;
}

/// The highest of the corners, and the triangle that faces d most of those that have it.
struct TopCorner {
  const Triangle* triangle;
  std::size_t corner;
};

TopCorner topCorner(std::span<const Triangle> triangles, const Vector3& d_G) {
  TopCorner top{triangles.data(), 0};  // also where no comparison holds, as the direction is none
  double height = -kInfinity, facing = -kInfinity;
  for (const Triangle& t : triangles) {
    const double faces = t.normal.dot(d_G);
    for (std::size_t k = 0; k < 3; ++k) {
      const double reach = t.corners[k].dot(d_G);
      if (reach > height || (reach == height && faces > facing))
        height = reach, facing = faces, top = {&t, k};
    }
  }
  return top;
}

/// The triangle where it faces d on either side, else an edge that lies across d, else a corner.
SupportFace triangleFace(std::span<const Triangle> triangles, const Transform& X_WG,
                         const Vector3& d_G) {
  const auto [t, top] = topCorner(triangles, d_G);
  SupportFace face;
  if (std::abs(t->normal.dot(d_G)) >= kFacing) {
    for (const Vector3& corner : t->corners) face.add(X_WG * corner);
    return face;
  }
  const std::size_t i = (top + 1) % 3, j = (top + 2) % 3;
  const std::size_t next = t->corners[i].dot(d_G) > t->corners[j].dot(d_G) ? i : j;
  const Vector3 edge = t->corners[top] - t->corners[next];
  face.add(X_WG * t->corners[top]);
  if (edge.dot(d_G) < kFacing * edge.norm()) face.add(X_WG * t->corners[next]);
  return face;
}

}  // namespace

double coreRadius(const Shape& shape) {
  return shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule ? shape.radius : 0.0;
}

Vector3 corePoint(const Convex& convex, const Transform& X_WG, const Vector3& d_W) {
  const Shape& shape = *convex.shape;
  const Vector3 axis = X_WG.R.col(2);
  switch (shape.kind) {
    case ShapeKind::sphere:
      return X_WG.p;
    case ShapeKind::capsule:
      return X_WG.p + axis * std::copysign(shape.halfLength, axis.dot(d_W));
    case ShapeKind::cylinder: {
      const Vector3 radial = radialDirection(d_W, axis, Vector3::Zero());
      return X_WG.p + radial * shape.radius + axis * std::copysign(shape.halfLength, axis.dot(d_W));
    }
    case ShapeKind::box: {
      const Vector3 d_G = X_WG.R.transpose() * d_W;
      const Vector3& h = shape.halfExtents;
      return X_WG * Vector3(std::copysign(h.x(), d_G.x()), std::copysign(h.y(), d_G.y()),
                            std::copysign(h.z(), d_G.z()));
    }
    case ShapeKind::ellipsoid: {
      const Vector3 d_G = X_WG.R.transpose() * d_W;
      const Vector3 scaled = shape.halfExtents.cwiseProduct(d_G);  // to a unit ball
      const double length = scaled.norm();
      if (length == 0.0) return X_WG.p;
      return X_WG * Vector3(shape.halfExtents.cwiseProduct(scaled) / length);
    }
    case ShapeKind::mesh:
      return X_WG * convex.hull->support(X_WG.R.transpose() * d_W);
    case ShapeKind::triangles: {
      const auto [t, top] = topCorner(convex.triangles, X_WG.R.transpose() * d_W);
      return X_WG * t->corners[top];
    }
    case ShapeKind::plane:
      break;
  }
  SOFTGAUSS_ASSERT(shape.kind != ShapeKind::plane);
  return X_WG.p;
}

Vector3 supportPoint(const Convex& convex, const Transform& X_WG, const Vector3& d_W) {
  const Vector3 x = corePoint(convex, X_WG, d_W);
  const double radius = coreRadius(*convex.shape);
  return radius > 0.0 ? Vector3(x + d_W.normalized() * radius) : x;
}

SupportFace supportFace(const Convex& convex, const Transform& X_WG, const Vector3& d_W) {
  const Shape& shape = *convex.shape;
  switch (shape.kind) {
    case ShapeKind::capsule:
      return capsuleFace(shape, X_WG, d_W);
    case ShapeKind::cylinder:
      return cylinderFace(shape, X_WG, d_W);
    case ShapeKind::box:
      return boxFace(shape.halfExtents, X_WG, X_WG.R.transpose() * d_W);
    case ShapeKind::mesh:
      return hullFace(*convex.hull, X_WG, X_WG.R.transpose() * d_W);
    case ShapeKind::triangles:
      return triangleFace(convex.triangles, X_WG, X_WG.R.transpose() * d_W);
    case ShapeKind::sphere:
    case ShapeKind::ellipsoid:
    case ShapeKind::plane:
      break;
  }
  SupportFace point;
  point.add(supportPoint(convex, X_WG, d_W));
  return point;
}

Vector3 supportFaceNormal(const Convex& convex, const Transform& X_WG, const Vector3& d_W) {
  const Shape& shape = *convex.shape;
  const Vector3 d_G = X_WG.R.transpose() * d_W;
  switch (shape.kind) {
    case ShapeKind::cylinder:
      if (std::abs(d_G.z()) < kEndCap) break;
      return X_WG.R.col(2) * std::copysign(1.0, d_G.z());
    case ShapeKind::box: {
      const int axis = boxFaceAxis(d_G);
      return X_WG.R.col(axis) * std::copysign(1.0, d_G[axis]);
    }
    case ShapeKind::mesh: {
      const HullFace& face =
          convex.hull->faces[static_cast<std::size_t>(convex.hull->supportFace(d_G))];
      if (face.normal.dot(d_G) < kFacing) break;
      return X_WG.R * face.normal;
    }
    case ShapeKind::triangles: {
      const Vector3& normal = topCorner(convex.triangles, d_G).triangle->normal;
      const double along = normal.dot(d_G);
      if (std::abs(along) < kFacing) break;
      return X_WG.R * normal * std::copysign(1.0, along);
    }
    default:
      break;
  }
  return Vector3::Zero();
}

double separationAlong(const Convex& a, const Transform& X_WA, const Convex& b,
                       const Transform& X_WB, const Vector3& n_W) {
  return n_W.dot(supportPoint(b, X_WB, -n_W) - supportPoint(a, X_WA, n_W));
}

}  // namespace softgauss::collision
