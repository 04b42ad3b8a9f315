// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/mesh_mass.hpp"

#include <cmath>

#include "softgauss/io/mjcf/principal_axes.hpp"

namespace softgauss::io::mjcf {
namespace {

using Inertia = MeshAttributes::Inertia;
constexpr double kNoVolume = 1e-15;  // [m³], [m²]

struct Face {
  Vector3 a, b, c;
  Vector3 center() const { return (a + b + c) / 3.0; }
  Vector3 normal() const { return 0.5 * (b - a).cross(c - a); }  ///< its length is the area
};

Face faceOf(const Mesh& mesh, const std::array<int, 3>& t, const Vector3& origin) {
  const auto at = [&](int i) {
    return Vector3(mesh.vertices[static_cast<std::size_t>(i)] - origin);
  };
  return {at(t[0]), at(t[1]), at(t[2])};
}

/// What a face stands for: the pyramid up to the origin, or itself.
double amount(const Face& face, Inertia inertia) {
  if (inertia == Inertia::shell) return face.normal().norm();
  const double volume = face.center().dot(face.normal()) / 3.0;
  return inertia == Inertia::legacy ? std::abs(volume) : volume;
}

Vector3 centroidOfFaces(const Mesh& mesh) {
  Vector3 sum = Vector3::Zero();
  double area = 0.0;
  for (const auto& t : mesh.triangles) {
    const Face face = faceOf(mesh, t, Vector3::Zero());
    const double own = face.normal().norm();
    sum += own * face.center();
    area += own;
  }
  return area > kNoVolume ? Vector3(sum / area) : Vector3::Zero();
}

}  // namespace

void weighMesh(MeshAsset& asset) {
  const Mesh& mesh = *asset.mesh;
  if (asset.inertia == Inertia::convex) {
    asset.problem =
        "has inertia=\"convex\", that of its convex hull, which is not worked out; expected "
        "legacy, exact or shell, or an <inertial> in the body";
    return;
  }
  const Vector3 middle = centroidOfFaces(mesh);
  double total = 0.0;
  Vector3 moment = Vector3::Zero();
  for (const auto& t : mesh.triangles) {
    const Face face = faceOf(mesh, t, middle);
    const double own = amount(face, asset.inertia);
    total += own;
    moment += own * 0.75 * face.center();
  }
  if (!(total > kNoVolume)) {
    asset.problem =
        "has no volume, or its triangles face inwards; expected them to face outwards, "
        "inertia=\"shell\" in its <mesh>, or an <inertial> in the body";
    return;
  }
  const Vector3 com = middle + moment / total;
  Matrix3 second = Matrix3::Zero();  // ∫ x xᵀ
  double mass = 0.0;
  for (const auto& t : mesh.triangles) {
    const Face f = faceOf(mesh, t, com);
    const double own = amount(f, asset.inertia);
    const Vector3 sum = f.a + f.b + f.c;
    mass += own;
    second += own / (asset.inertia == Inertia::shell ? 12.0 : 20.0) *
              (f.a * f.a.transpose() + f.b * f.b.transpose() + f.c * f.c.transpose() +
               sum * sum.transpose());
  }
  const PrincipalAxes axes = principalAxes(second.trace() * Matrix3::Identity() - second);
  asset.unit = {mass, com, axes.tensor()};
  asset.X_FP = {axes.R, com};
}

}  // namespace softgauss::io::mjcf
