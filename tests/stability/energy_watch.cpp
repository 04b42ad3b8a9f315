// SPDX-License-Identifier: Apache-2.0
#include "tests/stability/energy_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/step/integrators/implicit_forces.hpp"

namespace softgauss::test {
namespace {

/// Calls f(kind, first row, rows, softness) for every contact, range, connection, weld and dry
/// friction that has rows.
template <class F>
void forEachSoft(const Model& model, const State& state, const Data& data, F&& f) {
  const Constraints& rows = data.constraints;
  const Assembly in{
      model, state, data.kinematics, data.contacts, data.weights, data.inertia.sparsity, true};
  rows.visitContacts([&](const auto& c) {
    for (std::size_t i = 0; i < c.made().size(); ++i) {
      const int end = i + 1 < c.made().size() ? c.made()[i + 1].row : c.rowCount();
      f(c, c.made()[i].row, end - c.made()[i].row, touchAt(in, c.made()[i].contact)->softness);
    }
  });
  const auto softness = [&](const Impedance& p) { return softnessAt(p, 0.0, 1.0, model.options); };
  for (int i = 0; i < rows.jointLimit.rowCount(); ++i)
    for (const JointRange& range : model.ranges)
      if (model.bodies[range.body].v == rows.jointLimit.dof(i))
        f(rows.jointLimit, i, 1, softness(range.impedance));
  for (int i = 0; i < rows.dryFriction.rowCount(); ++i)
    f(rows.dryFriction, i, 1, softness(model.dofs[rows.dryFriction.dof(i)].frictionImpedance));
  for (int i = 0; i < rows.connection.rowCount(); i += 3)
    f(rows.connection, i, 3, softness(model.connections[i / 3].impedance));
  for (int i = 0; i < rows.weld.rowCount(); i += 3)  // its point, its rotation
    f(rows.weld, i, 3, softness(model.welds[i / 6].impedance));
}

/// References of the kinds that have rows.
std::vector<std::vector<double>> references(const Constraints& rows) {
  std::vector<std::vector<double>> all;
  rows.visit([&](const auto& kind) { all.push_back(kind.reference); });
  return all;
}

bool isPushed(const State& state) {
  return std::find(state.velocityOf.begin(), state.velocityOf.end(),
                   VelocityOf::halfAStepAgoPushed) != state.velocityOf.end();
}

/// √(2 K) by its largest part, as sub-steps have it: max_i (|v_i| + h |a_i|) √M_ii.
double speed(const Model& model, const State& state, const Data& data) {
  const VectorX v = state.v.cwiseAbs() + model.options.timestep * data.acceleration.cwiseAbs();
  return v.cwiseQuotient(data.inertia.motionScale).maxCoeff();
}

}  // namespace

EnergyWatch::EnergyWatch(const Model& model)
    : model_(model),
      leapfrog_(model.options.solvesOnce() && !model.options.stepDoubling &&
                model.options.integrator != Integrator::leapfrog),
      kinematics_(model),
      data_(model),
      contacts_(model) {}

double EnergyWatch::energy(const State& state) {
  const double h = model_.options.timestep;
  back_ = state;
  double pushed = 0.0;
  if (leapfrog_) {
    VectorX v = state.v;
    if (isPushed(state)) setRestForce(state);
    for (std::size_t t = 0; t < state.velocityOf.size(); ++t) {
      if (!wasFollowed(state.velocityOf[t])) continue;
      auto part =
          v.segment(model_.trees[t].firstDof, model_.trees[t].dofEnd - model_.trees[t].firstDof);
      if (state.velocityOf[t] == VelocityOf::halfAStepAgoPushed)
        pushed += 0.5 * h * part.dot(restForce_.segment(model_.trees[t].firstDof, part.size()));
      part.setZero();
    }
    integratePosition(model_, v, -0.5 * h, back_.q);
  }
  computeKinematics(model_, back_, kinematics_);
  return computeEnergy(model_, kinematics_, back_.q, back_.v).total() + pushed;
}

void EnergyWatch::setRestForce(const State& state) {
  State still = state;
  still.v.setZero();
  computeStages(model_, {}, still, data_, nullptr);
  restForce_ = data_.forces.net;
  for (const Plan::Spring& s : data_.plan.springs)  // no part of a half step: taken at its end
    if (isStiffSpring(model_, data_, s))
      restForce_[s.dof] += s.stiffness * (state.q[s.q] - s.reference);
}

double EnergyWatch::turning(const State& state) {
  VectorX v = state.v;
  for (const Tree& tree : model_.trees)
    if (model_.isFree(tree.rootBody)) v.segment<3>(tree.firstDof).setZero();
  return computeEnergy(model_, kinematics_, state.q, v).kinetic;
}

double EnergyWatch::offset(const State& state, const Input& input) {
  if (!leapfrog_) return 0.0;
  const double h = model_.options.timestep;
  computeStages(model_, input, state, data_, nullptr);
  VectorX force = data_.forces.net;
  for (std::size_t t = 0; t < model_.trees.size(); ++t) {
    const Tree& tree = model_.trees[t];
    if (model_.isFree(tree.rootBody)) force.segment<3>(tree.firstDof).setZero();
    if (!state.velocityOf.empty() && state.velocityOf[t] == VelocityOf::now)
      force.segment(tree.firstDof, tree.dofEnd - tree.firstDof).setZero();
  }
  VectorX a = force;
  data_.forward.massFactored = false;
  solveMass(data_, nullptr, a);
  return 2.0 * FollowedTrees::kFollowedTurn * turning(state) + 0.125 * h * h * force.dot(a);
}

double EnergyWatch::stored(const State& state, const Input& input) {
  Input soft = input;
  soft.softFriction = true;  // (T.97) scales k d by the speed
  computeStages(model_, soft, state, data_, &contacts_);
  const auto all = [](int) { return true; };
  data_.constraints.leaveOutTurning(all);
  const std::vector<std::vector<double>> moving = references(data_.constraints);
  State still = state;
  still.v.setZero();
  computeStages(model_, soft, still, data_, &contacts_);
  const std::vector<std::vector<double>> resting = references(data_.constraints);
  forwardDynamics(model_, nullptr, data_);
  std::vector<const void*> kinds;
  data_.constraints.visit([&](const auto& kind) { kinds.push_back(&kind); });

  double sum = 0.0;
  const auto add = [&](const auto& kind, int row, int rows, const Softness& s) {
    const auto k = std::find(kinds.begin(), kinds.end(), &kind) - kinds.begin();
    for (int i = row; i < row + rows; ++i) {
      const double rate = std::abs(moving[k][i] - resting[k][i]) / s.damping;
      const double depth = s.stiffness > 0.0 ? std::abs(resting[k][i]) / s.stiffness : 0.0;
      sum += std::abs(kind.f[i]) * (depth + rate * (1.0 / s.damping + model_.options.timestep));
    }
  };
  forEachSoft(model_, still, data_, add);
  return sum;
}

double EnergyWatch::begun(const Data& data) {
  before_.swap(now_);
  now_.clear();
  double sum = 0.0;
  data.constraints.visitContacts([&](const auto& c) {
    for (std::size_t i = 0; i < c.made().size(); ++i) {
      const ContactRows& made = c.made()[i];
      now_.push_back(c.name(made.row));
      if (std::find(before_.begin(), before_.end(), now_.back()) == before_.end())
        sum += c.frameForce(static_cast<int>(i))[0] *
               std::abs(data.contacts.contacts[made.contact].distance);
    }
  });
  return sum;
}

void EnergyWatch::begin(const State& state, const Input& input) {
  start_ = state;
  least_ = energy(state);
  limit_ = least_ + stored(state, input) + offset(state, input);
}

double EnergyWatch::check(const State& state, const Input& input, const Data& data, double work,
                          double perStep) {
  constexpr int kEvery = 5;
  if (steps_ == 0 && state.velocityOf != start_.velocityOf) {
    State start = start_;
    start.velocityOf = state.velocityOf;
    begin(start, input);
  }
  const double E = energy(state), now = E - work;
  limit_ += perStep + begun(data);
  if (leapfrog_) {
    const double K = turning(back_);
    limit_ += std::pow(2.0 * FollowedTrees::kFollowedTurn, 1.5) / 12.0 * K +
              TreeMotion::kTolerance * data.stats.substeps * speed(model_, state, data) *
                  std::sqrt(2.0 * K);
  }
  const double rounding =
      1e3 * std::numeric_limits<double>::epsilon() * (std::abs(E) + std::abs(work));
  double over = now - limit_ - rounding;
  if (over > 0.0) over -= offset(state, input);
  least_ = std::min(least_, now);
  if (now - least_ > rose) rose = now - least_, allowedThere = rose - over;
  if (++steps_ % kEvery == 0)
    limit_ = std::min(limit_, now + stored(state, input) + offset(state, input));
  return over;
}

}  // namespace softgauss::test
