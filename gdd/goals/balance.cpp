// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/balance.hpp"

#include <cmath>

#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {
namespace {

const Centroidal& centroidalOf(const GoalContext& context, int robot, Centroidal& c) {
  computeCentroidal(context.model, context.data.kinematics, context.data.inertia, robot, c);
  return c;
}

/// ½ weight (acceleration of the centre of mass along `axis` − wished)²: of m times that, the row
/// of A.
void addAxis(const Centroidal& c, int axis, double weight, double wished, GoalCost& cost) {
  const Eigen::Matrix<double, 1, 1> target(c.mass * wished - c.bias[axis]);
  cost.addRows(c.A.middleRows(axis, 1), weight / (c.mass * c.mass), target);
}

/// Frequency of the linear inverted pendulum [1/s]; 0 where there is none.
double pendulumRate(const GoalContext& context, double height) {
  const Options& options = context.model.options;
  const double pull = options.effects.has(Effect::gravity) ? -options.gravity.z() : 0.0;
  return pull > 0.0 && height > 1e-3 ? std::sqrt(pull / height) : 0.0;
}

}  // namespace

int drivenRobot(const Model& model) {
  for (const Dof& dof : model.dofs)
    if (dof.actuated) return model.bodies[dof.body].robot;
  throw ModelError({}, "model '" + model.name + "'",
                   "has no actuated joint, expected one for a goal of a robot");
}

CenterOfMass::CenterOfMass(const Model& model, int ofRobot, const Vector3& target)
    : PlaceTarget(target),
      robot(ofRobot),
      weight(kReachWeightPerMass * massOfRobot(model, robot)),
      defaultWeight(weight) {}

void CenterOfMass::addCost(const GoalContext& context, GoalCost& cost) const {
  const Centroidal& c = centroidalOf(context, robot, cost.workspace().centroidal);
  const PointMotion to = targetAt(context.state.time);
  const Vector3 wished = to.a + stiffness * (to.p - c.p_WC) + damping * (to.v - c.v_WC);
  for (int i = 0; i < 3; ++i)
    if (axes[static_cast<std::size_t>(i)]) addAxis(c, i, weight, wished[i], cost);
}

MomentumGoal::MomentumGoal(const Model& model, int ofRobot)
    : robot(ofRobot),
      linearWeight(kReachWeightPerMass / massOfRobot(model, robot)),
      angularWeight(10.0 / massOfRobot(model, robot)) {}

void MomentumGoal::addCost(const GoalContext& context, GoalCost& cost) const {
  const Centroidal& c = centroidalOf(context, robot, cost.workspace().centroidal);
  Vector6 wished;
  wished << linear, angular;
  wished = rate * (wished - c.momentum) - c.bias;
  cost.addRows(c.A.topRows(3), linearWeight, wished.head(3));
  cost.addRows(c.A.bottomRows(3), angularWeight, wished.tail(3));
}

CapturePoint::CapturePoint(const Model& model, int ofRobot, const Vector3& target)
    : PlaceTarget(target),
      robot(ofRobot),
      weight(kReachWeightPerMass * massOfRobot(model, robot)),
      defaultWeight(weight) {}

std::optional<Vector3> CapturePoint::position(const GoalContext& context) const {
  Centroidal c;
  centroidalOf(context, robot, c);
  const double ground = targetAt(context.state.time).p.z();
  const double omega = pendulumRate(context, c.p_WC.z() - ground);
  if (omega == 0.0) return std::nullopt;
  const Vector3 point = c.p_WC + c.v_WC / omega;
  return Vector3(point.x(), point.y(), ground);
}

void CapturePoint::addCost(const GoalContext& context, GoalCost& cost) const {
  const Centroidal& c = centroidalOf(context, robot, cost.workspace().centroidal);
  const PointMotion to = targetAt(context.state.time);
  const double z = c.p_WC.z() - to.p.z();
  const double omega = pendulumRate(context, z);
  if (omega == 0.0) return;
  for (int i = 0; i < 2; ++i) {
    const double v = c.v_WC[i], away = c.p_WC[i] + v / omega - to.p[i];
    addAxis(c, i, weight, omega * (to.v[i] - rate * away - v) - 0.5 * v * c.v_WC.z() / z, cost);
  }
}

}  // namespace softgauss::gdd
