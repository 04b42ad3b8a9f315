// SPDX-License-Identifier: Apache-2.0
/// What a viewer is told is what acted: forces against momentum, velocities against poses.

#include "softgauss/engine/step/snapshot.hpp"

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

Scene onPlane(const ModelBuilder& builder) {
  return Scene(builder.build(), std::make_shared<SampleContacts>());
}

Snapshot snapshotOf(const Scene& scene) {
  Snapshot snapshot;
  takeSnapshot(scene.model, *scene.data, scene.state.time, snapshot);
  return snapshot;
}

/// Force of the contacts on the moving bodies; those between two of them cancel.
Vector3 outerForce(const Model& model, const Snapshot& snapshot) {
  Vector3 sum = Vector3::Zero();
  for (const Snapshot::ContactForce& c : snapshot.contacts) {
    if (model.geometries[c.geometryB].body != 0) sum += c.force;
    if (model.geometries[c.geometryA].body != 0) sum -= c.force;
  }
  return sum;
}

// m (v⁺ − v)/h = Σ f + m g, exactly, for the linear motion of one body.
TEST(Snapshot, ContactForcesAndGravityChangeTheMomentum) {
  Scene s = onPlane(boxOnPlane({0.3, 0.2, 0.1}, 2.0, 0.4));
  s.state.v << 1.0, -0.5, -0.3, 0.2, 0.4, -0.6;
  const double h = s.model.options.timestep;
  int touching = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3 v = s.state.v.head<3>();
    s.step();
    const Vector3 rate = 2.0 * (s.state.v.head<3>() - v) / h;
    const Snapshot snapshot = snapshotOf(s);
    touching += snapshot.contacts.empty() ? 0 : 1;
    EXPECT_APPROX(rate, outerForce(s.model, snapshot) + 2.0 * s.model.options.gravity, 1e-10);
    for (const Snapshot::ContactForce& c : snapshot.contacts) EXPECT_GE(c.normalForce(), 0.0);
  }
  EXPECT_GT(touching, 100);
}

TEST(Snapshot, CenterOfPressureOfABodyAtRestIsBelowItsCenterOfMass) {
  ModelBuilder builder = freeBody(boxLink("body", 2.0, {0.3, 0.2, 0.1}, {0.11, -0.07, 0.02}));
  builder.geometry(groundSpec(1.0)).geometry(geometrySpec("body", Shape::box({0.3, 0.2, 0.1})));
  builder.X_WRoot.p.z() = 0.1;
  Scene s = onPlane(builder);
  s.steps(3000);
  const Snapshot snapshot = snapshotOf(s);
  ASSERT_TRUE(snapshot.centerOfPressure.has_value());
  // What is left of friction acts below the centre of mass, so 1e-9 m, not rounding.
  EXPECT_APPROX(snapshot.centerOfPressure->head<2>(), snapshot.centerOfMass.head<2>(), 1e-9);
}

TEST(Snapshot, NothingCarriesInTheAirAlongAWallOrWithoutGravity) {
  Scene air = onPlane(boxOnPlane({0.3, 0.2, 0.1}, 2.0, 1.0));
  air.state.q[2] = 1.0;
  air.step();
  EXPECT_TRUE(snapshotOf(air).contacts.empty());
  EXPECT_FALSE(snapshotOf(air).centerOfPressure.has_value());

  const Matrix3 wall = Eigen::AngleAxisd(1.2, Vector3::UnitY()).toRotationMatrix();
  Scene leaning = onPlane(sphereOnPlane(0.1, 1.0, 0.5, wall));
  leaning.state.q.head<3>() -= 1e-3 * wall.col(2);
  leaning.step();
  ASSERT_FALSE(snapshotOf(leaning).contacts.empty());
  EXPECT_FALSE(snapshotOf(leaning).centerOfPressure.has_value());

  ModelBuilder builder = sphereOnPlane(0.1, 1.0, 0.5);
  builder.options.gravity.setZero();
  Scene weightless = onPlane(builder);
  weightless.state.q[2] -= 1e-3;
  weightless.step();
  ASSERT_FALSE(snapshotOf(weightless).contacts.empty());
  EXPECT_FALSE(snapshotOf(weightless).centerOfPressure.has_value());
}

// Ẋ = V: over ε the origin moves by ε v and the body turns by ε ω, to second order.
TEST(Snapshot, VelocitiesAreRatesOfThePoses) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Scene s = randomScene(seed);
    const Snapshot now = snapshotOf(s);
    const double epsilon = 1e-6;
    const auto at = [&](double t) {
      State moved = s.state;
      integratePosition(s.model, s.state.v, t, moved.q);
      Kinematics k(s.model);
      computeKinematics(s.model, moved, k);
      return k.X_WB;
    };
    const std::vector<Transform> after = at(epsilon), before = at(-epsilon);
    for (int b = 1; b < s.model.bodyCount(); ++b) {
      const Vector3 v = (after[b].p - before[b].p) / (2.0 * epsilon);
      const Matrix3 spin = (after[b].R - before[b].R) / (2.0 * epsilon) * now.X_WB[b].R.transpose();
      EXPECT_APPROX(now.velocity[b], v, 1e-8);
      EXPECT_APPROX(now.angularVelocity[b], Vector3(spin(2, 1), spin(0, 2), spin(1, 0)), 1e-8);
    }
  }
}

}  // namespace
}  // namespace softgauss::test
