// SPDX-License-Identifier: Apache-2.0
/// What a contact does whose softness nobody gave: it hardly gives, stops what comes within a step,
/// lets nothing through, and holds what is carried.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tests/stability/scenes.hpp"
#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {
namespace {

constexpr double kGravity = 9.81;
constexpr double kLawSteps[] = {0.0005, 0.002, 0.005, 0.01};

/// What a near-rigid row leaves of a residual, and the depth that its load has (3.15): a body's
/// weight, whatever it weighs.
constexpr double kLeft = 1.0 / 31.0;
double depthOfWeight(double h) { return kGravity * h * (0.5 * h + 0.04) / 30.0; }

ModelBuilder ballAbove(double radius, double mass, double height) {
  ModelBuilder builder("ball");
  builder.geometry(groundSpec(0.5));
  addBody(builder, "ball", Shape::sphere(radius), mass,
          {Matrix3::Identity(), Vector3(0.0, 0.0, radius + height)}, 0.5);
  return builder;
}

// A ball that falls by 1 m goes as deep as its row leaves of the last step's way, and its weight.
TEST(ContactLaw, ABallFromAMetreGoesHardlyIn) {
  for (const Cone cone : kCones)
    for (const double h : kLawSteps) {
      Trial t("ball from 1 m", with(ballAbove(0.1, 1.0, 1.0), h, cone));
      t.run(1.0);
      const double v = std::sqrt(2.0 * kGravity);
      t.expect("deepest", t.deepest, kLeft * v * h + depthOfWeight(h) + 1e-6, "m");
      t.expect("deepest, as asked", t.deepest, h < 0.01 ? 1e-3 : 5e-3, "m");
    }
}

// From pebble to grain, what lies on the ground lies as deep as its weight asks.
TEST(ContactLaw, BeadsOfAnySizeRestAsDeepAsTheirWeightAsks) {
  for (const Cone cone : kCones)
    for (const double h : kLawSteps)
      for (const double radius : {5e-4, 5e-3, 0.5}) {
        const double mass = 4000.0 * std::pow(radius, 3.0);
        Trial t(fmt::format("bead of {} mm", 2e3 * radius),
                with(ballAbove(radius, mass, 0.0), h, cone));
        t.run(4.0);
        t.expect("depth beyond its weight's", t.data->stats.maxPenetration / depthOfWeight(h) - 1.0,
                 1e-3, "of it");
      }
}

// Speed aside changes nothing: what stops aside by friction is no slip that goes on.
TEST(ContactLaw, ObliqueImpactsGoNoDeeper) {
  for (const Cone cone : kCones)
    for (const double h : kLawSteps)
      for (const double aside : {2.0, 5.0, 10.0})
        for (const double friction : {0.5, 1.0})
          for (const bool ball : {true, false}) {
            ModelBuilder builder("oblique");
            builder.geometry(groundSpec(friction));
            addBody(builder, "body",
                    ball ? Shape::sphere(0.1) : Shape::box(Vector3(0.05, 0.05, 0.05)), 1.0,
                    {Matrix3::Identity(), Vector3(0.0, 0.0, ball ? 1.1 : 1.05)}, friction);
            Trial t(fmt::format("{} from 1 m with {} m/s aside, friction {}",
                                ball ? "ball" : "cube", aside, friction),
                    with(builder, h, cone));
            t.state.v[0] = aside;
            t.run(0.8);
            t.expect("deepest", t.deepest, h < 0.01 ? 1e-3 : 5e-3, "m");
            if (!ball) continue;  // a cube of this friction tips
            t.expect("height at the end", std::abs(t.origin("body").z() - 0.1), 2e-3, "m");
          }
}

// Nothing passes a wall of 10 mm, from whatever side. At 100 m/s a step of 10 ms leaves 1/31 of a
// metre, and elliptic cones, and what comes askew, are not asked (docs/limits.md).
TEST(ContactLaw, NothingPassesAThinWall) {
  for (const Cone cone : kCones)
    for (const double h : kLawSteps)
      for (const double speed : {1.0, 3.0, 10.0, 30.0, 100.0})
        for (const auto& [ball, degrees, friction] : {std::tuple(true, 0.0, 0.5),
                                                      {false, 0.0, 0.5},
                                                      {true, 20.0, 1.0},
                                                      {true, 45.0, 0.5},
                                                      {false, 45.0, 1.0}}) {
          if (speed * h > 0.49 && (cone == Cone::elliptic || degrees > 0.0)) continue;
          ModelBuilder builder("wall");
          builder.options.gravity.setZero();
          builder.geometry(geometrySpec("world", Shape::box(Vector3(0.005, 4.0, 4.0)), friction,
                                        {Matrix3::Identity(), Vector3(1.0, 0.0, 0.0)}));
          const Matrix3 askew = Eigen::AngleAxisd(0.6, Vector3(1, 2, 3).normalized()).matrix();
          addBody(builder, "body",
                  ball ? Shape::sphere(degrees > 0.0 ? 0.005 : 0.02)
                       : Shape::box(Vector3(0.02, 0.03, 0.01)),
                  0.1, {askew, Vector3::Zero()}, friction);
          Trial t(fmt::format("{} at {} m/s, {} deg", ball ? "ball" : "box", speed, degrees),
                  with(builder, h, cone));
          const double angle = degrees * M_PI / 180.0;
          t.state.v[0] = speed * std::cos(angle);
          t.state.v[1] = speed * std::sin(angle);
          t.mayGain = 1e-3 * t.energy().total();
          double farthest = 0.0;
          t.run(3.0 / speed, [&] { farthest = std::max(farthest, t.origin("body").x()); });
          // Past the middle it would be pushed out on the other side.
          t.expect("centre", farthest, degrees > 0.0 ? 1.0 : 0.995, "m");
        }
}

/// A body of half height 0.05 m on a slope of `angle` [rad] that falls by `yaw` from the x axis.
ModelBuilder onSlope(const Shape& shape, double angle, double yaw, int condim, double friction) {
  const Matrix3 R =
      (Eigen::AngleAxisd(yaw, Vector3::UnitZ()) * Eigen::AngleAxisd(angle, Vector3::UnitY()))
          .toRotationMatrix();
  ModelBuilder builder("slope");
  GeometrySpec ground = groundSpec(friction, R);
  ground.material.condim = condim;
  builder.geometry(ground);
  addBody(builder, "body", shape, 1.0, {R, R * Vector3(0.0, 0.0, 0.05)}, friction);
  return builder;
}

// What lies on a slope comes to rest, up to nearly all that friction holds and whichever way the
// slope falls: what sticks hardens until nothing is left to creep by.
TEST(ContactLaw, NothingCreepsOnASlope) {
  const std::pair<const char*, Shape> bodies[] = {{"box", Shape::box(Vector3(0.1, 0.1, 0.05))},
                                                  {"disc", Shape::cylinder(0.1, 0.05)}};
  // 15° of μ = 1, and shares of the cone.
  const std::pair<double, double> loads[] = {
      {std::tan(M_PI / 12.0), 1.0}, {0.5, 0.6}, {0.7, 0.6}, {0.9, 0.6}};
  for (const auto& [name, shape] : bodies)
    for (const auto& [share, friction] : loads)
      for (const double yaw : {0.0, 30.0, 45.0})
        for (const int condim : {3, 6})
          for (const Cone cone : kCones)
            for (const double h : kLawSteps) {
              const bool edges = condim > 3 && cone == Cone::pyramidal;
              if (edges && share > 0.7) continue;  // discs may slide (docs/limits.md)
              Trial t(
                  fmt::format("{} at {} of the cone, {} deg, condim {}", name, share, yaw, condim),
                  with(onSlope(shape, std::atan(friction * share), yaw * M_PI / 180.0, condim,
                               friction),
                       h, cone));
              t.run(6.0);
              t.expect("creeps", t.state.v.head<3>().norm(), 1e-6, "m/s");
            }
}

/// A ball of 1 kg that rolls or spins, with moments of friction of 2 mm and 4 mm.
Model rollingBall(double h, Cone cone) {
  Model model = with(ballAbove(0.1, 1.0, 0.0), h, cone).build();
  for (Geometry& geometry : model.geometries) {
    geometry.material.condim = 6;
    geometry.material.slidingFriction = 1.0;
    geometry.material.rollingFriction = 0.002;
    geometry.material.torsionalFriction = 0.004;
  }
  return model;
}

/// Time from which on |v_i| stays below 1/1000 of what it was, within 6 s [s], and the ball's way
/// [m].
std::pair<double, double> stops(Trial& t, int dof) {
  const double from = std::abs(t.state.v[dof]);
  const Vector3 begun = t.origin("ball");
  double stopped = 0.0;
  t.run(6.0, [&] {
    if (std::abs(t.state.v[dof]) > 1e-3 * from) stopped = t.state.time;
  });
  return {stopped, (t.origin("ball") - begun).norm()};
}

// Rolling friction is Coulomb's: a ball slows down by a = 5/7 c g/R, whatever its speed, rolls by
// v²/2a = 0.892 m and stops after v/a = 3.57 s. Cones keep that at any step. Along a pyramid the
// edges that roll share the load with those that slide, 1.5 %, and with the last speed: what is
// missing grows with the step (docs/limits.md).
TEST(ContactLaw, ABallRollsAsFarAsCoulombLets) {
  constexpr double kSpeed = 0.5, kSlows = 5.0 / 7.0 * 0.002 * kGravity / 0.1;
  constexpr double kWay = kSpeed * kSpeed / (2.0 * kSlows), kTime = kSpeed / kSlows;
  for (const Cone cone : kCones)
    for (const double h : kLawSteps)
      for (const double degrees : {0.0, 22.5, 45.0}) {
        Trial t(fmt::format("rolling ball at {} deg", degrees), rollingBall(h, cone));
        const double c = std::cos(degrees * M_PI / 180.0), s = std::sin(degrees * M_PI / 180.0);
        t.state.v.head<2>() << kSpeed * c, kSpeed * s;
        t.state.v.segment<2>(3) << -kSpeed / 0.1 * s, kSpeed / 0.1 * c;
        const auto [time, way] = stops(t, 0);
        const bool pyramid = cone == Cone::pyramidal;
        t.expect("way", std::abs(way / kWay - 1.0), pyramid ? 0.02 + 3.0 * h : 2e-3, "of it");
        t.expect("time", std::abs(time / kTime - 1.0), pyramid ? 0.02 + 20.0 * h : 5e-3, "of it");
      }
}

// So is torsional friction: ω̇ = c g/(2/5 R²).
TEST(ContactLaw, ABallSpinsAsLongAsCoulombLets) {
  constexpr double kSpin = 20.0, kTime = kSpin * 0.4 * 0.01 / (0.004 * kGravity);
  for (const Cone cone : kCones)
    for (const double h : kLawSteps) {
      Trial t("spinning ball", rollingBall(h, cone));
      t.state.v[5] = kSpin;
      t.expect("time", std::abs(stops(t, 5).first / kTime - 1.0), 2e-3 + 2.0 * h, "of it");
    }
}

constexpr double kFriction = 0.8, kCarried = 0.2;

/// Two fingers on a palm, which goes along x and up z, and a body of kCarried between them.
ModelBuilder grasp(const Shape& shape = Shape::box(Vector3::Constant(0.03)), int condim = 3) {
  ModelBuilder builder("hand");
  builder.base = BaseKind::fixed;
  builder.geometry(groundSpec(kFriction));
  builder.link(emptyLink("world")).link(emptyLink("carriage"));
  builder.joint(jointSpec("along", JointType::prismatic, "world", "carriage",
                          {Matrix3::Identity(), Vector3(0.0, 0.0, 0.03)}, Vector3::UnitX()));
  builder.link(boxLink("palm", 0.5, Vector3(0.02, 0.06, 0.01), Vector3(0.0, 0.0, 0.1)));
  builder.joint(jointSpec("up", JointType::prismatic, "carriage", "palm", {}, Vector3::UnitZ()));
  for (const double side : {-1.0, 1.0}) {
    const std::string finger = side < 0.0 ? "left" : "right";
    builder.link(boxLink(finger, 0.1, Vector3(0.015, 0.01, 0.02)));
    builder.joint(jointSpec("press_" + finger, JointType::prismatic, "palm", finger,
                            {Matrix3::Identity(), Vector3(0.0, 0.041 * side, 0.0)},
                            Vector3(0.0, -side, 0.0)));
    GeometrySpec pad = geometrySpec(finger, Shape::box(Vector3(0.015, 0.01, 0.02)), kFriction);
    pad.material.condim = condim;
    builder.geometry(pad);
  }
  addBody(builder, "cube", shape, kCarried, {Matrix3::Identity(), Vector3(0.0, 0.0, 0.03)},
          kFriction);
  return builder;
}

/// Presses with `squeeze` [N], lifts by 0.2 m from 1 s to 2 s, and swings by 0.1 m from 3 s on.
void carry(Trial& t, double squeeze) {
  const auto dof = [&](const char* joint) { return t.model.bodies[t.model.findJoint(joint)].v; };
  const int along = dof("along"), up = dof("up");
  const double now = t.state.time;
  const auto rise = [](double u) { return u * u * (3.0 - 2.0 * u); };
  const auto slope = [](double u) { return 6.0 * u * (1.0 - u); };
  const double u = std::clamp(now - 1.0, 0.0, 1.0), w = std::clamp(now - 3.0, 0.0, 1.0);
  const double lift = 0.2 * rise(u), rate = 0.2 * slope(u);
  const double sine = 0.1 * std::sin(2.0 * (now - 3.0)), cosine = std::cos(2.0 * (now - 3.0));
  const double swing = rise(w) * sine, swings = slope(w) * sine + rise(w) * 0.2 * cosine;
  const double lifted = 0.7 + (now > 1.0 ? kCarried : 0.0);
  t.input.tau[up] =
      lifted * kGravity + 2000.0 * (lift - t.state.q[up]) + 80.0 * (rate - t.state.v[up]);
  t.input.tau[along] = 2000.0 * (swing - t.state.q[along]) + 80.0 * (swings - t.state.v[along]);
  t.input.tau[dof("press_left")] = t.input.tau[dof("press_right")] = squeeze;
}

// A cube that is carried to and fro for a minute by fingers that press with 2 or 1.1 times what
// Coulomb's law needs for its weight.
TEST(ContactLaw, WhatIsCarriedIsHeld) {
  for (const Cone cone : kCones)
    for (const double h : kLawSteps)
      for (const double load : {0.5, 0.9}) {
        Trial t(fmt::format("grasp at {:.0f} %", 100.0 * load), with(grasp(), h, cone));
        t.mayGain = t.mayRise = kInfinity;  // the hand drives
        const double squeeze = kCarried * kGravity / (2.0 * kFriction * load);
        const auto place = [&]() -> Vector3 { return t.origin("cube") - t.origin("palm"); };
        carry(t, squeeze);
        t.run(3.0, [&] { carry(t, squeeze); });
        const Vector3 begun = place();
        t.run(60.0, [&] { carry(t, squeeze); });
        t.expect("slips in a minute", (place() - begun).norm(), load > 0.5 ? 5e-3 : 5e-4, "m");
      }
}

// What is held still does not creep, up to nearly all that friction holds, whatever its shape.
TEST(ContactLaw, NothingCreepsInAGrasp) {
  const std::pair<const char*, Shape> bodies[] = {{"cube", Shape::box(Vector3::Constant(0.03))},
                                                  {"ball", Shape::sphere(0.03)},
                                                  {"can", Shape::cylinder(0.03, 0.03)}};
  for (const auto& [name, shape] : bodies)
    for (const double load : {0.5, 0.9, 0.97})
      for (const int condim : {3, 6})
        for (const Cone cone : kCones)
          for (const double h : kLawSteps) {
            const bool edges = condim > 3 && cone == Cone::pyramidal;
            if (edges && load > 0.7 && shape.kind == ShapeKind::cylinder) continue;  // as discs
            Trial t(fmt::format("{} gripped at {:.0f} %, condim {}", name, 100.0 * load, condim),
                    with(grasp(shape, condim), h, cone));
            t.mayGain = t.mayRise = kInfinity;  // the hand drives
            const double squeeze = kCarried * kGravity / (2.0 * kFriction * load);
            carry(t, squeeze);
            t.run(2.9, [&] { carry(t, squeeze); });
            const Vector3 begun = t.origin("cube") - t.origin("palm");
            // It is held aloft from 2 s on; from 3 s on it would swing.
            t.run(0.1, [&] { carry(t, squeeze); });
            t.expect("creeps", (t.origin("cube") - t.origin("palm") - begun).norm() / 0.1, 1e-6,
                     "m/s");
          }
}

/// A pendulum of 1 m at 60° whose bob is two fingers with a cube between them.
ModelBuilder swungGrasp(const Shape& cube) {
  ModelBuilder builder("hand");
  builder.base = BaseKind::fixed;
  const Matrix3 R = Eigen::AngleAxisd(M_PI / 3.0, Vector3::UnitY()).toRotationMatrix();
  builder.link(emptyLink("world"));
  builder.link(boxLink("palm", 0.5, Vector3(0.02, 0.06, 0.01), Vector3(0.0, 0.0, -1.0)));
  builder.joint(jointSpec("swing", JointType::continuous, "world", "palm", {R, Vector3::Zero()},
                          Vector3::UnitY()));
  for (const double side : {-1.0, 1.0}) {
    const std::string finger = side < 0.0 ? "left" : "right";
    builder.link(boxLink(finger, 0.1, Vector3(0.015, 0.01, 0.02)));
    builder.joint(jointSpec("press_" + finger, JointType::prismatic, "palm", finger,
                            {Matrix3::Identity(), Vector3(0.0, 0.04 * side, -1.0)},
                            Vector3(0.0, -side, 0.0)));
    builder.geometry(geometrySpec(finger, Shape::box(Vector3(0.015, 0.01, 0.02)), kFriction));
  }
  ModelBuilder carried = freeBody(boxLink("cube", kCarried, Vector3::Constant(0.03)));
  carried.X_WRoot = {R, R * Vector3(0.0, 0.0, -1.0)};
  carried.geometry(geometrySpec("cube", cube, kFriction));
  return builder.add(carried, "");
}

// Fingers that press with twice what Coulomb's law needs at the lowest point, where the cube weighs
// twice as much. All turn by up to 0.03 rad in a step: a contact that knew the velocity alone would
// let the cube slip outwards by ½ (h ω)² L in each, 40 mm in 5 s of 2 ms.
TEST(ContactLaw, WhatIsSwungIsHeld) {
  const Vector3 half = Vector3::Constant(0.03);
  for (const Shape& cube : {Shape::box(half), Shape::hull(boxSurface(half))})
    for (const Cone cone : kCones)
      for (const double h : kLawSteps) {
        Trial t(fmt::format("swung {}", cube.kind == ShapeKind::box ? "box" : "hull"),
                with(swungGrasp(cube), h, cone));
        t.mayGain = t.mayRise = kInfinity;  // the fingers drive
        for (const char* finger : {"press_left", "press_right"})
          t.input.tau[t.model.bodies[t.model.findJoint(finger)].v] =
              2.0 * kCarried * kGravity / kFriction;
        const auto place = [&]() -> Vector3 {
          return t.rotation("palm").transpose() * (t.origin("cube") - t.origin("palm"));
        };
        t.run(h);
        const Vector3 begun = place();
        t.run(5.0);
        t.expect("slips in 5 s", (place() - begun).norm(), 5e-4, "m");
      }
}

}  // namespace
}  // namespace softgauss::test
