// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/core/rotation.hpp"

#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

// A few roundings of numbers of size 1.

struct NamedVector {
  const char* name;
  Vector3 phi;
};

std::vector<NamedVector> rotationVectors() {
  Random random(1);
  const Vector3 n = random.direction();
  return {{"identity", Vector3::Zero()},
          {"1e-12", 1e-12 * n},
          {"1e-8", 1e-8 * n},
          {"below the Taylor switch of exp", 0.999e-3 * n},
          {"above the Taylor switch of exp", 1.001e-3 * n},
          {"below the Taylor switch of log", 1.99e-5 * n},
          {"above the Taylor switch of log", 2.01e-5 * n},
          {"random", 1.3 * n},
          {"right angle", M_PI / 2 * Vector3::UnitY()},
          {"near pi", (M_PI - 1e-9) * n},
          {"near minus pi", -(M_PI - 1e-9) * n}};
}

TEST(QuaternionExp, IsUnitAndRotatesByTheVector) {
  for (const auto& [name, phi] : rotationVectors()) {
    SCOPED_TRACE(name);
    const Quaternion q = quaternionExp(phi);
    EXPECT_SMALL(q.norm() - 1.0, kUnitRounding);
    const double angle = phi.norm();
    const Matrix3 R = angle > 0.0 ? Eigen::AngleAxisd(angle, phi / angle).toRotationMatrix()
                                  : Matrix3(Matrix3::Identity());
    EXPECT_APPROX(q.toRotationMatrix(), R, 2 * kUnitRounding);
  }
}

TEST(QuaternionLog, InvertsExp) {
  for (const auto& [name, phi] : rotationVectors()) {
    SCOPED_TRACE(name);
    const Vector3 back = quaternionLog(quaternionExp(phi));
    EXPECT_APPROX(back, phi, 4 * kUnitRounding);
    // Also relative to a tiny vector.
    EXPECT_SMALL((back - phi).norm() / std::max(phi.norm(), 1e-300), 4 * kUnitRounding);
  }
}

TEST(QuaternionLog, TakesTheShorterRotation) {
  for (const auto& [name, phi] : rotationVectors()) {
    SCOPED_TRACE(name);
    Quaternion q = quaternionExp(phi);
    q.coeffs() *= -1.0;
    EXPECT_APPROX(quaternionLog(q), phi, 4 * kUnitRounding);
  }
}

TEST(QuaternionExp, OfParallelVectorsAdds) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const Vector3 n = random.direction();
    const double a = random.uniform(-3.0, 3.0), b = random.uniform(-3.0, 3.0);
    const Quaternion product = quaternionExp(a * n) * quaternionExp(b * n);
    EXPECT_APPROX(product.coeffs(), quaternionExp((a + b) * n).coeffs(), 2 * kUnitRounding);
  }
}

TEST(AxisRotation, IsExpOfTheAxis) {
  Random random(3);
  for (const double angle : {0.0, 1e-8, 0.7, -2.0, M_PI, 7.0}) {
    const Vector3 n = random.direction();
    const Matrix3 R = axisRotation(n, angle);
    EXPECT_APPROX(R, quaternionExp(angle * n).toRotationMatrix(), 4 * kUnitRounding);
    EXPECT_APPROX(R * R.transpose(), Matrix3::Identity(), 4 * kUnitRounding);
  }
}

TEST(Skew, IsTheCrossProduct) {
  Random random(4);
  const Vector3 a = random.vector3(2.0), b = random.vector3(2.0);
  EXPECT_APPROX(skew(a) * b, a.cross(b), kUnitRounding);
}

// A URDF's rpy turns about fixed axes: first roll about x, then pitch about y, then yaw about z.
TEST(RpyRotation, TurnsAboutFixedAxesInOrder) {
  const double h = M_PI / 2;
  // x goes along z's plane: roll keeps x, pitch takes x to −z, yaw keeps z.
  EXPECT_APPROX(rpyRotation({0.3, h, 0.4}) * Vector3::UnitX(), -Vector3::UnitZ(), kUnitRounding);
  // roll takes y to z, pitch takes z to x, yaw takes x to y.
  EXPECT_APPROX(rpyRotation({h, h, h}) * Vector3::UnitY(), Vector3::UnitY(), kUnitRounding);
  EXPECT_APPROX(rpyRotation({0, 0, h}) * Vector3::UnitX(), Vector3::UnitY(), kUnitRounding);
}

TEST(FrameFromNormal, IsRightHandedWithTheNormalFirst) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Vector3 n = i == 0 ? Vector3(Vector3::UnitY()) : random.direction();
    const Matrix3 R = frameFromNormal(n);
    EXPECT_APPROX(R.col(0), n, kUnitRounding);
    EXPECT_APPROX(R.transpose() * R, Matrix3::Identity(), 4 * kUnitRounding);
    EXPECT_SMALL(R.determinant() - 1.0, 4 * kUnitRounding);
  }
}

// MuJoCo's tangents for the ground, so that pyramids can be compared.
TEST(FrameFromNormal, OfTheGroundHasTangentsYAndMinusX) {
  const Matrix3 R = frameFromNormal(Vector3::UnitZ());
  EXPECT_EQ(R.col(1), Vector3::UnitY());
  EXPECT_EQ(R.col(2), -Vector3::UnitX());
}

}  // namespace
}  // namespace softgauss::test
