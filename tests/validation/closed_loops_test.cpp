// SPDX-License-Identifier: Apache-2.0
/// Mechanisms with closed loops, and joints that follow others.

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

ConnectSpec connection(const std::string& a, const Vector3& p, const std::string& b,
                       const Vector3& q) {
  ConnectSpec spec;
  spec.linkA = a;
  spec.linkB = b;
  spec.p_LAP = p;
  spec.p_LBP = q;
  return spec;
}

/// Two cranks of 0.3 m that hang from the world 0.4 m apart, and a coupler of 0.4 m on the left
/// one, to be tied to the right one: a parallelogram, which stays one.
ModelBuilder fourBar() {
  ModelBuilder builder("four-bar");
  builder.base = BaseKind::fixed;
  builder.link(emptyLink("world"));
  const Vector3 down(0, 0, -0.3), across(0.4, 0, 0), y = Vector3::UnitY();
  builder.link(boxLink("left", 1.0, {0.02, 0.02, 0.15}, 0.5 * down));
  builder.link(boxLink("coupler", 1.2, {0.2, 0.02, 0.02}, 0.5 * across));
  builder.link(boxLink("right", 1.0, {0.02, 0.02, 0.15}, 0.5 * down));
  builder.joint(jointSpec("a", JointType::revolute, "world", "left", {}, y));
  builder.joint(
      jointSpec("b", JointType::revolute, "left", "coupler", {Matrix3::Identity(), down}, y));
  builder.joint(
      jointSpec("c", JointType::revolute, "world", "right", {Matrix3::Identity(), across}, y));
  return builder;
}

/// Total mass of cranks and coupler on one angle φ from the vertical: the exact pendulum.
struct Parallelogram {
  double inertia, moment;
  Parallelogram() {
    // Each crank about its pin; the coupler moves without turning on a circle of 0.3 m.
    const double crank = 1.0 / 3.0 * (0.02 * 0.02 + 0.15 * 0.15) + 0.15 * 0.15;
    inertia = 2.0 * crank + 1.2 * 0.09;
    moment = 9.81 * (2.0 * 0.15 + 1.2 * 0.3);
  }
  /// φ after a time, by small steps of a symplectic leapfrog.
  double after(double time, double phi) const {
    const int steps = 200000;
    const double h = time / steps;
    double w = -0.5 * h * moment / inertia * std::sin(phi);
    for (int i = 0; i < steps; ++i) {
      phi += h * w;
      w -= h * moment / inertia * std::sin(phi);
    }
    return phi;
  }
};

/// A four-bar released at φ; returns the largest gap of its loop on the way.
double swing(Scene& s, double phi, int steps) {
  s.state.q << phi, -phi, phi;
  double gap = 0.0;
  for (int i = 0; i < steps; ++i) {
    EXPECT_EQ(s.step(), SolveStatus::converged);
    const Kinematics& k = s.data->kinematics;
    gap = std::max(gap, (k.X_WB[2] * Vector3(0.4, 0, 0) - k.X_WB[3] * Vector3(0, 0, -0.3)).norm());
  }
  return gap;
}

TEST(FourBar, StaysClosedAndSwingsAsOnePendulum) {
  ModelBuilder builder = fourBar();
  builder.options.timestep = 2e-4;
  builder.connect(connection("coupler", {0.4, 0, 0}, "right", {0, 0, -0.3}));
  Scene s(builder.build());
  const double gap = swing(s, 0.7, 5000);
  // The rows are soft: (1 − d)/(k d²) of the acceleration that they bear, about 10 m/s².
  EXPECT_SMALL(gap, 5e-4);
  // First order in h: the error of the phase of a swing at h = 0.2 ms.
  const double expected = Parallelogram().after(1.0, 0.7);
  EXPECT_SMALL(s.state.q[0] - expected, 2e-3);
  EXPECT_SMALL(s.state.q[2] - s.state.q[0], 1e-3);
}

// Five connections at one point, and a weld across the loop that they close already: 21 rows for
// two constraints. The rows' softness adds up, nothing else changes.
TEST(FourBar, TakesRedundantClosuresAsTheyAre) {
  ModelBuilder once = fourBar(), often = fourBar();
  for (ModelBuilder* b : {&once, &often}) b->options.timestep = 1e-3;
  once.connect(connection("coupler", {0.4, 0, 0}, "right", {0, 0, -0.3}));
  for (int i = 0; i < 5; ++i)
    often.connect(connection("coupler", {0.4, 0, 0}, "right", {0, 0, -0.3}));
  Scene a(once.build()), b(often.build());
  EXPECT_SMALL(swing(a, 0.5, 1000), 1e-3);
  EXPECT_SMALL(swing(b, 0.5, 1000), 1e-3);
  EXPECT_EQ(b.data->stats.rows, 15);
  EXPECT_APPROX(a.state.q, b.state.q, 1e-3);

  ModelBuilder welded = fourBar();
  welded.connect(connection("coupler", {0.4, 0, 0}, "right", {0, 0, -0.3}));
  WeldSpec weld;
  weld.linkA = "coupler";
  weld.linkB = "right";
  weld.X_LAF.p = {0.4, 0, 0};
  weld.X_LBF.p = {0, 0, -0.3};
  Scene rigid(welded.weld(weld).build());
  rigid.steps(500);
  // Three hinges, a connection and a weld: nothing is free to move.
  EXPECT_SMALL(rigid.state.v.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_SMALL(rigid.state.q.cwiseAbs().maxCoeff(), 2e-3);
}

// What hangs on a weld hangs as on a fixed joint, up to its softness.
TEST(Weld, CarriesWhatItWelds) {
  ModelBuilder builder("hanging");
  builder.link(boxLink("box", 2.0, {0.1, 0.2, 0.3}));
  WeldSpec weld;
  weld.linkA = "world";
  weld.linkB = "box";
  weld.X_LAF.p = {0, 0, 1};
  weld.X_LBF.p = {0.1, 0.0, 0.3};  // off the centre: the weld also bears a moment
  builder.X_WRoot.p = Vector3(-0.1, 0, 0.7);
  Scene s(builder.weld(weld).build());
  s.steps(2000);
  EXPECT_SMALL((s.state.q.head<3>() - Vector3(-0.1, 0, 0.7)).norm(), 2e-3);
  EXPECT_SMALL(s.state.q.segment<3>(4).norm(), 2e-3);
  VectorX force = VectorX::Zero(6);
  std::vector<Force> onBodies(s.model.bodies.size());
  BodyForce all{force, onBodies};
  s.data->constraints.weld.addTransposed(s.data->constraints.weld.f, all);
  addBodyForces(s.model, s.data->kinematics, onBodies, force);
  VectorX weight(6);
  weight << 0, 0, 2.0 * 9.81, 0, 0, 0;
  EXPECT_APPROX(force, weight, 1e-6);
}

// A finger of three joints, of which two follow the first as a URDF's mimic says, and a torque on
// the first alone. At rest they follow to the softness of their load; the motor feels them all.
TEST(Mimic, FollowersFollowAndTheLeaderCarriesThem) {
  ModelBuilder builder = chain(3);
  builder.options.gravity.setZero();
  for (int i = 1; i < 3; ++i) {
    CouplingSpec c;
    c.follower = "joint" + std::to_string(i);
    c.leader = "joint0";
    c.polynomial = {0.1 * i, 0.5 * i, 0, 0, 0};
    builder.couple(c);
  }
  Scene s(builder.build());
  EXPECT_SMALL(s.state.q[1] - 0.1, 1e-15);
  double worst = 0.0;
  for (int i = 0; i < 500; ++i) {
    s.input.tau[0] = i < 250 ? 0.5 : -0.5;
    ASSERT_EQ(s.step(), SolveStatus::converged);
    for (int j = 1; j < 3; ++j)
      worst = std::max(worst, std::abs(s.state.q[j] - 0.1 * j - 0.5 * j * s.state.q[0]));
  }
  EXPECT_SMALL(worst, 1e-3);
  EXPECT_GT(std::abs(s.state.q[0]), 0.1);
  // Virtual work: along the coupled direction the forces are those of one coordinate.
  s.stages();
  s.forward();
  VectorX along(3);
  along << 1.0, 0.5, 1.0;
  VectorX force = VectorX::Zero(3);
  s.data->constraints.coupling.addTransposed(s.data->constraints.coupling.f, force);
  EXPECT_SMALL(force.dot(along), 1e-10);
  EXPECT_GT(force.norm(), 1e-3);
}

}  // namespace
}  // namespace softgauss::test
