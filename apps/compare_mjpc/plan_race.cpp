// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mjpc/plan_race.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/shared/interrupt.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/io/simulation/scene.hpp"

namespace softgauss::app {
namespace {

using planning::Planner;

/// Of sums of a thousand terms in another order; anything else is another cost.
constexpr double kSameCost = 1e-9;

/// Our planner and its rival's models of one task.
class Contest {
 public:
  Contest(const std::filesystem::path& file, const PlanRaceChoice& choice)
      : choice_(choice),
        scene_(loadScene(file)),
        task_(io::readPlanTask(file, scene_->model, scene_->initial)) {
    for (const io::PlanTask::StateWeights* w : {&task_.running, &task_.final})
      if (!w->points.empty() || !w->orientations.empty() || w->centerOfMass)
        throw ModelError({file.string(), 0}, "plan",
                         "has terms of points, orientations or the centre of mass, expected those "
                         "of positions and velocities alone");
    race_.task = file.stem().string();
    race_.dofs = scene_->model.nv, race_.knots = task_.steps.knots;
    race_.settings.softness = choice.softness;
    planner_ = makePlanner();
    own_ = planner_->model();
    if (!task_.contacts) return;
    planner_->setContacts(task_.contacts->contacts);
    planning_ = planner_->model();
  }

  PlanRace run() {
    runOurs();
    runIlqg();
    if (!interrupted()) cross();
    return race_;
  }

 private:
  std::unique_ptr<Planner> makePlanner() const {
    auto planner = std::make_unique<Planner>(scene_->model, task_.steps, [](const Model& model) {
      return std::make_unique<collision::SceneContacts>(model);
    });
    task_.setCosts(*planner);
    return planner;
  }

  /// (P.3) of any states and controls.
  double cost(const ControlledMotion& x) const {
    const planning::PlanCost& terms = planner_->cost;
    const double h = task_.steps.step;
    double J = 0.0;
    for (int t = 0; t < task_.steps.knots; ++t) {
      for (const auto& term : terms.running)
        J += h * term->value({own_, x.q[idx(t)], x.v[idx(t)], t});
      J += 0.5 * h * controlled(terms.effort).dot(x.u[idx(t)].cwiseAbs2());
    }
    for (const auto& term : terms.final)
      J += term->value({own_, x.q.back(), x.v.back(), task_.steps.knots});
    return J;
  }

  /// The entries of the actuated dofs.
  VectorX controlled(const VectorX& all) const {
    VectorX some(own_.nv);
    Eigen::Index count = 0;
    for (int i = 0; i < own_.nv; ++i)
      if (own_.dofs[idx(i)].actuated) some[count++] = all[i];
    return some.head(count);
  }

  void check(const char* whose, const ControlledMotion& motion, double reported) {
    const double found = cost(motion);
    const double difference = std::abs(found - reported) / std::max(1e-300, std::abs(reported));
    if (!(difference <= kSameCost))
      throw std::runtime_error(
          fmt::format("{}: the cost of {} plan is {:.12g}, and by (P.3) {:.12g}", race_.task, whose,
                      reported, found));
    race_.difference = std::max(race_.difference, difference);
  }

  bool onOwnContacts() const {
    const std::vector<Geometry>& now = planner_->model().geometries;
    return std::equal(
        now.begin(), now.end(), own_.geometries.begin(),
        [](const Geometry& a, const Geometry& b) { return a.material == b.material; });
  }

  void runOurs() {
    for (int i = 0; i < choice_.repeats && !interrupted(); ++i) {
      planner_ = makePlanner();
      CostCurve curve;
      const double begin = processSeconds();
      planner_->progress = [&](const planning::MotionPlan&) {
        const planning::FeasiblePhase& feasible = planner_->feasible();
        if (onOwnContacts() && feasible.hasTrajectory())
          curve.add(processSeconds() - begin, feasible.trajectory().cost);
        return !interrupted();
      };
      const planning::MotionPlan& plan = task_.solve(*planner_, scene_->initial);
      const double seconds = processSeconds() - begin;
      if (!planner_->feasible().hasTrajectory())
        throw std::runtime_error(race_.task + ": AILQR finds no plan, so there is none to race");
      curve.add(seconds, plan.cost);
      // What ends it, checks its gap and is published counts too.
      curve.points.back() = {seconds, plan.cost};
      if (i > 0) {
        race_.ours.keepFaster(curve);
        continue;
      }
      race_.ours = curve;
      motion_ = {plan.q, plan.v, {}, {}};
      for (std::size_t t = 0; t < plan.tau.size(); ++t) {
        motion_.u.push_back(controlled(plan.tau[t]));
        motion_.K.push_back(planner_->feasible().feedback()[t].K);
      }
      check("our", motion_, plan.cost);
    }
  }

  IlqgPlan planTheirs(const IlqgSettings& settings, bool softFirst,
                      const ControlledMotion* guess = nullptr) {
    std::vector<const Model*> models;
    if (softFirst) models.push_back(&planning_);
    models.push_back(&own_);
    IlqgPlan plan = planByIlqg(task_, models, scene_->initial, settings, choice_.iterations, guess);
    if (!plan.curve.points.empty()) check("MuJoCo MPC's", plan.motion, plan.cost);
    return plan;
  }

  /// Of settings that end within what counts as the same, that which is first there.
  void runIlqg() {
    struct Run {
      IlqgSettings settings;
      bool softFirst;
      IlqgPlan plan;
    };
    std::vector<Run> runs;
    double least = kInfinity;
    for (const bool softFirst : {false, true})
      for (const double scale : {1.0, 0.1, 0.01})
        for (const bool ofValue : {false, true}) {
          if ((softFirst && !task_.contacts) || interrupted()) continue;
          const IlqgSettings settings{scale, ofValue, choice_.softness};
          runs.push_back({settings, softFirst, planTheirs(settings, softFirst)});
          least = std::min(least, runs.back().plan.cost);
        }
    for (const Run& run : runs) race_.ends.push_back(run.plan.cost);
    std::sort(race_.ends.begin(), race_.ends.end());
    double first = kInfinity;
    for (const Run& run : runs) {
      const double seconds = run.plan.curve.secondsTo(kSameEnd * least);
      if (!(seconds < first)) continue;
      first = seconds;
      race_.settings = run.settings, race_.softFirst = run.softFirst;
      race_.ilqg = run.plan.curve, theirs_ = run.plan.motion;
    }
    for (int i = 1; i < choice_.repeats && first < kInfinity && !interrupted(); ++i)
      race_.ilqg.keepFaster(planTheirs(race_.settings, race_.softFirst).curve);
  }

  void cross() {
    race_.ilqgFromOurs = planTheirs(race_.settings, false, &motion_).cost;
    if (theirs_.q.empty()) return;
    std::vector<VectorX> a;
    for (std::size_t t = 0; t + 1 < theirs_.v.size(); ++t)
      a.push_back((theirs_.v[t + 1] - theirs_.v[t]) / task_.steps.step);
    planner_->progress = {};
    planner_->setOwnContacts();
    const planning::MotionPlan& plan = planner_->solveFeasible(scene_->initial, task_.options, a);
    if (planner_->feasible().hasTrajectory()) race_.oursFromIlqg = plan.cost;
  }

  PlanRaceChoice choice_;
  std::unique_ptr<Scene> scene_;
  io::PlanTask task_;
  std::unique_ptr<Planner> planner_;
  Model own_, planning_;  ///< of the planner, on the scene's contacts and on those it plans with
  ControlledMotion motion_, theirs_;
  PlanRace race_;
};

}  // namespace

PlanRace racePlans(const std::filesystem::path& file, const PlanRaceChoice& choice) {
  return Contest(file, choice).run();
}

}  // namespace softgauss::app
