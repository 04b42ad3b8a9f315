// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/convex_hull.hpp"

#include <gtest/gtest.h>

#include <set>

#include "softgauss/collision/plane_pairs.hpp"
#include "softgauss/engine/core/check.hpp"
#include "tests/collision/random_pairs.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

Mesh cloud(std::vector<Vector3> vertices) {
  Mesh mesh;
  mesh.vertices = std::move(vertices);
  mesh.file = "part.stl";
  return mesh;
}

Mesh randomBall(unsigned seed, int count) {
  RandomPairs random(seed);
  Mesh mesh;
  for (int i = 0; i < count; ++i) mesh.vertices.push_back(random.vector(1.0).normalized());
  return mesh;
}

}  // namespace

TEST(ConvexHull, CubeHasSixSquareFacesAndEightCorners) {
  Mesh mesh = *boxMesh({1, 2, 3});
  mesh.vertices.push_back(Vector3(0.3, 0.2, 0.1));  // inside
  mesh.vertices.push_back(Vector3(1, 0.5, 0.5));    // on a face
  mesh.vertices.push_back(mesh.vertices[3]);        // twice
  const ConvexHull hull = makeConvexHull(mesh);
  EXPECT_FALSE(hull.flat);
  EXPECT_EQ(hull.vertices.size(), 8u);
  ASSERT_EQ(hull.faces.size(), 6u);
  for (const HullFace& face : hull.faces) {
    EXPECT_EQ(face.vertices.size(), 4u);
    EXPECT_NEAR(face.normal.cwiseAbs().maxCoeff(), 1.0, 1e-12);
  }
  EXPECT_LT((hull.halfExtents - Vector3(1, 2, 3)).norm(), 1e-12);
  EXPECT_NEAR(hull.boundingRadius, std::sqrt(14.0), 1e-12);
}

TEST(ConvexHull, FacesEncloseAllPointsAndRunCounterClockwise) {
  const Mesh mesh = randomBall(1, 200);
  const ConvexHull hull = makeConvexHull(mesh);
  EXPECT_EQ(hull.vertices.size(), 200u);
  for (const HullFace& face : hull.faces) {
    const auto corner = [&](std::size_t i) {
      return hull.vertices[static_cast<std::size_t>(face.vertices[i])];
    };
    for (const Vector3& v : mesh.vertices) EXPECT_LT(face.normal.dot(v - corner(0)), 1e-9);
    EXPECT_GT(face.normal.dot((corner(1) - corner(0)).cross(corner(2) - corner(0))), 0.0);
  }
}

TEST(ConvexHull, ClimbingFindsTheFarthestVertex) {
  const ConvexHull hull = makeConvexHull(randomBall(2, 500));
  RandomPairs random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 d = random.vector(1.0);
    double farthest = -kInfinity;
    for (const Vector3& v : hull.vertices) farthest = std::max(farthest, v.dot(d));
    EXPECT_DOUBLE_EQ(hull.support(d).dot(d), farthest);
  }
}

TEST(ConvexHull, FlatMeshBecomesAPolygonWithTwoSides) {
  const Transform X = RandomPairs(4).pose(1.0);
  Mesh mesh;
  for (double x : {-1.0, 0.0, 1.0})
    for (double y : {-2.0, 0.0, 2.0}) mesh.vertices.push_back(X * Vector3(x, y, 0.0));
  const ConvexHull hull = makeConvexHull(mesh);
  EXPECT_TRUE(hull.flat);
  EXPECT_EQ(hull.vertices.size(), 4u);
  ASSERT_EQ(hull.faces.size(), 2u);
  EXPECT_NEAR(hull.faces[0].normal.dot(hull.faces[1].normal), -1.0, 1e-12);
  EXPECT_NEAR(std::abs(hull.faces[0].normal.dot(X.R.col(2))), 1.0, 1e-12);
}

TEST(ConvexHull, MeshWithoutSurfaceIsAnErrorThatNamesTheFile) {
  for (const Mesh& mesh :
       {cloud({}), cloud({{0, 0, 0}, {1, 0, 0}}), cloud({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}),
        cloud({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}}),
        cloud({{0, 0, 0}, {1, 0, kNaN}, {0, 1, 0}})}) {
    try {
      makeConvexHull(mesh);
      ADD_FAILURE() << "no error";
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()).find("part.stl"), std::string::npos);
    }
  }
}

TEST(ConvexHull, OnPlaneItStandsOnSpreadCornersOfItsDeepestFace) {
  // A prism of sixty-four sides, sunk by 1 mm.
  Mesh mesh;
  for (int i = 0; i < 64; ++i)
    for (double z : {0.0, 0.5})
      mesh.vertices.push_back({std::cos(2 * M_PI * i / 64), std::sin(2 * M_PI * i / 64), z});
  const ConvexHull hull = makeConvexHull(mesh);
  PairContacts out;
  planeHull(at(0, 0, 0), hull, at(0, 0, -0.001), 0.0, out);
  ASSERT_EQ(out.count, 4);
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(out[i].distance, -0.001, 1e-12);
    sum += out[i].p_WC;
  }
  EXPECT_LT(sum.head<2>().norm(), 0.1);

  // Sunk completely, the deepest corners still count.
  out.clear();
  planeHull(at(0, 0, 0), hull, turned({1, 0, 0}, 0.1, {0, 0, -3}), 0.0, out);
  EXPECT_EQ(out.count, 4);
  EXPECT_NEAR(deepest(out), -3.0 - std::sin(0.1), 2e-3);
}

TEST(ConvexHull, BoxMeshOnPlaneIsTheBoxOnPlane) {
  RandomPairs random(5);
  const Vector3 h(0.2, 0.3, 0.4);
  const ConvexHull hull = makeConvexHull(*boxMesh(h));
  for (int i = 0; i < 200; ++i) {
    const Transform X_WA = random.pose(0.3), X_WB = random.pose(0.3);
    const PairContacts box = contactsOf(Shape::plane(), X_WA, Shape::box(h), X_WB);
    PairContacts mesh;
    planeHull(X_WA, hull, X_WB, 0.0, mesh);
    ASSERT_EQ(mesh.count > 0, box.count > 0);
    if (box.count == 0) continue;
    EXPECT_NEAR(deepest(mesh), deepest(box), 1e-12);
    EXPECT_LE(box.count, mesh.count);
  }
}
