// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Coulomb's law of what slides: pressed by what rests on it, held back along its slip.
///
/// The penalty of a friction cone is associated: it pushes what slides off the surface by μ times
/// its slip, which Castro, Han and Masterjohn call gliding ("Irrotational Contact Fields", 2023).
/// De Saxcé's change of variable removes it ("The bipotential method", 1998): the normal row asks
/// for less by the slip at the step's end. The last acceleration a₋ tells what that will be, so
/// that references stay functions of the state, the penalty convex and the inverse (1.2) explicit:
///
///   p = −b ẏ_n − k d r,   s_k = −μ_k b ẏ_k,   û = s/|s|     what depth, speed and slip ask for
///   ŷ = J a₋ + J̇ v,   β = Σ (û_k μ_k)² A_k/A
///   t₋ = Σ û_k μ_k ŷ_k − β max(0, ŷ_n)                      what the load met of s
///   t = t₋ + β max(0, (G p − ℓ)/(1 + G)),   |t| ≤ |s|       what load and impact will meet
///   σ = |s| − t                                             the slip that is left          (5.8)
///
/// β is what Coulomb's friction meets of s for each m/s² that the normal force adds to ẏ_n, with
/// A_k = A (1 + R² w_r/w_t) for a slide, R the radius of what is round, else 0. The force adds
/// (G p − ℓ)/(1 + G), with G = n A D of its n rows and the load ℓ = max(g, t₋/β): at rest nothing.
/// Without it an impact would count as slip what its own friction is about to stop, and stop half
/// of ẏ_n alone. A β too large would make ŷ_n swing from step to step: levers of bodies that are
/// not round, which many contacts share, are left out.
///
/// *Pyramids*: the n edges push by m_e ≥ 0 that add up to n p, whatever slides, and no edge asks
/// for more than stops the body within the step:
///
///   m_e = max(0, p ± γ σ û_k − λ),   Σ m_e = n p,   κ = max(γ, h b max m_e/p)
///   D ← κ D,   a_ref,e = m_e/κ ± t û_k                                                   (5.9)
///
/// so that in fast slip the leading edge has the stiffness n D of all. Where p ≤ 0 it asks for n p,
/// κ = max(γ, n h b). The tangents turn with the slip: friction points against it. Rolling and
/// spinning are slow in the units of the normal, and friction slows them little; γ asks as hard as
/// for a slide:
///
///   m = Σ (û_k μ_k/μ)² A_k/A,   γ = clamp(1/m, 1, n)                                     (5.12)
///
/// A_k = A of sliding, and the inverse inertia of turning.
///
/// *Elliptic cones* of ratio μ̂ slide where σ > μ̂² max(0, p). They have 1/(1 + μ̂²) of their normal
/// stiffness there, so that
///
///   κ = max(1, h b (1 + μ̂²)),   D ← κ D,   a_ref,n = p (1 + μ̂²)/κ − σ                   (5.10)
///
/// makes the normal force D max(0, p − y_n). All this counts min(1, 30 V) times, V the slip over
/// what friction stops within the row's horizon (5.11), so that forces are between the two: what
/// sticks answers s by itself.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace softgauss {

/// How a contact slides.
struct Slip {
  std::array<double, 5> direction{};  ///< û, of `dim` directions of friction
  int dim = 0;
  double asked = 0.0;    ///< |s| [m/s²]
  double met = 0.0;      ///< t [m/s²]
  double share = 0.0;    ///< min(1, 30 V), how much the law counts
  double asksFor = 1.0;  ///< γ
  double damping = 0.0;  ///< h b [-]

  double left() const { return asked - met; }  ///< σ
};

namespace detail {

/// λ with Σ max(0, q_e − λ) = target of n ≤ 10 numbers, where they add up to more than that.
inline double waterLevel(const double* q, int n, double target) {
  double sorted[10];
  std::copy_n(q, n, sorted);
  std::sort(sorted, sorted + n, std::greater<>());
  double sum = 0.0;
  for (int e = 0; e < n; ++e) {
    sum += sorted[e];
    const double level = (sum - target) / (e + 1);
    if (e + 1 == n || sorted[e + 1] <= level) return level;
  }
  return 0.0;
}

}  // namespace detail

/// References of a pyramid's edges in place of `asks`, p ± s_k; returns κ. `push` is p.
inline double levelPyramid(const Slip& slip, double push, double* asks) {
  const int n = 2 * slip.dim;
  const auto along = [&](int e) {
    return (e % 2 == 0 ? 1.0 : -1.0) * slip.direction[static_cast<std::size_t>(e / 2)];
  };
  double q[10];
  int lead = 0;
  for (int e = 0; e < n; ++e) {
    q[e] = push + slip.asksFor * along(e) * slip.left();
    if (q[e] > q[lead]) lead = e;
  }
  const bool presses = push > 0.0;
  const double level =
      presses ? std::max(0.0, detail::waterLevel(q, n, n * push)) : q[lead] - n * push;
  const double kappa =
      std::max(slip.asksFor, slip.damping * (presses ? (q[lead] - level) / push : n));
  const double harder = 1.0 + slip.share * (kappa - 1.0);
  for (int e = 0; e < n; ++e) {
    const double met = slip.share * along(e) * slip.met;
    const double more = (slip.asksFor - 1.0) * along(e) * slip.left() - level;
    const double pushes = asks[e] - met + slip.share * more;
    asks[e] = (pushes > 0.0 || e == lead ? pushes / harder : pushes) + met;
  }
  return harder;
}

/// The same of the normal row of an elliptic cone of ratio μ̂, in place of `push`.
inline double levelCone(const Slip& slip, double ratio, double& push) {
  const double square = ratio * ratio;
  if (!(slip.left() > square * std::max(0.0, push))) return 1.0;
  const double kappa = std::max(1.0, slip.damping * (1.0 + square));
  const double harder = 1.0 + slip.share * (kappa - 1.0);
  const double glides = push + slip.left();
  push = (glides + slip.share * (push * (1.0 + square) - glides)) / harder - slip.left();
  return harder;
}

}  // namespace softgauss
