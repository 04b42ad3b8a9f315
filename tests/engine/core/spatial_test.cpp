// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/core/spatial.hpp"

#include "softgauss/engine/core/rotation.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

Motion randomMotion(Random& r) { return {r.vector3(2.0), r.vector3(2.0)}; }
Force randomForce(Random& r) { return {r.vector3(2.0), r.vector3(2.0)}; }
Symmetric3 randomInertia(Random& r) {
  const Matrix3 R = r.rotation();
  return Symmetric3::fromMatrix(R * Vector3(1.0, 2.0, 2.5).asDiagonal() * R.transpose());
}
Vector6 vec(const Motion& m) { return (Vector6() << m.angular, m.linear).finished(); }
Vector6 vec(const Force& f) { return (Vector6() << f.moment, f.force).finished(); }

TEST(SpatialCross, IsAntisymmetricAndObeysJacobi) {
  Random r(1);
  for (int i = 0; i < 20; ++i) {
    const Motion a = randomMotion(r), b = randomMotion(r), c = randomMotion(r);
    EXPECT_APPROX(vec(cross(a, b)), -vec(cross(b, a)), kRounding);
    const Motion jacobi = cross(a, cross(b, c)) + cross(b, cross(c, a)) + cross(c, cross(a, b));
    EXPECT_APPROX(vec(jacobi), Vector6::Zero(), 1e-13);
  }
}

// The power of a force that is carried along with a motion does not change.
TEST(SpatialCross, OfForcesIsDualToThatOfMotions) {
  Random r(2);
  for (int i = 0; i < 20; ++i) {
    const Motion a = randomMotion(r), m = randomMotion(r);
    const Force f = randomForce(r);
    EXPECT_SMALL(dot(cross(a, m), f) + dot(m, crossForce(a, f)), 1e-13);
    EXPECT_GT(std::abs(dot(cross(a, m), f)), 1e-6);
  }
}

TEST(Transform, ComposesAndInverts) {
  Random r(3);
  const Transform A{r.rotation(), r.vector3(1.0)}, B{r.rotation(), r.vector3(1.0)};
  const Vector3 x = r.vector3(1.0);
  EXPECT_APPROX((A * B) * x, A * (B * x), kRounding);
  EXPECT_APPROX(A.inverse() * (A * x), x, kRounding);
}

TEST(Symmetric3, IsItsMatrix) {
  Random r(4);
  const Symmetric3 S = randomInertia(r);
  const Vector3 x = r.vector3(1.0);
  const Matrix3 R = r.rotation();
  EXPECT_APPROX(S * x, S.matrix() * x, kRounding);
  EXPECT_APPROX(rotated(R, S).matrix(), R * S.matrix() * R.transpose(), kRounding);
  EXPECT_EQ(Symmetric3::fromMatrix(S.matrix()).matrix(), S.matrix());
}

// Momentum of a rigid body from first principles: p = m v_c, H_O = I_c ω + c × p.
TEST(Inertia, GivesMomentumAboutTheOrigin) {
  Random r(5);
  for (int i = 0; i < 20; ++i) {
    const double mass = r.uniform(0.5, 3.0);
    const Vector3 c = r.vector3(1.0);
    const Symmetric3 I_c = randomInertia(r);
    const Motion V = randomMotion(r);
    const Vector3 p = mass * (V.linear + V.angular.cross(c));
    const Force h = Inertia::fromCentral(mass, c, I_c) * V;
    EXPECT_APPROX(h.force, p, kRounding);
    EXPECT_APPROX(h.moment, I_c * V.angular + c.cross(p), kRounding);
  }
}

TEST(Inertia, OfTwoBodiesIsTheSum) {
  Random r(6);
  const Vector3 ca = r.vector3(1.0), cb = r.vector3(1.0);
  const Inertia a = Inertia::fromCentral(1.5, ca, randomInertia(r));
  const Inertia b = Inertia::fromCentral(0.5, cb, randomInertia(r));
  const Motion V = randomMotion(r);
  Inertia sum = a;
  sum += b;
  EXPECT_APPROX(vec(sum * V), vec(a * V + b * V), kRounding);
  EXPECT_SMALL(sum.mass - 2.0, kRounding);
}

TEST(Inertia, IsSymmetric) {
  Random r(7);
  const Vector3 c = r.vector3(1.0);
  const Inertia I = Inertia::fromCentral(1.5, c, randomInertia(r));
  const Motion U = randomMotion(r), V = randomMotion(r);
  EXPECT_SMALL(dot(U, I * V) - dot(V, I * U), kRounding);
  EXPECT_GT(dot(V, I * V), 0.0);
}

}  // namespace
}  // namespace softgauss::test
