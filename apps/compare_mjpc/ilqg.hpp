// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The iLQG of MuJoCo MPC on a task of planning. Only ilqg.cpp knows its headers.

#include <string>
#include <utility>
#include <vector>

#include "apps/compare_mjpc/plan_mjcf.hpp"
#include "softgauss/io/plan_task.hpp"

namespace softgauss::app {

/// Costs over time, each when it was first had [s]: falling.
struct CostCurve {
  std::vector<std::pair<double, double>> points;  ///< times and costs

  void add(double seconds, double cost);
  double cost() const { return points.empty() ? kInfinity : points.back().second; }
  double seconds() const { return points.empty() ? kInfinity : points.back().first; }
  double secondsTo(double cost) const;      ///< until it is no more than this; infinite: never
  double costAt(double seconds) const;      ///< infinite where there was none
  void keepFaster(const CostCurve& other);  ///< of another run of the same: the lesser times
};

/// A motion with its controls and a feedback u + K (δq, δv).
struct ControlledMotion {
  std::vector<VectorX> q, v;  ///< N + 1 states
  std::vector<VectorX> u;     ///< N, of the actuated dofs
  std::vector<MatrixX> K;     ///< N
};

/// What is left open: its regularisation begins at 1 of the cost's unit.
struct IlqgSettings {
  double scale = 1.0;    ///< of the cost that it sees
  bool ofValue = false;  ///< regularisation of the value in place of the control's, its default
  UngivenSoftness softness = UngivenSoftness::nearRigid;
};

struct IlqgPlan {
  CostCurve curve;  ///< on the last model, in the plan's unit, from the first model's start on
  ControlledMotion motion;
  double cost = kInfinity;  ///< of the motion, as it counts; infinite: every rollout diverged
};

/// Plans with its own settings but for these, on one thread, until 50 iterations lower the cost by
/// less than 1e-6 of it, on each of the models in turn; what it has planned, feedback too, goes on
/// from one to the next. It begins with no control, or with `guess`. Models are those of a planner
/// (plan_mjcf.hpp). Throws ModelError.
IlqgPlan planByIlqg(const io::PlanTask& task, const std::vector<const Model*>& models,
                    const State& start, const IlqgSettings& settings, int iterations,
                    const ControlledMotion* guess = nullptr);

/// CPU time of all threads [s].
double processSeconds();

std::string mujocoVersion();

}  // namespace softgauss::app
