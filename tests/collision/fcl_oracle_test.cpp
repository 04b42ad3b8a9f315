// SPDX-License-Identifier: Apache-2.0
// FCL as the second opinion on every pair of kinds, hulls among them, apart and overlapping. Asked
// is what FCL answers well: whether two shapes touch. Each pair of kinds is a process of its own
// with a time limit, so that an abort of FCL fails one test.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "softgauss/collision/detail/convex_pairs.hpp"
#include "softgauss/collision/primitive_pairs.hpp"
#include "tests/collision/fcl_shapes.hpp"
#include "tests/collision/random_pairs.hpp"
#include "tests/support/in_child.hpp"

namespace softgauss::test {
namespace {

using namespace collision;
using enum ShapeKind;

constexpr ShapeKind kKinds[] = {plane, sphere, capsule, cylinder, box, ellipsoid, mesh};
/// Seconds that a pair of kinds may take; it takes a tenth of one.
constexpr double kLimit = 60.0;
/// How near to touching two answers may differ [m]: the tolerance of FCL's search is 1e-6 of its
/// own measure, and its answers are asked for at shapes of some decimetres.
constexpr double kUndecided = 1e-4;

/// A shape for both sides.
struct Both {
  Shape shape;
  std::shared_ptr<const ConvexHull> hull;
  FclGeometry fcl;
};

Both randomBoth(RandomPairs& random, ShapeKind kind) {
  Both both{random.shape(kind), nullptr, nullptr};
  if (kind == mesh) {
    auto points = std::make_shared<Mesh>();
    for (int i = 0; i < 24; ++i) points->vertices.push_back(random.vector(0.3));
    both.shape = Shape::hull(points);
    both.hull = std::make_shared<ConvexHull>(makeConvexHull(*points));
  }
  both.fcl = toFcl(both.shape, both.hull.get());
  return both;
}

bool touchByFcl(const Both& a, const Transform& X_WA, const Both& b, const Transform& X_WB) {
  return touchInFcl(*a.fcl, X_WA, *b.fcl, X_WB);
}

/// Our answer, whichever way the pair is tested; +∞ for "apart". A capsule's contacts are blended
/// where it lies along the other, or is pierced: they have no single depth, told as −∞. In a
/// half-space they have.
PairContact deepestByOurs(const Both& a, const Transform& X_WA, const Both& b,
                          const Transform& X_WB) {
  PairContacts found;
  if (hasClosedForm(a.shape.kind, b.shape.kind))
    collideInOrder(a.shape, X_WA, b.shape, X_WB, b.hull.get(), 0.0, found);
  else
    convexConvex(collision::detail::makeCollider(a.shape, a.hull.get()), X_WA,
                 collision::detail::makeCollider(b.shape, b.hull.get()), X_WB, 0.0, found);
  PairContact best{Vector3::Zero(), Vector3::UnitZ(), std::numeric_limits<double>::infinity()};
  for (int i = 0; i < found.count; ++i)
    if (found[i].distance < best.distance) best = found[i];
  for (const Both* s : {&a, &b})
    if (a.shape.kind != plane && s->shape.kind == capsule &&
        hasClosedForm(a.shape.kind, b.shape.kind) && best.distance < 0.0 &&
        (found.count > 1 || best.distance < -s->shape.radius))
      best.distance = -std::numeric_limits<double>::infinity();
  return best;
}

/// What is wrong with the answers on a pair of kinds; empty if nothing is.
std::string compare(ShapeKind kindA, ShapeKind kindB) {
  std::ostringstream wrong;
  RandomPairs random(11);
  int touching = 0, apart = 0, errors = 0;
  for (int i = 0; i < 300; ++i) {
    const Both a = randomBoth(random, kindA), b = randomBoth(random, kindB);
    const Transform X_WA = random.pose(0.45);
    Transform X_WB = random.pose(0.45);
    const PairContact ours = deepestByOurs(a, X_WA, b, X_WB);
    const bool touch = ours.distance < 0.0;
    if (!touch) {
      ++apart;
      // Pushed together by hardly anything they touch, if FCL is right that they touch.
      if (!touchByFcl(a, X_WA, b, X_WB)) continue;
      X_WB.p -= kUndecided *
                (kindA == plane ? Vector3(X_WA.R.col(2)) : Vector3((X_WB.p - X_WA.p).normalized()));
      if (!(deepestByOurs(a, X_WA, b, X_WB).distance < 0.0))
        wrong << "case " << i << ": FCL says touching, we say apart\n";
      continue;
    }
    if (ours.distance > -kUndecided) continue;
    ++touching;
    if (!touchByFcl(a, X_WA, b, X_WB)) wrong << "case " << i << ": FCL says apart\n";
    if (std::isinf(ours.distance)) continue;
    // Moved out along our normal they are apart, by a little less they touch.
    const auto moved = [&](double way, const Vector3& n) {
      Transform X = X_WB;
      X.p += way * n;
      return touchByFcl(a, X_WA, b, X);
    };
    const double depth = -ours.distance;
    // Contacts of a cylinder's round ends tell its depth to a tenth (manifold.hpp).
    const bool isRound = kindA == cylinder || kindB == cylinder;
    const double out = (isRound ? depth / 0.9 : depth) + kUndecided;
    if (moved(out, ours.n_W)) {
      // Support points prove them apart along n, or do not: FCL's search errs at times.
      Transform X = X_WB;
      X.p += out * ours.n_W;
      if (kindA != plane &&
          separationAlong({&a.shape, a.hull.get()}, X_WA, {&b.shape, b.hull.get()}, X, ours.n_W) >
              0.5 * kUndecided)
        ++errors;
      else
        wrong << "case " << i << ": still touching, moved by the depth " << depth << '\n';
    }
    if (!moved(std::max(0.0, 0.98 * depth - kUndecided), ours.n_W))
      wrong << "case " << i << ": apart, moved by less than the depth " << depth << '\n';
    // No other direction is a shorter way out.
    for (int k = 0; k < 6; ++k) {
      const Vector3 n = random.vector(1.0).normalized();
      if (!moved(0.98 * depth - kUndecided, n) && depth > 0.02)
        wrong << "case " << i << ": a shorter way out than " << depth << '\n';
    }
  }
  if (errors > touching / 50) wrong << errors << " touch for FCL that are proved apart\n";
  if (touching < 50 || apart < 20) wrong << touching << " touch, " << apart << " are apart\n";
  return wrong.str();
}

}  // namespace

TEST(FclOracle, AgreesOnEveryPairOfKinds) {
  for (std::size_t i = 0; i < std::size(kKinds); ++i)
    for (std::size_t j = i; j < std::size(kKinds); ++j) {
      if (kKinds[j] == plane) continue;  // two half-spaces always meet
      const std::string wrong = inChild([&] { return compare(kKinds[i], kKinds[j]); }, kLimit);
      EXPECT_EQ(wrong, "") << "kinds " << static_cast<int>(kKinds[i]) << " and "
                           << static_cast<int>(kKinds[j]);
    }
}

TEST(InChild, TellsWhatBecameOfIt) {
  EXPECT_EQ(inChild([] { return std::string(); }, 10.0), "");
  EXPECT_EQ(inChild([] { return std::string("found"); }, 10.0), "found");
  EXPECT_EQ(inChild([]() -> std::string { throw std::runtime_error("no"); }, 10.0),
            "child: throws: no");
  EXPECT_NE(inChild([]() -> std::string { std::abort(); }, 10.0).find("signal 6"),
            std::string::npos);
  EXPECT_NE(inChild(
                []() -> std::string {
                  for (;;) pause();
                },
                0.2)
                .find("not done"),
            std::string::npos);
}

}  // namespace softgauss::test
