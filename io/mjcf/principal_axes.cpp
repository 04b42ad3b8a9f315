// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/principal_axes.hpp"

#include <cmath>
#include <utility>

namespace softgauss::io::mjcf {
namespace {

constexpr double kEnd = 1e-12;

/// Exchanges axes i and i + 1, by a quarter of a turn about the third.
void exchange(PrincipalAxes& axes, Quaternion& q, int i) {
  std::swap(axes.moments[i], axes.moments[i + 1]);
  Quaternion turn(std::sqrt(0.5), 0.0, 0.0, 0.0);
  turn.vec()[(i + 2) % 3] = std::sqrt(0.5);
  q = (q * turn).normalized();
}

}  // namespace

PrincipalAxes principalAxes(const Matrix3& inertia) {
  PrincipalAxes axes;
  Quaternion q = Quaternion::Identity();
  for (int iteration = 0; iteration < 500; ++iteration) {
    const Matrix3 R = q.toRotationMatrix();
    const Matrix3 D = R.transpose() * inertia * R;
    axes.moments = D.diagonal();
    int row = 1, column = 2;
    if (std::abs(D(0, 1)) > std::abs(D(0, 2)) && std::abs(D(0, 1)) > std::abs(D(1, 2)))
      row = 0, column = 1;
    else if (std::abs(D(0, 2)) > std::abs(D(1, 2)))
      row = 0, column = 2;
    const int axis = 3 - row - column;
    if (std::abs(D(row, column)) < kEnd) break;
    const double tau = (D(column, column) - D(row, row)) / (2.0 * D(row, column));
    const double t = (tau >= 0.0 ? 1.0 : -1.0) / (std::abs(tau) + std::sqrt(1.0 + tau * tau));
    const double cosine = 1.0 / std::sqrt(1.0 + t * t);
    if (cosine > 1.0 - kEnd) break;
    double half = std::sqrt(0.5 - 0.5 * cosine);  // sine of half the angle
    if ((tau >= 0.0) != (axis == 1)) half = -half;
    Quaternion turn(std::sqrt(1.0 - half * half), 0.0, 0.0, 0.0);
    turn.vec()[axis] = half;
    q = (q * turn.normalized()).normalized();
  }
  for (const int i : {0, 1, 0})
    if (axes.moments[i] + kEnd < axes.moments[i + 1]) exchange(axes, q, i);
  axes.R = q.toRotationMatrix();
  return axes;
}

}  // namespace softgauss::io::mjcf
