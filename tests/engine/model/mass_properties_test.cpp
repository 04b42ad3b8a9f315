// SPDX-License-Identifier: Apache-2.0
/// Closed forms of solids against their meshes, and against scaling laws.

#include "softgauss/engine/model/mass_properties.hpp"

#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A shape of revolution about z from its outline (radius, height), in n slices around.
std::shared_ptr<const Mesh> turned(const std::vector<std::pair<double, double>>& outline, int n) {
  auto mesh = std::make_shared<Mesh>();
  for (const auto& [r, z] : outline)
    for (int i = 0; i < n; ++i)
      mesh->vertices.emplace_back(r * std::cos(2 * kPi * i / n), r * std::sin(2 * kPi * i / n), z);
  for (int k = 0; k + 1 < static_cast<int>(outline.size()); ++k)
    for (int i = 0; i < n; ++i) {
      const int a = k * n + i, b = k * n + (i + 1) % n;
      mesh->triangles.push_back({a, b, b + n});
      mesh->triangles.push_back({a, b + n, a + n});
    }
  return mesh;
}

/// From pole to pole; the equator occurs twice, at the two ends of the cylinder.
std::vector<std::pair<double, double>> capsuleOutline(double radius, double half, int n) {
  std::vector<std::pair<double, double>> outline;
  for (const double side : {-1.0, 1.0})
    for (int i = 0; i <= n; ++i) {
      const double latitude = kPi / 2 * (side < 0.0 ? i - n : i) / n;
      outline.emplace_back(radius * std::cos(latitude), radius * std::sin(latitude) + side * half);
    }
  return outline;
}

MassProperties ofMesh(std::shared_ptr<const Mesh> mesh) {
  return solidOf(Shape::hull(std::move(mesh)), 700.0);
}

// The mesh of n slices errs by O(1/n²).
TEST(MassProperties, OfRoundSolidsAreTheLimitOfTheirMeshes) {
  const double r = 0.3, half = 0.5;
  const std::pair<Shape, std::vector<std::pair<double, double>>> solids[] = {
      {Shape::cylinder(r, half), {{0, -half}, {r, -half}, {r, half}, {0, half}}},
      {Shape::capsule(r, half), capsuleOutline(r, half, 200)},
      {Shape::sphere(r), capsuleOutline(r, 0.0, 200)}};
  for (const auto& [shape, outline] : solids) {
    const MassProperties exact = solidOf(shape, 700.0), mesh = ofMesh(turned(outline, 400));
    EXPECT_NEAR(mesh.mass / exact.mass, 1.0, 2e-4);
    EXPECT_APPROX(mesh.com, exact.com, 1e-10);
    EXPECT_APPROX(mesh.I_Gcm, exact.I_Gcm, 3e-4 * exact.I_Gcm.norm());
    EXPECT_GT((mesh.I_Gcm - exact.I_Gcm).norm(), 0.0) << "two computations, not one";
  }
}

// A box and the same box as twelve triangles, anywhere and turned: exact.
TEST(MassProperties, OfABoxAreThoseOfItsMeshWhereverItIs) {
  const Vector3 h(0.1, 0.25, 0.4), place(3.0, -2.0, 0.7);
  const Matrix3 R = Eigen::AngleAxisd(0.8, Vector3(1, 2, -1).normalized()).toRotationMatrix();
  auto mesh = std::make_shared<Mesh>();
  for (int i = 0; i < 8; ++i)
    mesh->vertices.push_back(place + R * Vector3(i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(),
                                                 i & 4 ? h.z() : -h.z()));
  mesh->triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                     {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const MassProperties exact = solidOf(Shape::box(h), 700.0), found = ofMesh(mesh);
  EXPECT_NEAR(found.mass, exact.mass, 1e-9);
  EXPECT_APPROX(found.com, place, 1e-12);
  EXPECT_APPROX(found.I_Gcm, R * exact.I_Gcm * R.transpose(), 1e-9);
}

// Twice the length: 8 times the mass, 32 times the inertia.
TEST(MassProperties, ScaleAsThePowersOfLength) {
  for (const auto& [small, large] : {std::pair{Shape::sphere(0.1), Shape::sphere(0.2)},
                                     {Shape::capsule(0.1, 0.3), Shape::capsule(0.2, 0.6)},
                                     {Shape::cylinder(0.1, 0.3), Shape::cylinder(0.2, 0.6)},
                                     {Shape::box({0.1, 0.2, 0.3}), Shape::box({0.2, 0.4, 0.6})}}) {
    const MassProperties a = solidOf(small, 1000.0), b = solidOf(large, 1000.0);
    EXPECT_SMALL(b.mass / a.mass - 8.0, 1e-12);
    EXPECT_APPROX(b.I_Gcm, 32.0 * a.I_Gcm, 1e-12);
  }
}

}  // namespace
}  // namespace softgauss::test
