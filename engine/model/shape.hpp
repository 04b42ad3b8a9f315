// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Collision and visual shapes as plain data. No collision library is known here.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/material.hpp"

namespace softgauss {

/// Triangles of one colour in a mesh.
struct MeshPart {
  int firstTriangle = 0;
  int triangles = 0;
  Eigen::Vector4d rgba = Eigen::Vector4d::Ones();
};

/// Triangle mesh in the geometry's own frame G [m], scale already applied.
struct Mesh {
  std::vector<Vector3> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::vector<MeshPart> parts;  ///< where its file gives colours, for viewers
  std::string file;             ///< where it was read from, for messages and viewers
};

enum class ShapeKind : std::uint8_t {
  plane,      ///< half-space z ≤ 0 of G; the normal is +z
  sphere,     ///< radius
  capsule,    ///< radius, halfLength of the segment along z of G (without the caps)
  cylinder,   ///< radius, halfLength along z of G
  box,        ///< halfExtents along the axes of G
  ellipsoid,  ///< halfExtents, its radii along the axes of G
  mesh,       ///< convex hull of mesh->vertices
  triangles   ///< the surface mesh->triangles, met from the side that it faces
};

struct Shape {
  ShapeKind kind = ShapeKind::sphere;
  double radius = 0.0;                         ///< [m] sphere, capsule, cylinder
  double halfLength = 0.0;                     ///< [m] capsule, cylinder
  Vector3 halfExtents = Vector3::Zero();       ///< [m] box, ellipsoid
  std::shared_ptr<const Mesh> mesh = nullptr;  ///< mesh, triangles

  static Shape plane() { return make(ShapeKind::plane, 0.0, 0.0); }
  static Shape sphere(double radius) { return make(ShapeKind::sphere, radius, 0.0); }
  static Shape capsule(double radius, double halfLength) {
    return make(ShapeKind::capsule, radius, halfLength);
  }
  static Shape cylinder(double radius, double halfLength) {
    return make(ShapeKind::cylinder, radius, halfLength);
  }
  static Shape box(const Vector3& halfExtents) {
    Shape shape = make(ShapeKind::box, 0.0, 0.0);
    shape.halfExtents = halfExtents;
    return shape;
  }
  static Shape ellipsoid(const Vector3& radii) {
    Shape shape = make(ShapeKind::ellipsoid, 0.0, 0.0);
    shape.halfExtents = radii;
    return shape;
  }
  static Shape hull(std::shared_ptr<const Mesh> mesh) {
    Shape shape = make(ShapeKind::mesh, 0.0, 0.0);
    shape.mesh = std::move(mesh);
    return shape;
  }
  static Shape surface(std::shared_ptr<const Mesh> mesh) {
    Shape shape = make(ShapeKind::triangles, 0.0, 0.0);
    shape.mesh = std::move(mesh);
    return shape;
  }
  /// Of a kind that has a mesh, which may not have been read.
  bool isMesh() const { return kind == ShapeKind::mesh || kind == ShapeKind::triangles; }

 private:
  static Shape make(ShapeKind kind, double radius, double halfLength) {
    Shape shape;
    shape.kind = kind;
    shape.radius = radius;
    shape.halfLength = halfLength;
    return shape;
  }
};

/// Which geometries may touch each other: two, where a bit of the category of one is in the mask of
/// the other.
struct CollisionBits {
  std::uint32_t category = 1, mask = 1;
  bool operator==(const CollisionBits&) const = default;
};
inline bool mayTouch(const CollisionBits& a, const CollisionBits& b) {
  return (a.category & b.mask) != 0 || (b.category & a.mask) != 0;
}

/// A collision shape fixed to a body.
struct Geometry {
  std::string name;  ///< e.g. "left_foot/0"
  std::string link;  ///< the URDF link that it was written in (also after merging)
  int body = 0;      ///< index into Model::bodies; 0 is the world
  Transform X_BG;    ///< pose in the body
  Shape shape;
  Material material;
  /// The fixed base of a robot that it is part of, or that the first joint of its tree hangs from;
  /// −1 for scenery, and on what floats or hangs from the world itself.
  int base = -1;
  bool automaticMesh = false;  ///< of kind mesh or triangles: collision::chooseMeshes() says
  CollisionBits bits = {};
};

/// A pair of geometries with a surface of its own, in place of the mix of theirs.
struct ContactPair {
  int geometryA = 0;  ///< index into Model::geometries
  int geometryB = 0;  ///< > geometryA
  Material material;
  bool always = false;  ///< tested whatever Geometry::bits, Model::apart and joints say
};

/// A shape that is only looked at.
struct Visual {
  std::string link;
  int body = 0;
  Transform X_BG;
  Shape shape;
  Eigen::Vector4d rgba = Eigen::Vector4d(0.7, 0.7, 0.7, 1.0);
};

}  // namespace softgauss
