// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which geometries of a large scene are near each other: FCL's dynamic tree of boxes.

#include <memory>
#include <vector>

#include "engine/core/types.hpp"

namespace softgauss::collision::detail {

class Broadphase {
 public:
  /// One box per radius, for bounding spheres of these radii [m].
  explicit Broadphase(const std::vector<double>& radii);
  ~Broadphase();

  /// Moves the spheres to `centres` and appends to `near` every pair (i < j) whose boxes touch, in
  /// no particular order. May throw std::bad_alloc.
  void findNear(const std::vector<Vector3>& centres, std::vector<std::pair<int, int>>& near);

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace softgauss::collision::detail
