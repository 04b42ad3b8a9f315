// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/mass_properties.hpp"

#include <cmath>

namespace softgauss {
namespace {

constexpr double kPi = 3.14159265358979323846;

MassProperties symmetric(double mass, double xx, double yy, double zz) {
  return {mass, Vector3::Zero(), Vector3(xx, yy, zz).asDiagonal()};
}

/// A cylinder and the two halves of a sphere, whose centres of mass lie 3r/8 from the cut.
MassProperties capsule(double r, double half, double density) {
  const double length = 2.0 * half;
  const double cylinder = density * kPi * r * r * length;
  const double sphere = density * 4.0 / 3.0 * kPi * r * r * r;
  const double across = cylinder * (r * r / 4.0 + length * length / 12.0) +
                        sphere * (2.0 * r * r / 5.0 + half * half + 3.0 * r * half / 4.0);
  const double along = cylinder * r * r / 2.0 + sphere * 2.0 * r * r / 5.0;
  return symmetric(cylinder + sphere, across, across, along);
}

MassProperties solidMesh(const Mesh& mesh, double density) {
  double volume = 0.0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();
  for (const std::array<int, 3>& t : mesh.triangles) {
    const Vector3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vector3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Vector3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    const double det = a.dot(b.cross(c));
    const Vector3 sum = a + b + c;
    volume += det / 6.0;
    first += det / 24.0 * sum;
    second += det / 120.0 *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  MassProperties m;
  m.mass = density * volume;
  m.com = volume != 0.0 ? Vector3(first / volume) : Vector3::Zero();
  second -= volume * m.com * m.com.transpose();
  m.I_Gcm = density * (second.trace() * Matrix3::Identity() - second);
  return m;
}

}  // namespace

MassProperties solidOf(const Shape& shape, double density) {
  const double r = shape.radius;
  switch (shape.kind) {
    case ShapeKind::plane:
      return {};
    case ShapeKind::sphere: {
      const double mass = density * 4.0 / 3.0 * kPi * r * r * r, I = 0.4 * mass * r * r;
      return symmetric(mass, I, I, I);
    }
    case ShapeKind::capsule:
      return capsule(r, shape.halfLength, density);
    case ShapeKind::cylinder: {
      const double length = 2.0 * shape.halfLength, mass = density * kPi * r * r * length;
      const double across = mass * (r * r / 4.0 + length * length / 12.0);
      return symmetric(mass, across, across, mass * r * r / 2.0);
    }
    case ShapeKind::box: {
      const Vector3 sq = shape.halfExtents.cwiseAbs2();
      const double mass = density * 8.0 * shape.halfExtents.prod();
      return symmetric(mass, mass / 3.0 * (sq.y() + sq.z()), mass / 3.0 * (sq.z() + sq.x()),
                       mass / 3.0 * (sq.x() + sq.y()));
    }
    case ShapeKind::ellipsoid: {
      const Vector3 sq = shape.halfExtents.cwiseAbs2();
      const double mass = density * 4.0 / 3.0 * kPi * shape.halfExtents.prod();
      return symmetric(mass, mass / 5.0 * (sq.y() + sq.z()), mass / 5.0 * (sq.z() + sq.x()),
                       mass / 5.0 * (sq.x() + sq.y()));
    }
    case ShapeKind::mesh:
    case ShapeKind::triangles:
      return solidMesh(*shape.mesh, density);
  }
  return {};
}

}  // namespace softgauss
