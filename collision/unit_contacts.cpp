// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/unit_contacts.hpp"

#include <algorithm>

#include "softgauss/collision/detail/neighbours.hpp"
#include "softgauss/collision/scene_contacts.hpp"

namespace softgauss::collision {

struct UnitContacts::Neighbours : detail::Neighbours {
  using detail::Neighbours::Neighbours;
};

UnitContacts::UnitContacts(const Model& model)
    : model_(model),
      units_(model),
      ownPairs_(static_cast<std::size_t>(units_.size())),
      neighbours_(std::make_unique<Neighbours>(model, units_, meshes_)) {}

UnitContacts::~UnitContacts() = default;

const std::vector<GeometryPair>& UnitContacts::ownPairs(int unit) {
  const auto u = static_cast<std::size_t>(unit);
  if (ownPairs_[u]) return *ownPairs_[u];
  const SubModel alone(model_, units_.trees[u]);
  const SceneContacts contacts(alone.model, SceneContacts::kBroadphasePairs, true, &meshes_);
  ownPairs_[u] = std::make_unique<std::vector<GeometryPair>>(contacts.filter().pairs);
  for (GeometryPair& pair : *ownPairs_[u])
    pair = {alone.geometries[static_cast<std::size_t>(pair.a)],
            alone.geometries[static_cast<std::size_t>(pair.b)]};
  return *ownPairs_[u];
}

std::unique_ptr<ContactSource> UnitContacts::within(const SubModel& island) {
  // The units of the island, and of each its geometries in the island.
  std::vector<int> units;
  for (const int tree : island.trees)
    units.push_back(units_.ofTree[static_cast<std::size_t>(tree)]);
  std::sort(units.begin(), units.end());
  units.erase(std::unique(units.begin(), units.end()), units.end());

  const std::vector<int>& whole = island.geometries;
  const auto inIsland = [&](int geometry) {
    return static_cast<int>(std::lower_bound(whole.begin(), whole.end(), geometry) - whole.begin());
  };
  std::vector<GeometryPair> pairs;
  for (const int unit : units)
    for (const GeometryPair& pair : ownPairs(unit))
      pairs.push_back({inIsland(pair.a), inIsland(pair.b)});

  if (model_.options.effects.has(Effect::objectContact)) {
    const Model& model = island.model;
    const int count = static_cast<int>(model.geometries.size());
    std::vector<int> unitOf;
    for (const int g : whole)
      unitOf.push_back(units_.ofBody(model_, model_.geometries[static_cast<std::size_t>(g)].body));
    for (int i = 0; i < count; ++i)
      for (int j = i + 1; j < count; ++j) {
        const int u = unitOf[static_cast<std::size_t>(i)], w = unitOf[static_cast<std::size_t>(j)];
        if (u >= 0 && w >= 0 && u != w) pairs.push_back(inOrder(model, i, j));
      }
  }
  sortPairs(island.model, pairs);
  return std::make_unique<SceneContacts>(island.model, std::move(pairs), meshes_);
}

void UnitContacts::place(int tree, const TreeMotionView& bodies) noexcept {
  neighbours_->place(tree, bodies);
}

void UnitContacts::findTouching(const std::vector<int>& awake, const std::vector<int>& groupOf,
                                std::vector<std::pair<int, int>>& touching) noexcept {
  if (model_.options.effects.has(Effect::objectContact))
    neighbours_->findTouching(awake, groupOf, touching);
}

std::int64_t UnitContacts::searches() const { return neighbours_->searches(); }

}  // namespace softgauss::collision
