// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/kinematics.hpp"

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

constexpr int kForests = 15;
// Central differences with ε = 1e-6 of positions of a few m: rounding 1e-16·5/1e-6.
constexpr double kDifferenceTolerance = 3e-9;

using Matrix3X = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// A random forest at a random state with a point fixed to each of its bodies.
struct MovedForest {
  Model model;
  State state;
  Kinematics k;

  explicit MovedForest(std::uint64_t seed)
      : model(randomForest(seed).build()), state(model), k(model) {
    Random random(seed);
    state = randomState(model, random);
    computeKinematics(model, state, k);
  }
  Vector3 point(int body) const { return k.X_WB[body] * Vector3(0.1, -0.2, 0.3); }

  Transform poseAt(const VectorX& q, int body) const {
    Kinematics other(model);
    State moved = state;
    moved.q = q;
    computeKinematics(model, moved, other);
    return other.X_WB[body];
  }
};

TEST(Jacobian, IsDerivativeOfPose) {
  for (int seed = 0; seed < kForests; ++seed) {
    const MovedForest p(seed);
    Matrix3X Jp(3, p.model.nv), Jr(3, p.model.nv);
    for (int b = 1; b < p.model.bodyCount(); ++b) {
      pointJacobian(p.model, p.k, b, p.point(b), Jp);
      rotationJacobian(p.model, p.k, b, Jr);
      const MatrixX position = configurationGradient(p.model, p.state.q, [&](const VectorX& q) {
        return VectorX(p.poseAt(q, b) * Vector3(0.1, -0.2, 0.3));
      });
      // A rotation vector from the present pose: its derivative at zero is the angular velocity.
      const MatrixX rotation = configurationGradient(p.model, p.state.q, [&](const VectorX& q) {
        const Matrix3 R = p.poseAt(q, b).R * p.k.X_WB[b].R.transpose();
        return VectorX(quaternionLog(Quaternion(R)));
      });
      EXPECT_APPROX(Jp, position, kDifferenceTolerance) << "seed " << seed << ", body " << b;
      EXPECT_APPROX(Jr, rotation, kDifferenceTolerance) << "seed " << seed << ", body " << b;
      EXPECT_FALSE(MatrixX(Jp) == position) << "a thing compared with itself";
    }
  }
}

TEST(Velocity, IsJacobianTimesV) {
  for (int seed = 0; seed < kForests; ++seed) {
    const MovedForest p(seed);
    Matrix3X J(3, p.model.nv);
    for (int b = 1; b < p.model.bodyCount(); ++b) {
      pointJacobian(p.model, p.k, b, p.point(b), J);
      EXPECT_APPROX(pointVelocity(p.model, p.k, b, p.point(b)), J * p.state.v, 1e-14);
      rotationJacobian(p.model, p.k, b, J);
      EXPECT_APPROX(p.k.V[b].angular, J * p.state.v, 1e-14);
    }
  }
}

TEST(Velocity, IsDerivativeOfPosition) {
  for (int seed = 0; seed < kForests; ++seed) {
    const MovedForest p(seed);
    for (int b = 1; b < p.model.bodyCount(); ++b) {
      const VectorX rate = alongMotion(p.model, p.state.q, p.state.v, [&](const VectorX& q) {
        return VectorX(p.poseAt(q, b) * Vector3(0.1, -0.2, 0.3));
      });
      EXPECT_APPROX(pointVelocity(p.model, p.k, b, p.point(b)), rate, kDifferenceTolerance);
    }
  }
}

// J̇ v: the acceleration of a point of the body when v stays the same.
TEST(BiasAcceleration, IsDerivativeOfVelocityAtConstantV) {
  for (int seed = 0; seed < kForests; ++seed) {
    const MovedForest p(seed);
    const VectorX zero = VectorX::Zero(p.model.nv);
    for (int b = 1; b < p.model.bodyCount(); ++b) {
      const VectorX rate = alongTrajectory(p.model, p.state, zero, [&](const State& s) {
        Kinematics k(p.model);
        computeKinematics(p.model, s, k);
        return VectorX(pointVelocity(p.model, k, b, k.X_WB[b] * Vector3(0.1, -0.2, 0.3)));
      });
      EXPECT_APPROX(pointBiasAcceleration(p.model, p.k, b, p.point(b)), rate, 1e-8)
          << "seed " << seed << ", body " << b;
    }
  }
}

TEST(Kinematics, OfTheWorldIsAtRest) {
  const MovedForest p(1);
  Matrix3X J = Matrix3X::Ones(3, p.model.nv);
  pointJacobian(p.model, p.k, 0, Vector3(1, 2, 3), J);
  EXPECT_EQ(J, Matrix3X::Zero(3, p.model.nv));
  J.setOnes();
  rotationJacobian(p.model, p.k, 0, J);
  EXPECT_EQ(J, Matrix3X::Zero(3, p.model.nv));
  EXPECT_EQ(pointVelocity(p.model, p.k, 0, Vector3(1, 2, 3)), Vector3::Zero());
  EXPECT_EQ(pointBiasAcceleration(p.model, p.k, 0, Vector3(1, 2, 3)), Vector3::Zero());
}

// By hand: shoulder about z at the origin, elbow about z after 1 m, hand 0.5 m further.
TEST(Kinematics, OfAPlanarArm) {
  ModelBuilder builder("arm");
  builder.link(emptyLink("world"))
      .link(boxLink("upper", 1.0, {0.5, 0.05, 0.05}, {0.5, 0, 0}))
      .link(boxLink("lower", 1.0, {0.25, 0.05, 0.05}, {0.25, 0, 0}))
      .link(emptyLink("hand"));
  builder.joint(jointSpec("shoulder", JointType::continuous, "world", "upper"))
      .joint(jointSpec("elbow", JointType::continuous, "upper", "lower",
                       {Matrix3::Identity(), Vector3(1, 0, 0)}))
      .joint(jointSpec("wrist", JointType::fixed, "lower", "hand",
                       {Matrix3::Identity(), Vector3(0.5, 0, 0)}));
  const Model model = builder.build();
  State state(model);
  state.q << M_PI / 6, M_PI / 3;
  state.v << 2.0, -3.0;
  Kinematics k(model);
  computeKinematics(model, state, k);
  const Transform X = framePose(model, k, model.findFrame("hand"));
  EXPECT_APPROX(X.p, Vector3(std::cos(M_PI / 6), std::sin(M_PI / 6) + 0.5, 0.0), 1e-15);
  EXPECT_APPROX(X.R, axisRotation(Vector3::UnitZ(), M_PI / 2), 1e-15);
  // v = ω₁ × p + ω₂ × (p − elbow): 2 (−1, √3/2) − 3 (−1/2, 0).
  EXPECT_APPROX(pointVelocity(model, k, 2, X.p), Vector3(-0.5, std::sqrt(3.0), 0.0), 1e-14);
}

}  // namespace
}  // namespace softgauss::test
