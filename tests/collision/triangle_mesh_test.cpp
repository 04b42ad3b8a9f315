// SPDX-License-Identifier: Apache-2.0
/// What a surface knows of itself: normals at faces, edges and corners, inside and outside.
#include "softgauss/collision/triangle_mesh.hpp"

#include <gtest/gtest.h>

#include "softgauss/collision/detail/fcl_triangle_tree.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/model/mass_properties.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {
namespace {

using collision::TriangleMesh;
using collision::detail::Box;

constexpr double kTilt = 1e-6;

/// A triangle of the surface that has p on it.
int triangleAt(const TriangleMesh& surface, const Vector3& p) {
  for (int t = 0; t < surface.size(); ++t) {
    const collision::Triangle tri = surface.triangle(t);
    bool inside = std::abs(tri.normal.dot(p - tri.corners[0])) < 1e-12;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3& a = tri.corners[k];
      inside = inside && tri.normal.dot((tri.corners[(k + 1) % 3] - a).cross(p - a)) >= -1e-12;
    }
    if (inside) return t;
  }
  return -1;
}

}  // namespace

TEST(SampleSurfaces, EncloseTheirVolumes) {
  const auto volume = [](const MeshPointer& mesh) {
    return solidOf(Shape::surface(mesh), 1.0).mass;
  };
  EXPECT_SMALL(volume(boxSurface({0.1, 0.2, 0.3}, 3)) - 8 * 0.006, 1e-15);
  EXPECT_SMALL(volume(ballSurface(1.0, 100, 200)) / (4 * M_PI / 3) - 1, 2e-3);  // inscribed
  EXPECT_SMALL(volume(ringSurface(1.0, 0.2, 200, 100)) / (2 * M_PI * M_PI * 0.04) - 1, 2e-3);
}

TEST(TriangleMesh, KnowsWhetherItIsClosed) {
  EXPECT_TRUE(TriangleMesh(boxSurface({0.3, 0.2, 0.25}, 3)).isClosed());
  EXPECT_TRUE(TriangleMesh(boxSurface({1, 1, 1}, 2)).isClosed());
  EXPECT_TRUE(TriangleMesh(ringSurface(1.0, 0.3, 12, 8)).isClosed());
  EXPECT_FALSE(TriangleMesh(gridMesh(3, 3, 1.0)).isClosed());
  EXPECT_FALSE(TriangleMesh(bowlMesh(1.0, 4, 8)).isClosed());
}

TEST(TriangleMesh, InnerEdgesOfAPlaneHaveOneNormal) {
  const TriangleMesh plane(gridMesh(4, 4, 1.0, 0.3));
  Random random(1);
  for (int t = 0; t < plane.size(); ++t) {
    bool inner = true;
    for (const int v : plane[t].corners)
      inner = inner && plane.vertex(v).head<2>().cwiseAbs().maxCoeff() < 1.9;
    EXPECT_EQ(plane.owner(t, Vector3::UnitZ(), kTilt), t);
    EXPECT_EQ(plane.owner(t, -Vector3::UnitZ(), kTilt), -1);
    if (!inner) continue;
    EXPECT_EQ(plane[t].isHollow, (std::array{false, false, false}));
    for (int i = 0; i < 20; ++i) {
      const Vector3 m = (Vector3::UnitZ() + random.vector3(0.5)).normalized();
      EXPECT_EQ(plane.owner(t, m, kTilt), -1);
    }
  }
}

// Along the edge of a box the normals are those of the arc between its faces, at a corner those of
// the octant; a hollow edge has none.
TEST(TriangleMesh, NormalsFillTheArcOfAConvexEdge) {
  const TriangleMesh box(boxSurface({1, 1, 1}, 2));
  const int top = triangleAt(box, {0.9, 0.45, 1.0}), side = triangleAt(box, {1.0, 0.45, 0.9});
  ASSERT_GE(top, 0);
  ASSERT_GE(side, 0);
  for (const double angle : {-0.2, 0.2, 0.7, 0.9, 1.4, 1.8}) {
    const Vector3 m(std::sin(angle), 0.0, std::cos(angle));
    const bool isNormal = angle > 0.0 && angle < M_PI / 2;
    const int owner = box.owner(top, m, kTilt);
    if (!isNormal) {
      EXPECT_EQ(owner, -1) << angle;
    } else {
      ASSERT_GE(owner, 0) << angle;
      EXPECT_APPROX(box[owner].normal,
                    angle < M_PI / 4 ? Vector3(Vector3::UnitZ()) : Vector3(Vector3::UnitX()), 0);
      EXPECT_EQ(owner, box.owner(side, m, kTilt)) << "both tell of the same one";
    }
  }
  const int corner = triangleAt(box, {0.99, 0.99, 1.0});
  EXPECT_GE(box.owner(corner, Vector3(1, 2, 3).normalized(), kTilt), 0);
  EXPECT_EQ(box.owner(corner, Vector3(-0.1, 2, 3).normalized(), kTilt), -1);

  const TriangleMesh groove(grooveMesh(M_PI / 4, 1.0, 4.0, 0.5));
  int hollow = 0;
  for (int t = 0; t < groove.size(); ++t) {
    const collision::Triangle tri = groove.triangle(t);
    const Vector3 middle = (tri.corners[0] + tri.corners[1] + tri.corners[2]) / 3.0;
    if (std::abs(middle.y()) > 1.0 || middle.z() > 0.3) continue;
    ++hollow;
    EXPECT_EQ(groove.owner(t, tri.normal, kTilt), t);
    for (const double angle : {-0.7, -0.3, 0.0, 0.3, 0.7})
      EXPECT_EQ(groove.owner(t, {std::sin(angle), 0.0, std::cos(angle)}, kTilt), -1);
  }
  EXPECT_GT(hollow, 8);
}

TEST(TriangleMesh, EnclosesWhatIsInside) {
  const TriangleMesh ring(ringSurface(1.0, 0.3, 24, 12));
  const TriangleMesh box(boxSurface({0.5, 0.4, 0.3}, 5));
  std::vector<int> scratch;
  Random random(3);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3 p = random.vector3(1.4);
    const double toCircle = std::hypot(std::hypot(p.x(), p.y()) - 1.0, p.z());
    // Facets are within 8 % of the tube.
    if (std::abs(toCircle / 0.3 - 1.0) > 0.08) {
      EXPECT_EQ(ring.encloses(p, scratch), toCircle < 0.3);
    }
    const bool inBox = (p.cwiseAbs() - Vector3(0.5, 0.4, 0.3)).maxCoeff() < 0.0;
    EXPECT_EQ(box.encloses(p, scratch), inBox);
    inside += inBox;
  }
  EXPECT_GT(inside, 50);
  // Above edges and corners too.
  for (const double x : {-0.4999, -0.3, 0.0, 0.1, 0.4})
    for (const double y : {-0.24, 0.0, 0.08}) EXPECT_EQ(box.encloses({x, y, 0.0}, scratch), true);
}

TEST(TriangleMesh, TreeFindsWhatALoopFinds) {
  const MeshPointer mesh = ringSurface(1.0, 0.3, 40, 20);
  const TriangleMesh ring(mesh);
  Random random(4);
  std::vector<int> found;
  std::size_t total = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3 centre = random.vector3(1.5), half = random.vector3(0.3).cwiseAbs();
    const Box wanted{centre - half, centre + half};
    ring.tree().within(wanted, found);
    std::vector<int> expected;
    for (int t = 0; t < ring.size(); ++t) {
      Box box;
      for (const Vector3& corner : ring.triangle(t).corners) box.add(corner, 0.0);
      if (box.overlaps(wanted)) expected.push_back(t);
    }
    ASSERT_EQ(found, expected);
    total += found.size();
  }
  EXPECT_GT(total, 500u);
}

TEST(TriangleMesh, RefusesWhatHasNoSides) {
  auto mesh = std::make_shared<Mesh>(*boxSurface({1, 1, 1}));
  mesh->file = "part.stl";
  std::swap(mesh->triangles[3][0], mesh->triangles[3][1]);
  try {
    const TriangleMesh surface(mesh);
    FAIL();
  } catch (const ModelError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("part.stl"), std::string::npos);
    EXPECT_NE(text.find("opposite sides"), std::string::npos) << text;
    EXPECT_NE(text.find("(1 -1 -1) m"), std::string::npos) << "names the place: " << text;
  }
  auto line = std::make_shared<Mesh>();
  line->vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line->triangles = {{0, 1, 2}};
  EXPECT_THROW(TriangleMesh{line}, ModelError);
  line->vertices[1].z() = std::nan("");
  EXPECT_THROW(TriangleMesh{line}, ModelError);
}

TEST(TriangleMesh, CountsTrianglesWithoutArea) {
  auto mesh = std::make_shared<Mesh>(*boxSurface({1, 1, 1}));
  mesh->triangles.push_back({0, 0, 1});
  const TriangleMesh surface(mesh);
  EXPECT_EQ(surface.withoutArea(), 1);
  EXPECT_EQ(surface.size(), 12);
}

}  // namespace softgauss::test
