// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which triangles of a mesh are within a box: a hierarchy of boxes, which FCL builds.
///
/// Its nodes are copied, box and children, and walked here: a query calls nothing of FCL, allocates
/// nothing, throws nothing and gives the same triangles in the same order every time. Nothing but
/// plain numbers goes to FCL and back, whose files are compiled with the alignment that FCL was
/// built with, whatever the others are.

#include <array>
#include <utility>
#include <vector>

#include "softgauss/collision/detail/box.hpp"
#include "softgauss/engine/core/spatial.hpp"

namespace softgauss::collision::detail {

class TriangleTree {
 public:
  /// Throws std::runtime_error where FCL builds no hierarchy.
  TriangleTree(const std::vector<Vector3>& vertices,
               const std::vector<std::array<int, 3>>& triangles);

  /// The triangles whose own boxes overlap `box`, in rising order, into `found` (cleared first).
  void within(const Box& box, std::vector<int>& found) const;
  /// Whether there is any.
  bool anyWithin(const Box& box) const;
  /// Pairs of a triangle of this tree and one of another, at pose X in the axes of this one, whose
  /// own boxes come nearer than `reach`, in the order of the trees, into `found` (cleared first).
  void near(const TriangleTree& other, const Transform& X, double reach,
            std::vector<std::pair<int, int>>& found) const;
  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

  struct Node {
    Box box;
    int first;  ///< of two children beside each other, or −(triangle + 1)
  };
  /// [0] holds all; no more than kDepth levels below it.
  const std::vector<Node>& nodes() const { return nodes_; }
  static constexpr int kDepth = 128;

 private:
  /// Calls visit(triangle) for those within the box, in the tree's order, until it returns false.
  template <class Visit>
  void walk(const Box& box, Visit&& visit) const;

  std::vector<Node> nodes_;
};

}  // namespace softgauss::collision::detail
