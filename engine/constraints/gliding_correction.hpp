// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Slip redistributes the push of a contact among its edges and adds none.
///
/// The references of a pyramid's n edges, p_e = p ± μ_k b ẏ_k about p = −b ẏ_n − k d r, have no
/// bound: what slides fast is pushed up by its leading edge, thrown and overturned. MuJoCo's
/// contacts do so; convex approximations of friction do in general, and Castro, Han and Masterjohn
/// ("Irrotational Contact Fields", 2023) call it gliding. Here all edges give up the same λ ≥ 0,
///
///   Σ_e max(0, p_e − λ) = n max(0, p)                                                  (5.8)
///
/// so that where nothing accelerates the contact pushes as its depth and normal speed say, whatever
/// slides. At rest and in slow slip λ = 0 and all edges push; in fast slip the leading edge alone
/// does, and friction is μ f_n. That edge has 1/n of the stiffness: it may ask for as much as stops
/// within a step what comes in, and little more. Without λ an edge asks for 2p at most, so
///
///   p_e − λ ≤ max(2p − 4λ, p, 1.2 p/(h b))
///
/// An elliptic cone of ratio μ̂, with T = |μ_k b ẏ_k|, pushes by p − λ along its normal:
///   λ = max(0, T − μ̂² p) where p > 0, else max(0, T + p),  so that its normal force is D max(0, p)
/// and p − λ + T has the bound of an edge, with 1 + μ̂² for 2.
///
/// λ counts ρ times where a contact sticks (5.7), and 1/μ times beyond μ = 1, where by Coulomb's
/// law too what slides is overturned. It is a function of q and v: the penalty and the inverse
/// (1.2) are as they were.

#include <algorithm>
#include <functional>

namespace softgauss {

class GlidingCorrection {
 public:
  /// `push` is p [m/s²], `damping` b [1/s], `timestep` h [s].
  GlidingCorrection(double push, double damping, double timestep) : push_(push) {
    constexpr double kStops = 1.2;  // 1.5 overturns what slides with μ = 1 at 5 ms
    const double hb = timestep * damping;
    most_ = std::max(0.0, push) * (hb < kStops ? kStops / hb : 1.0);
  }

  /// p_e − λ in place of the references p_e of n ≤ 10 edges; λ counts `share` times.
  void level(double* p, int n, double share) const {
    const double target = n * std::max(0.0, push_);
    double sorted[10], total = 0.0;
    for (int e = 0; e < n; ++e) total += std::max(0.0, sorted[e] = p[e]);
    if (!(total > target)) return;
    std::sort(sorted, sorted + n, std::greater<>());
    double lambda = 0.0, sum = 0.0;
    for (int e = 0; e < n; ++e) {
      sum += sorted[e];
      lambda = (sum - target) / (e + 1);
      if (e + 1 == n || sorted[e + 1] <= lambda) break;
    }
    for (int e = 0; e < n; ++e)
      p[e] -= share * (p[e] - std::min(p[e] - lambda, bound(2.0, lambda)));
  }

  /// λ of an elliptic cone: `friction` is T [m/s²], `ratio` μ̂.
  double ofCone(double friction, double ratio) const {
    const double without = ratio * ratio;
    const double lambda =
        std::max(0.0, push_ > 0.0 ? friction - without * push_ : friction + push_);
    if (!(lambda > 0.0 && push_ > 0.0)) return lambda;
    return std::max(lambda, friction + push_ - bound(1.0 + without, lambda));
  }

  /// How often λ counts, by the friction μ.
  static double share(double mu) { return mu > 1.0 ? 1.0 / mu : 1.0; }

 private:
  /// Of an edge that asks for `without` p where λ is 0.
  double bound(double without, double lambda) const {
    constexpr double kFades = 4.0;
    return std::max(most_, without * push_ - kFades * lambda);
  }

  double push_, most_;
};

}  // namespace softgauss
