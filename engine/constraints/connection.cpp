// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/connection.hpp"

#include <algorithm>

#include "engine/constraints/contact_softness.hpp"
#include "engine/constraints/tie_softness.hpp"

namespace softgauss {

PointOffset::PointOffset(const Assembly& in, int bodyA, const Vector3& p_AP, int bodyB,
                         const Vector3& p_BP)
    : p_WA(in.kinematics.X_WB[bodyA] * p_AP), p_WB(in.kinematics.X_WB[bodyB] * p_BP) {
  r = p_WA - p_WB;
  if (in.drifts()) {
    actInOnePlace(in, bodyA, bodyB);
    return;
  }
  rate = pointVelocity(in.model, in.kinematics, bodyA, p_WA) -
         pointVelocity(in.model, in.kinematics, bodyB, p_WB);
  if (in.nearby == nullptr) {
    bias = pointBiasAcceleration(in.model, in.kinematics, bodyA, p_WA) -
           pointBiasAcceleration(in.model, in.kinematics, bodyB, p_WB);
    lag = in.lag();
    return;
  }
  const double h = in.model.options.timestep;
  const std::vector<Transform>&before = in.nearby->before.X_WB, &after = in.nearby->after.X_WB;
  const Vector3 from = before[bodyA] * p_AP - before[bodyB] * p_BP;
  const Vector3 to = after[bodyA] * p_AP - after[bodyB] * p_BP;
  ahead = rate - (r - from) / h;
  bias = (to - r - (r - from)) / (h * h);
}

/// The force acts in one place, lest it makes a moment: where what turns more easily is held. There
/// r changes as seen from between the bodies, by the velocity of the one against the other.
void PointOffset::actInOnePlace(const Assembly& in, int bodyA, int bodyB) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  const double turnsA = in.weights.rotation[bodyA], turnsB = in.weights.rotation[bodyB];
  const double share = turnsA + turnsB > 0.0 ? turnsA / (turnsA + turnsB) : 0.5;
  const Vector3 place = p_WB + share * r;
  const Vector3 runs = share * pointTurning(model, k, bodyA, p_WA) +
                       (1.0 - share) * pointTurning(model, k, bodyB, p_WB);
  p_WA = p_WB = place;
  const std::vector<Motion>& V = k.turning();
  bias = pointBiasAcceleration(model, k, bodyA, place) -
         pointBiasAcceleration(model, k, bodyB, place) +
         V[bodyA].angular.cross(runs - pointTurning(model, k, bodyA, place)) -
         V[bodyB].angular.cross(runs - pointTurning(model, k, bodyB, place));
  rate = pointVelocity(model, k, bodyA, place) - pointVelocity(model, k, bodyB, place);
  lag = in.lag();
  r -= 0.5 * lag * lag * bias;  // where the step's ends are
}

bool carries(const Assembly& in, const Impedance& tie) {
  return in.load && !bouncing(tie, in.model.options);
}

double tieWeight(const Assembly& in, const Impedance& tie, int bodyA, int bodyB) {
  const double weight = in.weights.translation[bodyA] + in.weights.translation[bodyB];
  if (!carries(in, tie)) return weight;
  return carrying(weight, std::max(in.load->mass(in.model, bodyA, bodyB),
                                   in.load->partOnTie(in.model, bodyA, bodyB)));
}

RelativeMotion offsetMotion(int bodyA, const Vector3& p_WA, int bodyB, const Vector3& p_WB) {
  RelativeMotion motion;
  motion.bodyA = bodyB;  // seen from B
  motion.bodyB = bodyA;
  motion.p_WA = p_WB;
  motion.p_WB = p_WA;
  motion.linearDim = 3;
  return motion;
}

void ConnectionRows::assemble(const Assembly& in) {
  const Model& model = in.model;
  clearBlocks();
  if (model.options.effects.has(Effect::equality)) {
    for (const Connection& c : model.connections) {
      const PointOffset offset(in, c.bodyA, c.p_AP, c.bodyB, c.p_BP);
      const Softness soft =
          tieSoftness(c.impedance, offset.r.norm(), tieWeight(in, c.impedance, c.bodyA, c.bodyB),
                      model.options);
      const RelativeMotion motion = offsetMotion(c.bodyA, offset.p_WA, c.bodyB, offset.p_WB);
      jacobian_.add(model, in.kinematics, in.tree, motion);
      pushRows(motion, offset, soft);
    }
  }
  resizeRows(reference.size());
}

}  // namespace softgauss
