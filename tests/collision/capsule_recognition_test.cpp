// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/capsule_recognition.hpp"

#include <gtest/gtest.h>

#include "tests/collision/random_pairs.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

GeometrySpec spec(const std::string& name, const Shape& shape, const Transform& X = {},
                  const std::string& link = "arm") {
  GeometrySpec g;
  g.name = name;
  g.link = link;
  g.shape = shape;
  g.X_LG = X;
  return g;
}

/// A cylinder and two caps at pose X.
std::vector<GeometrySpec> written(const Transform& X, double r, double L) {
  return {spec("lower", Shape::sphere(r), X * at(0, 0, -L)),
          spec("shaft", Shape::cylinder(r, L), X),
          spec("upper", Shape::sphere(r), X * at(0, 0, L))};
}

}  // namespace

TEST(CapsuleRecognition, CappedCylinderBecomesACapsule) {
  RandomPairs random(1);
  const Transform X = random.pose(1.0);
  const auto found = recogniseCapsules(written(X, 0.05, 0.2));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "shaft");
  EXPECT_EQ(found[0].shape.kind, ShapeKind::capsule);
  EXPECT_EQ(found[0].shape.radius, 0.05);
  EXPECT_EQ(found[0].shape.halfLength, 0.2);
  EXPECT_TRUE(found[0].X_LG.p.isApprox(X.p));
}

TEST(CapsuleRecognition, NumbersOfATextFileAreExactEnough) {
  auto shapes = written({}, 0.05, 0.2);
  shapes[0].X_LG.p.x() += 1e-8;
  shapes[2].shape.radius += 1e-8;
  EXPECT_EQ(recogniseCapsules(shapes).size(), 1u);
}

TEST(CapsuleRecognition, OtherTriplesAreLeftAlone) {
  const auto unchanged = [](auto&& change) {
    auto shapes = written({}, 0.05, 0.2);
    change(shapes);
    const auto found = recogniseCapsules(shapes);
    EXPECT_EQ(found.size(), shapes.size());
    EXPECT_EQ(found[1].shape.kind, ShapeKind::cylinder);
  };
  unchanged([](auto& s) { s[0].shape.radius = 0.06; });
  unchanged([](auto& s) { s[0].X_LG.p.z() += 1e-3; });
  unchanged([](auto& s) { s[0].X_LG.p = s[2].X_LG.p; });
  unchanged([](auto& s) { s[2].link = "hand"; });
  unchanged([](auto& s) { s[2].material.slidingFriction = 0.5; });
}

TEST(CapsuleRecognition, SharedCapServesBothCylinders) {
  // An L of two cylinders with three spheres, and a lone sphere.
  auto shapes = written({}, 0.05, 0.2);
  const Transform bent = turned({0, 1, 0}, M_PI / 2, {0.2, 0, 0.2});
  shapes.push_back(spec("second", Shape::cylinder(0.05, 0.2), bent));
  shapes.push_back(spec("tip", Shape::sphere(0.05), at(0.4, 0, 0.2)));
  shapes.push_back(spec("head", Shape::sphere(0.1), at(0, 0, 1)));
  const auto found = recogniseCapsules(shapes);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].name, "shaft");
  EXPECT_EQ(found[1].name, "second");
  EXPECT_EQ(found[2].name, "head");
  EXPECT_EQ(found[1].shape.kind, ShapeKind::capsule);
}

TEST(CapsuleRecognition, EqualCapsAreAllInside) {
  auto shapes = written({}, 0.05, 0.2);
  shapes.push_back(shapes[0]);
  EXPECT_EQ(recogniseCapsules(shapes).size(), 1u);
}

TEST(CapsuleRecognition, OtherShapesKeepTheirOrder) {
  const std::vector<GeometrySpec> shapes = {spec("a", Shape::box({1, 1, 1})),
                                            spec("b", Shape::cylinder(0.1, 0.2)),
                                            spec("c", Shape::plane())};
  const auto found = recogniseCapsules(shapes);
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found[i].name, shapes[i].name);
}
