// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The optimal value function of a pendulum that is to stand upright, by value iteration on a grid.
///
///   q_m = q + ½ h v,   v⁺ = v + h (u − c)/M̂,   q⁺ = q_m + ½ h v⁺                           (6.2)
///   M̂ = M + h d,   c = m g l sin q_m + d v
///   V(q, v) = p(q, v) + min_u ½ u²/M̂ + V(q⁺, v⁺),   p = κ (1 + cos q) + ½ κ_v v²            (21)
///
/// q = 0 hangs down. V is periodic in q and zero at rest upright. Between nodes it is a cubic in q
/// times a cubic in v, with slopes by central differences (C¹), which is what the control acts on.

#include <array>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::test {

struct PendulumPlant {
  double M = 1.0;                            ///< about the hinge [kg m²]
  double gravity = 0.0;                      ///< m g l [N m]
  double damping = 0.0;                      ///< d [N m s/rad]
  double h = 0.02;                           ///< [s]
  double angleCost = 20.0, speedCost = 0.1;  ///< κ, κ_v

  double felt() const { return M + h * damping; }  ///< damping is that of the step's end
  double middle(double q, double v) const { return q + 0.5 * h * v; }  ///< q_m
  /// At mid-step.
  double acceleration(double middle, double v, double u) const;
  double running(double q, double v, double u) const;
};

class PendulumValue {
 public:
  /// `angles` nodes around, an even number; `speeds` nodes over ± largest, an odd one.
  PendulumValue(const PendulumPlant& plant, int angles, int speeds, double largest);

  /// V with its first two derivatives in (q, v).
  struct Model {
    double value = 0.0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();
  };
  Model model(double q, double v) const;
  double at(double q, double v) const;
  /// min_u of ½ u²/M̂ + V(q⁺, v⁺), from a mesh of v⁺ refined to rounding; `u`: where.
  double backup(double q, double v, double& u) const;

 private:
  /// Four neighbouring nodes, and what they count for in value, slope and curvature.
  struct Stencil {
    std::array<int, 4> node;
    std::array<double, 4> value, slope, curvature;
  };
  static Stencil stencil(double x, int count, bool around);
  Stencil angle(double q) const;
  Stencil speed(double v) const;

  PendulumPlant plant_;
  double largest_, step_;
  MatrixX V_;  ///< (speeds × angles)
};

}  // namespace softgauss::test
