// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/servo_drive.hpp"

#include "softgauss/engine/constraints/law/row_law.hpp"

namespace softgauss {
namespace {

/// What Input asks of a dof, or `otherwise`.
double asked(const Input* input, VectorX Input::*of, int dof, double otherwise) {
  return input && (input->*of).size() > 0 ? (input->*of)[dof] : otherwise;
}

}  // namespace

void ServoDrive::assemble(const Assembly& in) {
  const Model& model = in.model;
  const Options& options = model.options;
  clear();
  for (int i = 0; options.effects.has(Effect::actuation) && i < model.nv; ++i) {
    const Dof& dof = model.dofs[i];
    const Servo& servo = dof.servo;
    if (!servo.exists() || in.controlled(dof.body) || !in.takesPart(dof.body)) continue;
    const double u = asked(in.input, &Input::setPoint, i, servo.setPoint);
    const double rate = asked(in.input, &Input::setPointRate, i, servo.setPointRate);
    const Softness soft = springLaw(servo.kp, servo.kd, in.weights.dof[i], options);
    const double away = in.state.q[model.bodies[dof.body].q] - u;
    push(i, 1.0, soft, soft.referenceAcceleration(in.state.v[i], away) + servo.kd * soft.R * rate);
    limit.push_back(servo.effort);
  }
  finish();
}

}  // namespace softgauss
