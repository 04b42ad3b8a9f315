// SPDX-License-Identifier: Apache-2.0
/// Family 6, violent by its spin alone: what rolls leaning, tops, coins that turn where they stand,
/// and balls with rotors. Nothing drives it, so that it only loses, to a thousandth, and with long
/// steps what it loses with short ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

constexpr double kRollingSteps[] = {0.0005, 0.002, 0.005, 0.01};

struct Wheel {
  double R, thickness, mass, lean, speed;  // [m], [kg], [rad], [m/s]
};

/// What a wheel has at its centre: nothing, or a ball of a tenth of its mass, which turns freely
/// about the wheel's axis or is tied by its own centre.
enum class Hub { none, axle, tiedBall };

ModelBuilder wheelOnGround(const Wheel& w, Hub hub) {
  ModelBuilder builder("wheel");
  builder.geometry(groundSpec(1.0));
  const double height = w.R * std::cos(w.lean) + 0.5 * w.thickness * std::sin(w.lean);
  const Eigen::AngleAxisd turn(0.5 * M_PI + w.lean, Vector3::UnitX());
  const Transform X_WB{turn.toRotationMatrix(), Vector3(0, 0, height)};
  addBody(builder, "wheel", Shape::cylinder(w.R, 0.5 * w.thickness), w.mass, X_WB);
  const LinkSpec ball = sphereLink("ball", 0.1 * w.mass, 0.3 * w.R);
  if (hub == Hub::axle) {
    builder.link(ball);
    builder.joint(jointSpec("bearing", JointType::continuous, "wheel", "ball"));
  }
  if (hub == Hub::tiedBall) {
    ModelBuilder one("ball");
    one.base = BaseKind::floating;
    one.X_WRoot = X_WB;
    one.link(ball);
    builder.add(one, "");
    ConnectSpec tie;
    tie.linkA = "wheel", tie.linkB = "ball";
    builder.connect(tie);
  }
  return builder;
}

// Coins and wheels that roll in a circle, leaning: their weight turns the spin, and the rim runs
// along under them.
class RollingWheel : public testing::TestWithParam<std::tuple<Hub, Cone>> {};

TEST_P(RollingWheel, OnlyLoses) {
  const auto [hub, cone] = GetParam();
  for (const Wheel& w : {Wheel{0.05, 0.005, 0.05, 0.4, 1.0}, Wheel{0.012, 0.002, 0.007, 0.4, 0.5},
                         Wheel{0.3, 0.04, 2.0, 0.4, 2.0}, Wheel{0.3, 0.04, 2.0, 0.1, 2.0},
                         Wheel{0.05, 0.005, 0.05, 1.0, 1.0}}) {
    double ofShortSteps = 0.0;
    for (const double timestep : kRollingSteps) {
      const double spin = w.speed / w.R;
      // What is tied and turns farther is not asked (docs/limits.md).
      if (hub == Hub::tiedBall && spin * timestep > 0.09) continue;
      Trial t("wheel of " + std::to_string(w.R) + " m",
              with(wheelOnGround(w, hub), timestep, cone));
      t.state.v[0] = w.speed;
      t.state.v[5] = -spin;
      if (hub == Hub::tiedBall) t.state.v[6] = w.speed;
      const double begun = t.energy().total();
      t.mayGain = 1e-3 * begun;
      t.mayRise = 0.01 * begun;
      t.run(20.0);
      const double left = t.energy().total();
      t.expect("energy at the end", left, begun, "J");
      if (timestep == kRollingSteps[0]) ofShortSteps = left;
      // Where the wheel falls over is chance, and so is what is left of it; a contact that carries
      // a tied ball may stick (5.7), at some steps and not at others.
      if (w.lean < 1.0 && hub != Hub::tiedBall && timestep <= 0.005)
        t.expect("off what short steps leave", left - ofShortSteps, 0.1 * begun, "J");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Hubs, RollingWheel,
                         testing::Combine(testing::Values(Hub::none, Hub::axle, Hub::tiedBall),
                                          testing::ValuesIn(kCones)));

// Tops on a rounded tip that lean by 0.2 rad. The tip rolls, and the ground feels how the place
// that touches it moves. They stay up and keep their energy, and at 5 ms they turn by 1 rad in a
// step.
TEST(Rolling, TopsKeepTheirEnergy) {
  const double R = 0.025, tip = 0.005, below = 0.025, mass = 0.05, lean = 0.2;
  const Eigen::AngleAxisd turn(lean, Vector3::UnitX());
  for (const Cone cone : kCones)
    for (const double spin : {100.0, 150.0, 200.0})
      for (const double timestep : {0.0005, 0.001, 0.002, 0.005}) {
        ModelBuilder builder = with(ModelBuilder("top"), timestep, cone);
        builder.geometry(groundSpec(1.0));
        LinkSpec link;
        link.name = "top";
        link.mass = mass;
        link.I_Lcm = (0.25 * mass * R * R * Vector3(1, 1, 2)).asDiagonal();
        ModelBuilder one("top");
        one.base = BaseKind::floating;
        one.X_WRoot = {turn.toRotationMatrix(), Vector3(0, 0, tip + below * std::cos(lean))};
        one.link(link);
        const Transform X_LTip{Matrix3::Identity(), Vector3(0, 0, -below)};
        one.geometry(geometrySpec("top", Shape::sphere(tip), 1.0, X_LTip));
        builder.add(one, "");
        Trial t("top at " + std::to_string(spin) + " rad/s", builder);
        t.state.v[5] = spin;
        const double begun = t.energy().total();
        t.mayGain = 1e-3 * begun;
        t.mayRise = 1e-3 * begun;
        t.run(4.0);
        t.expect("energy lost", begun - t.energy().total(), 0.01 * begun, "J");
        t.expect("leans at the end", tilt(t, "top"), lean, "rad");
      }
}

// Coins that lean and turn about the diameter through the place on their rim that touches the
// ground: it runs along the rim as the coin falls, and the coin rolls on in a circle or round and
// round. Where rows leave out J̇ v, it sinks in by 17 mm and gains a quarter of its energy. At 5 ms
// it is free for its first step, lands, and is pushed out by the load of its turning
// (docs/limits.md).
TEST(Rolling, CoinsThatTurnWhereTheyStandStayOnTop) {
  const double R = 0.05, thickness = 0.005;
  for (const Cone cone : kCones)
    for (const double spin : {10.0, 20.0, 30.0})
      for (const double lean : {0.3, 0.6, 1.0})
        for (const double timestep : {0.0005, 0.002, 0.005}) {
          const Eigen::AngleAxisd turn(0.5 * M_PI + lean, Vector3::UnitX());
          const double height = R * std::cos(lean) + 0.5 * thickness * std::sin(lean);
          ModelBuilder builder = with(ModelBuilder("coin"), timestep, cone);
          builder.geometry(groundSpec(1.0));
          addBody(builder, "coin", Shape::cylinder(R, 0.5 * thickness), 0.05,
                  {turn.toRotationMatrix(), Vector3(0, 0, height)});
          Trial t("coin at " + std::to_string(spin) + " rad/s", builder);
          t.state.v[4] = spin;
          const double begun = t.energy().total();
          t.mayGain = (timestep > 0.002 ? 0.02 : 1e-3) * begun;
          t.mayRise = 5e-3 * begun;
          t.run(3.0);
          t.expect("deepest", t.deepest, 2e-3, "m");
        }
}

/// A capsule as heavy as water whose lower end is `above` the ground [m].
ModelBuilder leaningCapsule(double R, double halfLength, const Matrix3& R_WB, double above) {
  ModelBuilder builder("capsule");
  builder.geometry(groundSpec(1.0));
  const double mass = 1000.0 * M_PI * R * R * (2.0 * halfLength + 4.0 / 3.0 * R);
  addBody(builder, "capsule", Shape::capsule(R, halfLength), mass,
          {R_WB, Vector3(0, 0, above + R + halfLength * std::abs(R_WB(2, 2)))});
  return builder;
}

// Capsules that begin to spin about the vertical half a millimetre above the ground: an end slips
// slowly where they touch, and turns fast. Where a reference leaves out J̇ v, of what slips a little
// or lies deep, they slip by J̇ v/b, friction works along that, and they gain 26 %. At 5 ms one that
// rolls round on its end by a quarter of a radian a step gains 2 % a second.
TEST(Rolling, CapsulesThatSpinWhereTheyTouchGainNothing) {
  for (const double timestep : {0.0005, 0.002, 0.005})
    for (int seed = 900; seed < 960; ++seed) {
      Random random(seed);
      const double R = random.uniform(0.02, 0.1), halfLength = 0.5 * random.uniform(0.03, 0.3);
      const double lean = random.uniform(0.0, 0.5 * M_PI), spin = random.uniform(20.0, 60.0);
      const Matrix3 R_WB = Eigen::AngleAxisd(lean, Vector3::UnitX()).toRotationMatrix();
      Trial t("capsule that spins, seed " + std::to_string(seed),
              with(leaningCapsule(R, halfLength, R_WB, 5e-4), timestep));
      t.state.v.tail<3>() = R_WB.transpose() * Vector3(0, 0, spin);
      const double begun = t.energy().total();
      t.mayGain = 1e-4 * begun;
      t.mayRise = (timestep < 0.005 ? 5e-3 : 0.04) * begun;
      t.run(1.5);
    }
}

// Capsules thrown to the ground, turning about anything.
TEST(Rolling, CapsulesLandWithoutGain) {
  for (int seed = 0; seed < 60; ++seed) {
    Random random(88000 + seed);
    const double R = std::exp(random.uniform(-4.5, -2.5));
    const Matrix3 R_WB = random.rotation();
    Trial t("capsule that lands, seed " + std::to_string(seed),
            with(leaningCapsule(R, R * random.uniform(0.2, 4.0), R_WB, 0.1), 0.002,
                 seed % 2 == 0 ? Cone::pyramidal : Cone::elliptic));
    t.state.v.head<3>() = random.vector3(0.5);
    t.state.v.tail<3>() = random.vector3(std::exp(random.uniform(std::log(5.0), std::log(60.0))));
    const double begun = t.energy().total();
    t.mayGain = 0.02 * begun;
    t.mayRise = 5e-3 * begun;
    t.run(2.0);
  }
}

// Balls with one to three rotors in bearings that point anywhere, half of them out of balance. The
// rotors' Coriolis forces run through the one contact, at every angle to it.
TEST(Rolling, BallsWithRotorsGainNothing) {
  for (int seed = 0; seed < 20; ++seed)
    for (const double timestep : kRollingSteps) {
      Random random(77000 + seed);
      ModelBuilder builder = with(ModelBuilder("ball"), timestep);
      const double R = std::exp(random.uniform(-4.0, -1.0));
      const double mass = std::exp(random.uniform(-3.0, 1.0));
      builder.geometry(groundSpec(random.uniform(0.5, 1.0)));
      addBody(builder, "ball", Shape::sphere(R), mass, {random.rotation(), Vector3(0, 0, R)});
      std::string inside = "ball";
      const double off = seed % 2 == 1 ? 0.3 * R : 0.0;
      for (int i = 0; i <= seed % 3; ++i) {
        const std::string name = "rotor" + std::to_string(i);
        const Vector3 half = random.vector3(0.2 * R) + Vector3::Constant(0.3 * R);
        const double part = mass * random.uniform(0.05, 1.0);
        builder.link(boxLink(name, part, half, random.vector3(off)));
        const Transform X_PC{random.rotation(), random.vector3(off)};
        builder.joint(
            jointSpec("bearing" + std::to_string(i), JointType::continuous, inside, name, X_PC));
        inside = name;
      }
      Trial t("ball with rotors, seed " + std::to_string(seed), builder);
      const double speed = 2.0 * std::sqrt(9.81 * R);
      t.state.v = random.vector(t.model.nv, 2.0 * speed / R);
      t.state.v.head<3>() = random.vector3(speed).cwiseProduct(Vector3(1, 1, 0));
      const double begun = t.energy().kinetic;
      t.mayGain = 0.02 * begun;
      t.mayRise = 0.02 * begun;
      t.run(8.0);
      t.expect("energy gained", std::max(0.0, t.gained), 0.02 * begun, "J");
    }
}

}  // namespace
}  // namespace softgauss::test
