// SPDX-License-Identifier: Apache-2.0
// Distances of shapes that are apart: proved by points that lie on both and a plane between, and
// by FCL's unsigned distance of triangles.
#include "softgauss/collision/clearance.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>

#include <map>

#include "softgauss/collision/support.hpp"
#include "tests/collision/random_pairs.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_surfaces.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

using collision::Clearance;
using collision::PreparedMeshes;
using collision::RandomPairs;

/// Two shapes, each a body of its own, and their distances.
struct TwoShapes {
  Model model;
  PreparedMeshes meshes;
  std::unique_ptr<Clearance> clearance;

  TwoShapes(const Shape& a, const Shape& b) : model(modelOf(a, b)) {
    clearance = std::make_unique<Clearance>(model, meshes);
  }
  std::span<const NearPoints> at(const Transform& X_WA, const Transform& X_WB) {
    const bool isFirst = model.geometries[0].name.starts_with("a");
    return isFirst ? clearance->between(0, X_WA, 1, X_WB) : clearance->between(1, X_WA, 0, X_WB);
  }
  static Model modelOf(const Shape& a, const Shape& b) {
    ModelBuilder builder("two");
    for (const Shape* shape : {&a, &b}) {
      ModelBuilder one("one");
      if (shape->kind != ShapeKind::plane) one.base = BaseKind::floating;
      one.link(shape->kind == ShapeKind::plane ? emptyLink("world") : sphereLink("body", 1.0, 0.1));
      one.geometry(geometrySpec(shape->kind == ShapeKind::plane ? "world" : "body", *shape));
      builder.add(one, shape == &a ? "a" : "b");
    }
    return builder.build();
  }
};

Shape randomConvex(RandomPairs& random, int kind) {
  if (kind < 4)
    return random.shape(std::array{ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder,
                                   ShapeKind::box}[static_cast<std::size_t>(kind)]);
  auto points = std::make_shared<Mesh>();
  for (int i = 0; i < 20; ++i) points->vertices.push_back(random.vector(0.3));
  return Shape::hull(points);
}

collision::Convex convexOf(const Shape& shape, PreparedMeshes& meshes) {
  return {&shape, shape.kind == ShapeKind::mesh ? meshes.hull(shape.mesh).get() : nullptr};
}

/// Two closed surfaces, one of them hollow.
std::array<MeshPointer, 2> surfaces() {
  return {washerSurface(0.2, 0.08, 0.03), ringSurface(0.15, 0.04, 14, 9)};
}

std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> toFcl(const Mesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles)
    triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2]));
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

fcl::Transform3d toFcl(const Transform& X) {
  fcl::Transform3d T = fcl::Transform3d::Identity();
  T.linear() = X.R;
  T.translation() = X.p;
  return T;
}

}  // namespace

// A point of each shape and a plane between them, both at the distance: no shorter way is there.
TEST(Clearance, IsProvedByPointsAndAPlane) {
  RandomPairs random(3);
  int apart = 0, rough = 0;
  double worst = 0.0;
  for (int kindA = 0; kindA < 5; ++kindA)
    for (int kindB = 0; kindB < 5; ++kindB)
      for (int i = 0; i < 60; ++i) {
        const Shape a = randomConvex(random, kindA), b = randomConvex(random, kindB);
        TwoShapes two(a, b);
        const Transform X_WA = random.pose(0.8), X_WB = random.pose(0.8);
        const auto points = two.at(X_WA, X_WB);
        ASSERT_FALSE(points.empty()) << kindA << kindB;
        const NearPoints nearest = points.front();
        if (nearest.distance <= 0.0) continue;
        ++apart;
        const auto& [p, q, n, distance, alongA, alongB] = nearest;
        (void)alongA, (void)alongB;
        const collision::Convex ofA = convexOf(a, two.meshes), ofB = convexOf(b, two.meshes);
        double miss =
            std::max({std::abs((q - p).norm() - distance), ((q - p) - distance * n).norm(),
                      std::abs(separationAlong(ofA, X_WA, ofB, X_WB, n) - distance)});
        for (int k = 0; k < 20; ++k) {
          const Vector3 m = random.vector(1.0).normalized();
          miss = std::max(miss, m.dot(p - supportPoint(ofA, X_WA, m)));
          miss = std::max(miss, m.dot(q - supportPoint(ofB, X_WB, m)));
        }
        rough += miss > 1e-9;
        worst = std::max(worst, miss);
        // All points come from both shapes, along the same normal, and no corner is nearer.
        for (const NearPoints& x : points) {
          EXPECT_GE(x.distance, distance);
          EXPECT_SMALL((x.p_WB - x.p_WA - x.distance * x.n_W).norm(), 1e-10);
        }
      }
  EXPECT_GT(apart, 800);
  // GJK ends where a step gains less than 1e-10 of the distance. On the round end of a cylinder a
  // triangle of the simplex can become so thin that rounding ends it earlier.
  EXPECT_LE(rough, apart / 200);
  EXPECT_SMALL(worst, 1e-5);
}

TEST(Clearance, OfOverlapsIsMinusTheirDepth) {
  TwoShapes balls(Shape::sphere(0.2), Shape::sphere(0.3));
  EXPECT_NEAR(balls.at({}, collision::at(0.1, 0.0, 0.45)).front().distance,
              std::hypot(0.1, 0.45) - 0.5, 1e-14);
  TwoShapes boxes(Shape::box({0.1, 0.2, 0.3}), Shape::box({0.3, 0.2, 0.1}));
  EXPECT_NEAR(boxes.at({}, collision::at(0.02, 0.01, 0.35)).front().distance, -0.05, 1e-12);
  TwoShapes inside(Shape::surface(ballSurface(0.5, 12, 16)), Shape::sphere(0.05));
  const auto deep = inside.at({}, collision::at(0.0, 0.0, 0.3));
  ASSERT_FALSE(deep.empty());
  EXPECT_LT(deep.front().distance, -0.2);
  TwoShapes poses(Shape::sphere(0.2), Shape::sphere(0.3));
  EXPECT_TRUE(poses.at({}, collision::at(kNaN, 0.0, 0.0)).empty());
}

TEST(Clearance, OfThePlaneIsThatOfTheLowestPoint) {
  RandomPairs random(5);
  for (int kind = 0; kind < 5; ++kind)
    for (int i = 0; i < 20; ++i) {
      const Shape shape = randomConvex(random, kind);
      TwoShapes two(shape, Shape::plane());
      const Transform X_WA = random.pose(1.0), X_WB = random.pose(1.0);
      const Vector3 n = X_WB.R.col(2);
      const auto points = two.at(X_WA, X_WB);
      ASSERT_FALSE(points.empty());
      const collision::Convex convex = convexOf(shape, two.meshes);
      EXPECT_NEAR(points.front().distance, n.dot(supportPoint(convex, X_WA, -n) - X_WB.p), 1e-12);
      EXPECT_APPROX(points.front().n_W, Vector3(-n), 1e-14) << "from the shape to the plane";
    }
  for (const MeshPointer& mesh : surfaces())
    for (int i = 0; i < 20; ++i) {
      TwoShapes two(Shape::surface(mesh), Shape::plane());
      const Transform X_WA = random.pose(1.0), X_WB = random.pose(1.0);
      const Vector3 n = X_WB.R.col(2);
      double lowest = kInfinity;
      for (const Vector3& x : mesh->vertices) lowest = std::min(lowest, n.dot(X_WA * x - X_WB.p));
      const auto points = two.at(X_WA, X_WB);
      ASSERT_FALSE(points.empty());
      EXPECT_NEAR(points.front().distance, lowest, 1e-12);
    }
  TwoShapes planes(Shape::plane(), Shape::plane());
  EXPECT_TRUE(planes.at({}, {}).empty());
}

// Whichever shape is asked about first.
TEST(Clearance, IsTheSameBothWays) {
  RandomPairs random(7);
  for (const MeshPointer& mesh : surfaces())
    for (int kind = 0; kind < 5; ++kind) {
      const Shape a = Shape::surface(mesh), b = randomConvex(random, kind);
      const Transform X_WA = random.pose(0.6), X_WB = random.pose(0.6);
      const auto there = TwoShapes(a, b).at(X_WA, X_WB);
      ASSERT_FALSE(there.empty());
      TwoShapes turned(b, a);
      const auto back = turned.at(X_WB, X_WA);
      ASSERT_FALSE(back.empty());
      TwoShapes again(a, b);
      EXPECT_EQ(back.front().distance, again.at(X_WA, X_WB).front().distance);
      EXPECT_EQ(back.front().p_WA, again.at(X_WA, X_WB).front().p_WB);
      EXPECT_EQ(back.front().n_W, -again.at(X_WA, X_WB).front().n_W);
    }
}

// A shape is as far from a surface as from the nearest of its triangles, each a hull of its own.
TEST(Clearance, OfASurfaceIsThatOfItsNearestTriangle) {
  RandomPairs random(9);
  int apart = 0;
  for (const MeshPointer& mesh : surfaces())
    for (int i = 0; i < 20; ++i) {
      const Shape shape = randomConvex(random, i % 5);
      TwoShapes two(shape, Shape::surface(mesh));
      const Transform X_WA = random.pose(0.6), X_WB = random.pose(0.2);
      const double found = two.at(X_WA, X_WB).front().distance;
      if (found <= 0.0) continue;
      ++apart;
      double least = kInfinity;
      for (const auto& t : mesh->triangles) {
        // As thin a hull as one can be.
        auto prism = std::make_shared<Mesh>();
        const auto corner = [&](std::size_t k) {
          return mesh->vertices[static_cast<std::size_t>(t[k])];
        };
        const Vector3 n = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
        for (std::size_t k = 0; k < 3; ++k)
          for (const double side : {0.0, -1e-4}) prism->vertices.push_back(corner(k) + side * n);
        TwoShapes one(shape, Shape::hull(prism));
        least = std::min(least, one.at(X_WA, X_WB).front().distance);
      }
      EXPECT_NEAR(found, least, 1e-9) << i;
    }
  EXPECT_GT(apart, 20);
}

// FCL's distance of two hierarchies of triangles has a closed form for each pair of them.
TEST(Clearance, OfSurfacesIsThatOfFcl) {
  RandomPairs random(13);
  const auto meshes = surfaces();
  TwoShapes two(Shape::surface(meshes[0]), Shape::surface(meshes[1]));
  const auto a = toFcl(*meshes[0]), b = toFcl(*meshes[1]);
  int apart = 0;
  for (int i = 0; i < 200; ++i) {
    const Transform X_WA = random.pose(0.4), X_WB = random.pose(0.4);
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    const double expected =
        fcl::distance(a.get(), toFcl(X_WA), b.get(), toFcl(X_WB), request, result);
    const auto points = two.at(X_WA, X_WB);
    ASSERT_FALSE(points.empty());
    if (!(expected > 0.0)) {
      EXPECT_LE(points.front().distance, 1e-6);
      continue;
    }
    ++apart;
    EXPECT_NEAR(points.front().distance, expected, 1e-9) << i;
  }
  EXPECT_GT(apart, 100);
  EXPECT_LT(apart, 200);
}

TEST(Clearance, OfLinksLeavesOutWhatIsJoined) {
  Scene scene(chain(4).build());
  const Model& model = scene.model;
  Kinematics k(model);
  computeKinematics(model, scene.state, k);
  Clearance distances(model);
  for (const auto& found : collision::clearances(model, k, distances)) {
    EXPECT_NE(found.a, found.b);
    EXPECT_GE(found.distance, 0.0);
  }
}

}  // namespace softgauss::test
