// SPDX-License-Identifier: Apache-2.0
/// Families 2 and 3: contacts of edge on edge and of lines that are almost parallel, and a box that
/// is pressed between more walls than it needs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "softgauss/engine/core/rotation.hpp"
#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

constexpr double kReach = 0.3;  // from a centre to the farthest surface [m]

/// Speed of the surface and place over the last second of `seconds`: what rests does not jitter.
void restsWithoutJitter(Trial& t, const std::string& link, double seconds) {
  t.run(seconds - 1.0);
  const Vector3 begun = t.origin(link);
  double fastest = 0.0, farthest = 0.0;
  t.run(1.0, [&] {
    for (Eigen::Index i = 0; i < t.state.v.size(); i += 6)
      fastest = std::max(
          fastest, t.state.v.segment<3>(i).norm() + kReach * t.state.v.segment<3>(i + 3).norm());
    farthest = std::max(farthest, (t.origin(link) - begun).norm());
  });
  t.expect("fastest in the last second", fastest, 1e-5, "m/s");
  t.expect("farthest in it", farthest, 1e-6, "m");
  t.expect("penetration at rest", t.data->stats.maxPenetration,
           1e-3 * std::pow(std::max(1.0, 2.0 * t.model.options.timestep / 0.02), 2.0), "m");
}

/// Two bars of square profile on their edges, one body, across two such rails: four contacts of
/// edge on edge, which cross at a right angle less `skew`.
ModelBuilder sled(double skew) {
  ModelBuilder builder("sled");
  const Matrix3 onEdgeX = axisRotation(Vector3::UnitX(), 0.25 * M_PI),
                onEdgeY = axisRotation(Vector3::UnitY(), 0.25 * M_PI);
  constexpr double kHalf = 0.05, kEdge = kHalf * M_SQRT2;
  for (const double side : {-1.0, 1.0})
    builder.geometry(geometrySpec("world", Shape::box(Vector3(kHalf, 0.5, kHalf)), 0.8,
                                  {onEdgeY, Vector3(0.2 * side, 0, kEdge)}));
  LinkSpec link = boxLink("sled", 2.0, Vector3(0.3, 0.2, 0.05));
  ModelBuilder body("sled");
  body.base = BaseKind::floating;
  body.X_WRoot = {axisRotation(Vector3::UnitZ(), skew), Vector3(0, 0, 3.0 * kEdge)};
  body.link(link);
  for (const double side : {-1.0, 1.0})
    body.geometry(geometrySpec("sled", Shape::box(Vector3(0.3, kHalf, kHalf)), 0.8,
                               {onEdgeX, Vector3(0, 0.15 * side, 0)}));
  builder.add(body, "");
  return builder;
}

TEST(Jams, EdgesOnEdgesRest) {
  for (const double skew : {0.0, 1e-9, 1e-3, 0.3})
    for (const double timestep : kSteps)
      for (const Cone cone : kCones) {
        Trial t("edges on edges", with(sled(skew), timestep, cone));
        restsWithoutJitter(t, "sled", 3.0);
        EXPECT_EQ(t.data->stats.contacts, 4);
      }
}

// A capsule in the groove between two others, parallel to them but for a small angle.
TEST(Jams, CapsulesThatAreAlmostParallelRest) {
  for (const double angle : {0.0, 1e-12, 1e-9, 1e-6, 1e-3})
    for (const double timestep : kSteps)
      for (const Cone cone : kCones) {
        ModelBuilder builder("capsules");
        constexpr double kRadius = 0.05;
        const Matrix3 along = axisRotation(Vector3::UnitY(), 0.5 * M_PI);
        for (const double side : {-1.0, 1.0})
          builder.geometry(geometrySpec("world", Shape::capsule(kRadius, 0.3), 0.8,
                                        {along, Vector3(0, kRadius * side, 0)}));
        addBody(builder, "capsule", Shape::capsule(kRadius, 0.2), 1.0,
                {axisRotation(Vector3::UnitZ(), angle) * along,
                 Vector3(0, 0, kRadius * std::sqrt(3.0))},
                0.8);
        Trial t("capsules within " + std::to_string(angle), with(builder, timestep, cone));
        // Its ends begin 0.2 sin 30° · angle deep, more than its weight asks: it is lifted out.
        t.mayGain += 9.81 * 0.2 * 0.5 * angle / std::cos(M_PI / 6.0);
        restsWithoutJitter(t, "capsule", 8.0);  // it turns back at the creep of its friction
      }
}

// A cube of 0.2 m in a pit of four walls 0.1 mm too narrow, and 100 kg upon it: seven faces for six
// freedoms. It leaves no wall, turns nowhere and rests; walls push no more than their depth asks.
void jams(double friction, double timestep, Cone cone) {
  ModelBuilder builder("jam");
  builder.geometry(groundSpec(friction));
  for (const double side : {-1.0, 1.0}) {
    builder.geometry(geometrySpec("world", Shape::box(Vector3(0.1, 0.4, 0.1)), friction,
                                  {Matrix3::Identity(), Vector3(0.1999 * side, 0, 0.1)}));
    builder.geometry(geometrySpec("world", Shape::box(Vector3(0.4, 0.1, 0.1)), friction,
                                  {Matrix3::Identity(), Vector3(0, 0.1999 * side, 0.1)}));
  }
  addBody(builder, "box", Shape::box(Vector3::Constant(0.1)), 1.0,
          {Matrix3::Identity(), Vector3(0, 0, 0.1)}, friction);
  addBody(builder, "press", Shape::box(Vector3(0.09, 0.09, 0.1)), 100.0,
          {Matrix3::Identity(), Vector3(0, 0, 0.3)}, friction);
  Trial t(friction > 0.0 ? "jammed box" : "jammed box, smooth", with(builder, timestep, cone));
  t.run(2.0);
  t.expect("off the middle", t.origin("box").head<2>().norm(), 1e-6, "m");
  t.expect("off the floor", t.origin("box").z() - 0.1,
           1e-3 * std::pow(std::max(1.0, 2.0 * timestep / 0.02), 2.0), "m");
  t.expect("tilt", tilt(t, "box"), 1e-5, "rad");
  t.expect("speed at rest", t.state.v.cwiseAbs().maxCoeff(), 1e-5, "m/s");
  // Opposite walls press alike: their forces on the box add up to its weight and the load's.
  Vector3 sum = Vector3::Zero();
  double pressing = 0.0;
  const auto add = [&](const auto& rows) {
    for (int i = 0; i < static_cast<int>(rows.contactsWithRows().size()); ++i) {
      const Contact& c = t.data->contacts.contacts[rows.contactsWithRows()[i].contact];
      if (c.bodyA != 0 && c.bodyB != 0) continue;
      const Vector3 force = c.bodyA == 0 ? rows.force(i) : Vector3(-rows.force(i));
      sum += force;
      pressing = std::max(pressing, force.head<2>().norm());
    }
  };
  t.data->constraints.visitContacts(add);
  t.expect("forces less the weight", (sum - Vector3(0, 0, 101.0 * 9.81)).norm(), 1e-2 * 991.0, "N");
  EXPECT_GT(pressing, 0.0);
}

// Without friction walls and floor alone hold it.
TEST(Jams, BoxBetweenMoreWallsThanItNeeds) {
  for (const double friction : {0.0, 1.0})
    for (const double timestep : kSteps)
      for (const Cone cone : kCones) jams(friction, timestep, cone);
}

}  // namespace
}  // namespace softgauss::test
