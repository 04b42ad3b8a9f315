// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/semi_implicit_euler.hpp"

#include <algorithm>

#include "engine/step/forward.hpp"
#include "engine/step/integrators/implicit_forces.hpp"
#include "engine/step/integrators/kick.hpp"
#include "engine/step/integrators/tree_turn.hpp"

namespace softgauss {
namespace {

/// Some tree does, or was followed in the last step.
bool mayFollow(const Model& model, const Data& data, const State& state) {
  for (const VelocityOf instant : state.velocityOf)
    if (wasFollowed(instant)) return true;
  return mayTurnFar(model, data, state.v, data.acceleration);
}

}  // namespace

bool semiImplicitEuler(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  ForwardSolution& s = data.forward;
  const Plan& plan = data.plan;
  if (plan.rows.has(RowKind::swing) && !holdSwings(model, data, state)) return false;
  const bool midpoint = plan.midpoint, follows = implicitFollows(model, data);
  const bool rows = !data.constraints.active().empty();
  // With bounded friction (T.34) a is the solution of another problem.
  const bool answers = midpoint && rows && !model.options.noSlip;
  data.acceleration = s.a;
  bool follow = false;
  if (follows || midpoint) {
    // Right side M a, less what the Coriolis forces gain by mid-step and rows answer to that.
    VectorX& net = data.acceleration;
    if (rows)
      data.inertia.hat().multiply(s.a, net);
    else
      net = s.Ma;
    if (follows) setImplicitForces(model, state, data, net);
    bool factored = false;
    const auto solve = [&](VectorX& x) {  // x ← M̂⁻¹ x
      if (factored && !plan.diagonal)
        s.massFactor.solve(x);
      else
        factored = solveMass(data, follows ? &s.Md : nullptr, x);
      return factored;
    };
    if (midpoint) {
      s.start = s.a;
      if (follows) {  // a is that of damping and springs that the step does not follow
        s.start = net;
        if (!solve(s.start)) return false;
      }
      s.start = state.v + 0.5 * h * s.start;
      ++data.forces.calls.coriolis;
      computeBiasAt(model, data.kinematics, data.inertia, s.start, data.forces.work, s.direction);
      s.direction -= data.forces.bias;  // Δb
      if (answers) {
        if (!data.midStep.answer(model, data, state, s.start, s.direction)) return false;
        net += data.midStep.change();
      } else if (rows) {
        data.midStep.leaveAlone(s.direction);
        net += data.midStep.change();
      } else {
        net -= s.direction;
      }
    }
    if (!solve(net)) return false;
    if (midpoint && mayFollow(model, data, state)) {
      // What Δb does to the velocity by itself, damped like the rest.
      if (follows || rows)
        solve(s.direction);
      else
        s.direction = s.a - net;
      follow = data.followed.needed(model, data, state, s.direction);
    }
  }
  if (follow && answers) data.midStep.leave(data);
  const bool kicked = follow && data.followed.anyPushed(model, data);
  if (kicked && !data.followed.kick(model, data, state)) return false;
  s.start = state.v + h * data.acceleration;
  if (tooFast(model, s.start)) return false;
  if (follow) {
    data.followed.follow(model, data, state, s.direction, s.start);
    if (tooFast(model, s.start)) return false;
    data.acceleration = (s.start - state.v) / h;
  }
  state.v = s.start;
  integratePosition(model, state.v, h, state.q);
  if (follow) data.followed.copyPositions(model, state.q);
  if (midpoint)
    std::replace(state.velocityOf.begin(), state.velocityOf.end(), VelocityOf::asGiven,
                 VelocityOf::halfAStepAgo);
  if (kicked)
    data.followed.endKick(model, data);
  else if (follow && answers)
    data.midStep.enter(data);
  state.time += h;
  return true;
}

}  // namespace softgauss
