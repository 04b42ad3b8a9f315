// SPDX-License-Identifier: Apache-2.0
/// Family 4: fast rotation.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "softgauss/engine/core/rotation.hpp"
#include "tests/stability/trial.hpp"

namespace softgauss::test {
namespace {

/// A body of three different moments without forces, spun at `rate` near its middle axis, where
/// it tumbles.
Model tumbling(double h) {
  LinkSpec link = emptyLink("body");
  link.mass = 1.0;
  link.I_Lcm = Vector3(0.01, 0.02, 0.025).asDiagonal();
  ModelBuilder builder = freeBody(link);
  builder.options.gravity.setZero();
  builder.options.timestep = h;
  return builder.build();
}

/// Drift of energy and of the vector of angular momentum, both relative, after `seconds`.
void tumbles(double rate, double h, double seconds) {
  Trial t("torque-free at " + std::to_string(static_cast<int>(rate)) + " rad/s", tumbling(h));
  t.state.v.tail<3>() = rate * Vector3(0.1, 1.0, 0.1).normalized();
  const double E0 = t.energy().kinetic;
  t.mayGain = 0.01 * E0;
  computeKinematics(t.model, t.state, t.data->kinematics);
  const Vector3 L0 = computeMomentum(t.model, t.data->kinematics).angular;
  double energy = 0.0, momentum = 0.0;  // the worst of all steps
  t.run(seconds, [&] {
    energy = std::max(energy, std::abs(t.energy().kinetic / E0 - 1.0));
    const Vector3 L = computeMomentum(t.model, t.data->kinematics).angular;  // where energy() was
    momentum = std::max(momentum, (L - L0).norm() / L0.norm());
  });
  t.expect("energy, relative", energy, 0.01, "");
  // What is not followed has turn < 1e-4, h ω < 0.014, and errs by some (h ω)²/8 a radian.
  t.expect("momentum, relative", momentum, 1e-3, "");
}

TEST(FastRotation, TorqueFreeBodyKeepsEnergyAndMomentum) {
  for (const double h : {0.0005, 0.002, 0.005, 0.01, 0.02})
    for (const double rate : {50.0, 100.0, 1000.0}) tumbles(rate, h, 2.0);
}

// MuJoCo 2.2.2 at 50 rad/s, 10 s: Euler +149 %, implicit −46 %.
TEST(FastRotation, TorqueFreeBodyKeepsEnergyAndMomentumForAMinuteLong) {
  for (const double h : {0.002, 0.01})
    for (const double rate : {10.0, 50.0, 100.0, 1000.0}) tumbles(rate, h, 60.0);
}

/// A heavy symmetric top of 1 kg, its centre 0.1 m above its point, leaning by 20°: three hinges
/// (precession, tilt, spin), which meet in the point.
Model top(double h) {
  ModelBuilder builder("top");
  LinkSpec disc = emptyLink("top");
  disc.mass = 1.0;
  disc.com = Vector3(0.0, 0.0, 0.1);
  disc.I_Lcm = Vector3(0.0025, 0.0025, 0.005).asDiagonal();
  builder.link(emptyLink("world")).link(emptyLink("a")).link(emptyLink("b")).link(disc);
  builder.joint(jointSpec("precession", JointType::continuous, "world", "a"));
  Transform leaning;
  leaning.R = axisRotation(Vector3::UnitX(), 20.0 * M_PI / 180.0);
  builder.joint(jointSpec("tilt", JointType::continuous, "a", "b", leaning, Vector3::UnitX()));
  builder.joint(jointSpec("spin", JointType::continuous, "b", "top"));
  builder.options.timestep = h;
  return builder.build();
}

struct TopMotion {
  double tilt, precession;  ///< [rad]
};

/// Tilt and precession after each tenth of a second.
std::vector<TopMotion> spin(Trial& t, double seconds) {
  t.state.v[2] = 100.0;
  t.mayGain = 0.01 * t.energy().total();
  std::vector<TopMotion> motion;
  const double E0 = t.energy().total();
  double off = 0.0;
  for (int i = 0; i < std::lround(10.0 * seconds); ++i) {
    t.run(0.1, [&] { off = std::max(off, std::abs(t.energy().total() / E0 - 1.0)); });
    motion.push_back({std::acos(std::clamp(t.rotation("top")(2, 2), -1.0, 1.0)), t.state.q[0]});
  }
  t.expect("energy, relative", off, 0.01, "");
  return motion;
}

void spinsLikeTheConvergedOne(double h, double seconds) {
  Trial fine("heavy top at 100 rad/s, fine", top(1e-4));
  const std::vector<TopMotion> expected = spin(fine, seconds);
  Trial t("heavy top at 100 rad/s", top(h));
  const std::vector<TopMotion> motion = spin(t, seconds);
  double tilt = 0.0, precession = 0.0;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    tilt = std::max(tilt, std::abs(motion[i].tilt - expected[i].tilt));
    precession = std::max(precession, std::abs(motion[i].precession - expected[i].precession));
  }
  t.expect("tilt, against converged", tilt * 180.0 / M_PI, 1.0, "deg");
  t.expect("precession, against converged", precession * 180.0 / M_PI, 2.0, "deg");
}

TEST(FastRotation, HeavyTopPrecesses) {
  for (const double h : {0.0005, 0.002, 0.005, 0.01}) spinsLikeTheConvergedOne(h, 1.0);
}

// MuJoCo 3.12: Euler and implicitfast diverge at 3.9 s at 2 ms, implicit falls over.
TEST(FastRotation, HeavyTopPrecessesForTenSecondsLong) {
  for (const double h : {0.002, 0.01}) spinsLikeTheConvergedOne(h, 10.0);
}

TEST(FastRotation, QuaternionStaysUnitOverAMillionStepsLong) {
  Trial t("10⁶ steps", tumbling(0.002));
  t.state.v.tail<3>() = Vector3(3.0, 1.0, -2.0);
  const double E0 = t.energy().kinetic;
  t.mayGain = 0.01 * E0;
  double off = 0.0;
  t.run(2000.0, [&] { off = std::max(off, std::abs(t.energy().kinetic / E0 - 1.0)); });
  EXPECT_EQ(t.steps, 1000000);
  t.expect("norm less 1", t.state.q.tail<4>().norm() - 1.0, 1e-14, "");
  t.expect("energy, relative", off, 0.01, "");
}

// What spins without turning its inertia is never followed: wheels, balls, tops that stand upright.
TEST(FastRotation, AWheelCostsNothing) {
  ModelBuilder builder = freeBody(sphereLink("ball", 1.0, 0.1));
  builder.options.timestep = 0.002;
  Trial t("ball at 1000 rad/s", builder);
  t.state.v.tail<3>() = Vector3(300.0, -900.0, 200.0);
  const Vector3 before = t.state.v.tail<3>();
  t.run(1.0, [&] { EXPECT_EQ(t.data->stats.substeppedTrees, 0); });
  t.expect("spin, relative", (t.state.v.tail<3>() - before).norm() / before.norm(), 1e-12, "");
}

TEST(FastRotation, SameBits) {
  expectSameBits([] {
    Trial t("torque-free at 1000 rad/s", tumbling(0.002));
    t.state.v.tail<3>() = 1000.0 * Vector3(0.1, 1.0, 0.1).normalized();
    t.mayGain = 0.01 * t.energy().kinetic;
    t.run(0.2);
    return hash(t.state);
  });
}

}  // namespace
}  // namespace softgauss::test
