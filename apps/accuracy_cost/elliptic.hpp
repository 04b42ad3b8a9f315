// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Jacobi's elliptic functions, by descending Landen transformations [Abramowitz and Stegun 16.4].

#include <array>
#include <cmath>
#include <numbers>

namespace softgauss::app {

struct Jacobi {
  double sn, cn, dn;
};

/// sn, cn and dn of argument u and modulus k, 0 ≤ k < 1.
inline Jacobi jacobi(double u, double k) {
  std::array<double, 16> a, c;
  a[0] = 1.0, c[0] = k;
  double b = std::sqrt(1.0 - k * k);
  int n = 0;
  while (n < 15 && std::abs(c[n]) > 1e-17) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, n);
  double before = phi;
  for (; n > 0; --n) {
    before = phi;
    phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  }
  const double sn = std::sin(phi), cn = std::cos(phi);
  const double difference = std::cos(before - phi);
  const double dn =
      k == 0.0 || std::abs(difference) < 0.1 ? std::sqrt(1.0 - k * k * sn * sn) : cn / difference;
  return {sn, cn, dn};
}

/// The complete integral K(k), by the arithmetic-geometric mean.
inline double quarterPeriod(double k) {
  double a = 1.0, b = std::sqrt(1.0 - k * k);
  while (std::abs(a - b) > 1e-16 * a) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return 0.5 * std::numbers::pi / a;
}

}  // namespace softgauss::app
