// SPDX-License-Identifier: Apache-2.0
#include "collision/detail/fcl_triangle_tree.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace softgauss::collision::detail {

namespace {

/// Nodes that wait on the way down, one for each level.
constexpr int kWaiting = 128;

}  // namespace

struct TriangleTree::Hierarchy {
  fcl::BVHModel<fcl::AABBd> model;

  /// Levels below a node.
  int depthBelow(int node) const {
    const auto& bv = model.getBV(node);
    return bv.isLeaf() ? 0 : 1 + std::max(depthBelow(bv.leftChild()), depthBelow(bv.rightChild()));
  }
};

TriangleTree::TriangleTree(const std::vector<Vector3>& vertices,
                           const std::vector<std::array<int, 3>>& triangles)
    : hierarchy_(std::make_unique<Hierarchy>()) {
  std::vector<fcl::Triangle> corners;
  corners.reserve(triangles.size());
  for (const std::array<int, 3>& t : triangles)
    corners.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                         static_cast<std::size_t>(t[2]));
  auto& model = hierarchy_->model;
  int result =
      model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  if (result == fcl::BVH_OK) result = model.addSubModel(vertices, corners);
  if (result == fcl::BVH_OK) result = model.endModel();
  if (result != fcl::BVH_OK || model.getNumBVs() == 0)
    throw std::runtime_error("FCL builds no hierarchy of its triangles, code " +
                             std::to_string(result));
  if (const int depth = hierarchy_->depthBelow(0); depth >= kWaiting)
    throw std::runtime_error("FCL's hierarchy of its triangles is " + std::to_string(depth) +
                             " levels deep, expected fewer than " + std::to_string(kWaiting));
}

TriangleTree::~TriangleTree() = default;

template <class Visit>
void TriangleTree::walk(const Box& box, Visit&& visit) const {
  const auto& model = hierarchy_->model;
  const fcl::AABBd wanted(box.lower, box.upper);
  std::array<int, kWaiting> waiting;
  int count = 0;
  waiting[static_cast<std::size_t>(count++)] = 0;
  while (count > 0) {
    const auto& node = model.getBV(waiting[static_cast<std::size_t>(--count)]);
    if (!node.bv.overlap(wanted)) continue;
    if (node.isLeaf()) {
      if (!visit(node.primitiveId())) return;
      continue;
    }
    waiting[static_cast<std::size_t>(count++)] = node.rightChild();
    waiting[static_cast<std::size_t>(count++)] = node.leftChild();
  }
}

void TriangleTree::within(const Box& box, std::vector<int>& found) const {
  found.clear();
  walk(box, [&](int t) {
    found.push_back(t);
    return true;
  });
  std::sort(found.begin(), found.end());
}

bool TriangleTree::anyWithin(const Box& box) const {
  bool any = false;
  walk(box, [&](int) {
    any = true;
    return false;
  });
  return any;
}

std::size_t TriangleTree::bytes() const {
  return sizeof(Hierarchy) + static_cast<std::size_t>(hierarchy_->model.memUsage(0));
}

}  // namespace softgauss::collision::detail
