// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/state.hpp"

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

TEST(State, StartsAtRestInTheInitialConfiguration) {
  const Model model = humanoid().build();
  const State state(model);
  EXPECT_EQ(state.q, model.q0);
  EXPECT_EQ(state.v, VectorX::Zero(27));
  EXPECT_EQ(state.time, 0.0);
  EXPECT_FALSE(state.warmstart.valid);
  EXPECT_EQ(state.warmstart.a.size(), 27);
}

TEST(PositionDifference, InvertsIntegratePosition) {
  for (int seed = 0; seed < 20; ++seed) {
    const Model model = randomForest(seed).build();
    Random random(seed);
    const State state = randomState(model, random);
    for (const double size : {0.0, 1e-8, 1e-3, 1.0}) {
      // Rotations of less than π come back as they went.
      const VectorX v = random.vector(model.nv, size);
      VectorX q = state.q;
      integratePosition(model, v, 1.0, q);
      EXPECT_APPROX(positionDifference(model, state.q, q), v, kRounding);
    }
  }
}

TEST(IntegratePosition, InvertsPositionDifference) {
  const Model model = randomForest(3).build();
  Random random(3);
  const VectorX q0 = randomState(model, random).q, q1 = randomState(model, random).q;
  VectorX q = q0;
  integratePosition(model, positionDifference(model, q0, q1), 1.0, q);
  EXPECT_SMALL(positionDifference(model, q1, q).cwiseAbs().maxCoeff(), kRounding);
}

TEST(IntegratePosition, OfHalvesAddsUpAndGoesBack) {
  const Model model = randomForest(4).build();
  Random random(4);
  const State state = randomState(model, random);
  VectorX whole = state.q, halves = state.q;
  integratePosition(model, state.v, 0.3, whole);
  integratePosition(model, state.v, 0.15, halves);
  integratePosition(model, state.v, 0.15, halves);
  EXPECT_APPROX(halves, whole, kRounding);
  integratePosition(model, state.v, -0.3, whole);
  EXPECT_APPROX(whole, state.q, kRounding);
}

// World linear velocity, body angular velocity.
TEST(IntegratePosition, OfAFreeBodyTurnsAboutItsOwnAxes) {
  const Model model = freeBody(sphereLink("body", 1.0, 0.1)).build();
  State state(model);
  const Quaternion tilt(Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()));
  state.q << 0, 0, 0, tilt.w(), tilt.x(), tilt.y(), tilt.z();
  state.v << 1, 0, 0, 0, 0, 0.5;
  integratePosition(model, state.v, 1.0, state.q);
  EXPECT_APPROX(state.q.head(3), Vector3::UnitX(), kRounding);
  const Quaternion q(state.q[3], state.q[4], state.q[5], state.q[6]);
  const Quaternion expected = tilt * Quaternion(Eigen::AngleAxisd(0.5, Vector3::UnitZ()));
  EXPECT_APPROX(q.coeffs(), expected.coeffs(), kRounding);
}

TEST(IntegratePosition, KeepsQuaternionsUnit) {
  const Model model = freeBody(sphereLink("body", 1.0, 0.1)).build();
  State state(model);
  const VectorX v = Random(5).vector(6, 30.0);
  for (int i = 0; i < 10000; ++i) integratePosition(model, v, 0.01, state.q);
  EXPECT_SMALL(state.q.tail(4).norm() - 1.0, 1e-15);
}

}  // namespace
}  // namespace softgauss::test
