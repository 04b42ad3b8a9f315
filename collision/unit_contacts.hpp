// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts of a scene that is stepped in islands (engine/islands): the engine's IslandContacts.
///
/// Within an island it is SceneContacts with the pairs of the island alone. Between units, each has
/// a box about its shapes and a fat one about that. Which fat boxes overlap is looked for anew when
/// a unit has left its own; after that only those neighbours are tested, shape by shape, exactly as
/// within an island. So a unit that sleeps costs nothing, and one that moves costs what is near it.

#include <memory>

#include "softgauss/collision/filter.hpp"
#include "softgauss/collision/prepared_meshes.hpp"
#include "softgauss/engine/islands/island_contacts.hpp"
#include "softgauss/engine/islands/units.hpp"

namespace softgauss::collision {

class UnitContacts final : public IslandContacts {
 public:
  /// Throws ModelError when a mesh has no surface. The model must outlive this object.
  explicit UnitContacts(const Model& model);
  ~UnitContacts() override;

  std::unique_ptr<ContactSource> within(const SubModel& island) override;
  void place(int tree, const TreeMotionView& bodies) noexcept override;
  void findTouching(const std::vector<int>& awake, const std::vector<int>& groupOf,
                    std::vector<std::pair<int, int>>& touching) noexcept override;

  /// How often the neighbours of a unit were looked for since the start.
  std::int64_t searches() const;

 private:
  struct Neighbours;
  const Model& model_;
  Units units_;
  PreparedMeshes meshes_;
  /// (units) pairs that a unit has with itself and the world, in the geometries of the model; made
  /// when first needed.
  std::vector<std::unique_ptr<std::vector<GeometryPair>>> ownPairs_;
  std::unique_ptr<Neighbours> neighbours_;

  const std::vector<GeometryPair>& ownPairs(int unit);
};

}  // namespace softgauss::collision
