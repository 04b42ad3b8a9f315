// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/energy.hpp"

namespace softgauss {
namespace {

struct CenterMotion {
  Vector3 p_WC;  ///< centre of mass
  Vector3 v_WC;
  Vector3 omega;
  Vector3 H_C;  ///< angular momentum about the centre of mass
};

CenterMotion centerMotion(const Model& model, const Kinematics& k, int b) {
  const Body& body = model.bodies[b];
  CenterMotion m;
  m.p_WC = k.X_WB[b] * body.com;
  m.v_WC = pointVelocity(model, k, b, m.p_WC);
  m.omega = k.V[b].angular;
  m.H_C = rotated(k.X_WB[b].R, body.I_Bcm) * m.omega;
  return m;
}

}  // namespace

Energy computeEnergy(const Model& model, const Kinematics& k, const VectorX& q, const VectorX& v) {
  Energy e;
  const bool gravity = model.options.effects.has(Effect::gravity);
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    if (body.massless) continue;
    const CenterMotion m = centerMotion(model, k, b);
    e.kinetic += 0.5 * body.mass * m.v_WC.squaredNorm() + 0.5 * m.omega.dot(m.H_C);
    if (gravity) e.potential -= body.mass * model.options.gravity.dot(m.p_WC);
  }
  if (model.options.effects.has(Effect::armature))
    for (int i = 0; i < model.nv; ++i) e.kinetic += 0.5 * model.dofs[i].armature * v[i] * v[i];
  if (model.options.effects.has(Effect::spring))
    for (const Dof& dof : model.dofs) {
      if (dof.stiffness == 0.0) continue;
      const double stretch = q[model.bodies[dof.body].q] - dof.springReference;
      e.potential += 0.5 * dof.stiffness * stretch * stretch;
    }
  return e;
}

Momentum computeMomentum(const Model& model, const Kinematics& k) {
  Momentum sum;
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    if (body.massless) continue;
    const CenterMotion m = centerMotion(model, k, b);
    sum.linear += body.mass * m.v_WC;
    sum.angular += m.p_WC.cross(body.mass * m.v_WC) + m.H_C;
  }
  return sum;
}

Vector3 centerOfMass(const Model& model, const Kinematics& k) {
  Vector3 sum = Vector3::Zero();
  double mass = 0.0;
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    sum += body.mass * (k.X_WB[b] * body.com);
    mass += body.mass;
  }
  return mass > 0.0 ? Vector3(sum / mass) : Vector3::Zero();
}

}  // namespace softgauss
