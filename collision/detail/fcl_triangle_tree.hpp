// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which triangles of a mesh are within a box: a hierarchy of boxes, which FCL builds.
///
/// Its nodes are walked here, so that a query allocates nothing, throws nothing and gives the same
/// triangles in the same order every time. Nothing but plain numbers goes to FCL and back: its
/// files are compiled with the alignment that FCL was built with, whatever the others are.

#include <array>
#include <memory>
#include <vector>

#include "collision/detail/box.hpp"

namespace softgauss::collision::detail {

class TriangleTree {
 public:
  /// Throws std::runtime_error where FCL builds no hierarchy.
  TriangleTree(const std::vector<Vector3>& vertices,
               const std::vector<std::array<int, 3>>& triangles);
  ~TriangleTree();
  TriangleTree(const TriangleTree&) = delete;
  TriangleTree& operator=(const TriangleTree&) = delete;

  /// The triangles whose own boxes overlap `box`, in rising order, into `found` (cleared first).
  void within(const Box& box, std::vector<int>& found) const;
  /// Whether there is any.
  bool anyWithin(const Box& box) const;
  std::size_t bytes() const;

 private:
  /// Calls visit(triangle) for those within the box, in the tree's order, until it returns false.
  template <class Visit>
  void walk(const Box& box, Visit&& visit) const;

  struct Hierarchy;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace softgauss::collision::detail
