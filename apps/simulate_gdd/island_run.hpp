// SPDX-License-Identifier: Apache-2.0
#pragma once

/// --islands: the steps of a run without goals, taken island by island.

#include "collision/unit_contacts.hpp"
#include "engine/engine.hpp"
#include "io/summary.hpp"

namespace softgauss::app {

class IslandRun {
 public:
  IslandRun(const Model& model, const State& initial, bool sleep);

  SolveStatus step(const Input& input) { return islands_.step(input); }
  /// Takes over what the last step has come to. Of `data`, which has the kinematics of its start,
  /// what a record reads is filled in: contacts, applied force, acceleration and statistics.
  void take(const Input& input, State& state, Data& data);
  /// Largest |g(q, v, a) − (u, 0)| of the last step, over the islands that are awake.
  double physicsViolation();
  /// Of the last solve of every island, those that sleep too, in the geometries of the model.
  const std::vector<Snapshot::ContactForce>& contacts() const { return forces_; }
  const io::IslandOutcomes& outcomes() const { return outcomes_; }

 private:
  void collectContacts(std::vector<Contact>& contacts);

  const Model& model_;
  collision::UnitContacts contacts_;
  Islands islands_;
  std::vector<Snapshot::ContactForce> forces_, some_;
  io::IslandOutcomes outcomes_;
  VectorX scratch_;
};

}  // namespace softgauss::app
