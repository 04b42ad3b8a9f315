// SPDX-License-Identifier: Apache-2.0
/// How far the robot is from goals, in figures that a person reads: distances of places, errors of
/// joints, forces, momenta. Reach as its distance is Goal::errors().

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "softgauss/gdd/goals/balance.hpp"
#include "softgauss/gdd/goals/center_of_pressure.hpp"
#include "softgauss/gdd/goals/contact_force.hpp"
#include "softgauss/gdd/goals/hold.hpp"
#include "softgauss/gdd/goals/joint_velocity.hpp"
#include "softgauss/gdd/goals/keep_clear.hpp"
#include "softgauss/gdd/goals/link_acceleration.hpp"
#include "softgauss/gdd/goals/posture.hpp"
#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {
namespace {

/// Mass, place and momentum of a robot, of poses and velocities alone (armature is not counted).
struct Bulk {
  double mass = 0.0;
  Vector3 p_WC = Vector3::Zero();     ///< centre of mass [m]
  Vector3 linear = Vector3::Zero();   ///< [kg m/s]
  Vector3 angular = Vector3::Zero();  ///< about the centre of mass [kg m²/s]

  Bulk(const GoalContext& context, int robot) {
    const Kinematics& k = context.data.kinematics;
    Vector3 moment = Vector3::Zero(), aboutOrigin = Vector3::Zero();
    for (int b = 1; b < context.model.bodyCount(); ++b) {
      const Body& body = context.model.bodies[b];
      if (body.robot != robot || body.mass == 0.0) continue;
      const Transform& X = k.X_WB[b];
      const Vector3 p = X * body.com, spin = k.V[b].angular;
      const Vector3 push = body.mass * pointVelocity(context.model, k, b, p);
      mass += body.mass;
      moment += body.mass * p;
      linear += push;
      aboutOrigin += p.cross(push) + X.R * (body.I_Bcm.matrix() * (X.R.transpose() * spin));
    }
    p_WC = mass > 0.0 ? Vector3(moment / mass) : moment;
    angular = aboutOrigin - p_WC.cross(linear);
  }
};

GoalError figure(double value, const char* unit, double met, const char* what = "") {
  GoalError f;
  f.value = value;
  f.unit = unit;
  f.met = met;
  f.what = what;
  return f;
}

/// The worst of errors of joints: one figure of hinges, one of those that slide.
class WorstJoints {
 public:
  WorstJoints(const char* hingeUnit, const char* slideUnit) : units_{hingeUnit, slideUnit} {}

  /// `met`: as of GoalError.
  void see(const Model& model, int dof, double error, double met) {
    const bool slides = model.bodies[model.dofs[dof].body].joint == JointKind::prismatic;
    GoalError& worst = worst_[slides];
    if (worst.dof >= 0 && !(error * worst.met > worst.value * met)) return;
    worst = figure(error, units_[slides], met, slides ? "sliding joints" : "");
    worst.dof = dof;
  }
  void addTo(std::vector<GoalError>& out) const {
    for (const GoalError& worst : worst_)
      if (worst.dof >= 0) out.push_back(worst);
  }

 private:
  const char* units_[2];
  GoalError worst_[2];
};

/// A joint's position is met within this.
double metPosition(const Body& body) {
  return body.joint == JointKind::prismatic ? GoalError::kMetLength : GoalError::kMetAngle;
}

Vector3 along(const std::array<bool, 3>& axes, Vector3 x) {
  for (int i = 0; i < 3; ++i)
    if (!axes[static_cast<std::size_t>(i)]) x[i] = 0.0;
  return x;
}

}  // namespace

void Reach::errors(const GoalContext& context, const ContactForces& contacts,
                   std::vector<GoalError>& out) const {
  Goal::errors(context, contacts, out);
  if (!R_WTarget) return;
  const Matrix3 R = framePose(context.model, context.data.kinematics, frame).R;
  const Vector3 turn = quaternionLog(Quaternion(Matrix3(*R_WTarget * R.transpose())));
  out.push_back(figure(turn.norm(), "rad", GoalError::kMetAngle, "orientation"));
  out.back().frame = frame;
}

void Hold::errors(const GoalContext& context, const ContactForces&,
                  std::vector<GoalError>& out) const {
  const Kinematics& k = context.data.kinematics;
  const int body = context.model.frames[frame].body;
  const Vector3 p = framePose(context.model, k, frame) * p_FP;
  out.push_back(
      figure(pointVelocity(context.model, k, body, p).norm(), "m/s", GoalError::kMetSpeed));
  out.back().frame = frame;
}

void Posture::errors(const GoalContext& context, const ContactForces&,
                     std::vector<GoalError>& out) const {
  if (weight == 0.0) return;
  const Model& model = context.model;
  VectorX away(model.nv);
  findAway(context, away);
  WorstJoints worst("rad", "m");
  double place = -1.0, turn = -1.0;
  // A posture of a scene holds objects too, but nobody asks where a cube is that a robot carries.
  const bool hasRobot = std::any_of(model.dofs.begin(), model.dofs.end(),
                                    [](const Dof& dof) { return dof.actuated; });
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    const Tree& tree = model.trees[body.tree];
    const bool isObject = hasRobot && tree.bodyEnd - tree.rootBody == 1;
    if (body.joint == JointKind::floating) {
      if (isObject) continue;
      place = std::max(place, away.segment<3>(body.v).norm());
      turn = std::max(turn, away.segment<3>(body.v + 3).norm());
    } else if (body.dofs == 1) {
      worst.see(model, body.v, std::abs(away[body.v]), metPosition(body));
    }
  }
  const std::size_t first = out.size();
  worst.addTo(out);
  if (place >= 0.0) {
    out.push_back(figure(place, "m", GoalError::kMetLength, "base"));
    out.push_back(figure(turn, "rad", GoalError::kMetAngle, "base orientation"));
  }
  for (std::size_t i = first; i < out.size(); ++i) out[i].yields = true;
}

void JointPosture::errors(const GoalContext& context, const ContactForces&,
                          std::vector<GoalError>& out) const {
  WorstJoints worst("rad", "m");
  for (const JointTarget& target : targets) {
    const Body& body = context.model.bodies[target.body];
    worst.see(context.model, body.v,
              std::abs(target.positionAt(context.state.time).p - context.state.q[body.q]),
              metPosition(body));
  }
  worst.addTo(out);
}

void JointAcceleration::errors(const GoalContext& context, const ContactForces&,
                               std::vector<GoalError>& out) const {
  WorstJoints worst("rad/s²", "m/s²");
  for (const JointTarget& target : targets) {
    const int dof = context.model.bodies[target.body].v;
    worst.see(context.model, dof, std::abs(target.value - context.data.forward.a[dof]),
              std::max(GoalError::kMetShare * std::abs(target.value), 0.05));
  }
  worst.addTo(out);
}

void JointVelocity::errors(const GoalContext& context, const ContactForces&,
                           std::vector<GoalError>& out) const {
  WorstJoints worst("rad/s", "m/s");
  for (const JointTarget& target : targets) {
    const int dof = context.model.bodies[target.body].v;
    worst.see(context.model, dof, std::abs(target.value - context.state.v[dof]),
              std::max(GoalError::kMetShare * std::abs(target.value), GoalError::kMetSpeed));
  }
  worst.addTo(out);
}

void LinkAcceleration::errors(const GoalContext& context, const ContactForces&,
                              std::vector<GoalError>& out) const {
  const Model& model = context.model;
  const Kinematics& k = context.data.kinematics;
  const int body = model.frames[frame].body;
  const Vector3 p = framePose(model, k, frame) * p_FP;
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, model.nv);
  pointJacobian(model, k, body, p, J);
  const Vector3 a = J * context.data.forward.a + pointBiasAcceleration(model, k, body, p);
  out.push_back(
      figure((linear - a).norm(), "m/s²", std::max(GoalError::kMetShare * linear.norm(), 0.05)));
  out.back().frame = frame;
}

void KeepClear::errors(const GoalContext& context, const ContactForces&,
                       std::vector<GoalError>& out) const {
  const std::optional<double> clear = clearance(context);
  if (!clear) return;
  out.push_back(figure(std::max(distance - *clear, 0.0), "m", kMetClearance, "short of distance"));
  out.back().frame = context.model.findFrame(link);
}

void CenterOfMass::errors(const GoalContext& context, const ContactForces&,
                          std::vector<GoalError>& out) const {
  const Bulk bulk(context, robot);
  out.push_back(figure(along(axes, targetAt(context.state.time).p - bulk.p_WC).norm(), "m",
                       GoalError::kMetLength));
}

void MomentumGoal::errors(const GoalContext& context, const ContactForces&,
                          std::vector<GoalError>& out) const {
  const Bulk bulk(context, robot);
  const double still = GoalError::kMetSpeed * bulk.mass;
  if (linearWeight > 0.0)
    out.push_back(figure((linear - bulk.linear).norm(), "kg m/s",
                         std::max(still, GoalError::kMetShare * linear.norm())));
  if (angularWeight > 0.0)
    out.push_back(figure((angular - bulk.angular).norm(), "kg m²/s",
                         std::max(still, GoalError::kMetShare * angular.norm()), "angular"));
}

void CapturePoint::errors(const GoalContext& context, const ContactForces&,
                          std::vector<GoalError>& out) const {
  const Bulk bulk(context, robot);
  const Vector3 to = targetAt(context.state.time).p;
  const double height = bulk.p_WC.z() - to.z();
  const double pull = -context.model.options.gravity.z();
  if (!(height > 1e-3 && pull > 0.0)) return;
  const Vector3 point = bulk.p_WC + bulk.linear / bulk.mass * std::sqrt(height / pull);
  out.push_back(figure((point - to).head<2>().norm(), "m", GoalError::kMetLength));
}

void ContactForce::errors(const GoalContext& context, const ContactForces& touching,
                          std::vector<GoalError>& out) const {
  Vector3 sum = Vector3::Zero();
  for (const Snapshot::ContactForce& c : touching)
    sum += contacts.sign(c.geometryA, c.geometryB) * c.force;
  const Vector3 asked = along(axes, force);
  out.push_back(figure((asked - along(axes, sum)).norm(), "N",
                       std::max(GoalError::kMetShare * asked.norm(), 0.5)));
  out.back().frame = context.model.findFrame(link);
}

void CenterOfPressure::errors(const GoalContext&, const ContactForces& touching,
                              std::vector<GoalError>& out) const {
  Vector3 moment = Vector3::Zero();  // about p*
  double load = 0.0;
  for (const Snapshot::ContactForce& c : touching) {
    const Vector3 push = contacts.sign(c.geometryA, c.geometryB) * c.force;
    moment += (c.p_WC - p_WTarget).cross(push);
    load += n_W.dot(push);
  }
  if (!(load > 0.0)) return;
  out.push_back(figure((n_W.cross(moment) / load).norm(), "m", GoalError::kMetLength));
}

}  // namespace softgauss::gdd
