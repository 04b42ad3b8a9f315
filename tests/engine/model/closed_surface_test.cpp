// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/closed_surface.hpp"

#include <algorithm>

#include "softgauss/engine/model/mass_properties.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// Adds a box to a mesh, facing outwards or inwards.
void addBox(Mesh& mesh, const Vector3& centre, double half, bool outwards = true) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(centre +
                            half * Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  for (std::array<int, 3> t : {std::array{0, 2, 3},
                               {0, 3, 1},
                               {4, 5, 7},
                               {4, 7, 6},
                               {0, 1, 5},
                               {0, 5, 4},
                               {2, 6, 7},
                               {2, 7, 3},
                               {0, 4, 6},
                               {0, 6, 2},
                               {1, 3, 7},
                               {1, 7, 5}}) {
    if (!outwards) std::swap(t[1], t[2]);
    for (int& vertex : t) vertex += first;
    mesh.triangles.push_back(t);
  }
}

Mesh box() {
  Mesh mesh;
  addBox(mesh, {3, -2, 1}, 0.5);
  return mesh;
}

TEST(ClosedSurface, OfSeveralShellsAndCavitiesHasNoDefects) {
  Mesh mesh = box();
  addBox(mesh, {3, -2, 1}, 0.2, false);
  addBox(mesh, {5, -2, 1}, 0.5);
  EXPECT_FALSE(surfaceDefects(mesh).any());
  EXPECT_NEAR(solidOf(Shape::hull(std::make_shared<Mesh>(mesh)), 1.0).mass, 2.0 - 0.064, 1e-12);
}

TEST(ClosedSurface, MayHoldTrianglesWithoutArea) {
  Mesh mesh = box();
  mesh.triangles.push_back({0, 0, 5});
  mesh.triangles.push_back({3, 3, 3});
  EXPECT_FALSE(surfaceDefects(mesh).any());
}

/// Whether the vertices are two of the triangle's.
bool isEdgeOf(const std::array<int, 3>& triangle, const int (&edge)[2]) {
  return edge[0] != edge[1] && std::count(triangle.begin(), triangle.end(), edge[0]) == 1 &&
         std::count(triangle.begin(), triangle.end(), edge[1]) == 1;
}

// The edge of a hole is one of the triangle that is missing; the triangle to turn is the turned
// one.
TEST(ClosedSurface, DefectsAreFoundWhereTheyAre) {
  for (std::size_t i = 0; i < 12; ++i) {
    Mesh open = box(), turned = box();
    const std::array<int, 3> missing = open.triangles[i];
    open.triangles.erase(open.triangles.begin() + static_cast<std::ptrdiff_t>(i));
    std::swap(turned.triangles[i][1], turned.triangles[i][2]);
    EXPECT_TRUE(isEdgeOf(missing, surfaceDefects(open).openEdge)) << i;
    EXPECT_EQ(surfaceDefects(turned).turnedTriangle, static_cast<int>(i));
  }
}

// Each defect makes the mass depend on where the origin is, but for a shell that is inside out,
// which takes away from another.
TEST(ClosedSurface, DefectsAreCounted) {
  Mesh open = box(), turned = box(), inside = box();
  open.triangles.pop_back();
  std::swap(turned.triangles[4][1], turned.triangles[4][2]);
  addBox(inside, {5, -2, 1}, 0.4, false);
  EXPECT_EQ(surfaceDefects(open).openEdges, 3);
  EXPECT_EQ(surfaceDefects(open).turnedEdges, 0);
  EXPECT_EQ(surfaceDefects(turned).turnedEdges, 3);
  EXPECT_EQ(surfaceDefects(turned).openEdges, 0);
  EXPECT_EQ(surfaceDefects(inside).insideOutShells, 1);
  EXPECT_GE(surfaceDefects(inside).insideOutTriangle, 12) << "of the second box";
  for (const Mesh* mesh : {&open, &turned}) {
    Mesh moved = *mesh;
    for (Vector3& vertex : moved.vertices) vertex.array() += 10.0;
    EXPECT_GT(std::abs(solidOf(Shape::hull(std::make_shared<Mesh>(moved)), 1.0).mass -
                       solidOf(Shape::hull(std::make_shared<Mesh>(*mesh)), 1.0).mass),
              0.1);
  }
}

}  // namespace
}  // namespace softgauss::test
