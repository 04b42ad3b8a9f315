// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/connection.hpp"

#include <algorithm>

#include "engine/constraints/contact_softness.hpp"
#include "engine/constraints/tie_softness.hpp"

namespace softgauss {

PointOffset::PointOffset(const Assembly& in, int bodyA, const Vector3& p_AP, int bodyB,
                         const Vector3& p_BP)
    : p_WA(in.kinematics.X_WB[bodyA] * p_AP), p_WB(in.kinematics.X_WB[bodyB] * p_BP) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  r = p_WA - p_WB;
  bias.setZero();
  if (model.options.ownSoftness) {
    // The force acts in one place, lest it makes a moment: where what turns more easily is held.
    const double turnsA = in.weights.rotation[bodyA], turnsB = in.weights.rotation[bodyB];
    const double share = turnsA + turnsB > 0.0 ? turnsA / (turnsA + turnsB) : 0.5;
    const Vector3 place = p_WB + share * r;
    const Vector3 runs = share * pointTurning(model, k, bodyA, p_WA) +
                         (1.0 - share) * pointTurning(model, k, bodyB, p_WB);
    p_WA = p_WB = place;
    const std::vector<Motion>& V = k.turning();
    bias = V[bodyA].angular.cross(runs - pointTurning(model, k, bodyA, place)) -
           V[bodyB].angular.cross(runs - pointTurning(model, k, bodyB, place));
  }
  rate = pointVelocity(model, k, bodyA, p_WA) - pointVelocity(model, k, bodyB, p_WB);
  bias +=
      pointBiasAcceleration(model, k, bodyA, p_WA) - pointBiasAcceleration(model, k, bodyB, p_WB);
  rate -= in.lag() * bias;
  r -= 0.5 * in.lag() * in.lag() * bias;
}

bool carries(const Assembly& in, const Impedance& tie) {
  return in.load && !bouncing(tie, in.model.options);
}

double tieWeight(const Assembly& in, const Impedance& tie, int bodyA, int bodyB) {
  const double weight = in.weights.translation[bodyA] + in.weights.translation[bodyB];
  if (!carries(in, tie)) return weight;
  const double loaded = carrying(weight, std::max(in.load->mass(in.model, bodyA, bodyB),
                                                  in.load->partOnTie(in.model, bodyA, bodyB)));
  in.count(Mechanism::carriedLoad, loaded < weight);
  return loaded;
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
      const Softness soft = tieSoftness(in, c.impedance, offset.r.norm(),
                                        tieWeight(in, c.impedance, c.bodyA, c.bodyB));
      const RelativeMotion motion = offsetMotion(c.bodyA, offset.p_WA, c.bodyB, offset.p_WB);
      jacobian_.add(model, in.kinematics, in.tree, motion);
      pushRows(offset, soft);
    }
  }
  resizeRows(reference.size());
}

}  // namespace softgauss
