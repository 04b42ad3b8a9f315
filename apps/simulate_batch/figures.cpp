// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/figures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softgauss/engine/dynamics/energy.hpp"

namespace softgauss::app {

RunFigures::RunFigures(const Sweep& sweep, Simulation& sim, PlanControl* plan)
    : sweep_(sweep), plan_(plan), start_(sim.model()), at_(sim.state()) {
  computeStages(sim.model(), {}, sim.state(), sim.data(), &sim.contacts());
  goals_.emplace(sim.controller().goals, context(sim));
  standing_.emplace(sim.model(), sim.data().kinematics);
  for (const Measure& measure : sweep.measures)
    frames_.push_back(sim.model().findFrame(measure.link));
  values_.assign(columns().size(), kNaN);
}

gdd::GoalContext RunFigures::context(const Simulation& sim) const {
  return {sim.model(), at_, sim.data()};
}

void RunFigures::before(const Simulation& sim) {
  at_.q = sim.state().q;
  at_.v = sim.state().v;
  at_.time = sim.state().time;
  computeKinematics(sim.model(), sim.state(), start_);
}

void RunFigures::after(Simulation& sim) {
  Data& data = sim.data();
  const Model& model = sim.model();
  penetration_ = std::max(penetration_, data.stats.maxPenetration);
  for (int i = 0; i < model.nv; ++i) {
    const double bound = std::max(-model.dofs[i].effortLower, model.dofs[i].effortUpper);
    if (model.dofs[i].actuated && std::isfinite(bound) && bound > 0.0)
      controlRatio_ = std::max(controlRatio_, std::abs(data.forces.tau[i]) / bound);
  }
  contactForces(data, touching_);
  std::swap(data.kinematics, start_);  // goals are seen at the step's start
  goals_->observe(context(sim), touching_);
  if (standing_->hasRobots())
    standing_->observe(data.kinematics, touching_, at_.time, sim.time() - at_.time);
  std::swap(data.kinematics, start_);
}

void RunFigures::finish(Simulation& sim) {
  before(sim);
  computeStages(sim.model(), {}, sim.state(), sim.data(), &sim.contacts());
  penetration_ = std::max(penetration_, sim.data().stats.maxPenetration);
  goals_->observe(context(sim), touching_);
  values_.clear();
  bool reached = true;
  for (const GoalRecord::Track& track : goals_->tracks()) {
    const io::GoalOutcome& o = track.outcome;
    values_.push_back(o.began ? o.finalError : kNaN);
    values_.push_back(o.began ? o.bestError : kNaN);
    reached = reached && (o.isMet() || o.yields);
  }
  if (!goals_->tracks().empty()) values_.push_back(reached ? 1.0 : 0.0);
  if (standing_->hasRobots()) {
    const std::vector<StandingOutcome> outcomes = standing_->outcomes(start_, at_.time);
    values_.push_back(std::any_of(outcomes.begin(), outcomes.end(),
                                  [](const StandingOutcome& o) { return o.fell; }));
  }
  if (plan_) {
    const MotionCost cost = plan_->cost(sim.state());
    values_.insert(values_.end(), {plan_->planned(), cost.total(), cost.final,
                                   plan_->outcome(sim.state()) == "carried out" ? 1.0 : 0.0});
  }
  const Energy energy = computeEnergy(sim.model(), start_, at_.q, at_.v);
  values_.insert(values_.end(), {energy.total(), penetration_, controlRatio_});
  for (std::size_t m = 0; m < frames_.size(); ++m) {
    const Frame& frame = sim.model().frames[static_cast<std::size_t>(frames_[m])];
    values_.push_back((start_.X_WB[frame.body] * frame.X_BF).p[sweep_.measures[m].axis]);
  }
}

std::vector<std::string> RunFigures::columns() const {
  std::vector<std::string> names;
  for (const std::string& goal : goals_->columns()) {
    names.push_back("final_error:" + goal);
    names.push_back("best_error:" + goal);
  }
  if (!goals_->tracks().empty()) names.emplace_back("reached");
  if (standing_->hasRobots()) names.emplace_back("fell");
  if (sweep_.planned())
    for (const char* name : {"planned_cost", "cost", "final_cost", "carried_out"})
      names.emplace_back(name);
  for (const char* name : {"energy_J", "max_penetration_m", "max_control_ratio"})
    names.emplace_back(name);
  for (const Measure& measure : sweep_.measures) names.push_back(measure.name + "_m");
  return names;
}

}  // namespace softgauss::app
