// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/weld.hpp"

#include <cmath>

#include "softgauss/engine/constraints/connection.hpp"
#include "softgauss/engine/constraints/equality_softness.hpp"
#include "softgauss/engine/core/rotation.hpp"

namespace softgauss {
namespace {

/// How a frame of A is turned against a frame of B, and how that changes.
struct RotationOffset : Offset {
  Matrix3 J_r;  ///< ṙ = J_r ω for ω = ω_A − ω_B in the world; r = s ē

  RotationOffset(const Assembly& in, const Weld& weld, const Matrix3& R_WA, const Matrix3& R_WB) {
    const Quaternion e(Matrix3(R_WB.transpose() * R_WA));
    const double s = weld.torqueScale;
    r = s * e.vec();
    Matrix3 E = skew(e.vec());
    E.diagonal().array() += e.w();
    J_r = 0.5 * s * E * R_WA.transpose();
    const Kinematics& k = in.kinematics;
    const Motion &A = k.A_bias[weld.bodyA], &B = k.A_bias[weld.bodyB];
    rate = J_r * (k.V[weld.bodyA].angular - k.V[weld.bodyB].angular);
    const Vector3 wA = k.midstepVelocities()[weld.bodyA].angular,
                  w = wA - k.midstepVelocities()[weld.bodyB].angular;
    bias = J_r * (A.angular - B.angular - wA.cross(w)) - 0.25 * w.squaredNorm() * r;
    rate -= in.velocityLag() * bias;
    r -= 0.5 * in.velocityLag() * in.velocityLag() * bias;
  }
};

}  // namespace

void WeldRows::assemble(const Assembly& in) {
  const Model& model = in.model;
  const Kinematics& k = in.kinematics;
  clearBlocks();
  if (model.options.effects.has(Effect::equality)) {
    for (std::size_t i = 0; i < model.welds.size(); ++i) {
      const Weld& weld = model.welds[i];
      if (!in.takesPart(weld.bodyA, weld.bodyB)) continue;
      const Transform X_WA = k.X_WB[weld.bodyA] * weld.X_AF, X_WB = k.X_WB[weld.bodyB] * weld.X_BF;
      const PointOffset point(in, weld.bodyA, weld.X_AF.p, weld.bodyB, weld.X_BF.p);
      const RotationOffset turn(in, weld, X_WA.R, X_WB.R);
      const double distance = std::hypot(point.r.norm(), turn.r.norm());
      const auto softness = [&](double weight) {
        return equalitySoftness(weld.impedance, distance, weight, model.options);
      };
      RelativeMotion motion = offsetMotion(weld.bodyA, point.p_WA, weld.bodyB, point.p_WB);
      const Softness linear = softness(
          equalityInverseMass(in, weld.impedance, weld.bodyA, weld.bodyB, in.weights.weld[i]));
      jacobian_.add(model, k, in.tree, motion, in.columns);
      pushRows(point, linear);

      // Bodies that slide only cannot be turned back.
      double weight = in.weights.rotation[weld.bodyA] + in.weights.rotation[weld.bodyB];
      if (weight == 0.0) continue;
      if (usesSupportedMass(in, weld.impedance))
        weight = cappedInverseMass(
            weight, in.load->inertia(model, weld.bodyA, weld.bodyB, 0.5 * (X_WA.p + X_WB.p)));
      motion.linearDim = 0;
      motion.angularDim = 3;
      motion.angular = turn.J_r.transpose();
      const Softness angular = softness(weight);
      jacobian_.add(model, k, in.tree, motion, in.columns);
      pushRows(turn, angular);
    }
  }
  resizeRows(reference.size());
}

}  // namespace softgauss
