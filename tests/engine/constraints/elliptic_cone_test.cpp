// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/elliptic_cone.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/types.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

EllipticCone randomCone(Random& random, int dim) {
  EllipticCone cone;
  cone.dim = dim;
  cone.D = std::exp(random.uniform(-3.0, 6.0));
  cone.mu = std::exp(random.uniform(-2.0, 1.0));
  const double mu = std::exp(random.uniform(-2.0, 1.0));
  cone.friction = {mu, mu, random.uniform(0.01, 0.5), 0.02, 0.02};
  return cone;
}

struct Values {
  double cost = 0.0;
  VectorX f;
  MatrixX H;
  ConeZone zone = ConeZone::top;
};

Values at(const EllipticCone& cone, const VectorX& x) {
  Values v;
  v.f.resize(cone.dim);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> H(cone.dim, cone.dim);
  const EllipticCone::Point z = cone.point(x.data());
  v.zone = z.zone();
  v.cost = cone.at(z, v.zone, v.f.data(), H.data());
  v.H = H;
  return v;
}

/// Square of the distance of z = (N, U) from { N ≥ μ̂ |U| }. The nearest point of a cone lies in the
/// plane of the axis and z, on the ray at the angle of the cone or at the apex.
double squaredDistance(const EllipticCone& cone, const VectorX& x) {
  double T = 0.0;
  for (int k = 1; k < cone.dim; ++k) T = std::hypot(T, cone.friction[k - 1] * x[k]);
  const double N = cone.mu * x[0];
  if (N >= cone.mu * T) return 0.0;
  const double angle = std::atan(cone.mu);  // of the ray above the U plane
  const double along = N * std::sin(angle) + T * std::cos(angle);
  if (along <= 0.0) return N * N + T * T;
  return std::pow(N * std::cos(angle) - T * std::sin(angle), 2);
}

/// x by zone: two thirds of them within the cones' own scales.
template <class F>
void forRandomPoints(F&& f) {
  Random random(11);
  int zones[3] = {};
  for (const int dim : {3, 4, 6})
    for (int i = 0; i < 300; ++i) {
      const EllipticCone cone = randomCone(random, dim);
      VectorX x = random.vector(dim, 1.0);
      for (int k = 1; k < dim; ++k) x[k] /= cone.friction[k - 1];
      x[0] *= 2.0 / std::min(1.0, cone.mu);
      ++zones[static_cast<int>(at(cone, x).zone)];
      f(cone, x);
    }
  for (const int count : zones) EXPECT_GT(count, 60);
}

TEST(EllipticCone, IsHalfTheSquaredDistanceFromTheCone) {
  forRandomPoints([](const EllipticCone& cone, const VectorX& x) {
    const double expected = 0.5 * cone.D / (cone.mu * cone.mu) * squaredDistance(cone, x);
    EXPECT_SMALL((at(cone, x).cost - expected) / (1e-3 * cone.D + expected), 1e-13);
  });
}

TEST(EllipticCone, IsTheSumOfTwoHalfQuadratics) {
  forRandomPoints([](const EllipticCone& cone, const VectorX& x) {
    const EllipticCone::Point z = cone.point(x.data());
    const double phi = std::min(z.phi, 0.0), chi = std::min(z.chi, 0.0);
    const double expected = 0.5 * cone.stiffness() * (phi * phi + chi * chi);
    EXPECT_SMALL((at(cone, x).cost - expected) / (1e-3 * cone.D + expected), 1e-13);
  });
}

// Differences over 1e-6; rounding of the cost relative to D, and bends of 1/T.
TEST(EllipticCone, ForceIsTheNegativeGradient) {
  forRandomPoints([](const EllipticCone& cone, const VectorX& x) {
    const Values v = at(cone, x);
    const double h = 1e-6, scale = cone.D * (1.0 + 1.0 / (cone.mu * cone.mu));
    for (int i = 0; i < cone.dim; ++i) {
      const VectorX d = h * VectorX::Unit(cone.dim, i);
      const double difference = (at(cone, x + d).cost - at(cone, x - d).cost) / (2.0 * h);
      EXPECT_SMALL((v.f[i] + difference) / (scale * (1.0 + x.norm())), 1e-8);
    }
  });
}

TEST(EllipticCone, CurvatureIsTheNegativeGradientOfTheForce) {
  int compared = 0;
  forRandomPoints([&](const EllipticCone& cone, const VectorX& x) {
    const Values v = at(cone, x);
    const EllipticCone::Point z = cone.point(x.data());
    const double h = 1e-7, scale = cone.D * (1.0 + 1.0 / (cone.mu * cone.mu));
    // Not across an edge, nor where the cone bends within the difference.
    if (std::min({std::abs(z.phi), std::abs(z.chi), z.T}) < 1e-2) return;
    ++compared;
    for (int i = 0; i < cone.dim; ++i) {
      const VectorX d = h * VectorX::Unit(cone.dim, i);
      const VectorX difference = (at(cone, x + d).f - at(cone, x - d).f) / (2.0 * h);
      EXPECT_SMALL((v.H.col(i) + difference).cwiseAbs().maxCoeff() / scale, 1e-6);
    }
  });
  EXPECT_GT(compared, 600);
}

TEST(EllipticCone, IsConvex) {
  forRandomPoints([](const EllipticCone& cone, const VectorX& x) {
    const MatrixX H = at(cone, x).H;
    EXPECT_SMALL(
        (H - H.transpose()).cwiseAbs().maxCoeff() / std::max(1e-300, H.cwiseAbs().maxCoeff()),
        1e-15);
    const VectorX eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixX>(H).eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1e-13 * cone.D * (1.0 + 1.0 / (cone.mu * cone.mu)));
  });
}

TEST(EllipticCone, ForceStaysInTheFrictionCone) {
  forRandomPoints([](const EllipticCone& cone, const VectorX& x) {
    const Values v = at(cone, x);
    EXPECT_GE(v.f[0], 0.0);
    double tangential = 0.0;
    for (int k = 1; k < cone.dim; ++k)
      tangential = std::hypot(tangential, v.f[k] / cone.friction[k - 1]);
    if (v.zone == ConeZone::middle)
      EXPECT_SMALL(tangential / v.f[0] - 1.0, 1e-12);
    else
      EXPECT_LE(tangential, v.f[0]);
  });
}

// Of both sides of an edge, value and force agree, and the curvature jumps by c times the square of
// the gradient of what vanishes there.
TEST(EllipticCone, ZonesJoinWithoutAJumpOfTheForce) {
  Random random(5);
  for (const int dim : {3, 4, 6})
    for (int i = 0; i < 50; ++i) {
      const EllipticCone cone = randomCone(random, dim);
      VectorX x = random.vector(dim, 1.0);
      for (int k = 1; k < dim; ++k) x[k] /= cone.friction[k - 1];
      const double T = cone.point(x.data()).T;
      for (const int breakpoint : {0, 1}) {
        x[0] = (breakpoint == 0 ? -T / cone.mu : cone.mu * T) / cone.mu;
        const EllipticCone::Point z = cone.point(x.data());
        EXPECT_SMALL(EllipticCone::aboveBreakpoint(z, breakpoint), 1e-14 * (1.0 + 1.0 / cone.mu));
        using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        VectorX below(dim), above(dim), gradient(dim);
        Square Hbelow(dim, dim), Habove(dim, dim);
        const double scale = cone.D * (1.0 + 1.0 / (cone.mu * cone.mu));
        const double costBelow =
            cone.at(z, static_cast<ConeZone>(breakpoint), below.data(), Hbelow.data());
        const double costAbove =
            cone.at(z, static_cast<ConeZone>(breakpoint + 1), above.data(), Habove.data());
        EXPECT_SMALL((costBelow - costAbove) / scale, 1e-13);
        EXPECT_SMALL((below - above).cwiseAbs().maxCoeff() / scale, 1e-13);
        cone.breakpointGradient(z, breakpoint, gradient.data());
        const MatrixX jump = cone.stiffness() * gradient * gradient.transpose();
        EXPECT_SMALL((Hbelow - Habove - jump).cwiseAbs().maxCoeff() / scale, 1e-13);
      }
    }
}

TEST(EllipticCone, NanReachesTheForce) {
  Random random(1);
  const EllipticCone cone = randomCone(random, 3);
  for (int i = 0; i < 3; ++i) {
    VectorX x = VectorX::Constant(3, -1.0);
    x[i] = kNaN;
    EXPECT_FALSE(at(cone, x).f.allFinite());
  }
}

}  // namespace
}  // namespace softgauss::test
