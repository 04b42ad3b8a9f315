// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A task of planning by AILQR and by MuJoCo MPC's iLQG.

#include <filesystem>

#include "apps/compare_mjpc/ilqg.hpp"

namespace softgauss::app {

/// Costs within this of each other are the same end.
inline constexpr double kSameEnd = 1.01;

struct PlanRaceChoice {
  int repeats = 5;        ///< of either, of which the least times count
  int iterations = 2000;  ///< of iLQG at most, on each of the contacts
  UngivenSoftness softness = UngivenSoftness::nearRigid;
};

struct PlanRace {
  std::string task;
  int dofs = 0, knots = 0;
  CostCurve ours;  ///< on the scene's own contacts, as simulate_gdd --plan has it
  CostCurve ilqg;  ///< by the best of its settings
  IlqgSettings settings;
  std::vector<double> ends;  ///< of all of them, ascending; infinite where every rollout diverged
  bool softFirst = false;    ///< these settings begin on the planning contacts
  /// From the plan of the other with its feedback: what iLQG comes to, and what phase F does.
  double ilqgFromOurs = kInfinity, oursFromIlqg = kInfinity;
  double difference = 0.0;  ///< relative, of two evaluations of the same cost, the largest
};

/// Throws ModelError where the file is at fault, std::runtime_error where the cost of a plan of
/// either is not that of plan_cost.hpp for the same states and controls.
PlanRace racePlans(const std::filesystem::path& file, const PlanRaceChoice& choice);

/// For people.
std::string planRaceTable(const std::vector<PlanRace>& races);

}  // namespace softgauss::app
