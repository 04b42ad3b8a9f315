// SPDX-License-Identifier: Apache-2.0

/// Islands as bytes, and back.

#include <algorithm>
#include <utility>

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/islands/islands.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "softgauss/engine/step/saved_contacts.hpp"

namespace softgauss {
namespace {

/// What an island brings along that its units and the whole state do not tell.
struct SavedIsland {
  Islands::Island& island;

  template <class Archive>
  void archive(Archive& a) {
    a(island.awake, island.age, island.resting, island.controlled, island.state);
    if (island.resting > 0.0) {  // else what an earlier rest has left
      a(island.restSpeed);
      a.sized(island.rest);
    }
    a(island.data.contacts.contacts);
  }
  void expectWhole() const {
    const Model& model = island.part.model;
    expectStateOf(model, island.state);
    ByteReader::expect(fits(model, island.data.contacts.contacts) && island.age >= 0);
  }
};

}  // namespace

// Found beside its type.
template <class Archive>
void archive(Archive& a, Motion& motion) {
  a(motion.angular, motion.linear);
}

void Islands::save(ByteWriter& a) {
  a(state_, acceleration_, setPoints_[0], setPoints_[1], clock_, active_);
  for (int unit = 0; unit < units_.size(); ++unit) {
    Island& island = *islandOf_[idx(unit)];
    if (island.units.front() == unit) a(island.units, SavedIsland{island});
  }
}

void Islands::restore(ByteReader& a) {
  a(state_);
  expectStateOf(model_, state_);
  a.sized(acceleration_);
  for (VectorX& x : setPoints_) a.sized(x);
  int islands = 0;
  a(clock_, islands);
  for (Island* island : islandOf_)
    if (island->active) deactivate(*island);
  std::vector<char> known(idx(units_.size()), 0);
  std::vector<int> units;
  for (int i = 0; i < islands; ++i) {
    a(units);
    a.expect(!units.empty() && std::is_sorted(units.begin(), units.end()) && units.front() >= 0 &&
             units.back() < units_.size());
    for (const int unit : units) a.expect(std::exchange(known[idx(unit)], 1) == 0);
    Island& island = find(units);
    activate(island);
    SavedIsland saved{island};
    a(saved);
    saved.expectWhole();
    computeKinematics(island.part.model, island.state, island.data.kinematics);
    place(island);
  }
  a.expect(std::find(known.begin(), known.end(), 0) == known.end());
  refreshLists();
}

}  // namespace softgauss
