// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Spatial goal: a point P of a link seeks a place in the world, equation (11) of the paper.
///
///   ℓ(a) = ½ w |J a + J̇ v − a*|²                                                        (T.22)
/// with the wished acceleration of P from one of two laws, e = p* − p:
///   spring-damper   a* = k_p e − k_d ṗ
///   minimum jerk    a* = r̈(t) + k_p (r − p) + k_d (ṙ − ṗ)                                (T.23)
/// r is the minimum-jerk line of Flash and Hogan (1985) from the start p₀, at rest, to p* in the
/// duration T:  r = p₀ + (p* − p₀)(10 s³ − 15 s⁴ + 6 s⁵),  s = (t − t₀)/T in [0, 1].

#include <optional>

#include "gdd/goal.hpp"

namespace softgauss::gdd {

struct MinimumJerk {
  Vector3 p_start = Vector3::Zero();  ///< p₀ [m]
  double startTime = 0.0;             ///< t₀ [s]
  double duration = 1.0;              ///< T [s]
};

/// w over the mass of all moving bodies, by default: 100 kg for a humanoid of 40 kg. A fixed weight
/// would ask a robot of 1 kg for accelerations that no time step can carry.
inline constexpr double kReachWeightPerMass = 2.5;

class Reach final : public Goal {
 public:
  std::string link;                        ///< for the name
  int frame = 0;                           ///< index into Model::frames
  Vector3 p_FP = Vector3::Zero();          ///< the point in the link's frame [m]
  Vector3 p_WTarget = Vector3::Zero();     ///< p* [m]
  double weight;                           ///< w [kg]; default 2.5 × the robot's mass
  double stiffness = 100.0;                ///< k_p [1/s²]
  double damping = 20.0;                   ///< k_d [1/s]
  std::optional<MinimumJerk> minimumJerk;  ///< absent: spring-damper

  /// Throws ModelError when the model has no such link.
  Reach(const Model& model, const std::string& link, const Vector3& p_WTarget,
        const Vector3& p_FP = Vector3::Zero());

  std::string name() const override { return "reach " + link; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  std::optional<GoalMark> mark(const GoalContext& context) const override;
  Vector3 position(const GoalContext& context) const;
};

}  // namespace softgauss::gdd
