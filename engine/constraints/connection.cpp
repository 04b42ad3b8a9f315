// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/connection.hpp"

#include <algorithm>

#include "engine/constraints/contact_softness.hpp"

namespace softgauss {
namespace {

/// (T.129): what each of the ties that hold a tree to others bears of it [kg]; 0 of single bodies,
/// whose weight is known, and of what stands on a base of its own.
double shareOf(const Model& model, int body) {
  const int tree = model.bodies[body].tree;
  if (tree < 0 || model.isFree(model.trees[tree].rootBody)) return 0.0;
  if (model.bodies[model.trees[tree].rootBody].joint != JointKind::floating) return 0.0;
  int ties = 0;
  const auto count = [&](int bodyA, int bodyB) {
    const int a = model.bodies[bodyA].tree, b = model.bodies[bodyB].tree;
    ties += a != b && (a == tree || b == tree);
  };
  for (const Connection& c : model.connections) count(c.bodyA, c.bodyB);
  for (const Weld& w : model.welds) count(w.bodyA, w.bodyB);
  return ties > 0 ? model.trees[tree].mass / ties : 0.0;
}

}  // namespace

PointOffset::PointOffset(const Assembly& in, int bodyA, const Vector3& p_AP, int bodyB,
                         const Vector3& p_BP)
    : p_WA(in.kinematics.X_WB[bodyA] * p_AP), p_WB(in.kinematics.X_WB[bodyB] * p_BP) {
  r = p_WA - p_WB;
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

bool carries(const Assembly& in, const Impedance& tie) {
  return in.load && !bouncing(tie, in.model.options);
}

double tieWeight(const Assembly& in, const Impedance& tie, int bodyA, int bodyB) {
  const double weight = in.weights.translation[bodyA] + in.weights.translation[bodyB];
  if (!carries(in, tie)) return weight;
  double load = in.load->mass(in.model, bodyA, bodyB);
  if (in.model.bodies[bodyA].tree != in.model.bodies[bodyB].tree)
    load = std::max({load, shareOf(in.model, bodyA), shareOf(in.model, bodyB)});
  return carrying(weight, load);
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
      const Softness soft = softnessAt(c.impedance, offset.r.norm(),
                                       tieWeight(in, c.impedance, c.bodyA, c.bodyB), model.options);
      const RelativeMotion motion = offsetMotion(c.bodyA, offset.p_WA, c.bodyB, offset.p_WB);
      jacobian_.add(model, in.kinematics, in.tree, motion);
      pushRows(motion, offset, soft);
    }
  }
  resizeRows(reference.size());
}

}  // namespace softgauss
