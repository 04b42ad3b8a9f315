// SPDX-License-Identifier: Apache-2.0
#include "apps/plan_benchmark/acting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/shared/interrupt.hpp"
#include "softgauss/engine/dynamics/inertia.hpp"
#include "softgauss/io/simulation/plan_control.hpp"
#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::app {
namespace {

constexpr double kRate = 20.0;  // ω of springs [rad/s]
/// As they are run: once the plan is the controller's goal, it stays so.
constexpr ActingLaw kLaws[] = {ActingLaw::springs, ActingLaw::feedback, ActingLaw::goalDirected};

/// What joints move at a state: diag M (nv).
VectorX massOfJoints(const Model& model, const State& state) {
  Kinematics kinematics(model);
  computeKinematics(model, state, kinematics);
  MassMatrix mass(model);
  computeMassMatrix(model, kinematics, mass);
  VectorX diagonal(model.nv);
  for (int i = 0; i < model.nv; ++i) diagonal[i] = mass.M.row(i)[i];
  return diagonal;
}

/// A law of control about a plan that has begun.
class AboutPlan {
 public:
  AboutPlan(const PlanControl& control, const Simulation& sim, ActingLaw law)
      : plan_(control.planner().feasible()),
        model_(sim.model()),
        step_(control.task().steps.step),
        law_(law),
        mass_(massOfJoints(model_, sim.state())),
        dq_(VectorX::Zero(model_.nv)),
        dx_(VectorX::Zero(2 * model_.nv)) {}

  /// The control (nv) at a time since the plan's begin, within its bounds.
  const VectorX& at(double time, const State& state) {
    const auto& knots = plan_.trajectory().knots;
    const auto t = std::min(static_cast<std::size_t>(time / step_ + 1e-9), knots.size() - 2);
    const planning::Knot& knot = knots[t];
    const double since = time - step_ * static_cast<double>(t);
    VectorX q = knot.q;
    dq_ = since * knot.v + 0.5 * since * since * knot.a;
    integratePosition(model_, dq_, 1.0, q);
    positionDifference(model_, q, state.q, dq_);
    dx_ << dq_, state.v - knot.v - since * knot.a;
    u_ = knot.tau;
    int row = 0;
    for (int i = 0; i < model_.nv; ++i) {
      const Dof& dof = model_.dofs[static_cast<std::size_t>(i)];
      if (!dof.actuated) continue;
      u_[i] += law_ == ActingLaw::feedback
                   ? plan_.feedback()[t].K.row(row++).dot(dx_)
                   : -mass_[i] * (kRate * kRate * dq_[i] + 2.0 * kRate * dx_[model_.nv + i]);
      u_[i] = std::clamp(u_[i], dof.effortLower, dof.effortUpper);
    }
    return u_;
  }

 private:
  const planning::FeasiblePhase& plan_;
  const Model& model_;
  double step_;
  ActingLaw law_;
  VectorX mass_, dq_, dx_, u_;
};

/// The plan from where it starts, in a simulation that starts disturbed.
MotionCost act(Simulation& sim, PlanControl& control, ActingLaw law) {
  const double h = sim.model().options.timestep;
  control.begin(sim.state());
  AboutPlan about(control, sim, law);
  bool refused = false;
  while (!control.hasEnded(sim.time()) && !refused && !interrupted()) {
    control.update(sim.state());
    if (law != ActingLaw::goalDirected) sim.input().tau = about.at(sim.time(), sim.state());
    refused = isRefused(sim.step());
    control.addStep(law == ActingLaw::goalDirected ? sim.controller().control : sim.input().tau, h);
  }
  control.update(sim.state());
  MotionCost cost = control.cost(sim.state());
  if (refused) cost.final = kInfinity;
  return cost;
}

ActingRuns runLaw(Simulation& sim, PlanControl& control, ActingLaw law,
                  const ActingChoice& choice) {
  ActingRuns all;
  all.law = law;
  if (law == ActingLaw::goalDirected) control.attach(sim.controller());
  for (int i = 0; i <= choice.runs && !interrupted(); ++i) {
    planning::NormalNumbers random(choice.seed + static_cast<unsigned>(i));
    sim.reset();
    sim.input().tau.setZero(sim.model().nv);
    if (i > 0)
      for (double& v : sim.state().v) v += choice.disturbed * random.next();
    const MotionCost cost = act(sim, control, law);
    if (i == 0) {
      all.undisturbed = cost.total();
      continue;
    }
    all.costs.push_back(cost.total());
    all.carriedOut += !control.isLost(cost.final);
  }
  std::sort(all.costs.begin(), all.costs.end());
  return all;
}

}  // namespace

std::string actingLawName(ActingLaw law) {
  switch (law) {
    case ActingLaw::goalDirected:
      return "GDD (22)";
    case ActingLaw::feedback:
      return "u + K dx";
    case ActingLaw::springs:
      return "u + PD";
  }
  return "";
}

std::vector<ActingRuns> runActing(const std::filesystem::path& file, const ActingChoice& choice) {
  SimulationOptions options;
  options.timestep = choice.timestep;
  Simulation sim = Simulation::load(file, options);
  PlanControl control(sim.scene(), io::readPlanTask(file, sim.model(), sim.scene().initial), false);
  sim.controller().goals.clear();
  const double planned = control.solve().cost;
  std::vector<ActingRuns> all;
  for (const ActingLaw law : kLaws) {
    if (interrupted()) break;
    ActingRuns& runs = all.emplace_back(runLaw(sim, control, law, choice));
    runs.task = file.stem().string();
    runs.planned = planned;
  }
  std::reverse(all.begin(), all.end());
  return all;
}

std::string actingTable(const std::vector<ActingRuns>& all) {
  std::string out = fmt::format("{:<16}{:<10}{:>10}{:>14}{:>14}{:>10}{:>10}\n", "task", "law",
                                "planned", "undisturbed", "carried out", "median", "worst");
  for (const ActingRuns& r : all)
    if (!r.costs.empty())
      out += fmt::format("{:<16}{:<10}{:>10.4g}{:>14.4g}{:>11}/{:<2}{:>10.4g}{:>10.4g}\n", r.task,
                         actingLawName(r.law), r.planned, r.undisturbed, r.carriedOut,
                         r.costs.size(), r.costs[r.costs.size() / 2], r.costs.back());
  return out;
}

}  // namespace softgauss::app
