// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which units touch, found from boxes about their shapes and then shape by shape.

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "softgauss/collision/detail/box.hpp"
#include "softgauss/collision/detail/geometry_set.hpp"
#include "softgauss/collision/filter.hpp"
#include "softgauss/engine/islands/island_contacts.hpp"
#include "softgauss/engine/islands/units.hpp"

namespace softgauss::collision::detail {

class Neighbours {
 public:
  Neighbours(const Model& model, const Units& units, PreparedMeshes& meshes);

  void place(int tree, const TreeMotionView& bodies) noexcept;
  /// As IslandContacts::findTouching().
  void findTouching(const std::vector<int>& awake, const std::vector<int>& groupOf,
                    std::vector<std::pair<int, int>>& touching) noexcept;
  std::int64_t searches() const { return searches_; }

 private:
  /// A geometry of a unit.
  struct Part {
    int geometry = 0;
    int tree = 0;
    int bodyInTree = 0;
    Vector3 centreInB = Vector3::Zero();  ///< of the bounding sphere [m]
    double radius = 0.0;                  ///< of it, with the part of the margin that it brings [m]
    double lever = 0.0;                   ///< of its points about the centre [m]
  };
  struct Row {
    int a = 0, b = 0;     ///< geometries, as in GeometryPair
    double reach = 0.0;   ///< bounding radii and margin together [m]
    double margin = 0.0;  ///< of the pair [m]
    bool plane = false;   ///< a is one
  };
  using UnitPair = std::pair<int, int>;

  const Transform& pose(const Part& part) const {
    return bodies_[static_cast<std::size_t>(part.tree)]
        .X_WB[static_cast<std::size_t>(part.bodyInTree)];
  }
  /// How far its points go within the step, where rows begin before they touch (3.16) [m].
  double wayOf(const Part& part, const Vector3& centre) const;
  /// Centres, ways and box of a unit, now.
  void measure(int unit);
  /// Poses of its geometries, unless they are known.
  void poseParts(int unit);
  /// Finds the neighbours of a unit that has left its fat box.
  void search(int unit);
  const std::vector<Row>& rowsOf(int i, int j);
  bool touch(int i, int j);

  const GeometrySet set_;
  const Units& units_;
  std::vector<std::vector<Part>> parts_;       ///< (units)
  std::vector<TreeMotionView> bodies_;         ///< (trees)
  std::vector<Vector3> centre_;                ///< (geometries) of bounding spheres, world
  std::vector<double> way_;                    ///< (geometries) wayOf() [m]
  std::vector<Transform> X_WG_;                ///< (geometries)
  std::vector<std::uint8_t> posed_;            ///< (units) X_WG_ is that of now
  std::vector<Box> box_, fat_;                 ///< (units) in the world
  std::vector<std::vector<int>> near_;         ///< (units) whose fat boxes overlap its own
  std::map<UnitPair, std::vector<Row>> rows_;  ///< of pairs that have been near
  std::vector<int> moved_;                     ///< placed since the last findTouching()
  std::vector<std::uint8_t> awake_;            ///< (units) scratch
  PairTest test_;
  std::int64_t searches_ = 0;
};

}  // namespace softgauss::collision::detail
