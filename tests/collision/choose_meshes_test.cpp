// SPDX-License-Identifier: Apache-2.0
/// Hull or triangles, where nobody said.
#include "softgauss/collision/choose_meshes.hpp"

#include <gtest/gtest.h>

#include "softgauss/engine/model/model_builder.hpp"
#include "tests/support/sample_models.hpp"
#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {
namespace {

using collision::chooseMeshes;
using collision::PreparedMeshes;

struct Chosen {
  ShapeKind kind;
  std::string warnings;
};

/// What a mesh becomes on the world, or on a floating body.
Chosen choose(const MeshPointer& mesh, bool fixed, bool either = true) {
  ModelBuilder builder = freeBody(boxLink("part", 1.0, {0.1, 0.1, 0.1}));
  GeometrySpec g = geometrySpec(fixed ? "world" : "part", Shape::hull(mesh));
  g.automaticMesh = either;
  builder.geometry(g);
  Model model = builder.build();
  const std::size_t before = model.warnings.size();
  PreparedMeshes meshes;
  chooseMeshes(model, meshes);
  Chosen chosen{model.geometries[0].shape.kind, {}};
  for (std::size_t i = before; i < model.warnings.size(); ++i) chosen.warnings += model.warnings[i];
  EXPECT_FALSE(model.geometries[0].automaticMesh);
  return chosen;
}

/// A mesh whose second half of triangles is turned over.
MeshPointer turned(const MeshPointer& mesh) {
  auto copy = std::make_shared<Mesh>(*mesh);
  for (std::size_t t = copy->triangles.size() / 2; t < copy->triangles.size(); ++t)
    std::swap(copy->triangles[t][0], copy->triangles[t][1]);
  return copy;
}

bool says(const Chosen& chosen, const std::string& words) {
  return chosen.warnings.find(words) != std::string::npos;
}

TEST(ChooseMeshes, AConvexMeshIsItsHull) {
  for (const bool fixed : {true, false}) {
    const Chosen chosen = choose(boxSurface({0.1, 0.2, 0.3}, 3), fixed);
    EXPECT_EQ(chosen.kind, ShapeKind::mesh);
    EXPECT_EQ(chosen.warnings, "");
  }
}

// As triangles too, so that both move alike to the bit.
TEST(ChooseMeshes, TrianglesThatEncloseAConvexSolidAreItsHull) {
  const auto kindOf = [](const MeshPointer& mesh) {
    ModelBuilder builder = freeBody(boxLink("part", 1.0, {0.1, 0.1, 0.1}));
    builder.geometry(geometrySpec("part", Shape::surface(mesh)));
    Model model = builder.build();
    PreparedMeshes meshes;
    chooseMeshes(model, meshes);
    return model.geometries[0].shape.kind;
  };
  EXPECT_EQ(kindOf(boxSurface({0.1, 0.2, 0.3}, 3)), ShapeKind::mesh);
  EXPECT_EQ(kindOf(ballSurface(0.5, 9, 12)), ShapeKind::mesh);
  EXPECT_EQ(kindOf(ringSurface(0.5, 0.1, 24, 12)), ShapeKind::triangles);
  EXPECT_EQ(kindOf(bowlMesh(0.5, 4, 8)), ShapeKind::triangles);
}

TEST(ChooseMeshes, TrianglesThatFaceInwardsAreToldToBeARoom) {
  auto inwards = std::make_shared<Mesh>(*boxSurface({0.1, 0.2, 0.3}, 3));
  for (auto& triangle : inwards->triangles) std::swap(triangle[0], triangle[1]);
  ModelBuilder builder = freeBody(boxLink("part", 1.0, {0.1, 0.1, 0.1}));
  builder.geometry(geometrySpec("world", Shape::surface(inwards)));
  Model model = builder.build();
  PreparedMeshes meshes;
  chooseMeshes(model, meshes);
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_NE(model.warnings.back().find("walls of a room"), std::string::npos)
      << model.warnings.back();
}

TEST(ChooseMeshes, WhatIsHollowIsItsTrianglesWhereItIsFixed) {
  const Chosen chosen = choose(ringSurface(0.5, 0.1, 24, 12), true);
  EXPECT_EQ(chosen.kind, ShapeKind::triangles);
  EXPECT_EQ(chosen.warnings, "");
}

TEST(ChooseMeshes, AHullThatFillsWhatMovesIsTold) {
  const Chosen chosen = choose(ringSurface(0.5, 0.1, 24, 12), false);
  EXPECT_EQ(chosen.kind, ShapeKind::mesh);
  for (const char* words : {"hull", "'part'", "ring", "93.2 l", "hull 206 l"})
    EXPECT_TRUE(says(chosen, words)) << words << ": " << chosen.warnings;
}

TEST(ChooseMeshes, AMeshThatIsNotClosedIsTold) {
  const Chosen fixed = choose(gridMesh(4, 4, 0.1), true), moving = choose(bowlMesh(1, 4, 8), false);
  EXPECT_EQ(fixed.kind, ShapeKind::triangles);
  EXPECT_EQ(moving.kind, ShapeKind::mesh);
  EXPECT_TRUE(says(fixed, "not closed") && says(fixed, "16 open edges")) << fixed.warnings;
  EXPECT_TRUE(says(moving, "not closed") && says(moving, "hull")) << moving.warnings;
}

TEST(ChooseMeshes, MixedSidesAreHullsAndTold) {
  for (const bool fixed : {true, false}) {
    const Chosen chosen = choose(turned(ringSurface(0.5, 0.1, 24, 12)), fixed);
    EXPECT_EQ(chosen.kind, ShapeKind::mesh);
    EXPECT_TRUE(says(chosen, "do not all face outwards") && says(chosen, "hull"))
        << chosen.warnings;
  }
}

TEST(ChooseMeshes, WhatWasSaidStays) {
  const Chosen moving = choose(ringSurface(0.5, 0.1, 24, 12), false, false);
  EXPECT_EQ(moving.kind, ShapeKind::mesh);
  EXPECT_EQ(moving.warnings, "");
}

TEST(ChooseMeshes, AHullThatWasAskedForAndFillsWhatIsFixedIsTold) {
  const Chosen ring = choose(ringSurface(0.5, 0.1, 24, 12), true, false);
  EXPECT_EQ(ring.kind, ShapeKind::mesh);
  for (const char* words : {"as asked for", "ring", "93.2 l", "hull 206 l"})
    EXPECT_TRUE(says(ring, words)) << words << ": " << ring.warnings;
}

}  // namespace
}  // namespace softgauss::test
