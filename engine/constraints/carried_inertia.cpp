// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/carried_inertia.hpp"

namespace softgauss {

double supportedInertia(const Assembly& in, int body) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  const Body& joint = model.bodies[body];
  const Motion& axis = k.S[joint.v];
  double inertia = model.options.effects.has(Effect::armature) ? model.dofs[joint.v].armature : 0.0;
  for (int b = body; b < joint.subtreeEnd; ++b) {
    const Body& carried = model.bodies[b];
    if (carried.massless) continue;
    const Vector3 r = k.X_WB[b] * carried.com - k.p_WO[joint.tree];
    const Vector3 turns = k.X_WB[b].R.transpose() * axis.angular;
    inertia += carried.mass * (axis.linear + axis.angular.cross(r)).squaredNorm() +
               turns.dot(carried.I_Bcm * turns);
  }
  return inertia;
}

}  // namespace softgauss
