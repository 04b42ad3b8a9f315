// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/semi_implicit_euler.hpp"

#include <algorithm>

#include "engine/step/forward.hpp"
#include "engine/step/integrators/implicit_forces.hpp"

namespace softgauss {
namespace {

/// A joint slides as fast as one of its tree turns at the speed `fast` [rad/s]: √M_ii |v_i| of it
/// is larger than of the dof that turns most easily.
template <class Ends>
bool slidesFar(const Model& model, const Tree& tree, const Data& data, const Ends& ends,
               double fast) {
  double fastest = 0.0, lightest = kInfinity;
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[b];
    const auto root = [&](int i) { return 1.0 / data.inertia.forceScale[i]; };  // √M_ii
    if (body.joint == JointKind::prismatic)
      fastest = std::max(fastest, std::abs(ends(body.v)) * root(body.v));
    else if (body.joint == JointKind::revolute)
      lightest = std::min(lightest, root(body.v));
    else
      for (int i = body.v + 3; i < body.v + 6; ++i) lightest = std::min(lightest, root(i));
  }
  return fastest > fast * lightest;
}

/// A body turns by more than 0.005 rad in the step, or a joint does by the velocity that it ends
/// with, or slides as far, or a tree was followed in the last one. Below that (T.93) need not be
/// worked out.
bool mayTurnFar(const Model& model, const Data& data, const State& state) {
  for (const VelocityOf instant : state.velocityOf)
    if (wasFollowed(instant)) return true;
  const double h = model.options.timestep, fast = 0.005 / h;
  for (const Motion& V : data.kinematics.V)
    if (V.angular.squaredNorm() > fast * fast) return true;
  const auto ends = [&](int i) { return state.v[i] + h * data.acceleration[i]; };
  for (const Tree& tree : model.trees)
    if (slidesFar(model, tree, data, ends, fast)) return true;
  for (const Body& body : model.bodies) {
    if (body.joint == JointKind::revolute && std::abs(ends(body.v)) > fast) return true;
    if (body.joint == JointKind::floating)
      for (int i = body.v + 3; i < body.v + 6; ++i)
        if (std::abs(ends(i)) > fast) return true;
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

}  // namespace

bool semiImplicitEuler(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  ForwardSolution& s = data.forward;
  const Plan& plan = data.plan;
  const bool stiff = anyStiffSpring(model, data);
  const bool midpoint = plan.midpoint, implicit = plan.damped() || stiff;
  data.acceleration = s.a;
  bool follow = false;
  if (implicit || midpoint) {
    // Right side M a, less what the Coriolis forces gain by mid-step.
    VectorX& net = data.acceleration;
    if (data.constraints.active().empty())
      net = s.Ma;
    else
      data.inertia.M.multiply(s.a, net);
    if (implicit) setImplicitForces(model, state, data, net);
    bool factored = false;
    const auto solve = [&](VectorX& x) {  // x ← (M + h D)⁻¹ x
      if (factored && !plan.diagonal)
        s.massFactor.solve(x);
      else
        factored = solveMass(data, implicit ? &s.Md : nullptr, x);
      return factored;
    };
    if (midpoint) {
      s.start = s.a;
      if (implicit) {  // a is that of damping and springs that the step does not follow
        s.start = net;
        if (!solve(s.start)) return false;
      }
      s.start = state.v + 0.5 * h * s.start;
      ++data.forces.calls.coriolis;
      computeBiasAt(model, data.kinematics, data.inertia, s.start, data.forces.work, s.direction);
      s.direction -= data.forces.bias;
      net -= s.direction;
    }
    if (!solve(net)) return false;
    if (midpoint && mayTurnFar(model, data, state)) {
      // What Δb does to the velocity, damped like the rest.
      if (!implicit)
        s.direction = s.a - net;
      else
        solve(s.direction);
      follow = data.followed.needed(model, data, state, s.direction);
    }
  }
  const bool kicked = follow && data.followed.anyPushed(model, data);
  if (kicked && !data.followed.kick(model, data, state, s.direction)) return false;
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
  if (kicked) data.followed.endKick(model, data);
  state.time += h;
  return true;
}

}  // namespace softgauss
