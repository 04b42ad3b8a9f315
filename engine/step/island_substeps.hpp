// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Islands that take a step in parts of their own.
///
/// Into how many parts a step goes (substep_selection.hpp) is asked of each island: of trees that
/// rows hold together, or contacts that may begin to within the step. Islands that need one part
/// take the step whole; each of the others takes it in its parts, one after the other, in Data of
/// which the stages are of its trees alone. What one does costs the others nothing, and what it
/// comes to depends on them in no bit. Trees that are asleep are of none.
///
/// A control finds one torque for all trees that it acts on: these count as one island, and where
/// that needs parts, all the scene takes these.

#include <utility>
#include <vector>

#include "softgauss/engine/step/snapshot.hpp"

namespace softgauss {

/// Appends the pairs of bodies that move together within the step: that touch or may, or that rows
/// couple.
void appendTouching(const Model& model, const Data& data, std::vector<std::pair<int, int>>& pairs);

class IslandSubsteps {
 public:
  explicit IslandSubsteps(const Model& model);

  /// Makes room for so many contacts.
  void reserve(std::size_t contacts);
  /// All take the step whole.
  void clear() { any_ = false; }
  /// Finds the islands, of the stages of `whole`, and which of them need parts. False where all
  /// have to take the same ones. `controlled`: a control acts.
  bool divide(const Model& model, bool controlled, const Data& whole);

  /// Whether any island is left to parts of its own.
  bool any() const { return any_; }
  /// Whether a body, a tree's root or another, is of one of those.
  bool leaves(int body) const { return any_ && parts_[idx(islands_.ofBody()[idx(body)])] > 1; }
  int islands() const { return islands_.size(); }
  int parts(int island) const { return parts_[idx(island)]; }

  /// Readies `data` for the parts of an island of `whole`: from `before`, with these a₋ and f₋.
  void begin(const Model& model, int island, const Data& whole, const State& before,
             const VectorX& a, const VectorX& connectionForces);
  /// What the island has come to becomes part of the whole.
  void finish(const Model& model, int island, Data& whole, State& state);

  /// Contacts of those that have finished, with the forces of their last parts.
  const std::vector<Snapshot::ContactForce>& contacts() const { return contacts_; }

  Data data;
  State state;

 private:
  void findPairs(const Model& model, bool controlled, const Data& whole);

  TreeIslands islands_;
  std::vector<int> parts_;  ///< (islands)
  bool any_ = false;
  std::vector<std::pair<int, int>> pairs_;  ///< scratch
  std::vector<Snapshot::ContactForce> contacts_;
};

}  // namespace softgauss
