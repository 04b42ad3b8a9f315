// SPDX-License-Identifier: Apache-2.0
/// Contacts of hollow bodies: of two that are apart there is none, and of two of which one has been
/// pushed into the other by δ from where they first touch there is one, none deeper than δ. Along
/// its normal the way out is not longer than the way in.
///
/// Whether they touch FCL tells, triangle by triangle, of two surfaces; of a surface and a convex
/// shape, our search for a plane between the shape and each triangle.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <sstream>

#include "softgauss/collision/detail/fcl_triangle_tree.hpp"
#include "softgauss/collision/detail/surface_contacts.hpp"
#include "softgauss/collision/detail/surface_pairs.hpp"
#include "tests/collision/random_pairs.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/in_child.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {
namespace {

using namespace collision;
using collision::detail::Collider;
using collision::detail::colliderOf;
using collision::detail::makeCollider;
using collision::detail::SurfaceContacts;
using collision::detail::SurfacePairs;
using enum ShapeKind;

/// Seconds that a pair of bodies may take; it takes one.
constexpr double kLimit = 120.0;
/// How far one is pushed in [m]: less than the triangles are wide.
constexpr double kDeltas[] = {1e-4, 1e-3};

std::vector<MeshPointer> hollowMeshes() {
  return {ringSurface(0.5, 0.15, 24, 12), washerSurface(0.5, 0.25, 0.1),
          clampSurface({0.5, 0.3, 0.4}, 0.2),
          joined({{boxSurface({0.4, 0.3, 0.02}), at(0, 0, 0.3)},
                  {boxSurface({0.03, 0.03, 0.3}), at(0.35, 0.2, 0)},
                  {boxSurface({0.03, 0.03, 0.3}), at(-0.35, -0.2, 0)}})};
}

/// What is known of a pair, whatever it is made of. A is moved.
struct Pair {
  std::function<bool(const Transform&)> touches;
  std::function<const std::vector<PairContact>&(const Transform&)> contacts;
};

/// What is wrong with its contacts; empty if nothing is. `slack` is what a round shape's contacts
/// may be deeper by.
std::string check(const Pair& pair, int cases, double slack) {
  std::ostringstream wrong;
  RandomPairs random(5);
  int pushed = 0, apart = 0;
  for (int i = 0; i < cases; ++i) {
    Transform X = random.pose(1.0);
    const Vector3 way = (random.vector(0.4) - X.p).normalized();  // towards the other
    if (pair.touches(X)) {
      if (pair.contacts(X).empty()) wrong << "case " << i << ": missed\n";
      continue;
    }
    ++apart;
    if (!pair.contacts(X).empty()) wrong << "case " << i << ": apart, and a contact\n";
    constexpr double kStride = 0.03;
    const auto moved = [&](double s) { return Transform{X.R, X.p + s * way}; };
    double low = 0.0;
    while (low < 2.0 && !pair.touches(moved(low + kStride))) low += kStride;
    if (low >= 2.0) continue;
    double high = low + kStride;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      (pair.touches(moved(middle)) ? high : low) = middle;
    }
    const double delta = kDeltas[i % 2];
    ++pushed;
    double depth = -std::numeric_limits<double>::infinity();
    for (const PairContact& c : pair.contacts(moved(high + delta))) {
      depth = std::max(depth, -c.distance);
      if (!c.p_WC.allFinite() || std::abs(c.n_W.norm() - 1.0) > 1e-9)
        wrong << "case " << i << ": no unit normal\n";
    }
    if (!(depth > 0.0))
      wrong << "case " << i << ": missed, pushed in by " << delta << '\n';
    else if (depth > (1.0 + slack) * delta + 1e-7)
      wrong << "case " << i << ": " << depth << " deep, pushed in by " << delta << '\n';
  }
  if (pushed < cases / 10 || apart < cases / 4) wrong << pushed << " pushed of " << apart << '\n';
  return wrong.str();
}

std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> trianglesOf(const Mesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles)
    triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2]));
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

std::string checkSurfaces(const MeshPointer& meshA, const MeshPointer& meshB, int cases) {
  const TriangleMesh a(meshA), b(meshB);
  const auto fclA = trianglesOf(*meshA), fclB = trianglesOf(*meshB);
  SurfacePairs pairs;
  const Pair pair{[&](const Transform& X) {
                    fcl::Transform3d T = fcl::Transform3d::Identity();
                    T.linear() = X.R;
                    T.translation() = X.p;
                    const fcl::CollisionRequestd request;
                    fcl::CollisionResultd result;
                    return fcl::collide(fclA.get(), T, fclB.get(),
                                        fcl::Transform3d(fcl::Transform3d::Identity()), request,
                                        result) > 0;
                  },
                  [&](const Transform& X) -> const std::vector<PairContact>& {
                    pairs.find(a, X, b, Transform(), 0.0);
                    return pairs.points();
                  }};
  return check(pair, cases, 0.0);
}

/// Long and thin, or small: what fits into hollows.
Shape slenderShape(RandomPairs& random, ShapeKind kind) {
  const double scale = random.uniform(0.2, 1.0);
  switch (kind) {
    case sphere:
      return Shape::sphere(0.3 * scale);
    case capsule:
      return Shape::capsule(0.1 * scale, random.uniform(0.1, 0.8));
    case cylinder:
      return Shape::cylinder(0.15 * scale, random.uniform(0.1, 0.8));
    case box:
      return Shape::box({0.15 * scale, 0.1 * scale, random.uniform(0.1, 0.8)});
    default: {
      auto points = std::make_shared<Mesh>();
      for (int i = 0; i < 20; ++i) points->vertices.push_back(random.vector(0.3 * scale));
      return Shape::hull(points);
    }
  }
}

std::string checkShape(const Shape& shape, const MeshPointer& mesh, int cases) {
  const std::shared_ptr<const ConvexHull> hull =
      shape.kind == ShapeKind::mesh ? std::make_shared<ConvexHull>(makeConvexHull(*shape.mesh))
                                    : nullptr;
  const Collider a = makeCollider(shape, hull.get());
  const TriangleMesh surface(mesh);
  SurfaceContacts contacts;
  std::vector<int> scratch;
  const Pair pair{
      [&](const Transform& X) {
        if (surface.encloses(X * a.boxCentre, scratch)) return true;
        for (int t = 0; t < surface.size(); ++t) {
          const Triangle triangle = surface.triangle(t);
          if (separate(a, X, colliderOf({&triangle, 1}), Transform(), 1e-3).distance < 0.0)
            return true;
        }
        return false;
      },
      [&](const Transform& X) -> const std::vector<PairContact>& {
        contacts.find(a, X, surface, Transform(), 0.0);
        return contacts.points();
      }};
  // The sides of what is round are straight lines, a little beside the deepest place.
  const bool isRound = shape.kind == capsule || shape.kind == cylinder;
  return check(pair, cases, isRound ? 0.1 : 0.0);
}

void expectDepths(int cases) {
  const std::vector<MeshPointer> meshes = hollowMeshes();
  for (const MeshPointer& a : meshes)
    for (const MeshPointer& b : meshes)
      EXPECT_EQ(inChild([&] { return checkSurfaces(a, b, cases); }, kLimit), "")
          << a->file << " and " << b->file;
}

}  // namespace

TEST(SurfaceDepth, OfTwoSurfacesIsNoMoreThanTheWayIn) { expectDepths(60); }

// Sixteen pairs, 100,000 poses.
TEST(SurfaceDepthLong, OfTwoSurfacesIsNoMoreThanTheWayIn) { expectDepths(6250); }

TEST(SurfaceDepth, OfAShapeAndASurfaceIsNoMoreThanTheWayIn) {
  for (const MeshPointer& mesh : hollowMeshes())
    for (const ShapeKind kind : {sphere, capsule, cylinder, box, ShapeKind::mesh}) {
      RandomPairs random(3);
      for (int i = 0; i < 4; ++i) {
        const Shape shape = slenderShape(random, kind);
        EXPECT_EQ(checkShape(shape, mesh, 40), "")
            << mesh->file << ", kind " << static_cast<int>(kind) << ", shape " << i;
      }
    }
}

// Faces that lie on each other touch in the corners of what they share, whatever they are cut into.
TEST(SurfacePairs, ThatLieOnEachOtherTouchAtFourCorners) {
  const double sunk = 1e-4;
  const TriangleMesh upper(clampSurface({0.5, 0.3, 0.4}, 0.2));
  const TriangleMesh plates[] = {TriangleMesh(washerSurface(0.8, 0.1, 0.05)),
                                 TriangleMesh(clampSurface({0.5, 0.3, 0.4}, 0.2))};
  SurfacePairs pairs;
  for (const TriangleMesh& lower : plates) {
    // The other clamp lies with its floor up.
    const bool isClamp = &lower == &plates[1];
    const Transform X_WB =
        isClamp ? turned(Vector3::UnitX(), M_PI, {0, 0, -0.4}) : at(0.05, 0.02, -0.05);
    ASSERT_TRUE(pairs.find(upper, at(0, 0, 0.4 - sunk), lower, X_WB, 0.0));
    ASSERT_EQ(pairs.points().size(), 4u);
    for (const PairContact& c : pairs.points()) {
      EXPECT_APPROX(c.n_W, Vector3(0, 0, -1), 1e-9);
      EXPECT_SMALL(c.distance + sunk, 1e-9);
      EXPECT_SMALL(std::abs(c.p_WC.x()) - 0.5, 1e-6);
      EXPECT_SMALL(std::abs(c.p_WC.y()) - 0.3, 1e-6);
    }
  }
}

// Whichever of two is asked first, the contacts are the same but for their sides.
TEST(SurfacePairs, SwappedTurnTheirNormals) {
  const std::vector<MeshPointer> meshes = hollowMeshes();
  SurfacePairs one, other;
  RandomPairs random(2);
  int touching = 0;
  for (int i = 0; i < 300; ++i) {
    const TriangleMesh a(meshes[static_cast<std::size_t>(i % 4)]),
        b(meshes[static_cast<std::size_t>(i / 4 % 4)]);
    const Transform X_WA = random.pose(0.5), X_WB = random.pose(0.5);
    one.find(a, X_WA, b, X_WB, 0.0);
    other.find(b, X_WB, a, X_WA, 0.0);
    ASSERT_EQ(one.touch(), other.touch()) << i;
    ASSERT_EQ(one.points().empty(), other.points().empty()) << i;
    touching += one.touch();
  }
  EXPECT_GT(touching, 50);
}

TEST(SurfacePairs, AllocateNothingInSteadyStateAndRepeatTheirBits) {
  const TriangleMesh ring(ringSurface(0.5, 0.15, 24, 12));
  const TriangleMesh clamp(clampSurface({0.5, 0.3, 0.4}, 0.2));
  RandomPairs random(3);
  std::vector<Transform> poses;
  for (int i = 0; i < 200; ++i) poses.push_back(random.pose(0.6));
  SurfacePairs pairs;
  const auto sumOfAll = [&] {
    Vector3 sum = Vector3::Zero();
    for (const Transform& X : poses) {
      pairs.find(ring, X, clamp, Transform(), 0.0);
      for (const PairContact& c : pairs.points()) sum += c.distance * c.n_W + c.p_WC;
    }
    EXPECT_GT(sum.norm(), 0.0);
    return sum;
  };
  const Vector3 first = sumOfAll();
  const AllocationGuard guard;
  const Vector3 second = sumOfAll();
  EXPECT_EQ(guard.count(), 0);
  EXPECT_EQ(first, second);
}

TEST(SurfacePairs, PosesThatAreNotFiniteAreTold) {
  const TriangleMesh ring(ringSurface(0.5, 0.15, 24, 12));
  SurfacePairs pairs;
  EXPECT_FALSE(
      pairs.find(ring, at(0, 0, std::numeric_limits<double>::quiet_NaN()), ring, Transform(), 0.0));
  EXPECT_TRUE(pairs.points().empty());
}

}  // namespace softgauss::test
