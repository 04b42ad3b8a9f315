// SPDX-License-Identifier: Apache-2.0
/// Family 8: long runs, many links, many bodies, far from the origin, very small and very large.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "softgauss/gdd/gdd.hpp"
#include "tests/stability/scenes.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

// A humanoid stands and moves a hand between two places, pushed now and then. Returns its last
// hash.
void stands(double seconds, std::uint64_t& last) {
  const Model model = humanoid().build();
  collision::SceneContacts contacts(model);
  Data data(model);
  State state(model);
  gdd::GoalDirectedController controller(model);
  auto posture = std::make_unique<gdd::Posture>(state.q);
  controller.goals.push_back(std::move(posture));
  auto owned = std::make_unique<gdd::Reach>(model, "right_forearm", Vector3(0.3, -0.2, 1.2));
  gdd::Reach& reach = *owned;
  controller.goals.push_back(std::move(owned));
  const int pelvis = model.findFrame("pelvis");
  double lowest = 1.0, farthest = 0.0, fastest = 0.0;
  long uncertified = 0, solves = 0;
  Input input;
  input.tau = VectorX::Zero(model.nv);
  const auto steps = static_cast<long>(std::round(seconds / model.options.timestep));
  for (long i = 0; i < steps; ++i) {
    reach.p_WTarget.z() = (i / 1000) % 2 == 0 ? 1.2 : 1.0;
    input.tau[1] = i % 5000 < 50 ? 40.0 : 0.0;  // [N] for a tenth of a second
    const SolveStatus status = controller.step(model, input, state, data, &contacts);
    ASSERT_EQ(status, SolveStatus::converged) << "at " << state.time << " s";
    ASSERT_EQ(controller.limits.violation(controller.control), 0.0);
    const StepStats& stats = data.stats;
    ASSERT_EQ(stats.invalidWarmStarts + stats.abandonedTrees + stats.minimumStepsAccepted, 0)
        << "at " << state.time << " s";
    ASSERT_EQ(stats.pairsSkipped, 0);
    const gdd::GddStatus ended = controller.report.status;
    uncertified += ended != gdd::GddStatus::converged && ended != gdd::GddStatus::nonsmoothMinimum;
    ++solves;
    const Vector3 p = data.kinematics.X_WB[model.frames[pelvis].body].p;
    ASSERT_TRUE(p.allFinite());
    lowest = std::min(lowest, p.z());
    farthest = std::max(farthest, p.head<2>().norm());
    fastest = std::max(fastest, state.v.cwiseAbs().maxCoeff());
  }
  const auto expect = [&](const char* quantity, double value, double bound, const char* unit) {
    std::printf("  humanoid for %4.0f s                 %-24s %10.3g of %10.3g %s\n", seconds,
                quantity, value, bound, unit);
    EXPECT_SMALL(value, bound) << quantity;
  };
  expect("pelvis below its place", 0.9 - lowest, 0.1, "m");
  expect("away", farthest, 0.1, "m");
  expect("fastest", fastest, 10.0, "rad/s");
  expect("solves not certified", static_cast<double>(uncertified) / static_cast<double>(solves),
         1e-3, "");
  expect("norm less 1", state.q.segment<4>(3).norm() - 1.0, 1e-14, "");
  last = hash(state);
}

/// At once on two threads: the same bits.
void standsTwice(double seconds) {
  std::uint64_t one = 0, other = 1;
  std::thread thread([&] { stands(seconds, other); });
  stands(seconds, one);
  thread.join();
  EXPECT_EQ(one, other);
}

TEST(Large, HumanoidStandsForTenSeconds) { standsTwice(10.0); }
TEST(Large, HumanoidStandsForTenMinutesLong) { standsTwice(600.0); }

/// n links of 0.05 m and 0.05 kg that hang from hinges about x and y in turn.
ModelBuilder rope(int n) {
  ModelBuilder builder("rope");
  builder.link(emptyLink("world"));
  std::string parent = "world";
  for (int i = 0; i < n; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(boxLink(name, 0.05, {0.005, 0.005, 0.025}, {0.0, 0.0, -0.025}));
    builder.joint(jointSpec("hinge" + std::to_string(i), JointType::continuous, parent, name,
                            {Matrix3::Identity(), Vector3(0, 0, i > 0 ? -0.05 : 0.0)},
                            i % 2 == 0 ? Vector3::UnitX() : Vector3::UnitY()));
    parent = name;
  }
  return builder;
}

// A rope of links of 0.05 m swings from 6 degrees off its rest.
void ropeSwings(int links, double timestep, double seconds) {
  Trial t("rope of " + std::to_string(links) + " links", with(rope(links), timestep));
  t.state.q[0] = 0.1;
  const double E0 = t.energy().total();
  // What it can give: its weight by the height of its centre.
  const double scale = 0.05 * links * 9.81 * 0.025 * links * (1.0 - std::cos(0.1));
  t.mayGain = 0.01 * scale;
  t.mayRise = 0.005 * scale;  // its shortest waves swing by more than a radian in 10 ms
  double off = 0.0;
  t.run(seconds, [&] { off = std::max(off, std::abs(t.energy().total() - E0) / scale); });
  t.expect("energy, relative", off, 0.01, "");
}

TEST(Large, RopeOfManyLinks) {
  for (const double timestep : {0.002, 0.01}) ropeSwings(200, timestep, 0.2);
}
TEST(Large, RopeOfThousandLinksLong) {
  ropeSwings(1000, 0.002, 0.5);
  ropeSwings(1000, 0.01, 2.0);
}

/// Bodies of four shapes on the ground, 0.3 m from each other, in 20 columns.
ModelBuilder field(int bodies) {
  ModelBuilder builder("field");
  builder.geometry(groundSpec(0.7));
  for (int i = 0; i < bodies; ++i) {
    const Shape shapes[] = {Shape::sphere(0.1), Shape::box(Vector3(0.1, 0.08, 0.06)),
                            Shape::capsule(0.05, 0.05), Shape::cylinder(0.08, 0.05)};
    addBody(builder, "body" + std::to_string(i), shapes[i % 4], 1.0,
            {Matrix3::Identity(), Vector3(0.3 * (i % 20), 0.3 * (i / 20 % 25), 0.12)}, 0.7);
  }
  return builder;
}

void bodiesRest(double timestep, double seconds) {
  Trial t("500 free bodies", with(field(500), timestep));
  t.mayGain = 1e-6;
  t.run(seconds);
  t.expect("penetration at rest", t.data->stats.maxPenetration, 1e-3, "m");
  t.expect("kinetic energy at rest", t.energy().kinetic, 500e-6, "J");
  t.expect("iterations", t.mostIterations, 20, "");
}

TEST(Large, FiveHundredBodies) { bodiesRest(0.01, 1.0); }
TEST(Large, FiveHundredBodiesLong) {
  for (const double timestep : {0.002, 0.005, 0.01}) bodiesRest(timestep, 10.0);
}

/// A tower of three boxes of `length`, `away` from the origin along x and y.
ModelBuilder towerAt(double length, double away) {
  ModelBuilder builder("tower");
  builder.geometry(groundSpec(1.0));
  for (int i = 0; i < 3; ++i)
    addBody(builder, "box" + std::to_string(i), Shape::box(Vector3::Constant(0.5 * length)),
            1000.0 * length * length * length,
            {Matrix3::Identity(), Vector3(away, away, (i + 0.5) * length)});
  return builder;
}

// 100 km from the origin doubles have 1.5e-11 m left: the tower stands as it does at the origin.
TEST(Large, TowerFarFromTheOrigin) {
  for (const double timestep : {0.002, 0.01})
    for (const Cone cone : kCones) {
      Trial here("tower at the origin", with(towerAt(0.2, 0.0), timestep, cone));
      here.run(3.0);
      Trial far("tower 100 km away", with(towerAt(0.2, 1e5), timestep, cone));
      far.mayGain = 1e-6;
      far.run(3.0);
      far.expect("drift of the top",
                 (far.origin("box2").head<2>() - Eigen::Vector2d(1e5, 1e5)).norm(), 1e-6, "m");
      far.expect("height, against the origin", far.origin("box2").z() - here.origin("box2").z(),
                 1e-9, "m");
      far.expect("speed at rest", far.state.v.cwiseAbs().maxCoeff(), 1e-6, "m/s");
    }
}

// A tumbling body and a humanoid that falls, there and here, move alike.
TEST(Large, MotionFarFromTheOrigin) {
  for (const double timestep : {0.002, 0.01}) {
    ModelBuilder builder = with(humanoid(), timestep);
    Trial here("humanoid at the origin", builder);
    builder.X_WRoot.p += Vector3(1e5, -1e5, 0.0);
    Trial far("humanoid falls 100 km away", builder);
    here.run(0.3), far.run(0.3);
    VectorX off = far.state.q - here.state.q;
    off.head<2>() -= Eigen::Vector2d(1e5, -1e5);
    far.expect("against the origin", off.cwiseAbs().maxCoeff(), 1e-6, "m or rad");
  }
}

// Cubes of 1 mm (1 mg) and of 1 km (10¹² kg): both stand. In its first step of 10 ms each falls
// g h² = 1 mm, and the one upon it for a step longer: they may sink by as much.
TEST(Large, FromMillimetresToKilometres) {
  for (const double length : {1e-3, 1.0, 1e3})
    for (const double timestep : {0.0005, 0.002, 0.01})
      for (const Cone cone : kCones) {
        Trial t(length < 0.1    ? "tower of 1 mm"
                : length < 10.0 ? "tower of 1 m"
                                : "tower of 1 km",
                with(towerAt(length, 0.0), timestep, cone));
        const double weight = 3.0 * 9.81 * 1000.0 * length * length * length;
        t.mayGain = 1e-9 * weight * std::max(1.0, length);
        t.run(3.0);
        const Vector3 top = t.origin("box2");
        t.expect("drift of the top", top.head<2>().norm(), 1e-6 * std::max(1.0, length), "m");
        t.expect("sinks in all", 2.5 * length - top.z(),
                 0.5e-3 + (timestep > 0.002 ? 3.0 * 9.81 * timestep * timestep : 0.0), "m");
        t.expect("tilt", tilt(t, "box2"), 1e-3, "rad");
        t.expect("speed at rest", t.state.v.cwiseAbs().maxCoeff(), 1e-4, "m/s");
      }
}

// Pendulums of 1 mm and of 1 km have the period of theirs, 2 π √(l/g).
TEST(Large, PendulumsFromMillimetresToKilometres) {
  for (const double length : {1e-3, 1.0, 1e3}) {
    const double period = 2.0 * M_PI * std::sqrt(length / 9.81);
    Trial t("pendulum of " + std::to_string(length) + " m",
            with(pendulum(length, 1.0, 1e-3 * length), std::min(0.01, period / 200.0)));
    t.state.q[0] = 0.01;
    const double E0 = t.energy().total();
    const double scale = 9.81 * length * 0.5 * 1e-4;
    double off = 0.0;
    t.mayGain = 0.05 * scale;
    t.run(10.0 * period, [&] { off = std::max(off, std::abs(t.energy().total() - E0)); });
    t.expect("energy, relative", off / scale, 0.05, "");
    t.expect("place after ten periods", t.state.q[0] / 0.01 - 1.0, 0.02, "");
  }
}

TEST(Large, SameBits) {
  expectSameBits([] {
    Trial t("100 free bodies", field(100));
    t.run(0.1);
    return hash(t.state);
  });
}

}  // namespace
}  // namespace softgauss::test
