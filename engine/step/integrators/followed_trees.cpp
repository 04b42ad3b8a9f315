// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/followed_trees.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/memory.hpp"
#include "engine/step/data.hpp"
#include "engine/step/forward.hpp"
#include "engine/step/integrators/implicit_forces.hpp"
#include "engine/step/integrators/tree_turn.hpp"

namespace softgauss {

const double FollowedTrees::kFollowedTurn = 5e-4;
constexpr double kRollingTurn = 0.05;  // of (T.93), about a third of a radian

namespace {

/// How many entries of q a tree has.
int coordinates(const Model& model, const Tree& tree) {
  return tree.dofEnd - tree.firstDof +
         (model.bodies[tree.rootBody].joint == JointKind::floating ? 1 : 0);
}

/// Rows push the tree. Half a step of what they do is no part of how v is understood: an impact
/// would get half as much again, and the other body would not. `push` = M a − net is rounding where
/// there is none, and much of it in a whipping chain; the rows themselves, `rows` = Jᵀf, are exact.
bool isPushed(const Tree& tree, const Data& data, const VectorX& push, const VectorX& rows) {
  constexpr double kRounding = 1e-9;
  for (int i = tree.firstDof; i < tree.dofEnd; ++i)
    if (rows[i] != 0.0 &&
        std::abs(push[i]) > kRounding * std::max(1.0, std::abs(data.forces.net[i])))
      return true;
  return false;
}

/// What rows do to such a tree carries on what its velocity makes, as in (T.16): a coin that leans
/// rolls on by it. (T.116) tells of a single body that moves on as it has come, not of links.
bool rolls(const Model& model, const Data& data, const FollowedTrees& f, int t) {
  const Tree& tree = model.trees[t];
  if (!(f.turn[t] < kRollingTurn)) return false;
  return !f.tied[t] ||
         (model.isFree(tree.rootBody) && stepAngle(model, data, tree.rootBody) <= kTiedTurn);
}

void setRowForces(const Data& data, VectorX& rows) {
  rows.setZero();
  data.constraints.addForce(rows);
}

/// f.coriolis = a_c of (T.118): what Coriolis forces do by themselves; f.kicked = b(q, 0).
bool setCoriolis(const Model& model, Data& data, FollowedTrees& f) {
  f.smooth.setZero();
  computeBiasAt(model, data.kinematics, data.inertia, f.smooth, data.forces.work, f.kicked);
  f.coriolis = f.kicked - data.forces.bias;
  return solveMass(data, implicitFollows(model, data) ? &data.forward.Md : nullptr, f.coriolis);
}

}  // namespace

FollowedTrees::FollowedTrees(const Model& model)
    : turn(model.trees.size(), 0.0),
      followed(model.trees.size(), 0),
      pushed(model.trees.size(), 0),
      push(VectorX::Zero(model.nv)),
      coriolis(VectorX::Zero(model.nv)),
      a(VectorX::Zero(model.nv)),
      net(VectorX::Zero(model.nv)),
      bias(VectorX::Zero(model.nv)),
      smooth(VectorX::Zero(model.nv)),
      kicked(VectorX::Zero(model.nv)),
      q(model.q0),
      tied(model.trees.size(), 0),
      motion(model) {
  atEnd.stiff.reserve(model.dofs.size());
  atEnd.inertia = VectorX::Zero(model.nv);
  const auto ties = [&](int body) {
    if (model.bodies[body].tree >= 0) tied[model.bodies[body].tree] = 1;
  };
  for (const Connection& c : model.connections) ties(c.bodyA), ties(c.bodyB);
  for (const Weld& w : model.welds) ties(w.bodyA), ties(w.bodyB);
}

bool FollowedTrees::needed(const Model& model, const Data& data, State& state, const VectorX& dv) {
  const double h = model.options.timestep;
  if (state.velocityOf.size() != model.trees.size())
    state.velocityOf.assign(model.trees.size(), VelocityOf::asGiven);
  // What a tie holds is turned by it, also a ball, which has no Coriolis forces.
  std::fill(turn.begin(), turn.end(), 0.0);
  const auto turns = [&](int body) {
    const int tree = model.bodies[body].tree;
    if (tree < 0) return;
    const double far = stepAngle(model, data, body) / kTiedTurn;
    turn[tree] = std::max(turn[tree], kFollowedTurn * far * far);
  };
  for (const Connection& c : model.connections) turns(c.bodyA), turns(c.bodyB);
  for (const Weld& w : model.welds) turns(w.bodyA), turns(w.bodyB);

  bool any = false, multiplied = false;
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const Tree& tree = model.trees[t];
    const Following& following = followingOf(tree, tied[t], data, state.v, data.forward.a, h);
    turn[t] = std::max(turn[t], h * turnRate(model, tree, data, state.v, data.forward.a, dv));
    if (following.byEnergy) {
      if (!multiplied) {  // all trees at once
        data.inertia.M.multiply(dv, smooth);
        data.inertia.M.multiply(state.v, kicked);
        data.inertia.hat().multiply(data.forward.a, push);
        multiplied = true;
      }
      const auto square = [&](const VectorX& x, const VectorX& Mx) {
        const int dofs = tree.dofEnd - tree.firstDof;
        return x.segment(tree.firstDof, dofs).dot(Mx.segment(tree.firstDof, dofs));
      };
      const double moving = square(state.v, kicked) + h * h * square(data.forward.a, push);
      turn[t] = std::max(turn[t], h * energyRate(square(dv, smooth), moving));
    }
    const VelocityOf instant = state.velocityOf[t];
    const bool was = wasFollowed(instant);
    const double stays = instant == VelocityOf::now ? following.staysFree : following.staysPushed;
    followed[t] = turn[t] > (was ? stays : 1.0) * kFollowedTurn;
    any = any || followed[t] || was;
  }
  return any;
}

bool FollowedTrees::anyPushed(const Model& model, const Data& data) {
  data.inertia.hat().multiply(data.forward.a, push);
  push -= data.forces.net;
  setRowForces(data, smooth);
  bool any = false;
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const Tree& tree = model.trees[t];
    pushed[t] = followed[t] && isPushed(tree, data, push, smooth);
    // A single body rolls on: (T.123) has its Coriolis forces, and the rows' answer.
    if (pushed[t] && !model.options.noSlip && isSingle(tree) && !tied[t] && turn[t] < kRollingTurn)
      followed[t] = pushed[t] = 0;
    // Where damping takes all speed in a step, as of massless links, (T.16) has it; where rows
    // push, (T.130) does.
    if (followed[t] && !pushed[t] && dampingStops(tree, data, model.options.timestep))
      followed[t] = 0;
    any = any || pushed[t];
  }
  return any;
}

bool FollowedTrees::kick(const Model& model, Data& data, const State& state) {
  const double h = model.options.timestep;
  ForwardSolution& s = data.forward;
  a = s.a;
  net = data.forces.net;
  bias = data.forces.bias;
  data.constraints.copyReferences(references);
  if (!setCoriolis(model, data, *this)) return false;
  // (T.120) of trees that roll, without Coriolis forces of the others.
  smooth.setZero();
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    if (!pushed[t]) continue;
    const int first = model.trees[t].firstDof, dofs = model.trees[t].dofEnd - first;
    if (rolls(model, data, *this, static_cast<int>(t))) {
      smooth.segment(first, dofs) = coriolis.segment(first, dofs);
      continue;
    }
    data.forces.net.segment(first, dofs) += (bias - kicked).segment(first, dofs);
    data.forces.bias.segment(first, dofs) = kicked.segment(first, dofs);
  }
  data.constraints.dampAhead(smooth, -0.5 * h);
  const auto turnsFar = [&](int body) {
    const int tree = model.bodies[body].tree;
    return tree >= 0 && pushed[tree] && !rolls(model, data, *this, tree);
  };
  data.constraints.leaveOutTurning(turnsFar);

  forwardDynamics(model, &a, data);
  ++data.stats.kicks;
  if (!data.stats.count(data.forward.report)) return false;
  // a′ by what a has changed, and of pushed trees without what mid-step changes.
  smooth = s.a - a;
  data.inertia.hat().multiply(smooth, kicked);
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    if (!pushed[t]) continue;
    const int first = model.trees[t].firstDof, dofs = model.trees[t].dofEnd - first;
    kicked.segment(first, dofs) -= data.midStep.change().segment(first, dofs);
  }
  const bool follows = implicitFollows(model, data);
  if (follows) setImplicitForces(model, state, data, smooth);
  if (!solveMass(data, follows ? &s.Md : nullptr, kicked)) return false;
  data.acceleration += kicked;
  return true;
}

void FollowedTrees::endKick(const Model& model, Data& data) {
  data.forces.net = net;
  data.forces.bias = bias;
  data.constraints.setReferences(references);
  forwardDynamics(model, &a, data);
}

void FollowedTrees::follow(const Model& model, Data& data, State& state, VectorX& held,
                           VectorX& vPlus) {
  const double h = model.options.timestep;
  bool kicks = false, ends = false;
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    kicks = kicks || (followed[t] && pushed[t]);
    ends = ends || (!followed[t] && wasFollowed(state.velocityOf[t]));
  }
  if (ends && !kicks && !setCoriolis(model, data, *this)) coriolis.setZero();
  // Q = M a + b + D v + K (q − q_s): applied and constraint forces of the step.
  data.inertia.hat().multiply(data.forward.a, held);
  push = held - data.forces.net;  // Jᵀf
  setRowForces(data, smooth);     // of trees that are not followed it stays so below
  held += data.forces.bias;
  atEnd.stiff.clear();
  atEnd.inertia.setZero();
  for (const Plan::Spring& spring : data.plan.springs) {
    held[spring.dof] += spring.stiffness * (state.q[spring.q] - spring.reference);
    atEnd.stiff.push_back(isStiffSpring(model, data, spring));
    if (!atEnd.stiff.back()) continue;
    atEnd.inertia[spring.dof] = h * h * spring.stiffness;
    if (data.plan.inSolve) held[spring.dof] += h * spring.stiffness * state.v[spring.dof];
  }
  if (data.plan.damped()) {
    held += data.plan.damping.cwiseProduct(state.v);
    atEnd.inertia += h * data.plan.damping;
  }

  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const Tree& tree = model.trees[t];
    const int first = tree.firstDof, dofs = tree.dofEnd - first;
    const auto part = [&](VectorX& x) { return x.segment(first, dofs); };
    const auto half = 0.5 * h * data.acceleration.segment(first, dofs);
    const bool free = followed[t] ? !pushed[t] : !isPushed(tree, data, push, smooth);
    VelocityOf& instant = state.velocityOf[t];
    if (!followed[t] && (!wasFollowed(instant) || (instant == VelocityOf::now && free))) {
      if (wasFollowed(instant)) part(vPlus) -= half;
      instant = VelocityOf::halfAStepAgo;
      continue;
    }
    if (!followed[t]) part(vPlus) -= 0.5 * h * part(coriolis);
    if (!followed[t] && instant != VelocityOf::now) {
      instant = VelocityOf::halfAStepAgo;
      continue;
    }
    if (!free) {  // Q is what is left for the step's course; the kick is of what is stiff
      part(held) -= part(push);
      if (data.plan.damped())
        part(push) -= data.plan.damping.segment(first, dofs).cwiseProduct(part(state.v));
      for (std::size_t i = 0; i < atEnd.stiff.size(); ++i) {
        const Plan::Spring& s = data.plan.springs[i];
        if (atEnd.stiff[i] && s.dof >= first && s.dof < tree.dofEnd)
          push[s.dof] -= s.stiffness * (state.q[s.q] + h * state.v[s.dof] - s.reference);
      }
    }
    const Body& root = model.bodies[tree.rootBody];
    Vector3 heldInWorld = Vector3::Zero();
    if (root.joint == JointKind::floating) {
      // Moments on the root that are not applied in its axes are of the world.
      const Vector3 own = data.forces.tau.segment<3>(root.v + 3);
      heldInWorld = data.kinematics.X_WB[tree.rootBody].R * (held.segment<3>(root.v + 3) - own);
      held.segment<3>(root.v + 3) = own;
    }
    motion.start(model, state, tree, free, atEnd);
    if (!followed[t]) {
      motion.atRest(model, data.plan, tree, held, heldInWorld, kicked);
      part(vPlus) -= 0.5 * h * part(kicked);
      instant = VelocityOf::halfAStepAgo;
      continue;
    }
    if (free && instant == VelocityOf::halfAStepAgo) motion.kick(tree, half);
    if (!free && instant == VelocityOf::halfAStepAgo) motion.kick(tree, 0.5 * h * part(coriolis));
    if (!free) {
      // Applied forces go with what rows answer to them; of a v that is of now, half of theirs.
      part(push) += part(held);
      if (instant == VelocityOf::now) {
        motion.atRest(model, data.plan, tree, held, heldInWorld, kicked);
        motion.kick(tree, -0.5 * h * part(kicked));
      }
      part(held) -= part(data.forces.tau);
    }
    if (!free || instant == VelocityOf::halfAStepAgoPushed) {
      motion.atRest(model, data.plan, tree, held, heldInWorld, smooth);
      motion.kick(tree, 0.5 * h * part(smooth));
    }
    if (!free) {
      motion.atRest(model, data.plan, tree, push, heldInWorld, kicked);
      motion.kick(tree, h * (part(kicked) - part(smooth)));
    }
    const double firstStep = h * std::min(1.0, 0.2 / std::sqrt(turn[t]));
    const TreeMotion::Outcome outcome =
        motion.run(model, data.plan, tree, held, heldInWorld, data.inertia.motionScale,
                   treeSpeed(tree, data, state.v, data.forward.a, h), h, firstStep);
    data.stats.substeps += motion.substeps();
    if (outcome != TreeMotion::Outcome::done) {
      ++data.stats.abandonedTrees;
      followed[t] = 0;
      instant = VelocityOf::halfAStepAgo;
      continue;
    }
    if (!free) {
      motion.atRest(model, data.plan, tree, held, heldInWorld, smooth);
      motion.kick(tree, -0.5 * h * part(smooth));
    }
    ++data.stats.followedTrees;
    instant = free ? VelocityOf::now : VelocityOf::halfAStepAgoPushed;
    part(vPlus) = motion.v().segment(first, dofs);
    const int count = coordinates(model, tree);
    q.segment(root.q, count) = motion.q().segment(root.q, count);
  }
}

void FollowedTrees::copyPositions(const Model& model, VectorX& qPlus) const {
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    if (!followed[t]) continue;
    const Tree& tree = model.trees[t];
    const int first = model.bodies[tree.rootBody].q, count = coordinates(model, tree);
    qPlus.segment(first, count) = q.segment(first, count);
  }
}

std::size_t FollowedTrees::bytes() const {
  return bytesOfAll(turn, followed, pushed, push, coriolis, a, net, bias, smooth, kicked, q, tied,
                    atEnd.stiff, atEnd.inertia, references) +
         motion.bytes();
}

}  // namespace softgauss
