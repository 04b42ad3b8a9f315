// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mjpc/ilqg.hpp"

#include <fmt/format.h>
#include <mjpc/planners/ilqg/planner.h>
#include <mjpc/states/state.h>
#include <mjpc/task.h>
#include <mjpc/threadpool.h>
#include <mujoco/mujoco.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "apps/compare_mujoco/mujoco_load.hpp"
#include "apps/shared/interrupt.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::app {
namespace {

/// It has settled where so many iterations lower the cost by less than this share.
constexpr int kPatience = 50;
constexpr double kFalls = 1e-6;

/// (P.3) as residuals: errors times the roots of their weights, of running ones times h.
class PlanResidual final : public mjpc::BaseResidualFn {
 public:
  PlanResidual(const mjpc::Task* owner, const io::PlanTask& task, const Model& model)
      : mjpc::BaseResidualFn(owner), task_(task) {
    const double h = task.steps.step;
    for (int i = 0; i < model.nv; ++i)
      if (model.dofs[idx(i)].actuated) effort_.push_back(std::sqrt(h * task.effort[i]));
    position_[0] = (h * task.running.position).cwiseSqrt();
    velocity_[0] = (h * task.running.velocity).cwiseSqrt();
    position_[1] = task.final.position.cwiseSqrt();
    velocity_[1] = task.final.velocity.cwiseSqrt();
  }

  void Residual(const mjModel* model, const mjData* data, double* residual) const override {
    const auto t = static_cast<std::size_t>(std::lround(data->time / task_.steps.step));
    const bool last = t >= idx(task_.steps.knots);
    const auto at = [&](const std::vector<VectorX>& x) -> const VectorX& {
      return x[std::min(x.size() - 1, t)];
    };
    const int n = model->nv;
    Eigen::Map<VectorX> position(residual, n), velocity(residual + n, n);
    mj_differentiatePos(model, residual, 1.0, at(task_.q).data(), data->qpos);
    position.array() *= position_[last].array();
    velocity = velocity_[last].cwiseProduct(Eigen::Map<const VectorX>(data->qvel, n) - at(task_.v));
    for (int i = 0; i < model->nu; ++i)
      residual[2 * n + i] = last ? 0.0 : effort_[idx(i)] * data->ctrl[i];
  }

 private:
  const io::PlanTask& task_;
  std::vector<double> effort_;
  VectorX position_[2], velocity_[2];  ///< running, final
};

class PosedTask final : public mjpc::Task {
 public:
  PosedTask(const io::PlanTask& task, const Model& model)
      : task_(task), model_(model), residual_(this, task, model) {}
  std::string Name() const override { return "plan"; }
  std::string XmlPath() const override { return {}; }

 protected:
  PlanResidual* InternalResidual() override { return &residual_; }
  std::unique_ptr<mjpc::ResidualFn> ResidualLocked() const override {
    return std::make_unique<PlanResidual>(this, task_, model_);
  }

 private:
  const io::PlanTask& task_;
  const Model& model_;
  PlanResidual residual_;
};

const mjpc::Task* shownTask = nullptr;  ///< whose residuals MuJoCo's sensors show

void showResidual(const mjModel* model, mjData* data, int stage) {
  if (stage == mjSTAGE_ACC) shownTask->Residual(model, data, data->sensordata);
}

/// Its rollouts print where they diverge.
class Silence {
 public:
  Silence() : before_(std::cerr.rdbuf(nullptr)) {}
  ~Silence() {
    std::cerr.rdbuf(before_);
    std::cerr.clear();
  }

 private:
  std::streambuf* before_;
};

class Ilqg {
 public:
  Ilqg(const io::PlanTask& task, const State& start, const IlqgSettings& settings)
      : posed_(task), start_(start), settings_(settings), knots_(task.steps.knots) {
    if (settings.ofValue) planner_.settings.regularization_type = mjpc::kValueRegularization;
    if (knots_ >= mjpc::kMaxTrajectoryHorizon)
      throw ModelError({}, "plan",
                       fmt::format("has {} knots, expected fewer than {} of MuJoCo MPC", knots_,
                                   mjpc::kMaxTrajectoryHorizon));
  }
  ~Ilqg() {
    mjcb_sensor = nullptr;
    shownTask = nullptr;
  }

  /// What it has planned stays.
  void take(const Model& model) {
    const bool first = !mujoco_;
    // Its return is the mean over knots.
    const double weight = settings_.scale * (knots_ + 1);
    MujocoModel next(loadMujoco("plan.xml", planMjcf(model, settings_.softness, weight)),
                     mj_deleteModel);
    if (next->nq != model.nq || next->nv != model.nv)
      throw ModelError({}, "MuJoCo", "has other positions or velocities than the plan's model");
    auto task = std::make_unique<PosedTask>(posed_, model);
    task->Reset(next.get());
    shownTask = task.get();
    mjcb_sensor = showResidual;
    planner_.Initialize(next.get(), *task);
    planner_.Allocate();
    if (first) planner_.Reset(knots_ + 1);
    planner_.policy.representation = 0;  // controls stay for a step
    mjpc::State state;
    state.Allocate(next.get());
    state.Set(next.get(), start_.q.data(), start_.v.data(), nullptr, nullptr, nullptr, nullptr,
              0.0);
    planner_.SetState(state);
    mujoco_ = std::move(next);
    task_ = std::move(task);
    if (first) begin(nullptr);
  }

  /// From this motion, or none. To be called after take().
  void begin(const ControlledMotion* guess) {
    mjpc::iLQGPolicy& policy = planner_.policy;
    policy.trajectory.times[0] = 0.0;
    for (int t = 0; t < knots_; ++t)  // as MuJoCo adds them up
      policy.trajectory.times[idx(t + 1)] = policy.trajectory.times[idx(t)] + mujoco_->opt.timestep;
    if (!guess) return;
    const auto put = [](const auto& x, std::vector<double>& to, std::size_t t) {
      std::copy(x.data(), x.data() + x.size(), to.begin() + static_cast<long>(t) * x.size());
    };
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    for (std::size_t t = 0; t < guess->q.size(); ++t) {
      VectorX state(guess->q[t].size() + guess->v[t].size());
      state << guess->q[t], guess->v[t];
      put(state, policy.trajectory.states, t);
      if (t == guess->u.size()) break;
      put(guess->u[t], policy.trajectory.actions, t);
      put(Rows(guess->K[t]), policy.feedback_gain, t);
    }
  }

  /// Its costs count from `seconds` on.
  void descend(int iterations, double seconds, IlqgPlan& plan) {
    const Silence silence;
    plan = {};
    const double begin = processSeconds() - seconds;
    planner_.UpdateNumTrajectoriesFromGUI();
    planner_.NominalTrajectory(knots_ + 1, pool_);
    if (planner_.BestRollout() < 0) return;
    double before = kInfinity;
    for (int i = 0, last = 0; !interrupted(); ++i) {
      plan.cost = now().total_return / settings_.scale;
      if (!(plan.cost >= (1.0 - kFalls) * before)) {
        before = plan.cost, last = i;
        plan.curve.add(processSeconds() - begin, plan.cost);
      }
      if (i == iterations || i - last >= kPatience) break;
      planner_.Iteration(knots_ + 1, pool_);
    }
    takeMotion(plan.motion);
  }

 private:
  using MujocoModel = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;

  const mjpc::Trajectory& now() const { return planner_.candidate_policy[0].trajectory; }

  void takeMotion(ControlledMotion& motion) const {
    const int nq = mujoco_->nq, nv = mujoco_->nv, nu = mujoco_->nu;
    for (int t = 0; t <= knots_; ++t) {
      const double* const state = now().states.data() + t * (nq + nv);
      motion.q.push_back(Eigen::Map<const VectorX>(state, nq));
      motion.v.push_back(Eigen::Map<const VectorX>(state + nq, nv));
      if (t < knots_)
        motion.u.push_back(Eigen::Map<const VectorX>(now().actions.data() + t * nu, nu));
    }
  }

  const io::PlanTask& posed_;
  const State& start_;
  IlqgSettings settings_;
  int knots_;
  MujocoModel mujoco_{nullptr, mj_deleteModel};
  std::unique_ptr<PosedTask> task_;
  mjpc::ThreadPool pool_{1};
  mjpc::iLQGPlanner planner_;
};

}  // namespace

double processSeconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

IlqgPlan planByIlqg(const io::PlanTask& task, const std::vector<const Model*>& models,
                    const State& start, const IlqgSettings& settings, int iterations,
                    const ControlledMotion* guess) {
  const auto ilqg = std::make_unique<Ilqg>(task, start, settings);  // large
  IlqgPlan plan;
  double seconds = 0.0;
  for (const Model* model : models) {
    ilqg->take(*model);
    if (guess && model == models.front()) ilqg->begin(guess);
    ilqg->descend(iterations, seconds, plan);
    if (plan.curve.points.empty()) break;
    seconds = plan.curve.seconds();
  }
  return plan;
}

std::string mujocoVersion() { return mj_versionString(); }

}  // namespace softgauss::app
