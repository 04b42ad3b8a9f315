// SPDX-License-Identifier: Apache-2.0
/// Families 1 and 4: long chains, light links that carry a heavy load, released horizontally and
/// never damped.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/stability/energy_watch.hpp"
#include "tests/stability/scenes.hpp"
#include "tests/stability/trial.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

enum class Hinges : std::uint8_t { parallel, crossed };

/// n links of 0.1 m and 0.1 kg in a row along x, their hinges about y, or about y and z in turn; at
/// the end a cube of `load` links' mass.
ModelBuilder hangingChain(int n, double load, Hinges hinges, double h) {
  ModelBuilder builder("chain");
  builder.link(emptyLink("world"));
  std::string parent = "world";
  Transform end;
  end.p = Vector3(0.1, 0.0, 0.0);
  for (int i = 0; i < n; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(boxLink(name, 0.1, {0.05, 0.01, 0.01}, {0.05, 0.0, 0.0}));
    const bool y = hinges == Hinges::parallel || i % 2 == 0;
    builder.joint(jointSpec("hinge" + std::to_string(i), JointType::continuous, parent, name,
                            i > 0 ? end : Transform{}, y ? Vector3::UnitY() : Vector3::UnitZ()));
    parent = name;
  }
  if (load > 0.0) {
    builder.link(boxLink("load", 0.1 * load, {0.1, 0.1, 0.1}));
    builder.joint(jointSpec("load", JointType::fixed, parent, "load", end));
  }
  builder.options.timestep = h;
  return builder;
}

/// Energy against what the chain can give: its weight times half its length, the load's times all.
void keepsItsEnergy(int n, double load, Hinges hinges, double h, double seconds) {
  Trial t(std::to_string(n) + " links" + (load > 0.0 ? ", load 1,000 ×" : "") +
              (hinges == Hinges::parallel ? ", parallel" : ", crossed"),
          hangingChain(n, load, hinges, h));
  const double scale = 0.1 * n * 9.81 * (0.5 * 0.1 * n + 0.1 * load);
  t.mayGain = 0.01 * scale;
  double worst = 0.0;
  const double E0 = t.energy().total();
  t.run(seconds, [&] { worst = std::max(worst, std::abs(t.energy().total() - E0) / scale); });
  t.expect("energy, relative", worst, 0.01, "");
  EXPECT_EQ(t.data->stats.abandonedTrees, 0);
}

TEST(Chains, TenLinksKeepTheirEnergy) {
  for (const double load : {0.0, 1000.0})
    for (const Hinges hinges : {Hinges::parallel, Hinges::crossed})
      for (const double h : {0.002, 0.01}) keepsItsEnergy(10, load, hinges, h, 2.0);
}

// MuJoCo 3.12 at 2 ms: Euler +10.5 %, with the load +9 %, where implicit diverges.
TEST(Chains, TenLinksKeepTheirEnergyForTenSecondsLong) {
  for (const double load : {0.0, 1000.0})
    for (const Hinges hinges : {Hinges::parallel, Hinges::crossed})
      for (const double h : {0.002, 0.01}) keepsItsEnergy(10, load, hinges, h, 10.0);
}

TEST(Chains, HundredLinksKeepTheirEnergy) {
  for (const double load : {0.0, 1000.0}) keepsItsEnergy(100, load, Hinges::crossed, 0.002, 0.5);
}

// MuJoCo 3.12 at 2 ms with the load: Euler, implicit and implicitfast diverge at 3.4 to 3.7 s.
TEST(Chains, HundredLinksKeepTheirEnergyForTenSecondsLong) {
  for (const double load : {0.0, 1000.0})
    for (const Hinges hinges : {Hinges::parallel, Hinges::crossed})
      for (const double h : {0.002, 0.01}) keepsItsEnergy(100, load, hinges, h, 10.0);
}

/// The most energy above the start's [J].
double gainedIn(Trial& t, double seconds) {
  EnergyWatch watch(t.model);
  const double E0 = watch.energy(t.state);
  double gained = 0.0;
  t.run(seconds, [&] { gained = std::max(gained, watch.energy(t.state) - E0); });
  return gained;
}

// Two and three links go in parts where dry friction acts, and are followed where not. Of what the
// weight can give 1 % at most, at 10 ms 5 %.
void gainsNothing(int n, double friction, double h, double seconds) {
  ModelBuilder builder = hangingChain(n, 0.0, Hinges::parallel, h);
  for (int i = 0; i < n; ++i)
    builder.findJoint("hinge" + std::to_string(i))->dryFriction = friction;
  std::ostringstream name;
  name << n << " links, friction " << friction << " N m";
  Trial t(name.str(), builder);
  const double scale = 0.1 * n * 9.81 * 0.05 * n, bound = h > 0.002 ? 0.05 : 0.01;
  t.mayGain = t.mayRise = bound * scale;
  t.expect("energy gained, relative", gainedIn(t, seconds) / scale, bound, "");
}

TEST(Chains, ShortOnesWithDryFrictionGainNothing) {
  for (const int n : {2, 3})
    for (const double friction : {0.0, 1e-4, 1e-3})
      for (const double h : {0.0005, 0.002, 0.01}) gainsNothing(n, friction, h, 10.0);
}
TEST(Chains, ShortOnesGainNothingInHalfAMinuteLong) {
  for (const int n : {2, 3})
    for (const double friction : {0.0, 1e-5, 1e-4, 1e-3}) gainsNothing(n, friction, 0.002, 30.0);
}

// Bearings that are all but free: any change of method would gain what they do not take. Three bars
// of 2, 1 and 0.05 kg gained 1400 times their energy at 2 ms.
TEST(Chains, BearingsOfNextToNoDampingGainNothing) {
  const std::vector<std::vector<double>> masses = {{1.0, 1.0}, {2.0, 1.0, 0.05}};
  for (const std::vector<double>& bars : masses)
    for (const double damping : {1e-9, 1e-6, 1e-4, 1e-2})
      for (const double h : kSteps) {
        ModelBuilder builder("bars");
        builder.link(emptyLink("world"));
        std::string parent = "world";
        Transform end;
        double scale = 0.0, level = 0.0;
        for (std::size_t i = 0; i < bars.size(); ++i) {
          const double half = bars[i] < 0.1 ? 0.05 : 0.25;
          const std::string name = "bar" + std::to_string(i);
          builder.link(boxLink(name, bars[i], {half, 0.01, 0.01}, {half, 0, 0}));
          JointSpec hinge = jointSpec("hinge" + std::to_string(i), JointType::continuous, parent,
                                      name, end, Vector3::UnitY());
          hinge.damping = damping;
          builder.joint(hinge);
          scale += 9.81 * bars[i] * (level + half);
          level += 2.0 * half;
          end.p = Vector3(2.0 * half, 0, 0);
          parent = name;
        }
        std::ostringstream name;
        name << bars.size() << " bars, damping " << damping;
        Trial t(name.str(), with(builder, h));
        t.mayGain = 0.01 * scale;
        t.mayRise = 1e-3 * scale;
        t.expect("energy gained, relative", gainedIn(t, 20.0) / scale, 0.01, "");
      }
}

// Trees without damping that swing through their limits at 10 rad/s. Pairs of hinges and of slides
// with nothing between them come to whip at hundreds of rad/s and m/s, and hide what the others
// turn.
// Returns the parts of a step, their mean.
double whipsThroughItsLimits(int seed, double h, double seconds, double bound,
                             double torque = 0.0) {
  RandomTreeOptions options;
  options.trees = 1 + seed % 2;
  options.links = 3 + seed % 9;
  options.damping = false;
  options.armature = seed % 3 == 0;
  options.geometries = false;
  ModelBuilder builder = randomForest(seed, options);
  builder.options.timestep = h;
  Trial t("limits, seed " + std::to_string(seed), builder);
  Random random(seed + 99);
  t.state.v = 10.0 * random.vector(t.model.nv, 1.0);
  if (torque > 0.0) t.input.tau = VectorX::Constant(t.model.nv, torque);
  const double scale = t.energy().kinetic;
  t.mayGain = bound * scale;
  t.mayRise = 0.01 * scale;
  EnergyWatch watch(t.model);
  const double E0 = watch.energy(t.state);
  double gained = 0.0;
  double parts = 0.0;
  t.run(seconds, [&] {
    gained = std::max(gained, watch.energy(t.state) - t.work - E0);
    parts += t.data->stats.parts;
  });
  t.expect("energy gained, relative", gained / scale, bound, "");
  return parts / t.steps;
}

TEST(Chains, TreesThatWhipThroughTheirLimitsGainNothing) {
  for (const int seed : {7, 12, 16, 22, 30, 71})
    for (const double h : {0.0005, 0.002, 0.005, 0.01}) whipsThroughItsLimits(seed, h, 2.0, 0.01);
}
// A torque that changes next to nothing makes no driven tree of a passive one, which would go in
// fewer parts: seed 71 gained 390 % so. It has two trees, of which each goes in its own parts.
TEST(Chains, TreesThatWhipUnderATinyTorqueGoInAsManyParts) {
  for (const int seed : {12, 71})
    for (const double h : {0.002, 0.005}) {
      const double parts = whipsThroughItsLimits(seed, h, 10.0, 0.01);
      EXPECT_GT(parts, 1.0);
      EXPECT_NEAR(whipsThroughItsLimits(seed, h, 10.0, 0.01, 1e-9) / parts, 1.0, 0.02);
      EXPECT_NEAR(whipsThroughItsLimits(seed, h, 10.0, seed == 12 ? 0.01 : kInfinity, 1e-3) / parts,
                  1.0, 0.1);
    }
}
// Of 320 such trees three gain 1.6 to 1.9 % with steps of 0.5 ms, none more than 0.5 % with longer
// ones; before slides were looked at, 279 gained 390 %, and by (6.4) without energies 71 gained
// 40 % at 2 ms and 103 180 % at 0.5 ms.
TEST(Chains, TreesThatWhipForTenSecondsGainNothingLong) {
  for (const double h : {0.0005, 0.002, 0.005, 0.01}) {
    for (int seed = 0; seed < 120; ++seed)
      whipsThroughItsLimits(seed, h, 10.0, h < 0.002 ? 0.02 : 0.01);
    for (const int seed : {229, 239, 275, 279, 331, 367})
      whipsThroughItsLimits(seed, h, 10.0, 0.01);
  }
}

TEST(Chains, SameBits) {
  expectSameBits([] {
    Trial t("10 links", hangingChain(10, 1000.0, Hinges::crossed, 0.002));
    t.mayGain = 0.05 * 0.1 * 1000.0 * 9.81;
    t.run(0.5);
    return hash(t.state);
  });
}

}  // namespace
}  // namespace softgauss::test
