// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/centroidal.hpp"

namespace softgauss {

void computeCentroidal(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                       int robot, Centroidal& result) {
  result.mass = 0.0;
  result.p_WC.setZero();
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    if (body.robot != robot) continue;
    result.mass += body.mass;
    result.p_WC += body.mass * (k.X_WB[b] * body.com);
  }
  if (result.mass > 0.0) result.p_WC /= result.mass;

  // A force about O of the tree, as (force, moment about C).
  const auto aboutCentre = [&](int tree, const Force& F) {
    Vector6 x;
    x << F.force, F.moment + (k.p_WO[tree] - result.p_WC).cross(F.force);
    return x;
  };
  result.A.setZero(6, model.nv);
  result.momentum.setZero();
  result.bias.setZero();
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    if (body.robot != robot) continue;
    for (int i = body.v; i < body.v + body.dofs; ++i)
      result.A.col(i) = aboutCentre(body.tree, inertia.composite[b] * k.S[i]);
    if (body.massless) continue;
    const Force h = inertia.body[b] * k.V[b];
    result.momentum += aboutCentre(body.tree, h);
    result.bias += aboutCentre(body.tree, inertia.body[b] * k.A_bias[b] + crossForce(k.V[b], h));
  }
  result.v_WC.setZero();
  if (result.mass > 0.0) result.v_WC = result.momentum.head<3>() / result.mass;
}

}  // namespace softgauss
