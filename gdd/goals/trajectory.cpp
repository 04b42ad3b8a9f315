// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/trajectory.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::gdd {
namespace {

/// The integrals (9.27) over one piece, quadratic in x = (Δ, rates at its begin, rates at its end).
/// With s as time a piece is p + Σ c_k s^k: c = B x holds the coefficients that matter, and the
/// integrand is a polynomial in s whose square integrates to cᵀ G c.
MatrixX pieceIntegral(double h, bool jerk) {
  MatrixX B, G;
  VectorX scale;
  if (jerk) {  // c₃, c₄, c₅ of Δ, h v, h² a, h v, h² a;  6 c₃ + 24 c₄ s + 60 c₅ s²
    B.resize(3, 5), G.resize(3, 3), scale.resize(5);
    B << 10.0, -6.0, -1.5, -4.0, 0.5, -15.0, 8.0, 1.5, 7.0, -1.0, 6.0, -3.0, -0.5, -3.0, 0.5;
    G << 36.0, 72.0, 120.0, 72.0, 192.0, 360.0, 120.0, 360.0, 720.0;
    scale << 1.0, h, h * h, h, h * h;
  } else {  // c₂, c₃ of Δ, h v, h v;  2 c₂ + 6 c₃ s
    B.resize(2, 3), G.resize(2, 2), scale.resize(3);
    B << 3.0, -2.0, -1.0, -2.0, 1.0, 1.0;
    G << 4.0, 6.0, 6.0, 12.0;
    scale << 1.0, h, h;
  }
  B = B * scale.asDiagonal();
  return B.transpose() * G * B / std::pow(h, jerk ? 5 : 3);
}

/// The rates at the knots that make the sum of the integrals least: (orders × knots) a coordinate,
/// one below the other. At the ends they are 0, or free where `freeEnds`.
MatrixX leastRates(const std::vector<double>& times, const MatrixX& p, bool jerk, bool freeEnds) {
  const Eigen::Index m = jerk ? 2 : 1, knots = p.cols(), first = freeEnds ? 0 : 1;
  const Eigen::Index count = m * (knots - 2 * first);
  MatrixX rates = MatrixX::Zero(m * knots, p.rows());
  if (count <= 0) return rates;
  std::vector<Eigen::Triplet<double>> entries;
  MatrixX slope = MatrixX::Zero(count, p.rows());
  for (Eigen::Index k = 0; k + 1 < knots; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const MatrixX H = pieceIntegral(times[at + 1] - times[at], jerk);
    for (Eigen::Index i = 0; i < 2 * m; ++i) {
      const Eigen::Index row = m * (k - first) + i;
      if (row < 0 || row >= count) continue;
      slope.row(row) += H(1 + i, 0) * (p.col(k + 1) - p.col(k)).transpose();
      for (Eigen::Index j = 0; j < 2 * m; ++j)
        if (const Eigen::Index column = m * (k - first) + j; column >= 0 && column < count)
          entries.emplace_back(row, column, H(1 + i, 1 + j));
    }
  }
  Eigen::SparseMatrix<double> H(count, count);
  H.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(H);
  rates.middleRows(m * first, count) = factor.solve(MatrixX(-slope));
  return rates;
}

std::string atKnot(std::size_t i) { return "trajectory, knot " + std::to_string(i + 1); }

}  // namespace

CoordinateMotion minimumJerkShare(double time, double start, double T) {
  const double x = std::clamp((time - start) / T, 0.0, 1.0);
  return {x * x * x * (10.0 + x * (-15.0 + 6.0 * x)), 30.0 * x * x * (1.0 - x) * (1.0 - x) / T,
          60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (T * T)};
}

PointMotion Trajectory::pointAt(double time) const {
  PointMotion point;
  for (int i = 0; i < 3; ++i) {
    const CoordinateMotion x = at(time, i);
    point.p[i] = x.p;
    point.v[i] = x.v;
    point.a[i] = x.a;
  }
  return point;
}

void KnotTrajectory::check(const MatrixX& x) const {
  const auto knots = static_cast<Eigen::Index>(times_.size());
  if (knots == 0 || x.rows() == 0 || x.cols() != knots || x.rows() != p_.rows())
    throw ModelError({}, "trajectory",
                     "has " + std::to_string(knots) + " times for " + std::to_string(x.cols()) +
                         " knots, expected as many, and at least one");
  for (std::size_t k = 0; k < times_.size(); ++k) {
    if (!std::isfinite(times_[k]) || !x.col(static_cast<Eigen::Index>(k)).allFinite())
      throw ModelError({}, atKnot(k), "found NaN or ∞, expected finite numbers");
    if (k > 0 && !(times_[k] > times_[k - 1]))
      throw ModelError({}, atKnot(k), "is not later than the one before, expected rising times");
  }
}

KnotTrajectory::KnotTrajectory(std::vector<double> times, MatrixX p, MatrixX v, MatrixX a)
    : times_(std::move(times)), p_(std::move(p)), v_(std::move(v)), a_(std::move(a)) {
  for (const MatrixX* x : {&p_, &v_, &a_}) check(*x);
}

KnotTrajectory::KnotTrajectory(std::vector<double> times, const MatrixX& p,
                               Interpolation interpolation)
    : times_(std::move(times)), p_(p) {
  check(p);
  const bool jerk = interpolation == Interpolation::minimumJerk;
  const MatrixX rates = leastRates(times_, p, jerk, interpolation == Interpolation::naturalSpline);
  v_ = a_ = MatrixX::Zero(p.rows(), p.cols());
  const Eigen::Index m = jerk ? 2 : 1;
  for (Eigen::Index k = 0; k < p.cols(); ++k) {
    v_.col(k) = rates.row(m * k).transpose();
    if (jerk) a_.col(k) = rates.row(m * k + 1).transpose();
  }
  for (Eigen::Index k = 0; !jerk && k < p.cols() && p.cols() > 1; ++k) {  // of the cubic beside it
    const Eigen::Index i = std::min(k, p.cols() - 2);
    const double h = times_[static_cast<std::size_t>(i + 1)] - times_[static_cast<std::size_t>(i)];
    const VectorX bend = 6.0 * (p.col(i + 1) - p.col(i)) / (h * h);
    a_.col(k) = k == i ? VectorX(bend - (4.0 * v_.col(i) + 2.0 * v_.col(i + 1)) / h)
                       : VectorX((2.0 * v_.col(i) + 4.0 * v_.col(i + 1)) / h - bend);
  }
}

CoordinateMotion KnotTrajectory::at(double time, int i) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  if (after == times_.begin()) return {p_(i, 0), 0.0, 0.0};
  const auto k = static_cast<Eigen::Index>(after - times_.begin()) - 1;
  if (after == times_.end() && time > times_.back()) return {p_(i, k), 0.0, 0.0};
  if (after == times_.end()) return {p_(i, k), v_(i, k), a_(i, k)};
  const double t = *(after - 1), h = *after - t, s = (time - t) / h, r = 1.0 - s;
  const CoordinateMotion share = minimumJerkShare(s, 0.0, 1.0);
  const double way = p_(i, k + 1) - p_(i, k);
  const double v0 = h * v_(i, k), v1 = h * v_(i, k + 1);
  const double a0 = 0.5 * h * h * a_(i, k), a1 = 0.5 * h * h * a_(i, k + 1);
  CoordinateMotion x;
  x.p = p_(i, k) + share.p * way + s * (1.0 + s * s * (-6.0 + s * (8.0 - 3.0 * s))) * v0 +
        s * s * r * r * r * a0 - s * s * s * (4.0 + s * (-7.0 + 3.0 * s)) * v1 +
        s * s * s * r * r * a1;
  x.v = (share.v * way + r * r * (1.0 + s * (2.0 - 15.0 * s)) * v0 +
         s * r * r * (2.0 - 5.0 * s) * a0 - s * s * (12.0 + s * (-28.0 + 15.0 * s)) * v1 +
         s * s * r * (3.0 - 5.0 * s) * a1) /
        h;
  x.a = (share.a * way - 12.0 * s * r * (3.0 - 5.0 * s) * v0 +
         2.0 * r * (1.0 + s * (-8.0 + 10.0 * s)) * a0 - s * (24.0 + s * (-84.0 + 60.0 * s)) * v1 +
         2.0 * s * (3.0 + s * (-12.0 + 10.0 * s)) * a1) /
        (h * h);
  return x;
}

CircleTrajectory::CircleTrajectory(const Circle& circle)
    : circle_(circle), rate_(2.0 * M_PI * circle.frequency) {
  const bool finite = circle.center.allFinite() && circle.normal.allFinite() &&
                      std::isfinite(circle.radius) && std::isfinite(rate_) &&
                      std::isfinite(circle.phase) && std::isfinite(circle.startTime);
  if (!finite) throw ModelError({}, "circle", "found NaN or ∞, expected finite numbers");
  if (circle.normal.stableNorm() == 0.0)
    throw ModelError({}, "circle", "has a normal of length 0, expected a direction");
  const Vector3 n = circle.normal.stableNormalized();
  constexpr double kAlong = 1e-3;  // sine of the angle below which x gives no direction across n
  const Vector3 x = Vector3::UnitX() - n.x() * n;
  u_ = x.norm() > kAlong ? x.normalized() : (Vector3::UnitY() - n.y() * n).normalized();
  w_ = n.cross(u_);
}

CoordinateMotion CircleTrajectory::at(double time, int i) const {
  const double angle = circle_.phase + rate_ * (time - circle_.startTime);
  const double c = circle_.radius * std::cos(angle), s = circle_.radius * std::sin(angle);
  return {circle_.center[i] + c * u_[i] + s * w_[i], rate_ * (c * w_[i] - s * u_[i]),
          -rate_ * rate_ * (c * u_[i] + s * w_[i])};
}

}  // namespace softgauss::gdd
