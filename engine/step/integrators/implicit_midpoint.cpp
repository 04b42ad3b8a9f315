// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/implicit_midpoint.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/dynamics/energy.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/integrators/stages.hpp"
#include "softgauss/engine/step/integrators/velocity_derivative.hpp"
#include "softgauss/engine/step/step.hpp"

namespace softgauss {
namespace {

enum class Outcome { closed, open, jump, notFinite };

/// What of v⁺ may be left open, relative to the speeds at hand.
constexpr double kClosed = 1e-12;
constexpr int kMostSweeps = 25;

/// One part of a step, from s.from to s.end.
class Part {
 public:
  Part(const Model& model, ContactSource* contacts, double length, IntegratorStages& s,
       StepStats& stats)
      : model_(model), contacts_(contacts), h_(length), s_(s), stats_(stats) {}

  /// `guess`: of the acceleration.
  Outcome run(const VectorX& guess, const Energy& before) {
    VectorX& vPlus = s_.end.v;
    vPlus = s_.from.v + h_ * guess;
    s_.acceleration[0] = guess;
    double gamma = 0.0, best = kInfinity;
    int rowsBefore = -1;
    bool sameRows = true;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      // Sweeps that run away from a middle that is finite have not closed.
      if (!evaluateMiddle()) return sweep == 0 ? Outcome::notFinite : Outcome::open;
      const int rows = s_.data.constraints.rowCount();
      sameRows = rowsBefore < 0 || (rows == 0 && rowsBefore == 0);
      rowsBefore = rows;
      // s.rate is v⁺ of the equation, phi what the sweep is off by.
      VectorX& target = s_.rate[0];
      target = s_.from.v + h_ * (s_.data.forward.a + gamma * s_.state.v);
      const double more = missingEnergyRate(before);
      gamma += more;
      target += (h_ * more) * s_.state.v;
      s_.phi = target - vPlus;
      const double scale = std::max(kClosed, model_.options.tolerance) * speed();
      const double off = std::max(weighted(s_.phi), std::abs(h_ * more) * weighted(s_.state.v));
      if (!std::isfinite(off)) return sweep == 0 ? Outcome::notFinite : Outcome::open;
      if (off <= scale) {
        vPlus = target;
        moveToEnd();
        return s_.end.q.allFinite() ? Outcome::closed : Outcome::notFinite;
      }
      if (sweep >= 6 && off > 0.5 * best && off > 1e3 * scale) break;
      if (sweep >= 6 && off >= (rows > 0 ? 0.5 : 1.0) * best) {
        // Rounding, or a row at its kink, ends the progress of a part that is as good as closed.
        vPlus = target;
        moveToEnd();
        return Outcome::closed;
      }
      best = std::min(best, off);
      newtonSweep();
      vPlus += s_.phi;
    }
    moveToEnd();
    return sameRows ? Outcome::open : Outcome::jump;
  }

 private:
  /// max |x_i| √M_ii, M of the middle.
  double weighted(const VectorX& x) const {
    return x.cwiseQuotient(s_.data.inertia.forceScale).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }
  double speed() const {
    return weighted(s_.from.v) + weighted(s_.end.v) + h_ * weighted(s_.data.forward.a);
  }

  /// Stages and forward dynamics at (q̄, v̄).
  bool evaluateMiddle() {
    s_.state.v = 0.5 * (s_.from.v + s_.end.v);
    s_.state.q = s_.from.q;
    integratePosition(model_, s_.state.v, 0.5 * h_, s_.state.q);
    if (!s_.state.q.allFinite() || !s_.state.v.allFinite()) return false;
    if (isRefused(computeStages(model_, s_.input, s_.state, s_.data, contacts_))) return false;
    forwardDynamics(model_, &s_.acceleration[0], s_.data);
    if (!countEvaluation(s_.data, stats_)) return false;
    s_.acceleration[0] = s_.data.forward.a;
    return true;
  }

  void moveToEnd() {
    s_.end.q = s_.from.q;
    integratePosition(model_, 0.5 * (s_.from.v + s_.end.v), h_, s_.end.q);
  }

  /// What γ has to change by so that a step to v⁺, in s.rate, has the energy of the work done.
  double missingEnergyRate(const Energy& before) {
    const VectorX& v = s_.state.v;  // v̄
    s_.end.q = s_.from.q;
    integratePosition(model_, v, h_, s_.end.q);
    s_.end.v.swap(s_.rate[0]);  // computeKinematics() reads a state
    computeKinematics(model_, s_.end, s_.kinematics);
    const Energy after = computeEnergy(model_, s_.kinematics, s_.end.q, s_.end.v);
    s_.end.v.swap(s_.rate[0]);
    // Q = M a + b + K (q̄ − q_s)
    s_.data.inertia.M.multiply(v, s_.phi);
    const double twiceKinetic = v.dot(s_.phi);
    double power = s_.phi.dot(s_.data.forward.a) + v.dot(s_.data.forces.bias);
    for (const Plan::Spring& spring : s_.data.plan.springs)
      power += v[spring.dof] * spring.stiffness * (s_.state.q[spring.q] - spring.reference);
    const double scale = before.kinetic + after.kinetic + std::abs(before.potential) +
                         std::abs(after.potential) + h_ * std::abs(power);
    const double defect =
        (after.kinetic - before.kinetic) + (after.potential - before.potential) - h_ * power;
    // Below this it is rounding, or there is no motion to correct.
    if (!(twiceKinetic > 1e-10 * scale) || std::abs(defect) <= 1e-15 * scale) return 0.0;
    return std::clamp(-defect / (h_ * twiceKinetic), -0.1 / h_, 0.1 / h_);
  }

  /// phi ← (M + ½h(D + C) + ¼h²K)⁻¹ M phi.
  void newtonSweep() {
    const Plan& plan = s_.data.plan;
    const bool diagonal = plan.hasDamping() || plan.hasSprings();
    if (!diagonal && !plan.coriolis) return;
    VectorX& added = s_.data.forward.diagonal;
    if (plan.hasDamping())
      added = 0.5 * h_ * plan.damping;
    else
      added.setZero(model_.nv);
    for (const Plan::Spring& spring : plan.springs)
      added[spring.dof] += 0.25 * h_ * h_ * spring.stiffness;
    VectorX& x = s_.rate[0];
    s_.data.inertia.M.multiply(s_.phi, x);
    if (!s_.data.derivative->factorize(model_, s_.data, plan.coriolis ? 0.5 * h_ : 0.0, &added))
      return;
    s_.data.derivative->solve(model_, x);
    s_.phi.swap(x);
  }

  const Model& model_;
  ContactSource* contacts_;
  double h_;
  IntegratorStages& s_;
  StepStats& stats_;
};

}  // namespace

SolveStatus implicitMidpoint(const Model& model, const Input& input, ContactSource* contacts,
                             Data& data, State& state) noexcept {
  constexpr double kShortest = 1.0 / 64.0;  // of the step
  const double h = model.options.timestep;
  IntegratorStages& s = *data.stages;
  StepStats& stats = data.stats;
  s.begin(input, state);
  ++stats.evaluations;

  Energy energy = computeEnergy(model, data.kinematics, state.q, state.v);
  VectorX& guess = s.acceleration[0];
  guess = data.forward.a;
  double done = 0.0, length = h;
  while (done < h) {
    const bool closes = done + length >= h * (1.0 - 1e-12);
    if (closes) length = h - done;
    const double deepest = stats.maxPenetration;
    const Outcome outcome = Part(model, contacts, length, s, stats).run(guess, energy);
    const bool shortest = isShortest(length, kShortest * h);
    const bool taken = outcome == Outcome::closed || (outcome == Outcome::jump && shortest);
    if (!taken) {
      if (shortest && outcome == Outcome::notFinite) return SolveStatus::notFinite;
      if (shortest) return SolveStatus::integratorDiverged;
      ++stats.rejections;
      stats.maxPenetration = deepest;  // what was tried has not happened
      length = std::max(0.5 * length, kShortest * h);
      guess = data.forward.a;
      continue;
    }
    stats.minimumStepsAccepted += outcome == Outcome::jump;
    ++stats.substeps;
    done = closes ? h : done + length;
    length *= 2.0;
    s.from.q = s.end.q;
    s.from.v = s.end.v;
    if (done == h) break;
    computeKinematics(model, s.from, s.kinematics);
    energy = computeEnergy(model, s.kinematics, s.from.q, s.from.v);
  }
  data.acceleration = (s.from.v - state.v) / h;
  state.q = s.from.q;
  state.v = s.from.v;
  state.time += h;
  return SolveStatus::converged;
}

}  // namespace softgauss
