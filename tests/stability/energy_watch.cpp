// SPDX-License-Identifier: Apache-2.0
#include "tests/stability/energy_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "softgauss/engine/constraints/equality_softness.hpp"
#include "softgauss/engine/constraints/law/row_law.hpp"
#include "softgauss/engine/step/integrators/tree_motion.hpp"

namespace softgauss::test {
namespace {

/// Calls f(kind, first row, rows, softness) for every contact, range, connection, weld and dry
/// friction that has rows.
template <class F>
void forEachSoft(const Model& model, const State& state, const Data& data, F&& f) {
  const Constraints& rows = data.constraints;
  const Assembly in{model,         state,        data.kinematics,
                    data.contacts, data.weights, data.inertia.sparsity};
  PairSurface pair;
  rows.visitContacts([&](const auto& c) {
    for (std::size_t i = 0; i < c.contactsWithRows().size(); ++i) {
      const int end =
          i + 1 < c.contactsWithRows().size() ? c.contactsWithRows()[i + 1].row : c.rowCount();
      f(c, c.contactsWithRows()[i].row, end - c.contactsWithRows()[i].row,
        touchAt(in, c.contactsWithRows()[i].contact, pair)->softness);
    }
  });
  const auto softness = [&](const Impedance& p) {
    return model.options.hasRowLaw() ? rowLaw(p, 0.0, 1.0, model.options)
                                     : softnessAt(p, 0.0, 1.0, model.options.rowTimestep());
  };
  const auto tie = [&](const Impedance& p) { return equalitySoftness(p, 0.0, 1.0, model.options); };
  for (int i = 0; i < rows.jointLimit.rowCount(); ++i)
    for (const JointRange& range : model.ranges)
      if (model.bodies[range.body].v == rows.jointLimit.dof(i))
        f(rows.jointLimit, i, 1, softness(range.impedance));
  for (int i = 0; i < rows.dryFriction.rowCount(); ++i)
    f(rows.dryFriction, i, 1, softness(model.dofs[rows.dryFriction.dof(i)].frictionImpedance));
  for (int i = 0; i < rows.connection.rowCount(); i += 3)
    f(rows.connection, i, 3, tie(model.connections[i / 3].impedance));
  for (int i = 0; i < rows.weld.rowCount(); i += 3)  // its point, its rotation
    f(rows.weld, i, 3, tie(model.welds[i / 6].impedance));
}

/// (6.4) of what is not followed: of (6.3), 4 √(2 turn) ≤ substepAngle in a part of a step.
double leastTurn(const Options& options) {
  return 0.5 * std::pow(0.25 * options.substepAngle, 2.0);
}

/// What a sub-step may be off by for each second of the step, relative to the speed (6.7) [1/s].
constexpr double kFollowed = 1e-5;

/// √(2 K) by its largest part: max_i (|v_i| + h |a_i|) √M_ii.
double speed(const Model& model, const State& state, const Data& data) {
  const VectorX v = state.v.cwiseAbs() + model.options.timestep * data.acceleration.cwiseAbs();
  return v.cwiseQuotient(data.inertia.motionScale).maxCoeff();
}

}  // namespace

EnergyWatch::EnergyWatch(const Model& model)
    : model_(model),
      leapfrog_(model.options.integrator == Integrator::leapfrog && !model.options.stepDoubling),
      kinematics_(model),
      data_(model),
      contacts_(model),
      back_(model),
      ahead_(VectorX::Zero(model.nv)),
      behind_(ahead_) {}

double EnergyWatch::energy(const State& state) {
  // The velocity of semi-implicit Euler is that of half a step earlier.
  const bool lags = model_.options.integrator == Integrator::semiImplicitEuler;
  back_ = state;
  if (lags && !model_.options.stepDoubling)
    integratePosition(model_, state.v, -0.5 * model_.options.timestep, back_.q);
  computeKinematics(model_, back_, kinematics_);
  return computeEnergy(model_, kinematics_, back_.q, back_.v).total();
}

void EnergyWatch::forceAt(const VectorX& q, const Input& input, VectorX& force) {
  back_.q = q;
  back_.v.setZero();
  back_.forgetLastStep();
  computeStages(model_, input, back_, data_, nullptr);
  force = data_.forces.net;
  for (const Tree& tree : model_.trees)
    if (model_.isFree(tree.rootBody)) force.segment<3>(tree.firstDof).setZero();
}

double EnergyWatch::bend(const State& state, const Input& input) {
  constexpr double kAngle = 1e-4;
  const double speed = state.v.cwiseAbs().maxCoeff();
  if (!(speed > 0.0)) return 0.0;
  const double time = kAngle / speed;
  VectorX q = state.q;
  integratePosition(model_, state.v, time, q);
  forceAt(q, input, ahead_);
  q = state.q;
  integratePosition(model_, state.v, -time, q);
  forceAt(q, input, behind_);
  return std::abs(state.v.dot(ahead_ - behind_)) / (2.0 * time);
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
  const double bends = bend(state, input);
  computeStages(model_, input, state, data_, nullptr);
  VectorX force = data_.forces.net;
  for (const Tree& tree : model_.trees)
    if (model_.isFree(tree.rootBody)) force.segment<3>(tree.firstDof).setZero();
  VectorX a = force;
  solveMass(model_, data_, nullptr, a);
  back_ = state;
  computeKinematics(model_, back_, kinematics_);
  return 2.0 * leastTurn(model_.options) * turning(state) + 0.125 * h * h * force.dot(a) +
         h * h * bends / 24.0;
}

double EnergyWatch::stored(const State& state, const Input& input) {
  Input soft = input;
  soft.controlled = allTrees(model_, kControlledSoft);  // (5.7) scales k d by the speed
  State still = state;
  still.v.setZero();
  still.forgetLastStep();
  computeStages(model_, soft, still, data_, &contacts_);
  forwardDynamics(model_, nullptr, data_);
  std::vector<const void*> kinds;
  std::vector<std::vector<double>> rates;  // J v
  data_.constraints.visit([&](const auto& kind) {
    kinds.push_back(&kind);
    rates.emplace_back(kind.x.size());
    kind.multiply(state.v, rates.back());
  });

  double sum = 0.0;
  const auto add = [&](const auto& kind, int row, int rows, const Softness& s) {
    const auto k = std::find(kinds.begin(), kinds.end(), &kind) - kinds.begin();
    for (int i = row; i < row + rows; ++i) {
      const double rate = std::abs(rates[k][i]);
      const double depth = s.stiffness > 0.0 ? std::abs(kind.reference[i]) / s.stiffness : 0.0;
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
    for (std::size_t i = 0; i < c.contactsWithRows().size(); ++i) {
      const ContactRows& made = c.contactsWithRows()[i];
      now_.push_back(c.name(made.row));
      if (std::find(before_.begin(), before_.end(), now_.back()) == before_.end())
        sum += c.frameForce(static_cast<int>(i))[0] *
               std::abs(data.contacts.contacts[made.contact].distance);
    }
  });
  return sum;
}

void EnergyWatch::begin(const State& state, const Input& input) {
  least_ = energy(state);
  limit_ = least_ + stored(state, input) + offset(state, input);
}

double EnergyWatch::check(const State& state, const Input& input, const Data& data, double work,
                          double perStep) {
  constexpr int kEvery = 5;
  const double E = energy(state), now = E - work;
  limit_ += perStep + begun(data);
  if (leapfrog_) {
    const double K = turning(back_);
    limit_ += std::pow(2.0 * leastTurn(model_.options), 1.5) / 12.0 * K * data.stats.parts +
              kFollowed * model_.options.timestep * data.stats.substeps *
                  speed(model_, state, data) * std::sqrt(2.0 * K);
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
