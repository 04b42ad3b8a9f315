// SPDX-License-Identifier: Apache-2.0
/// What is held where it swings faster than a step follows (6.8), (6.9).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

constexpr double kBar = 0.1, kBarMass = 0.1, kLoad = 10.0;

/// A load on a bar that hangs from the world, at rest.
ModelBuilder hung(double timestep) {
  ModelBuilder builder("hung");
  builder.base = BaseKind::floating;
  builder.options.timestep = timestep;
  builder.link(boxLink("bar", kBarMass, Vector3(0.01, 0.01, 0.5 * kBar)));
  builder.link(sphereLink("load", kLoad, 0.05));
  ConnectSpec tie;
  tie.linkA = "bar", tie.linkB = "world";
  tie.p_LAP = Vector3(0, 0, 0.5 * kBar);
  builder.connect(tie);
  tie.linkA = "load", tie.linkB = "bar";
  tie.p_LAP = Vector3::Zero(), tie.p_LBP = Vector3(0, 0, -0.5 * kBar);
  builder.connect(tie);
  return builder;
}

/// How many bodies are held after so many seconds.
int held(const ModelBuilder& builder, double seconds) {
  const Model model = builder.build();
  State state(model);
  state.q.segment<3>(0) = Vector3(0, 0, -0.5 * kBar);
  state.q.segment<3>(7) = Vector3(0, 0, -kBar);
  Data data(model);
  for (int i = 0; i * model.options.timestep < seconds; ++i)
    EXPECT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
  return data.stats.stabilisedBodies;
}

// At rest the equality constraints pull with the load and with the load and the bar, ω² = (T₁ + T₂)
// ½ l/I.
TEST(GeometricStiffness, BeginsAtHalfARadianAStep) {
  const double inertia = kBarMass * (kBar * kBar + 0.02 * 0.02) / 12.0;
  const double omega = std::sqrt((2.0 * kLoad + kBarMass) * 9.81 * 0.5 * kBar / inertia);
  EXPECT_EQ(held(hung(0.499 / omega), 2.0), 0);
  EXPECT_EQ(held(hung(0.501 / omega), 2.0), 1);
  ModelBuilder mujoco = hung(0.01);
  mujoco.options.constraintModel = ConstraintModel::mujoco;
  EXPECT_EQ(held(mujoco, 0.1), 0) << "(6.9) is ours";
}

// A body that turns about its tied corner, by a radian a step: only what it pulls itself goes
// there.
TEST(GeometricStiffness, LeavesAloneWhatCarriesNothing) {
  ModelBuilder builder("alone");
  builder.base = BaseKind::floating;
  builder.options.timestep = 0.01;
  builder.options.gravity.setZero();
  builder.link(boxLink("body", 1.0, Vector3(0.1, 0.1, 0.1)));
  ConnectSpec tie;
  tie.linkA = "body", tie.linkB = "world";
  tie.p_LAP = Vector3(0.1, 0.1, 0.1);
  builder.connect(tie);
  Scene s(builder.build());
  s.state.q.head<3>() = -tie.p_LAP;
  const Vector3 omega(70.0, -70.0, 0.0);
  s.state.v << omega.cross(-tie.p_LAP), omega;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(s.step(), SolveStatus::converged);
    EXPECT_EQ(s.data->stats.stabilisedBodies, 0) << i;
  }
}

/// Free bodies of 0.1 to 1000 kg on connections, as they fly.
Scene flying(int seed) {
  Random random(seed);
  ModelBuilder builder("flying");
  builder.base = BaseKind::floating;
  builder.options.timestep = 0.01;
  constexpr int kBodies = 4;
  const auto name = [](int i) { return "body" + std::to_string(i); };
  for (int i = 0; i < kBodies; ++i)
    builder.link(boxLink(name(i), std::pow(10.0, random.uniform(-1.0, 3.0)), Vector3(0.1, 0.1, 0.1),
                         random.vector3(0.05)));
  for (int i = 0; i + 1 < kBodies; ++i) {
    ConnectSpec tie;
    tie.linkA = name(i), tie.linkB = name(i + 1);
    tie.p_LAP = random.vector3(0.2), tie.p_LBP = random.vector3(0.2);
    builder.connect(tie);
  }
  builder.options.substepAngle = kInfinity;
  Scene s(builder.build());
  for (int i = 0; i < kBodies; ++i) {
    s.state.q.segment<3>(7 * i) = random.vector3(0.05);
    const Quaternion turn = random.quaternion();
    s.state.q.segment<4>(7 * i + 3) << turn.w(), turn.vec();
  }
  s.state.v = random.vector(s.model.nv, 3.0);
  return s;
}

// Its moments are between two bodies: they sum up to nothing.
TEST(GeometricStiffness, KeepsMomentum) {
  int holds = 0;
  for (int seed = 0; seed < 100; ++seed) {
    Scene s = flying(seed);
    const VectorX before = s.state.v;
    ASSERT_NE(s.step(), SolveStatus::notFinite);
    ASSERT_EQ(s.data->stats.parts, 1);
    const GeometricStiffness& swing = s.data->constraints.geometricStiffness;
    if (s.data->stats.stabilisedBodies == 0) {
      EXPECT_EQ(swing.rowCount(), 0);
      continue;
    }
    ++holds;
    VectorX tau = VectorX::Zero(s.model.nv);
    std::vector<Force> F(s.model.bodies.size());
    BodyForce onBodies{tau, F};
    swing.addTransposed(swing.f, onBodies);
    addBodyForces(s.model, s.data->kinematics, F, tau);
    Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
    for (int b = 1; b < s.model.bodyCount(); ++b) {
      const auto on = tau.segment<6>(s.model.bodies[b].v);
      force += on.head<3>();
      moment += s.data->kinematics.X_WB[b].R * on.tail<3>();
    }
    EXPECT_EQ(force, Vector3::Zero()) << seed;
    EXPECT_LE(moment.norm(), 1e-12 * tau.lpNorm<Eigen::Infinity>()) << seed;
    double turn = 0.0;  // of one against another, at most
    for (const Motion& one : s.data->kinematics.V)
      for (const Motion& other : s.data->kinematics.V)
        turn = std::max(turn, (one.angular - other.angular).norm());
    const double h = s.model.options.timestep, most = 0.1 + std::pow(4.0 * h * turn, 4);
    std::vector<double> rate(swing.reference.size());  // a_ref = −b J v
    std::vector<Motion> V(s.model.bodies.size());
    moveBodies(s.model, s.data->kinematics, before, V);
    swing.multiply(BodyMotion{before, V}, rate);
    for (std::size_t i = 0; i < rate.size(); ++i) {
      EXPECT_LE(swing.reference[i] * rate[i], 0.0);
      EXPECT_LE(h * std::abs(swing.reference[i]), most * (1.0 + 1e-9) * std::abs(rate[i]))
          << "nothing touches them";
    }
  }
  EXPECT_GT(holds, 50);
}

}  // namespace
}  // namespace softgauss::test
