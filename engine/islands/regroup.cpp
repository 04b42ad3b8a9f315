// SPDX-License-Identifier: Apache-2.0

/// Islands join and come apart.

#include <algorithm>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/core/union_find.hpp"
#include "softgauss/engine/islands/islands.hpp"

namespace softgauss {
/// Makes an island of each set of the units of `old` islands, unless there is such a one already.
void Islands::makeIslands(const std::vector<Island*>& old, UnionFind& sets) {
  std::map<int, std::vector<int>> groups;  // by first unit
  for (const Island* island : old)
    for (const int unit : island->units) groups[sets.find(unit)].push_back(unit);
  for (Island* island : old) {
    const int set = sets.find(island->units.front());
    const bool whole = std::all_of(island->units.begin(), island->units.end(),
                                   [&](int unit) { return sets.find(unit) == set; });
    if (!whole || groups.at(set).size() != island->units.size()) deactivate(*island);
  }
  for (auto& [first, group] : groups) {
    std::sort(group.begin(), group.end());
    Island& island = find(group);
    if (island.active) continue;  // as it was
    activate(island);
    poseForStep(island.part.model, island.state, island.data);
    ++islandStats_.regroups;
  }
  refreshLists();
}

/// Lets islands come apart whose units did not touch one another in the step before.
void Islands::part() {
  affected_.clear();
  for (Island* island : awake_)
    if (island->units.size() > 1 && island->age > 0 && island->age % kSplitAge == 0)
      affected_.push_back(island);
  if (affected_.empty()) return;
  UnionFind sets(units_.size());
  for (const Island* island : affected_) {
    const auto unitOf = [&](int body) {
      const int tree = island->part.model.bodies[idx(body)].tree;
      return tree < 0 ? -1 : units_.ofTree[idx(island->part.trees[idx(tree)])];
    };
    for (const Contact& c : island->data.contacts.contacts) {
      const int a = unitOf(c.bodyA), b = unitOf(c.bodyB);
      if (a >= 0 && b >= 0) sets.unite(a, b);
    }
  }
  makeIslands(affected_, sets);
}

/// Joins islands that touch at the start of the step.
void Islands::join() {
  touching_.clear();
  if (contacts_) contacts_->findTouching(awakeUnits_, groupOf_, touching_);
  if (touching_.empty()) return;
  UnionFind sets(units_.size());
  affected_.clear();
  for (const auto& [i, j] : touching_) {
    sets.unite(i, j);
    for (Island* island : {islandOf_[idx(i)], islandOf_[idx(j)]})
      if (std::find(affected_.begin(), affected_.end(), island) == affected_.end())
        affected_.push_back(island);
  }
  for (const Island* island : affected_) {
    islandStats_.wakeups += !island->awake;
    for (const int unit : island->units) sets.unite(unit, island->units.front());
  }
  makeIslands(affected_, sets);
  forget();
}

/// Islands of several units that were not met for long are forgotten.
void Islands::forget() {
  constexpr std::size_t kKept = 64;
  std::vector<std::pair<std::int64_t, const std::vector<int>*>> idle;
  for (const auto& [units, island] : islands_)
    if (units.size() > 1 && !island->active) idle.emplace_back(island->lastUse, &units);
  if (idle.size() <= kKept) return;
  std::sort(idle.begin(), idle.end(), [](const auto& x, const auto& y) {
    return x.first != y.first ? x.first < y.first : *x.second < *y.second;
  });
  for (std::size_t n = 0; n < idle.size() - kKept / 2; ++n)
    islands_.erase(std::vector<int>(*idle[n].second));
}

}  // namespace softgauss
