// SPDX-License-Identifier: Apache-2.0
/// Family 3: Jansen's linkage, eight bars in three closed loops, driven by its crank; a cam;
/// slider-cranks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/stability/random_scenes.hpp"

namespace softgauss::test {
namespace {

using Vector2 = Eigen::Vector2d;

// Jansen's numbers, in decimetres here [m]; the crank turns about the origin of the x-z plane.
constexpr double kB = 0.415, kC = 0.393, kD = 0.401, kE = 0.558, kF = 0.394, kG = 0.367, kH = 0.657,
                 kI = 0.490, kJ = 0.500, kK = 0.619, kM = 0.150;
const Vector2 kPivot(-0.38, -0.078);

/// The point at `p` from P and `q` from Q on the left of the way from P to Q.
Vector2 meet(const Vector2& P, double p, const Vector2& Q, double q) {
  const Vector2 way = Q - P;
  const double l = way.norm(), along = (p * p - q * q + l * l) / (2.0 * l);
  const double across = std::sqrt(p * p - along * along);
  return P + way / l * along + Vector2(-way.y(), way.x()) / l * across;
}

/// Where the joints are when the crank is at `angle` from x towards z.
struct Places {
  Vector2 crank, knee, hip, ankle, low, foot;
  explicit Places(double angle) {
    crank = kM * Vector2(std::cos(angle), std::sin(angle));
    knee = meet(kPivot, kB, crank, kJ);  // above
    hip = meet(kPivot, kD, knee, kE);    // to the left
    low = meet(crank, kK, kPivot, kC);   // below
    ankle = meet(low, kG, hip, kF);
    foot = meet(low, kI, ankle, kH);
  }
};

Vector3 inSpace(const Vector2& p) { return {p.x(), 0.0, p.y()}; }

/// Bars of 1 kg/m. A link's frame is at its first joint, not turned while the crank is at 0.
ModelBuilder jansen() {
  const Places at(0.0);
  ModelBuilder builder("linkage");
  builder.link(emptyLink("world"));
  const auto bar = [&](const std::string& name, const std::string& parent, const Vector2& parentAt,
                       const Vector2& from, const std::vector<Vector2>& corners) {
    Vector2 centre = from;
    double length = 0.0, inertia = 0.0;
    for (const Vector2& c : corners) centre += c;
    centre /= static_cast<double>(corners.size() + 1);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const double l = (corners[i] - (i > 0 ? corners[i - 1] : from)).norm();
      length += l;
      inertia += l * l * l / 12.0;
    }
    LinkSpec link = emptyLink(name);
    link.mass = length;
    link.com = inSpace(centre - from);
    link.I_Lcm = Vector3(inertia, inertia, inertia).asDiagonal();
    builder.link(link);
    builder.joint(jointSpec(name, JointType::continuous, parent, name,
                            {Matrix3::Identity(), inSpace(from - parentAt)}, -Vector3::UnitY()));
  };
  const Vector2 origin = Vector2::Zero();
  bar("crank", "world", origin, origin, {at.crank});
  bar("upper", "crank", origin, at.crank, {at.knee});
  bar("lower", "crank", origin, at.crank, {at.low});
  bar("thigh", "world", origin, kPivot, {at.knee, at.hip});
  bar("link", "world", origin, kPivot, {at.low});
  bar("rear", "thigh", kPivot, at.hip, {at.ankle});
  bar("shin", "link", kPivot, at.low, {at.ankle, at.foot});
  const auto tie = [&](const std::string& a, const Vector2& fromA, const std::string& b,
                       const Vector2& fromB, const Vector2& p) {
    ConnectSpec connect;
    connect.linkA = a, connect.linkB = b;
    connect.p_LAP = inSpace(p - fromA), connect.p_LBP = inSpace(p - fromB);
    builder.connect(connect);
  };
  tie("upper", at.crank, "thigh", kPivot, at.knee);
  tie("lower", at.crank, "link", kPivot, at.low);
  tie("rear", at.hip, "shin", at.low, at.ankle);
  return builder;
}

/// The crank is driven at one turn a second. The loops stay closed, and on their branch: the foot
/// is where the lengths of the bars put it.
void walks(double timestep, double seconds) {
  constexpr double kRate = 2.0 * M_PI, kGain = 2.0;  // [rad/s], [N m s/rad]
  Trial t("Jansen's linkage", with(jansen(), timestep));
  const Vector2 local = Places(0.0).foot - Places(0.0).low;
  double off = 0.0, wrong = 0.0, slowest = kInfinity;
  const auto drive = [&] { t.input.tau[0] = kGain * (kRate - t.state.v[0]); };
  drive();
  // Half a step behind, v shows the power of the weight over it, of bars at 1 m/s.
  t.mayGain = 0.5 * timestep * 9.81 * t.model.totalMass();
  t.run(seconds, [&] {
    drive();
    computeKinematics(t.model, t.state, t.data->kinematics);
    for (const Connection& c : t.model.connections)
      off = std::max(off, (t.data->kinematics.X_WB[c.bodyA] * c.p_AP -
                           t.data->kinematics.X_WB[c.bodyB] * c.p_BP)
                              .norm());
    const Vector3 foot = t.origin("shin") + t.rotation("shin") * inSpace(local);
    wrong = std::max(wrong, (foot - inSpace(Places(t.state.q[0]).foot)).norm());
    if (t.state.time > 1.0) slowest = std::min(slowest, t.state.v[0]);
  });
  // An equality constraint of the default softness gives way by a t_c² (1 − d)/d where its place
  // would go with the acceleration a, of the weight and of a bar at the crank's rate to and fro;
  // and by the chord of its turn in a step. The linkage takes the foot up to five times as far.
  const double a = 9.81 + 4.0 * kRate * kRate * kH, turn = timestep * 2.0 * kRate;
  const double gives = a * 4e-4 * 0.1 / 0.9 + 0.5 * turn * turn * kH;
  t.expect("ties are off", off, gives, "m");
  t.expect("foot off its path", wrong, 5.0 * gives, "m");
  EXPECT_GT(slowest, 0.0);
  t.expect("turns", t.state.q[0] / (2.0 * M_PI) / seconds - 1.0, 0.2, "1/s");
}

TEST(Linkage, JansensWalks) {
  for (const double timestep : {0.0005, 0.002, 0.005, 0.01}) walks(timestep, 5.0);
}
TEST(Linkage, JansensWalksForAHundredSecondsLong) {
  for (const double timestep : {0.002, 0.01}) walks(timestep, 100.0);
}

// Two cubes that turn about hinges of their own, the second by ½ q² of the first: nothing drives
// them, and the row has to answer what the curvature of its cam makes, p″ v² (4.6). Without, the
// passivity bound breaks by 2.6 %, and 12 % are lost.
TEST(Linkage, CamsNeitherGainNorBrake) {
  for (const double timestep : {0.0005, 0.002, 0.005, 0.01}) {
    ModelBuilder builder = with(ModelBuilder("cam"), timestep);
    builder.link(emptyLink("world"));
    for (const std::string name : {"leader", "follower"}) {
      builder.link(boxLink(name, 1.0, Vector3::Constant(0.1)));
      builder.joint(jointSpec(name + "_hinge", JointType::continuous, "world", name));
    }
    CouplingSpec cam;
    cam.leader = "leader_hinge", cam.follower = "follower_hinge";
    cam.polynomial = {0.0, 0.0, 0.5, 0.0, 0.0};
    builder.couple(cam);
    Trial t("cam", builder);
    t.state.q << -2.0, 2.0;
    t.state.v << 10.0, -20.0;
    const double begun = t.energy().kinetic;
    t.mayGain = 1e-3 * begun;
    t.mayRise = 0.01 * begun;
    t.run(2.0);
    t.expect("energy lost", begun - t.energy().kinetic, 0.03 * begun, "J");
  }
}

/// A slider-crank that is left to itself.
void crank(int seed, double timestep) {
  RandomScene scene = randomCrank(seed, timestep);
  Trial t("crank " + std::to_string(seed), std::move(scene.model));
  t.state = scene.state;
  const double begun = t.energy().kinetic;
  t.mayGain = kInfinity;  // of energies half a step apart; the law has the start too
  t.mayRise = 0.01 * begun;
  t.run(2.0);
}

// The rod turns by up to 0.6 rad in a step, and what holds it comes and goes with its load (6.9).
// As a string's δ = 0.1 that gave a quarter of these up to twice their energy.
TEST(Linkage, RodsOfFlywheels) {
  for (int seed = 0; seed < 50; ++seed) crank(seed, 0.01);
}

}  // namespace
}  // namespace softgauss::test
