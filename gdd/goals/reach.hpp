// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Spatial goal: a point P of a link seeks a place in the world, equation (11) of the paper; the
/// link may seek an orientation too.
///
///   ℓ(a) = ½ w |J a + J̇ v − a*|² + ½ w_r |J_r a + J̇_r v − α*|²                            (9.2)
/// with the wished acceleration of P
///   a* = r̈ + k_p (r − p) + k_d (ṙ − ṗ)                                                   (9.3)
/// r is the target p*(t), which rests or moves (trajectory.hpp). With a minimum jerk, P comes to it
/// from the start p₀, at rest, in the duration T: r = p₀ + σ(s) (p* − p₀), s = (t − t₀)/T, σ of
/// (9.26); where p* rests that is the line of Flash and Hogan (1985).
/// The angular acceleration α* follows the same law with θ, the rotation vector of R* Rᵀ, for
/// r − p, and ω for ṗ; with a minimum jerk the link turns about one axis                   (9.4)
/// The metric may be the consistent one (9.5) instead of the Euclidean.

#include <optional>

#include "softgauss/gdd/goals/default_weight.hpp"
#include "softgauss/gdd/goals/link_rows.hpp"
#include "softgauss/gdd/goals/trajectory.hpp"

namespace softgauss::gdd {

/// How a point comes to its target.
struct MinimumJerk {
  Vector3 p_start = Vector3::Zero();      ///< p₀ [m]
  double startTime = 0.0;                 ///< t₀ [s]
  double duration = 1.0;                  ///< T [s]
  Matrix3 R_start = Matrix3::Identity();  ///< orientation of the link at t₀, for an orientation
};

/// w over the mass of the robot, by default: 100 kg for a humanoid of 40 kg. A fixed weight would
/// ask a robot of 1 kg for accelerations that no time step can carry.
inline constexpr double kReachWeightPerMass = 2.5;

/// The mass of a robot (Body::robot) [kg].
double massOfRobot(const Model& model, int robot);
/// The mass by which goals of a link weigh, of a frame or of none (< 0): that of its robot, whoever
/// else is in the scene; of all that moves where nothing drives that robot, as others then move it
/// [kg].
double referenceMass(const Model& model, int frame);

/// w_r over w by default [m²]: a link of radius of gyration 0.1 m.
inline constexpr double kRotationWeightPerWeight = 0.01;

/// The target is a PlaceTarget.
class Reach final : public Goal, public PlaceTarget {
 public:
  std::string link;                     ///< for the name
  int frame = 0;                        ///< index into Model::frames
  Vector3 p_FP = Vector3::Zero();       ///< the point in the link's frame [m]
  std::optional<Matrix3> R_WTarget;     ///< R*: orientation of the link; absent: any
  double weight;                        ///< w [kg; - if consistent]; default 2.5 × referenceMass()
  double rotationWeight;                ///< w_r [kg m²; - if consistent]; default 0.01 m² × w
  DefaultWeight defaultWeight;          ///< of w
  DefaultWeight defaultRotationWeight;  ///< of w_r
  LinkMetric metric = LinkMetric::euclidean;
  double stiffness = 100.0;                ///< k_p [1/s²]
  double damping = 20.0;                   ///< k_d [1/s]
  std::optional<MinimumJerk> minimumJerk;  ///< absent: at once

  /// Throws ModelError when the model has no such link.
  Reach(const Model& model, const std::string& link, const Vector3& p_WTarget,
        const Vector3& p_FP = Vector3::Zero());

  std::string name() const override { return "reach " + link; }
  int linkFrame() const override { return frame; }
  void weighBeside(double posture) override {
    defaultWeight.setBeside(posture, weight);
    defaultRotationWeight.setBeside(posture, rotationWeight);
  }
  std::optional<LedPlace> ledPlace() const override {
    if (!defaultWeight.isAt(weight)) return std::nullopt;
    return LedPlace{frame, p_FP, R_WTarget.has_value(), startTime, endTime};
  }
  double* soughtPlace() override { return restingPlace(); }
  bool steadyAt(double time) const override {
    const bool comes = minimumJerk && time >= minimumJerk->startTime &&
                       time <= minimumJerk->startTime + minimumJerk->duration;
    return !comes && !targetMovesAt(time);
  }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return isOfTree(model, frame, tree);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
  std::optional<GoalMark> mark(const GoalContext& context) const override;
  Vector3 position(const GoalContext& context) const;

 private:
  PointMotion referenceAt(double time) const;
  Vector3 wishedAcceleration(double time, const Vector3& p, const Vector3& v) const;
  Vector3 wishedRotation(double time, const Matrix3& R, const Vector3& omega) const;
};

}  // namespace softgauss::gdd
