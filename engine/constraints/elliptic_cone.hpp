// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Penalty of a contact with an elliptic friction cone (4.13).
///
/// In the coordinates  z = (N, U),  N = μ̂ x₀,  U_k = μ_k x_k  (k = 1 … dim − 1),  T = |U|,
/// the penalty is D/μ̂² times half the squared distance of z from the cone K = { N ≥ μ̂ T }:
///
///   s(x) = ½ (D/μ̂²) dist²(z, K) = ½ c (min(φ, 0)² + min(χ, 0)²)
///   φ = N − μ̂ T,   χ = μ̂ N + T,   c = D/(μ̂² (1 + μ̂²))
///
/// so it is convex and C¹ on three zones (4.14):
///   top     φ ≥ 0          no force: the contact breaks
///   middle  φ < 0 ≤ χ      the force lies on the cone: the contact slides
///   bottom  χ < 0          s = ½ D x₀² + ½ (D/μ̂²) T²: the contact sticks
/// The force f = −∇s has  f₀ ≥ 0  and  √Σ (f_k/μ_k)² ≤ f₀  for every x: it cannot leave the cone.
/// φ and χ are two scalar half-quadratic rows, but for their bending. Where one of them crosses 0,
/// ∇²s jumps by c times the square of its gradient.

#include <array>
#include <cmath>
#include <cstdint>

#include "softgauss/engine/core/index.hpp"

namespace softgauss {

enum class ConeZone : std::int8_t { bottom, middle, top };

struct EllipticCone {
  static constexpr int kMaxDim = 6;

  int dim = 3;                       ///< 1 normal row, dim − 1 of friction
  double D = 0.0;                    ///< stiffness of the normal row, > 0
  double mu = 0.0;                   ///< μ̂ = μ₁/√impratio, > 0
  std::array<double, 5> friction{};  ///< μ_k > 0

  /// c of the half quadratics.
  double stiffness() const { return D / (mu * mu * (1.0 + mu * mu)); }

  /// x in the coordinates of the cone.
  struct Point {
    double N = 0.0, T = 0.0, phi = 0.0, chi = 0.0;
    std::array<double, 5> u{};  ///< U/T; 0 where T is
    /// NaN counts as middle, so that it reaches the force.
    ConeZone zone() const {
      return phi >= 0.0 ? ConeZone::top : (chi < 0.0 ? ConeZone::bottom : ConeZone::middle);
    }
  };
  Point point(const double* x) const {
    Point z;
    double squares = 0.0;
    for (int k = 0; k + 1 < dim; ++k) {
      z.u[idx(k)] = friction[idx(k)] * x[k + 1];
      squares += z.u[idx(k)] * z.u[idx(k)];
    }
    z.N = mu * x[0];
    z.T = std::sqrt(squares);
    z.phi = z.N - mu * z.T;
    z.chi = mu * z.N + z.T;
    if (z.T != 0.0)
      for (int k = 0; k + 1 < dim; ++k) z.u[idx(k)] /= z.T;
    return z;
  }

  /// Returns s(x); writes f = −∇s (dim) and, unless null, H = ∇²s (dim × dim, row-major), all by
  /// the formula of `zone`. At an edge, z.zone() is the zone of less curvature.
  double at(const Point& z, ConeZone zone, double* f, double* H) const {
    if (H)
      for (int i = 0; i < dim * dim; ++i) H[i] = 0.0;
    if (zone == ConeZone::top) {
      for (int i = 0; i < dim; ++i) f[i] = 0.0;
      return 0.0;
    }
    if (zone == ConeZone::bottom) {
      const double scale = D / (mu * mu);
      f[0] = -scale * mu * z.N;
      if (H) H[0] = D;
      for (int k = 0; k + 1 < dim; ++k) {
        f[k + 1] = -scale * friction[idx(k)] * z.T * z.u[idx(k)];
        if (H) H[(k + 1) * (dim + 1)] = scale * friction[idx(k)] * friction[idx(k)];
      }
      return 0.5 * scale * (z.N * z.N + z.T * z.T);
    }
    const double c = stiffness();
    f[0] = -c * z.phi * mu;
    for (int k = 0; k + 1 < dim; ++k) f[k + 1] = c * z.phi * mu * z.u[idx(k)] * friction[idx(k)];
    if (H) {
      // c (∇φ ∇φᵀ + φ ∇²φ),  ∇φ = (1, −μ̂ u),  ∇²φ = −(μ̂/T)(1 − u uᵀ)
      const double bend = z.T > 0.0 ? -z.phi * mu / z.T : 0.0;
      H[0] = c * mu * mu;
      for (int k = 0; k + 1 < dim; ++k) {
        H[k + 1] = H[(k + 1) * dim] = -c * mu * mu * z.u[idx(k)] * friction[idx(k)];
        for (int l = 0; l + 1 < dim; ++l)
          H[(k + 1) * dim + l + 1] =
              c * friction[idx(k)] * friction[idx(l)] *
              ((mu * mu - bend) * z.u[idx(k)] * z.u[idx(l)] + (k == l ? bend : 0.0));
      }
    }
    return 0.5 * c * z.phi * z.phi;
  }

  /// Breakpoint k lies between the zones k and k + 1: χ = 0, then φ = 0.
  static double aboveBreakpoint(const Point& z, int k) { return k == 0 ? z.chi : z.phi; }
  /// Gradient in x of what vanishes at breakpoint k (dim).
  void breakpointGradient(const Point& z, int k, double* gradient) const {
    gradient[0] = k == 0 ? mu * mu : mu;
    for (int i = 0; i + 1 < dim; ++i)
      gradient[i + 1] = (k == 0 ? 1.0 : -mu) * z.u[idx(i)] * friction[idx(i)];
  }
};

}  // namespace softgauss
