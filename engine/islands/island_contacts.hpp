// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where the contacts of a scene come from that is stepped in islands: those within an island, and
/// which units touch across.

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "softgauss/engine/islands/sub_model.hpp"
#include "softgauss/engine/step/contact_source.hpp"

namespace softgauss {

/// Where the bodies of a tree are and how they move, in their order: poses, and velocities about O.
struct TreeMotionView {
  std::span<const Transform> X_WB;
  std::span<const Motion> V;
  const Vector3* p_WO = nullptr;
};

class IslandContacts {
 public:
  virtual ~IslandContacts() = default;

  /// The contacts of an island, in the geometries and bodies of its own model, which must outlive
  /// the result.
  virtual std::unique_ptr<ContactSource> within(const SubModel& island) = 0;

  /// The bodies of a tree are found there from now on, until this is called again. To be called
  /// also when a tree that is not among the awake ones has moved.
  virtual void place(int tree, const TreeMotionView& bodies) noexcept = 0;

  /// Appends the pairs of units (i, j) that touch (distance < margin) or may within the step, of
  /// which one is in `awake` and which are in different groups. Order and content depend on poses
  /// and velocities alone.
  virtual void findTouching(const std::vector<int>& awake, const std::vector<int>& groupOf,
                            std::vector<std::pair<int, int>>& touching) noexcept = 0;
};

}  // namespace softgauss
