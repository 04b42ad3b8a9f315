// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/semi_implicit_euler.hpp"

#include <algorithm>

#include "engine/step/forward.hpp"
#include "engine/step/integrators/implicit_forces.hpp"

namespace softgauss {
namespace {

/// A body turns by more than 0.005 rad in the step, or a joint does by the velocity that it ends
/// with, or slides with as much energy, v_i √M_ii, as the joint of its tree that turns most easily
/// would have so, or a tree was followed in the last one. Below that (T.93) need not be worked out.
bool mayTurnFar(const Model& model, const Data& data, const State& state) {
  for (const VelocityOf instant : state.velocityOf)
    if (wasFollowed(instant)) return true;
  const double h = model.options.timestep, fast = 0.005 / h;
  for (const Motion& V : data.kinematics.V)
    if (V.angular.squaredNorm() > fast * fast) return true;
  for (const Tree& tree : model.trees) {
    double slides = 0.0, lightest = kInfinity;
    for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
      const Body& body = model.bodies[b];
      const bool floats = body.joint == JointKind::floating;
      for (int i = body.v + (floats ? 3 : 0); i < body.v + (floats ? 6 : 1); ++i) {
        const double ends = std::abs(state.v[i] + h * data.acceleration[i]);
        const double root = 1.0 / data.inertia.motionScale[i];  // √M_ii
        if (body.joint == JointKind::prismatic) {
          slides = std::max(slides, ends * root);
          continue;
        }
        if (ends > fast) return true;
        lightest = std::min(lightest, root);
      }
    }
    if (slides > fast * lightest) return true;
  }
  return false;
}

/// Not finite, or turning so fast that the square of the angle overflows.
bool tooFast(const Model& model, const VectorX& v) {
  if (!v.allFinite()) return true;
  return std::any_of(model.trees.begin(), model.trees.end(), [&](const Tree& tree) {
    const Body& root = model.bodies[static_cast<std::size_t>(tree.rootBody)];
    return root.joint == JointKind::floating &&
           v.segment<3>(root.v + 3).cwiseAbs().maxCoeff() > 1e150;
  });
}

/// Solves again where rows have to hold what swings too fast (T.128). False: not finite.
bool holdSwings(const Model& model, Data& data, const State& state) {
  data.stats.swings = data.constraints.holdSwings(
      {model, state, data.kinematics, data.contacts, data.weights, data.inertia.sparsity});
  if (data.stats.swings == 0) return true;
  data.acceleration = data.forward.a;
  forwardDynamics(model, &data.acceleration, data);
  return data.stats.count(data.forward.report);
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
    if (midpoint && mayTurnFar(model, data, state)) {
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
