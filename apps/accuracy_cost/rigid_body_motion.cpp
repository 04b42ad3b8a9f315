// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/rigid_body_motion.hpp"

#include <algorithm>
#include <cmath>

#include "apps/accuracy_cost/elliptic.hpp"

namespace softgauss::app {
namespace {

/// ∫ f over [0, t] by Gauss-Legendre's rule of five points on pieces of at most `piece`.
template <class F>
double integral(const F& f, double t, double piece) {
  constexpr double kPlaces[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double kWeights[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const int pieces = std::max(1, static_cast<int>(std::ceil(t / piece)));
  const double half = 0.5 * t / pieces;
  double sum = 0.0;
  for (int i = 0; i < pieces; ++i) {
    const double middle = (2 * i + 1) * half;
    sum += kWeights[0] * half * f(middle);
    for (int k = 1; k < 3; ++k)
      sum += kWeights[k] * half * (f(middle - kPlaces[k] * half) + f(middle + kPlaces[k] * half));
  }
  return sum;
}

/// u with sn u = s and cn u = c, |u| < 2 K(k): ∫ dφ/√(1 − k² sin²φ).
double argument(double s, double c, double k) {
  const double phi = std::atan2(s, c);
  const double size =
      integral([k](double x) { return 1.0 / std::sqrt(1.0 - std::pow(k * std::sin(x), 2)); },
               std::abs(phi), 0.01);
  return std::copysign(size, phi);
}

/// Axes with z along L, and x such that the body's x axis lies in the plane of z and −x; in body
/// axes as columns.
Matrix3 axesAbout(const Vector3& L_B) {
  Matrix3 axes;
  axes.col(2) = L_B.normalized();
  axes.col(1) = axes.col(2).cross(Vector3::UnitX()).normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return axes;
}

}  // namespace

Turn freeTurn(const Vector3& I, const Vector3& w, double t) {
  const Vector3 L = I.cwiseProduct(w);
  const double L2 = L.squaredNorm(), T2 = L.dot(w);  // |L|² and 2 T
  const double x = I.x(), y = I.y(), z = I.z();
  const double least = T2 * x - L2, most = L2 - T2 * z;
  const double ax = std::copysign(std::sqrt(most / (x * (x - z))), w.x());
  const double ay = std::sqrt(least / (y * (x - y))), az = std::sqrt(least / (z * (x - z)));
  const double k = std::sqrt((y - z) * least / ((x - y) * most));
  // w_y′ = (I_z − I_x) w_z w_x/I_y, and sn′ = cn dn: the sign of the rate is that of −w_x.
  const double rate = -std::copysign(std::sqrt((x - y) * most / (x * y * z)), w.x());
  const double start = argument(w.y() / ay, w.z() / az, k);
  const auto at = [&](double time) -> Vector3 {
    const Jacobi e = jacobi(rate * time + start, k);
    return {ax * e.dn, ay * e.sn, az * e.cn};
  };
  // The plane of L and the body's x axis turns about L.
  const auto turning = [&](double time) {
    const Vector3 now = at(time), squares = I.cwiseProduct(now).cwiseProduct(now);
    const double across = squares.y() + squares.z();
    return std::sqrt(L2) * across / (y * squares.y() + z * squares.z());
  };
  const double angle = integral(turning, t, 1e-3);
  Turn turn;
  turn.w_B = at(t);
  const Matrix3 now = axesAbout(I.cwiseProduct(turn.w_B)), then = axesAbout(L);
  const Matrix3 about = Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
  turn.R_WB = then * about * now.transpose();
  return turn;
}

TopAngles topAngles(double moment, double axial, double weight, double tilt, double spin,
                    double t) {
  // (d cos θ/dt)² = (c₀ − c) (β (1 − c²) − a² (c₀ − c))
  const double a = axial * spin / moment, beta = 2.0 * weight / moment, c0 = std::cos(tilt);
  const double root = std::sqrt(std::pow(a, 4) - 4.0 * beta * (a * a * c0 - beta));
  const double c2 = (a * a + root) / (2.0 * beta);
  const double c1 = 2.0 * (a * a * c0 - beta) / (a * a + root);  // the smaller root
  const double k = std::sqrt((c0 - c1) / (c2 - c1)), rate = 0.5 * std::sqrt(beta * (c2 - c1));
  const auto cosine = [&](double time) {
    const Jacobi e = jacobi(rate * time, k);
    const double cd = e.cn / e.dn;
    return c1 + (c0 - c1) * cd * cd;
  };
  const auto precession = [&](double c) { return a * (c0 - c) / (1.0 - c * c); };
  TopAngles top;
  const double c = cosine(t);
  const Jacobi e = jacobi(rate * t, k);
  top.tilt = std::acos(c);
  // d cd/du = −(1 − k²) sn/dn²
  const double dc = -2.0 * (c0 - c1) * rate * (1.0 - k * k) * e.cn * e.sn / (e.dn * e.dn * e.dn);
  top.tiltRate = -dc / std::sin(top.tilt);
  top.precessionRate = precession(c);
  top.spinRate = spin - c * top.precessionRate;
  top.precession = integral([&](double s) { return precession(cosine(s)); }, t, 1e-3);
  top.spin =
      spin * t - integral([&](double s) { return cosine(s) * precession(cosine(s)); }, t, 1e-3);
  return top;
}

}  // namespace softgauss::app
