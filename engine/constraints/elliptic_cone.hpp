// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Penalty of a contact with an elliptic friction cone (T.31).
///
/// In the coordinates  z = (N, U),  N = μ̂ x₀,  U_k = μ_k x_k  (k = 1 … dim − 1),  T = |U|,
/// the penalty is half the squared distance of z from the cone K = { N ≥ μ̂ T }, times D/μ̂²:
///
///   s(x) = ½ (D/μ̂²) dist²(z, K) = ½ c (min(φ, 0)² + min(χ, 0)²)
///   φ = N − μ̂ T,   χ = μ̂ N + T,   c = D/(μ̂² (1 + μ̂²))
///
/// so it is convex and C¹ on three zones:
///   top     φ ≥ 0          no force: the contact breaks
///   middle  φ < 0 < χ      the force lies on the cone: the contact slides
///   bottom  χ ≤ 0          s = ½ D x₀² + ½ (D/μ̂²) T²: the contact sticks
/// The force f = −∇s has  f₀ ≥ 0  and  √Σ (f_k/μ_k)² ≤ f₀  for every x: it cannot leave the cone.

#include <array>
#include <cmath>

namespace softgauss {

enum class ConeZone { bottom, middle, top };

struct EllipticCone {
  static constexpr int kMaxDim = 6;

  int dim = 3;                       ///< 1 normal row, dim − 1 of friction
  double D = 0.0;                    ///< stiffness of the normal row, > 0
  double mu = 0.0;                   ///< μ̂ = μ₁/√impratio, > 0
  std::array<double, 5> friction{};  ///< μ_k > 0

  /// Returns s(x); writes f = −∇s (dim) and, unless null, H = ∇²s (dim × dim, row-major), and the
  /// zone. At a zone's edge H is that of the zone with less curvature.
  double at(const double* x, double* f, double* H, ConeZone& zone) const {
    double u[5], squares = 0.0;
    for (int k = 0; k + 1 < dim; ++k) {
      u[k] = friction[k] * x[k + 1];
      squares += u[k] * u[k];
    }
    const double N = mu * x[0], T = std::sqrt(squares);
    const double phi = N - mu * T, chi = mu * N + T;
    if (H)
      for (int i = 0; i < dim * dim; ++i) H[i] = 0.0;

    if (phi >= 0.0) {
      zone = ConeZone::top;
      for (int i = 0; i < dim; ++i) f[i] = 0.0;
      return 0.0;
    }
    if (chi < 0.0) {
      zone = ConeZone::bottom;
      f[0] = -D * x[0];
      if (H) H[0] = D;
      const double scale = D / (mu * mu);
      for (int k = 0; k + 1 < dim; ++k) {
        f[k + 1] = -scale * friction[k] * u[k];
        if (H) H[(k + 1) * (dim + 1)] = scale * friction[k] * friction[k];
      }
      return 0.5 * (D * x[0] * x[0] + scale * squares);
    }
    // Here T > 0, or x is not finite.
    zone = ConeZone::middle;
    const double c = D / (mu * mu * (1.0 + mu * mu));
    for (int k = 0; k + 1 < dim; ++k) u[k] /= T;
    f[0] = -c * phi * mu;
    for (int k = 0; k + 1 < dim; ++k) f[k + 1] = c * phi * mu * u[k] * friction[k];
    if (H) {
      // c (∇φ ∇φᵀ + φ ∇²φ),  ∇φ = (1, −μ̂ u),  ∇²φ = −(μ̂/T)(1 − u uᵀ)
      const double bend = -phi * mu / T;
      H[0] = c * mu * mu;
      for (int k = 0; k + 1 < dim; ++k) {
        H[k + 1] = H[(k + 1) * dim] = -c * mu * mu * u[k] * friction[k];
        for (int l = 0; l + 1 < dim; ++l)
          H[(k + 1) * dim + l + 1] = c * friction[k] * friction[l] *
                                     ((mu * mu - bend) * u[k] * u[l] + (k == l ? bend : 0.0));
      }
    }
    return 0.5 * c * phi * phi;
  }
};

}  // namespace softgauss
