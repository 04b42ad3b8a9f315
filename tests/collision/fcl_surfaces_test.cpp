// SPDX-License-Identifier: Apache-2.0
// FCL as the second opinion on surfaces of triangles: its BVHModel against every kind of shape, a
// half-space among them, and against another BVHModel, apart and overlapping. Asked is whether they
// touch. Each kind is a process of its own with a time limit, so that an abort of FCL fails one
// test.
#include <gtest/gtest.h>

#include <memory>
#include <sstream>

#include "softgauss/collision/detail/geometry_set.hpp"
#include "softgauss/collision/filter.hpp"
#include "tests/collision/fcl_shapes.hpp"
#include "tests/collision/random_meshes.hpp"
#include "tests/support/in_child.hpp"

namespace softgauss::test {
namespace {

using namespace collision;
using enum ShapeKind;

constexpr ShapeKind kSurfaceKinds[] = {plane, sphere, capsule, cylinder, box, mesh, triangles};
/// Seconds that a kind may take; it takes one.
constexpr double kSurfaceLimit = 60.0;
/// How near to touching two answers may differ [m]: the tolerance of FCL's search is 1e-6 of its
/// own measure, of shapes of some decimetres.
constexpr double kSurfaceUndecided = 1e-5;

Shape randomShape(RandomPairs& random, ShapeKind kind) {
  if (kind == triangles) return Shape::surface(closedMesh(random));
  return kind == mesh ? Shape::hull(bumpyBall(random, 0.3)) : random.shape(kind);
}

/// A point in a convex shape.
Mesh centreOf(const collision::detail::GeometrySet& set, int g) {
  Mesh point;
  point.vertices.push_back(set.centreInG[idx(g)]);
  return point;
}

/// Whether a corner of one of two closed surfaces is within the other, by rays.
bool oneInTheOther(const Mesh& a, const Transform& X_WA, const Mesh& b, const Transform& X_WB,
                   RandomPairs& random) {
  const auto anyIn = [&](const Mesh& inner, const Mesh& outer, const Transform& X) {
    for (const Vector3& x : inner.vertices) {
      int inside = 0;
      for (int i = 0; i < 3; ++i) inside += insideMesh(outer, X * x, random.vector(1.0));
      if (inside >= 2) return true;
    }
    return false;
  };
  return anyIn(a, b, X_WB.inverse() * X_WA) || anyIn(b, a, X_WA.inverse() * X_WB);
}

struct SurfaceTally {
  int touching = 0, apart = 0, within = 0;
  std::ostringstream wrong;
};

/// Poses of a random closed surface against a random shape of a kind.
void trySurface(RandomPairs& random, ShapeKind kind, SurfaceTally& tally) {
  const Model model = twoBodies(Shape::surface(closedMesh(random)), randomShape(random, kind));
  PreparedMeshes meshes;
  const collision::detail::GeometrySet set(model, meshes);
  collision::detail::PairTest test;
  const auto [a, b] = inOrder(model, 0, 1);
  const Shape &shapeA = set.geometry(a).shape, &shapeB = set.geometry(b).shape;
  const auto fclA = toFcl(shapeA, set.hull[idx(a)].get()), fclB = toFcl(shapeB, nullptr);
  for (int i = 0; i < 20; ++i) {
    const Transform X_WA = random.pose(0.25), X_WB = random.pose(0.25);
    const auto deepest = [&](double margin) {
      const bool known = set.test(a, X_WA, b, X_WB, margin, test);
      const PairContact* found = known ? test.deepest() : nullptr;
      return found ? found->distance : kInfinity;
    };
    const bool theirs = touchInFcl(*fclA, X_WA, *fclB, X_WB);
    if (theirs) {
      // The triangles of the one meet the other; then the two solids do.
      if (!(deepest(kSurfaceUndecided) < kSurfaceUndecided))
        tally.wrong << "FCL says touching, we say apart\n";
      ++tally.touching;
    } else if (deepest(0.0) < -kSurfaceUndecided) {
      // FCL knows no inside of a surface: what is within it, without touching it, is apart.
      // Of a convex shape any point tells.
      const Mesh inner = kind == triangles ? *shapeA.mesh : centreOf(set, a);
      if (kind == plane || !oneInTheOther(inner, X_WA, *shapeB.mesh, X_WB, random))
        tally.wrong << "FCL says apart, we say " << deepest(0.0) << '\n';
      ++tally.within;
    } else {
      ++tally.apart;
    }
  }
}

/// What is wrong with the answers on a kind; empty if nothing is.
std::string compareSurfaces(ShapeKind kind) {
  SurfaceTally tally;
  RandomPairs random(17);
  for (int i = 0; i < 40; ++i) trySurface(random, kind, tally);
  if (tally.touching < 100 || tally.apart < 40)
    tally.wrong << tally.touching << " touch, " << tally.apart << " are apart, " << tally.within
                << " are within\n";
  return tally.wrong.str();
}

}  // namespace

TEST(FclOracle, AgreesOnSurfacesAgainstEveryKind) {
  for (const ShapeKind kind : kSurfaceKinds)
    EXPECT_EQ(inChild([&] { return compareSurfaces(kind); }, kSurfaceLimit), "")
        << "kind " << static_cast<int>(kind);
}

}  // namespace softgauss::test
