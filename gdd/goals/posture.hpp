// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Posture: every joint and floating base seeks a reference configuration, as a spring-damper.
///
///   ℓ(a) = ½ w (a − a*)ᵀ M (a − a*),   a* = v̇* + k_p (q* ⊖ q) + k_d (v* − v)              (9.7)
/// in the metric M, so that one weight serves heavy and light joints. ⊖ is the difference on the
/// configuration manifold. With R = M⁻¹ torques at light links are dear: a weight of 10³ makes a
/// standing humanoid stay up.
///
/// To places that other goals seek it yields. With J the rows of all of them, which act now,
///   a* = N (v̇* + k_p (q* ⊖ q) + k_d v*) − k_d v,
///   N = 1 − M⁻¹Jᵀ (C + ε diag C)⁻¹ J,   C = J M⁻¹Jᵀ                                      (9.24)
/// so that it moves nothing but what the places leave free: J N = 0 but for ε, and where a
/// robot whose base is fixed has come to rest, the places are reached whatever the weights are. N
/// shortens every vector in the metric M, so that yielding asks for no large accelerations where an
/// arm is stretched. ε = 10⁻⁴ leaves a direction to the posture in which the link is 10⁴ times as
/// heavy as along its rows, and keeps the change from one to the other, over an angle of √ε, slower
/// than a step of 2 ms can carry: k_p/√ε = 5000/s², against 1/h². In (9.24) the base of a robot
/// that touches something counts 1/√ε times: contacts hold it, so that a place is left to the
/// joints that move the link against the base, and what only the base can do stays above ε.

#include <utility>
#include <vector>

#include "softgauss/gdd/goals/joints.hpp"

namespace softgauss::gdd {

class Posture final : public Goal {
 public:
  static constexpr double kDefaultWeight = 1000.0;

  VectorX q;                        ///< q* (nq)
  std::vector<JointTarget> moving;  ///< joints whose target moves; it replaces that of q
  double weight = kDefaultWeight;   ///< w [-]
  double stiffness = 50.0;          ///< k_p [1/s²]
  double damping = 15.0;            ///< k_d [1/s]
  std::vector<LedPlace> yieldsTo;   ///< as weighDefaults() finds them

  explicit Posture(VectorX reference) : q(std::move(reference)) {}

  std::string name() const override { return "posture"; }
  VectorX* soughtPositions() override { return &q; }
  bool steadyAt(double time) const override;
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;

 private:
  void findAway(const GoalContext& context, VectorX& away) const;
  void yield(const GoalContext& context, GoalWorkspace& work, VectorX& pull) const;
  Eigen::Index findRows(const GoalContext& context, GoalWorkspace& work) const;
};

}  // namespace softgauss::gdd
