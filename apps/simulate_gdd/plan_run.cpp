// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/plan_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/shared/interrupt.hpp"
#include "apps/shared/standard_streams.hpp"
#include "apps/shared/wall_clock.hpp"
#include "apps/simulate_gdd/names.hpp"
#include "apps/simulate_gdd/progress.hpp"

namespace softgauss::app {
namespace {

using planning::MotionPlan;

/// "knee, by 0.021 rad"
std::string farthestText(const Model& model, const std::pair<int, double>& farthest) {
  const auto [dof, amount] = farthest;
  const Body& body =
      model.bodies[static_cast<std::size_t>(model.dofs[static_cast<std::size_t>(dof)].body)];
  const auto index = static_cast<std::size_t>(model.dofs[static_cast<std::size_t>(dof)].body);
  const int place = dof - body.v;
  if (body.joint == JointKind::floating)
    return fmt::format("{} of base {}, by {:.3g} {}", place < 3 ? "the place" : "the orientation",
                       model.bodyNames[index], amount, place < 3 ? "m" : "rad");
  return fmt::format("{}, by {:.3g} {}", nameText(model.jointNames[index]), amount,
                     body.joint == JointKind::prismatic ? "m" : "rad");
}

}  // namespace

void readPlan(SimulateOptions& options, const Scene& scene) {
  takePlan(options, scene, io::readPlanTask(options.model, scene.model, scene.initial));
}

void takePlan(SimulateOptions& options, const Scene& scene, io::PlanTask task) {
  task.steps.threads = options.planThreads;
  options.planControl = std::make_shared<PlanControl>(scene, std::move(task), options.mpc);
  const bool byTheClock = options.mpc && std::isfinite(options.planControl->task().mpc.seconds);
  if (byTheClock && (!options.record.empty() || !options.play.empty()))
    throw UsageError(
        "--mpc: plan.mpc.seconds ends ticks by the clock, so that events give another run each "
        "time; expected none of it with --record and --play");
  if (!options.hasDuration && !options.acted()) options.duration = options.planControl->duration();
  checkSteps(options, scene.model.options.timestep, scene.timestepWhere);
  options.changeGoals = [plan = options.planControl](gdd::GoalDirectedController& controller) {
    plan->attach(controller);
  };
}

std::string explainPlan(const PlanControl& plan) {
  const io::PlanTask& task = plan.task();
  std::string text = fmt::format("plan: {} knots of {:g} s", task.steps.knots, task.steps.step);
  if (plan.recedes())
    text += fmt::format(", planned anew {:.6g} times a second", 1.0 / task.mpc.period);
  if (task.contacts)
    text += fmt::format(", on contacts that begin {:.4g} mm apart{}",
                        1e3 * task.contacts->contacts.margin,
                        task.endsOnOwnContacts ? " first, then on the scene's own" : "");
  return text + "\n";
}

bool makePlan(const SimulateOptions& options) {
  PlanControl& plan = *options.planControl;
  catchInterrupts();
  RunProgress progress(options.duration, options.quiet);
  const Clock::time_point start = Clock::now();
  plan.planner().progress = [&](const MotionPlan& so_far) {
    progress.showPlan(so_far.feasible > 0, so_far.iterations, so_far.cost, so_far.rootForce,
                      secondsSince(start));
    return !interrupted();
  };
  try {
    plan.solve();
  } catch (const PlanError&) {
    progress.clear();
    if (!interrupted()) throw;
    return false;
  }
  progress.clear();
  plan.planner().progress = {};
  if (!interrupted()) return true;
  tell(
      "simulate_gdd: interrupted while it planned: the best plan so far is acted out; ctrl-c again "
      "ends the run");
  forgetInterrupts();
  return true;
}

std::string planText(const PlanControl& plan) {
  const MotionPlan& p = plan.planner().plan();
  return fmt::format(
      "planned {} knots of {:g} s in {:.3g} s: cost {:.6g}, {} iterations, {}\n"
      "  root force {:.3g}, gap {:.2g} of an acceleration, the last model promises {:.2g} of the "
      "cost\n",
      plan.task().steps.knots, plan.task().steps.step, p.seconds, p.cost, p.iterations,
      planStatusName(p.status), p.rootForce, p.gap, p.certificate);
}

bool PlanRun::before(long taken) {
  if (taken == 0) plan_.begin(state_);
  if (std::exchange(moved_, false)) planFromHere();
  plan_.update(state_);
  const planning::HorizonReport& report = plan_.report();
  if (report.ticks > ticks_) tickMs_.add(1e3 * report.last);
  ticks_ = report.ticks;
  return true;
}

void PlanRun::planFromHere() {
  ticks_ = 0;
  plan_.planner().progress = [](const MotionPlan&) { return !interrupted(); };
  try {
    plan_.restart(state_);
    const MotionPlan& p = plan_.planner().plan();
    tell_(fmt::format("planned from here in {:.3g} s: cost {:.4g}, {}", p.seconds, p.cost,
                      planStatusName(p.status)));
  } catch (const PlanError& error) {
    tell_(std::string(error.what()) + "; until the state is another one nothing drives the run");
  }
  plan_.planner().progress = {};
}

void PlanRun::after(const SeenStep& step, const Verdict&) {
  plan_.addStep(step.record.u, step.length);
}

void PlanRun::concludeTicks(io::Summary& summary, io::PlanOutcome& outcome) const {
  const planning::HorizonReport& report = plan_.report();
  outcome.ticks = report.ticks, outcome.failedTicks = report.failed;
  outcome.tickMs = tickMs_;
  summary.verdict.emplace_back(
      "planned anew",
      fmt::format("{} times, {} failed; {:.3g} ms (p50), {:.3g} ms (p99.9), every {:g} ms",
                  report.ticks, report.failed, tickMs_.percentile(0.5), tickMs_.percentile(0.999),
                  1e3 * plan_.task().mpc.period));
}

void PlanRun::conclude(io::Summary& summary) {
  const MotionPlan& plan = plan_.planner().plan();
  const Model& model = plan_.planner().model();
  io::PlanOutcome& o = summary.plan.emplace();
  o.planned = plan.cost;
  o.status = planStatusName(plan.status);
  o.iterations = plan.iterations;
  o.seconds = plan.seconds;
  o.rootForce = plan.rootForce, o.gap = plan.gap, o.certificate = plan.certificate;
  o.finalPlanned = plan_.finalPlanned();
  const MotionCost cost = plan_.cost(state_);
  o.cost = cost.total(), o.running = cost.running, o.effort = cost.effort, o.final = cost.final;
  summary.verdict.emplace_back(
      "planned", fmt::format("cost {:.4g}, {:.4g} of it at the end; {} iterations in {:.3g} s, {}",
                             o.planned, o.finalPlanned, o.iterations, o.seconds, o.status));
  o.outcome = plan_.outcome(state_);
  const bool early = o.outcome == "cut short";
  const char* const aim = plan_.recedes() ? "the target" : "the plan's end";
  summary.verdict.emplace_back(
      o.outcome,
      fmt::format("cost {:.4g}, {:.4g} of it {} ({:.4g} at the start); farthest from {} is {}",
                  o.cost, o.final, early ? "where it is" : "at the end", plan_.finalAtStart(), aim,
                  farthestText(model, plan_.farthest(state_))));
  if (plan_.recedes()) concludeTicks(summary, o);
}

}  // namespace softgauss::app
