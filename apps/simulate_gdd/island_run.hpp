// SPDX-License-Identifier: Apache-2.0
#pragma once

/// --islands: the steps of a run, taken island by island.

#include <map>
#include <optional>

#include "softgauss/collision/unit_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/engine/step/saved_contacts.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss::app {

class IslandRun {
 public:
  /// Islands on which goals act are controlled as `controller` tells, which gets the results.
  /// Throws ModelError where a goal ties what may be apart.
  IslandRun(const Model& model, const State& initial, const Sleep& sleep,
            gdd::GoalDirectedController& controller);

  SolveStatus step(const Input& input) { return islands_.step(input); }
  /// Takes over what the last step has come to. Of `data`, which has the kinematics of its start,
  /// what a record reads is filled in: contacts, applied force, acceleration and statistics.
  void take(const Input& input, State& state, Data& data);
  /// Largest |g(q, v, a) − (u, 0)| of the last step, over the islands that are awake.
  double physicsViolation();
  /// Of the last solve of every island, those that sleep too, in the geometries of the model.
  const std::vector<Snapshot::ContactForce>& contacts() const { return forces_; }
  /// Whether an island with elliptic cones was controlled in the last step.
  bool controlledCones() const;
  const io::IslandOutcomes& outcomes() const { return outcomes_; }
  template <class Archive>
  void archive(Archive& a) {
    a(islands_);
    if (controls_) {
      a(*controls_);
      a.sized(controller_.control, controller_.commands);
    }
    if constexpr (!Archive::kReads) keepAsleep();
    a(outcomes_, asleep_);
    if constexpr (Archive::kReads)
      for (const auto& [unit, forces] : asleep_) a.expect(fits(model_, forces));
  }

 private:
  void collectContacts(std::vector<Contact>& contacts);
  void addServoForces(VectorX& tau);
  void forcesOf(const Islands::Island& island);
  void keepAsleep();

  const Model& model_;
  gdd::GoalDirectedController& controller_;
  collision::UnitContacts contacts_;
  std::optional<gdd::GoalDirectedIslands> controls_;  ///< with goals
  Islands islands_;
  std::vector<Snapshot::ContactForce> forces_, some_;
  /// Of islands that sleep since an earlier process stepped them, by their first unit.
  std::map<int, std::vector<Snapshot::ContactForce>> asleep_;
  io::IslandOutcomes outcomes_;
  VectorX scratch_, ofIsland_, ofScene_;
};

}  // namespace softgauss::app
