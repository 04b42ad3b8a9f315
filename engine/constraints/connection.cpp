// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/connection.hpp"

#include <algorithm>

#include "softgauss/engine/constraints/contact_softness.hpp"
#include "softgauss/engine/constraints/equality_softness.hpp"

namespace softgauss {

PointOffset::PointOffset(const Assembly& in, int bodyA, const Vector3& p_AP, int bodyB,
                         const Vector3& p_BP)
    : p_WA(in.kinematics.X_WB[bodyA] * p_AP), p_WB(in.kinematics.X_WB[bodyB] * p_BP) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  r = p_WA - p_WB;
  bias.setZero();
  if (model.options.constraintModel == ConstraintModel::softgauss) {
    // The force acts in one place, lest it makes a moment: where what turns more easily is held.
    const double turnsA = in.weights.rotation[bodyA], turnsB = in.weights.rotation[bodyB];
    const double share = turnsA + turnsB > 0.0 ? turnsA / (turnsA + turnsB) : 0.5;
    const Vector3 place = p_WB + share * r;
    const Vector3 runs = share * pointMidstepVelocity(model, k, bodyA, p_WA) +
                         (1.0 - share) * pointMidstepVelocity(model, k, bodyB, p_WB);
    p_WA = p_WB = place;
    const std::vector<Motion>& V = k.midstepVelocities();
    bias = V[bodyA].angular.cross(runs - pointMidstepVelocity(model, k, bodyA, place)) -
           V[bodyB].angular.cross(runs - pointMidstepVelocity(model, k, bodyB, place));
  }
  rate = pointVelocity(model, k, bodyA, p_WA) - pointVelocity(model, k, bodyB, p_WB);
  bias +=
      pointBiasAcceleration(model, k, bodyA, p_WA) - pointBiasAcceleration(model, k, bodyB, p_WB);
  rate -= in.velocityLag() * bias;
  r -= 0.5 * in.velocityLag() * in.velocityLag() * bias;
}

bool usesSupportedMass(const Assembly& in, const Impedance& tie) {
  return in.load && !underdampedReference(tie, in.model.options);
}

double equalityInverseMass(const Assembly& in, const Impedance& tie, int bodyA, int bodyB,
                           double ofCenters) {
  if (in.model.options.constraintModel == ConstraintModel::mujoco) return ofCenters;
  const double weight = in.weights.translation[bodyA] + in.weights.translation[bodyB];
  if (!usesSupportedMass(in, tie)) return weight;
  const double loaded =
      cappedInverseMass(weight, std::max(in.load->mass(in.model, bodyA, bodyB),
                                         in.load->equalityShare(in.model, bodyA, bodyB)));
  in.count(Mechanism::supportedMass, loaded < weight);
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
  connections_.clear();
  if (model.options.effects.has(Effect::equality)) {
    for (std::size_t i = 0; i < model.connections.size(); ++i) {
      const Connection& c = model.connections[i];
      if (!in.takesPart(c.bodyA, c.bodyB)) continue;
      connections_.push_back(static_cast<int>(i));
      const PointOffset offset(in, c.bodyA, c.p_AP, c.bodyB, c.p_BP);
      const Softness soft = equalitySoftness(
          c.impedance, offset.r.norm(),
          equalityInverseMass(in, c.impedance, c.bodyA, c.bodyB, in.weights.connection[i]),
          model.options);
      const RelativeMotion motion = offsetMotion(c.bodyA, offset.p_WA, c.bodyB, offset.p_WB);
      jacobian_.add(model, in.kinematics, in.tree, motion, in.columns);
      pushRows(offset, soft);
    }
  }
  resizeRows(reference.size());
}

}  // namespace softgauss
