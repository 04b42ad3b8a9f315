// SPDX-License-Identifier: Apache-2.0
/// Family 1: heavy robots on light feet. What a contact feels of a foot is what turns it about its
/// ankle, and neither it nor any body tells what stands above. Engines whose contacts follow the
/// foot let the robot sink in proportion: MuJoCo 100 kg on feet of 10 g by 6 to 73 mm.

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

/// How far the ankle is above the sole, and about how many axes it turns.
struct Ankle {
  double height;
  int axes;
};

constexpr Ankle kAnkles[] = {{0.02, 1}, {0.02, 2}, {0.1, 1}, {0.1, 2}};
constexpr double kSole = 0.01;  // half its height

/// Hangs a foot on a link at p, by an ankle.
void addFoot(ModelBuilder& builder, const std::string& name, const std::string& parent,
             const Vector3& p, double mass, const Ankle& ankle) {
  const Transform sole{Matrix3::Identity(), Vector3(0, 0, -ankle.height)};
  const Vector3 half(0.08, 0.03, kSole);
  std::string last = parent;
  Vector3 at = p;
  if (ankle.axes == 2) {
    last = name + "_ankle";
    builder.link(emptyLink(last));
    builder.joint(jointSpec(name + "_roll", JointType::continuous, parent, last,
                            {Matrix3::Identity(), at}, Vector3::UnitX()));
    at.setZero();
  }
  builder.link(boxLink(name, mass, half, sole.p));
  builder.joint(jointSpec(name + "_pitch", JointType::continuous, last, name,
                          {Matrix3::Identity(), at}, Vector3::UnitY()));
  builder.geometry(geometrySpec(name, Shape::box(half), 1.0, sole));
}

/// A body of 0.6 m × 0.4 m that stands on four feet.
ModelBuilder robot(double mass, double foot, const Ankle& ankle) {
  ModelBuilder builder("robot");
  builder.base = BaseKind::floating;
  builder.geometry(groundSpec(1.0));
  builder.link(boxLink("body", mass, Vector3(0.3, 0.2, 0.1)));
  for (const double x : {-0.25, 0.25})
    for (const double y : {-0.2, 0.2})
      addFoot(builder, (x < 0.0 ? "hind" : "fore") + std::string(y < 0.0 ? "_right" : "_left"),
              "body", Vector3(x, y, -0.2), foot, ankle);
  return builder;
}

/// 1 mm at rest, as the square of the time constant, which is at least two steps.
double bound(double timestep) { return 1e-3 * std::pow(std::max(1.0, timestep / 0.01), 2.0); }

void comesToRest(Trial& t, double timestep) {
  t.run(1.5);
  t.expect("penetration at rest", t.data->stats.maxPenetration, bound(timestep), "m");
  t.expect("speed at rest", t.state.v.cwiseAbs().maxCoeff(), 1e-6, "m/s");
}

std::string named(const std::string& what, double mass, double foot, const Ankle& ankle) {
  return what + " of " + std::to_string(mass) + " kg on feet of " + std::to_string(foot) + " kg, " +
         std::to_string(ankle.height) + " m below " + std::to_string(ankle.axes) + " axes";
}

/// Calls f(mass, foot, ankle, timestep, cone) for all.
template <class F>
void forAll(F&& f) {
  for (const auto& [mass, foot] :
       {std::pair(10.0, 0.1), std::pair(100.0, 0.1), std::pair(100.0, 0.01), std::pair(1e3, 0.01)})
    for (const Ankle& ankle : kAnkles)
      for (const double timestep : kSteps)
        for (const Cone cone : kCones) f(mass, foot, ankle, timestep, cone);
}

TEST(LightFeet, BearARobot) {
  forAll([](double mass, double foot, const Ankle& ankle, double timestep, Cone cone) {
    Trial t(named("a robot", mass, foot, ankle), with(robot(mass, foot, ankle), timestep, cone));
    t.state.q[2] = 0.2 + ankle.height + kSole;
    comesToRest(t, timestep);
  });
}

// A hopper on a rail, which holds it upright and bears none of it.
TEST(LightFeet, BearAHopperOnARail) {
  forAll([](double mass, double foot, const Ankle& ankle, double timestep, Cone cone) {
    ModelBuilder builder("hopper");
    builder.base = BaseKind::fixed;
    builder.link(emptyLink("world"));
    builder.geometry(groundSpec(1.0));
    builder.link(boxLink("body", mass, Vector3::Constant(0.1)));
    builder.joint(jointSpec("rail", JointType::prismatic, "world", "body"));
    addFoot(builder, "foot", "body", Vector3(0, 0, -0.2), foot, ankle);
    Trial t(named("a hopper", mass, foot, ankle), with(builder, timestep, cone));
    t.state.q[0] = 0.2 + ankle.height + kSole;
    comesToRest(t, timestep);
  });
}

// A ram that slides on a rail, which bears none of it, on plates that are free.
TEST(LightFeet, PlatesBearARamOnARail) {
  for (const auto& [mass, plates, plate] :
       {std::tuple(10.0, 1, 0.1), std::tuple(100.0, 1, 1.0), std::tuple(100.0, 3, 0.1),
        std::tuple(1000.0, 1, 1.0), std::tuple(1000.0, 3, 0.1)})
    for (const double timestep : kSteps)
      for (const Cone cone : kCones) {
        ModelBuilder builder("ram");
        builder.base = BaseKind::fixed;
        builder.link(emptyLink("world"));
        builder.geometry(groundSpec(1.0));
        builder.link(boxLink("ram", mass, Vector3::Constant(0.1)));
        builder.joint(jointSpec("rail", JointType::prismatic, "world", "ram"));
        builder.geometry(geometrySpec("ram", Shape::box(Vector3::Constant(0.1))));
        for (int i = 0; i < plates; ++i)
          addBody(builder, "plate" + std::to_string(i), Shape::box(Vector3(0.15, 0.15, 0.03)),
                  plate, {Matrix3::Identity(), Vector3(0, 0, 0.03 + 0.06 * i)});
        Trial t("a ram of " + std::to_string(mass) + " kg on " + std::to_string(plates) +
                    " plates of " + std::to_string(plate) + " kg",
                with(builder, timestep, cone));
        for (const Tree& tree : t.model.trees)
          if (!t.model.floats(t.model.bodies[tree.rootBody].tree))
            t.state.q[t.model.bodies[tree.rootBody].q] = 0.1 + 0.06 * plates;
        comesToRest(t, timestep);
      }
}

// A robot on a board of 0.1 kg, which bears it on fewer contacts.
TEST(LightFeet, BearARobotOnABoard) {
  for (const double timestep : kSteps)
    for (const Cone cone : kCones) {
      const Ankle ankle{0.1, 2};
      ModelBuilder builder = robot(100.0, 0.1, ankle);
      addBody(builder, "board", Shape::box(Vector3(0.5, 0.4, 0.02)), 0.1,
              {Matrix3::Identity(), Vector3(0, 0, 0.02)});
      Trial t("a robot on a board", with(builder, timestep, cone));
      t.state.q[2] = 0.2 + ankle.height + kSole + 0.04;
      comesToRest(t, timestep);
    }
}

/// A body of 1 to 100 kg with one to five legs of one to three hinges, whose feet of 5 to 500 g are
/// boxes or, every other seed, balls.
ModelBuilder anyRobot(Random& random, bool round) {
  ModelBuilder builder("any robot");
  builder.base = BaseKind::floating;
  builder.geometry(groundSpec(1.0));
  const Vector3 half(0.3, 0.2, 0.1);
  builder.link(boxLink("body", decades(random, 1.0, 100.0), half));
  builder.geometry(geometrySpec("body", Shape::box(half), 1.0));
  const int legs = 1 + random.index(5);
  for (int leg = 0; leg < legs; ++leg) {
    const int joints = 1 + random.index(3);
    std::string last = "body";
    Vector3 at(random.uniform(-0.25, 0.25), random.uniform(-0.2, 0.2), -0.1);
    for (int i = 1; i <= joints; ++i) {
      const std::string name = "leg" + std::to_string(leg) + "_" + std::to_string(i);
      const double length = random.uniform(0.02, 0.3);
      const Transform middle{Matrix3::Identity(), Vector3(0, 0, -0.5 * length)};
      const double mass = decades(random, 0.005, i < joints ? 3.0 : 0.5);
      const Vector3 sole(0.08, 0.03, kSole);
      const bool ball = i == joints && round;
      builder.link(i < joints ? boxLink(name, mass, Vector3(0.02, 0.02, 0.5 * length), middle.p)
                   : ball     ? sphereLink(name, mass, 0.03)
                              : boxLink(name, mass, sole, middle.p));
      if (i == joints)
        builder.geometry(ball ? geometrySpec(name, Shape::sphere(0.03), 0.8)
                              : geometrySpec(name, Shape::box(sole), 0.8, middle));
      builder.joint(jointSpec(name + "_joint", JointType::continuous, last, name,
                              {Matrix3::Identity(), at}, random.direction()));
      last = name;
      at = Vector3(0, 0, -length);
    }
  }
  return builder;
}

// Contacts that come and go change how much of a robot each bears, and what it stores (5.3).
TEST(LightFeet, RobotsThatAreThrownGainNothing) {
  for (int seed = 0; seed < 40; ++seed)
    for (const double timestep : {0.0005, 0.002, 0.005, 0.01}) {
      Random random(seed);
      Trial t("thrown robot " + std::to_string(seed),
              with(anyRobot(random, seed % 2 == 1), timestep, kCones[seed / 2 % 2]));
      t.state.q[2] = random.uniform(1.0, 2.0);
      const Quaternion turn = random.quaternion();
      t.state.q.segment<4>(3) << turn.w(), turn.vec();
      t.state.v = random.vector(t.model.nv, decades(random, 0.1, 10.0));
      t.state.v.head<3>() = random.vector3(1.0);
      const double scale = t.energy().kinetic + t.model.totalMass() * 9.81 * 0.5;
      t.mayGain = t.mayRise = 0.01 * scale;
      t.run(1.5);
    }
}

}  // namespace
}  // namespace softgauss::test
