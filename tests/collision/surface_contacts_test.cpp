// SPDX-License-Identifier: Apache-2.0
/// Contacts of convex shapes with surfaces: against hulls, closed forms and an inside test.
#include "softgauss/collision/detail/surface_contacts.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/collision/random_pairs.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"
#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {
namespace {

using namespace collision;
using collision::detail::Collider;
using collision::detail::makeCollider;
using collision::detail::SurfaceContacts;
using enum ShapeKind;

/// A shape, with its hull where it is a mesh.
struct Solid {
  Shape shape;
  std::shared_ptr<const ConvexHull> hull;
  Collider collider;

  explicit Solid(const Shape& s) : shape(s) {
    if (shape.kind == mesh) hull = std::make_shared<ConvexHull>(makeConvexHull(*shape.mesh));
    collider = makeCollider(shape, hull.get());
  }
};

Shape randomHull(RandomPairs& random) {
  auto points = std::make_shared<Mesh>();
  for (int i = 0; i < 20; ++i) points->vertices.push_back(random.vector(0.3));
  return Shape::hull(points);
}

Shape randomShape(RandomPairs& random, ShapeKind kind) {
  return kind == mesh ? randomHull(random) : random.shape(kind);
}

constexpr ShapeKind kConvexKinds[] = {sphere, capsule, cylinder, box, mesh};

/// Largest distance from a point of one list to the nearest of the other, both ways [m].
double apart(const std::vector<PairContact>& x, const std::vector<PairContact>& y) {
  double worst = 0.0;
  for (const auto& [from, to] : {std::pair(&x, &y), std::pair(&y, &x)})
    for (const PairContact& a : *from) {
      double nearest = 1.0;
      for (const PairContact& b : *to)
        nearest = std::min(nearest, (a.p_WC - b.p_WC).norm() + (a.n_W - b.n_W).norm() +
                                        std::abs(a.distance - b.distance));
      worst = std::max(worst, nearest);
    }
  return worst;
}

std::vector<PairContact> listOf(const PairContacts& found) {
  return {found.points.begin(), found.points.begin() + found.count};
}

double leastDistance(const std::vector<PairContact>& points) {
  double least = 1.0;
  for (const PairContact& c : points) least = std::min(least, c.distance);
  return least;
}

/// Moves a shape along n until its separation from a convex one is `distance`.
void setDistance(const Solid& a, Transform& X_WA, const Solid& b, const Transform& X_WB,
                 double distance) {
  for (int i = 0; i < 30; ++i) {
    const auto [n, now] = collision::detail::separate(a.collider, X_WA, b.collider, X_WB, 10.0);
    X_WA.p -= (distance - now) * n;
  }
}

}  // namespace

// A plane of jittered triangles has the contacts of one polygon: inner edges do not show.
TEST(SurfaceContacts, OfAFlatMeshAreThoseOfItsHull) {
  const Solid ground(Shape::hull(gridMesh(2, 2, 2.0)));
  SurfaceContacts contacts;
  for (const double cell : {1.0, 0.1, 0.03}) {
    const int n = static_cast<int>(4.0 / cell);
    const TriangleMesh surface(gridMesh(n, n, cell, 0.3));
    for (const ShapeKind kind : kConvexKinds) {
      RandomPairs random(5);
      int points = 0;
      for (int i = 0; i < 100; ++i) {
        const Solid a(randomShape(random, kind));
        Transform X = random.pose(0.5);
        // Some lie flat, or nearly.
        if (i % 2 == 0) X.R = axisRotation(Vector3::UnitX(), i % 4 == 0 ? 0.0 : 1e-3);
        const Vector3 low = supportPoint(a.collider.convex, X, -Vector3::UnitZ());
        X.p.z() -= low.z() + random.uniform(-1e-3, 0.01);
        ASSERT_TRUE(contacts.find(a.collider, X, surface, Transform(), 0.0));
        PairContacts expected;
        convexConvex(a.collider, X, ground.collider, Transform(), 0.0, expected);
        SCOPED_TRACE(testing::Message()
                     << "kind " << static_cast<int>(kind) << ", case " << i << ", cell " << cell);
        for (const PairContact& c : contacts.points())
          EXPECT_APPROX(c.n_W, Vector3(0, 0, -1), 1e-12);
        ASSERT_EQ(contacts.points().empty(), expected.count == 0);
        if (expected.count == 0) continue;
        EXPECT_SMALL(leastDistance(contacts.points()) - deepest(expected), 1e-9);
        if (static_cast<int>(contacts.points().size()) == expected.count && kind != mesh) {
          EXPECT_SMALL(apart(contacts.points(), listOf(expected)), 1e-6);
          ++points;
        }
      }
      EXPECT_GT(points, kind == mesh ? -1 : 70) << static_cast<int>(kind);
    }
  }
}

// Convex bodies at little depth, and apart by less than the margin: one answer, whether by
// triangles or as hulls.
TEST(SurfaceContacts, OfAConvexMeshAreThoseOfItsHull) {
  const MeshPointer meshes[] = {boxSurface({0.3, 0.2, 0.25}), boxSurface({0.3, 0.2, 0.25}, 4),
                                ballSurface(0.3, 9, 12)};
  SurfaceContacts contacts;
  for (const MeshPointer& m : meshes) {
    const Solid b(Shape::hull(m));
    const TriangleMesh surface(m);
    for (const ShapeKind kind : kConvexKinds) {
      RandomPairs random(6);
      int same = 0, total = 0;
      for (int i = 0; i < 200; ++i) {
        const Solid a(randomShape(random, kind));
        Transform X_WA = random.pose(0.6);
        const Transform X_WB = random.pose(0.6);
        const double margin = i % 4 == 0 ? 0.01 : 0.0;
        setDistance(a, X_WA, b, X_WB, random.uniform(-2e-3, 5e-4));
        ASSERT_TRUE(contacts.find(a.collider, X_WA, surface, X_WB, margin));
        PairContacts found;
        convexConvex(a.collider, X_WA, b.collider, X_WB, margin, found);
        SCOPED_TRACE(testing::Message() << "kind " << static_cast<int>(kind) << ", case " << i);
        // The search for a direction ends early on round shapes.
        const double tolerance = kind == cylinder ? 1e-4 : 1e-8;
        const double least = std::min(leastDistance(contacts.points()), margin);
        ASSERT_SMALL(least - std::min(deepest(found), margin), tolerance);
        if (found.count == 0 || contacts.points().empty()) continue;
        ++total;
        same += apart(contacts.points(), listOf(found)) < 1e-4;
      }
      // The points too, but where a normal is nearly that of a face, and on what is round, whose
      // normals differ by what the search leaves.
      EXPECT_GE(same, kind == cylinder ? 0 : total - 2);
      EXPECT_GT(total, 100);
    }
  }
}

// A plate of 2 mm that is entered by 3 mm pushes back out of the side that was entered; its far
// side says nothing.
TEST(SurfaceContacts, TheFarSideOfAThinWallDoesNotPull) {
  for (const int n : {1, 20}) {
    const TriangleMesh plate(boxSurface({0.5, 0.5, 0.001}, n));
    SurfaceContacts contacts;
    for (const ShapeKind kind : kConvexKinds) {
      RandomPairs random(8);
      for (int i = 0; i < 30; ++i) {
        const Solid a(randomShape(random, kind));
        Transform X = random.pose(0.05);
        if (i % 2 == 0) X.R.setIdentity();
        X.p.z() += 0.001 - 0.003 - supportPoint(a.collider.convex, X, -Vector3::UnitZ()).z();
        ASSERT_TRUE(contacts.find(a.collider, X, plate, Transform(), 0.0));
        ASSERT_FALSE(contacts.points().empty());
        for (const PairContact& c : contacts.points()) {
          EXPECT_APPROX(c.n_W, Vector3(0, 0, -1), 1e-9) << static_cast<int>(kind) << ' ' << i;
          EXPECT_GT(c.distance, -0.003 - 1e-9);
        }
        EXPECT_SMALL(leastDistance(contacts.points()) + 0.003, 1e-6);
      }
    }
  }
}

// From behind, an open surface is not there.
TEST(SurfaceContacts, AnOpenSurfaceIsMetFromTheSideThatItFaces) {
  const TriangleMesh sheet(gridMesh(4, 4, 0.25, 0.2));
  SurfaceContacts contacts;
  const Solid ball(Shape::sphere(0.1)), cube(Shape::box({0.1, 0.1, 0.1}));
  for (const Solid* a : {&ball, &cube}) {
    contacts.find(a->collider, at(0.02, 0.01, 0.099), sheet, Transform(), 0.0);
    EXPECT_FALSE(contacts.points().empty());
    contacts.find(a->collider, at(0.02, 0.01, -0.05), sheet, Transform(), 0.0);
    EXPECT_TRUE(contacts.points().empty());
  }
}

namespace {

/// Closed surfaces at random against every kind of shape, from apart to deep inside: nothing that
/// is overlapped is missed, as rays through the surface tell, and every normal is a unit vector.
void expectNoOverlapMissed(int cases) {
  const MeshPointer meshes[] = {ringSurface(0.5, 0.2, 24, 12), boxSurface({0.5, 0.4, 0.3}, 4),
                                ballSurface(0.5, 12, 16)};
  SurfaceContacts contacts;
  std::vector<int> scratch;
  int overlaps = 0, touching = 0;
  for (const MeshPointer& m : meshes) {
    const TriangleMesh surface(m);
    for (const ShapeKind kind : kConvexKinds) {
      RandomPairs random(9);
      for (int i = 0; i < cases; ++i) {
        const Solid a(randomShape(random, kind));
        const Transform X_WA = random.pose(0.8), X_WB = random.pose(0.2);
        SCOPED_TRACE(testing::Message()
                     << m->file << ", kind " << static_cast<int>(kind) << ", case " << i);
        ASSERT_TRUE(contacts.find(a.collider, X_WA, surface, X_WB, 0.0));
        touching += !contacts.points().empty();
        for (const PairContact& c : contacts.points()) {
          ASSERT_SMALL(c.n_W.norm() - 1.0, 1e-9);
          ASSERT_TRUE(c.p_WC.allFinite() && c.distance < 0.0);
          ASSERT_GT(c.distance, -3.0);
        }
        // Points of A: its centre and those halfway to its surface.
        bool inside = surface.encloses(X_WB.inverse() * (X_WA * a.collider.boxCentre), scratch);
        for (int k = 0; k < 6; ++k) {
          const Vector3 d = Vector3::Unit(k / 2) * (k % 2 == 0 ? 1.0 : -1.0);
          const Vector3 x =
              0.5 * (X_WA * a.collider.boxCentre + supportPoint(a.collider.convex, X_WA, d));
          inside = inside || surface.encloses(X_WB.inverse() * x, scratch);
        }
        if (!inside) continue;
        ++overlaps;
        ASSERT_FALSE(contacts.points().empty());
      }
    }
  }
  EXPECT_GT(overlaps, 2 * cases);
  EXPECT_GT(touching, overlaps);
}

}  // namespace

TEST(SurfaceContacts, MissNoOverlap) { expectNoOverlapMissed(2000); }

// Of fifteen kinds of pairs, 100,000 poses.
TEST(SurfaceContactsLong, MissNoOverlap) { expectNoOverlapMissed(6700); }

TEST(SurfaceContacts, PosesThatAreNotFiniteAreTold) {
  const TriangleMesh surface(gridMesh(2, 2, 1.0));
  SurfaceContacts contacts;
  for (const ShapeKind kind : kConvexKinds) {
    RandomPairs random(1);
    const Solid a(randomShape(random, kind));
    Transform X = at(0, 0, 0);
    X.p.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(contacts.find(a.collider, X, surface, Transform(), 0.0));
    EXPECT_TRUE(contacts.points().empty());
  }
}

TEST(SurfaceContacts, AllocateNothingInSteadyStateAndRepeatTheirBits) {
  const MeshPointer bumps = gridMesh(60, 60, 0.05, 0.2, [](double x, double y) {
    return 0.03 * std::sin(7.0 * x) * std::sin(5.0 * y);
  });
  const TriangleMesh surface(bumps);
  RandomPairs random(3);
  std::deque<Solid> solids;  // colliders point into them
  std::vector<Transform> poses;
  for (int i = 0; i < 200; ++i) {
    solids.emplace_back(randomShape(random, kConvexKinds[i % 5]));
    poses.push_back(random.pose(0.6));
  }
  SurfaceContacts contacts;
  const auto sumOfAll = [&] {
    Vector3 sum = Vector3::Zero();
    int count = 0;
    for (std::size_t i = 0; i < solids.size(); ++i) {
      contacts.find(solids[i].collider, poses[i], surface, Transform(), 0.0);
      for (const PairContact& c : contacts.points()) sum += c.distance * c.n_W + c.p_WC, ++count;
    }
    EXPECT_GT(count, 100);
    return sum;
  };
  const Vector3 first = sumOfAll();
  const AllocationGuard guard;
  const Vector3 second = sumOfAll();
  EXPECT_EQ(guard.count(), 0);
  EXPECT_EQ(first, second);
}

// What a pair remembers of the triangles about it changes no bit.
TEST(SurfaceContacts, AreTheSameWithWhatThePairRemembers) {
  const TriangleMesh surface(gridMesh(60, 60, 0.05, 0.2, [](double x, double y) {
    return 0.03 * std::sin(7.0 * x) * std::sin(5.0 * y);
  }));
  SurfaceContacts with, without;
  int touching = 0;
  for (const ShapeKind kind : kConvexKinds) {
    RandomPairs random(4);
    const Solid a(randomShape(random, kind));
    Transform X = random.pose(0.1);
    collision::detail::SurfaceReach reach;
    for (int i = 0; i < 300; ++i) {
      X.p += random.vector(0.02);
      X.p.z() = std::clamp(X.p.z(), -0.05, 0.3);
      X.R = axisRotation(random.vector(1.0).normalized(), 0.05) * X.R;
      ASSERT_TRUE(with.find(a.collider, X, surface, Transform(), 0.001, &reach));
      ASSERT_TRUE(without.find(a.collider, X, surface, Transform(), 0.001));
      ASSERT_EQ(with.points().size(), without.points().size());
      for (std::size_t k = 0; k < with.points().size(); ++k) {
        ASSERT_EQ(with.points()[k].p_WC, without.points()[k].p_WC);
        ASSERT_EQ(with.points()[k].distance, without.points()[k].distance);
      }
      touching += !with.points().empty();
    }
  }
  EXPECT_GT(touching, 500);
}

// The end of a cylinder has eight corners, of which four carry; the rest is counted.
TEST(SurfaceContacts, AreThinnedAndCounted) {
  ModelBuilder builder = freeBody(boxLink("body", 1.0, {0.4, 0.4, 0.1}));
  builder.X_WRoot.p.z() = 0.0999;
  builder.geometry(geometrySpec("body", Shape::cylinder(0.4, 0.1)));
  builder.geometry(geometrySpec("world", Shape::surface(gridMesh(70, 70, 0.05, 0.2))));
  const Model model = builder.build();
  SceneContacts scene(model);
  Kinematics kinematics(model);
  computeKinematics(model, State(model), kinematics);
  ContactSet contacts;
  scene.detect(model, kinematics, contacts);
  EXPECT_EQ(contacts.size(), 4);
  EXPECT_EQ(contacts.pointsReduced, 4);
  EXPECT_EQ(contacts.pairsSkipped, 0);
}

}  // namespace softgauss::test
