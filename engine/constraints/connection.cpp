// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/connection.hpp"

#include "engine/constraints/impedance.hpp"

namespace softgauss {

PointOffset::PointOffset(const Assembly& in, int bodyA, const Vector3& p_WA, int bodyB,
                         const Vector3& p_WB)
    : r(p_WA - p_WB),
      rate(pointVelocity(in.model, in.kinematics, bodyA, p_WA) -
           pointVelocity(in.model, in.kinematics, bodyB, p_WB)),
      bias(pointBiasAcceleration(in.model, in.kinematics, bodyA, p_WA) -
           pointBiasAcceleration(in.model, in.kinematics, bodyB, p_WB)) {}

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
      const Vector3 p_WA = in.kinematics.X_WB[c.bodyA] * c.p_AP;
      const Vector3 p_WB = in.kinematics.X_WB[c.bodyB] * c.p_BP;
      const PointOffset offset(in, c.bodyA, p_WA, c.bodyB, p_WB);
      const Softness soft = softnessAt(
          c.impedance, offset.r.norm(),
          in.weights.translation[c.bodyA] + in.weights.translation[c.bodyB], model.options);
      const RelativeMotion motion = offsetMotion(c.bodyA, p_WA, c.bodyB, p_WB);
      jacobian_.add(model, in.kinematics, in.tree, motion);
      pushRows(motion, -soft.damping * offset.rate - soft.stiffness * offset.r, offset.bias, soft);
    }
  }
  resizeRows(reference.size());
}

}  // namespace softgauss
