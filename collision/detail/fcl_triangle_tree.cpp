// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/fcl_triangle_tree.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision::detail {
namespace {

/// Nodes that wait on the way down, one for each level.
constexpr int kWaiting = TriangleTree::kDepth;

using Hierarchy = fcl::BVHModel<fcl::AABBd>;

/// Levels below a node.
int depthBelow(const Hierarchy& model, int node) {
  const auto& bv = model.getBV(node);
  if (bv.isLeaf()) return 0;
  return 1 + std::max(depthBelow(model, bv.leftChild()), depthBelow(model, bv.rightChild()));
}

/// The box about a box of other axes, and `reach` more.
struct Turned {
  Turned(const Transform& X, double reach) : X_(X), extent_(X.R.cwiseAbs()), reach_(reach) {}
  Box operator()(const Box& box) const {
    const Vector3 centre = X_ * Vector3(0.5 * (box.lower + box.upper));
    const Vector3 half = (0.5 * (extent_ * (box.upper - box.lower))).array() + reach_;
    return {centre - half, centre + half};
  }

 private:
  Transform X_;
  Matrix3 extent_;
  double reach_;
};

}  // namespace

TriangleTree::TriangleTree(const std::vector<Vector3>& vertices,
                           const std::vector<std::array<int, 3>>& triangles) {
  std::vector<fcl::Triangle> corners;
  corners.reserve(triangles.size());
  for (const std::array<int, 3>& t : triangles)
    corners.emplace_back(idx(t[0]), idx(t[1]), idx(t[2]));
  Hierarchy model;
  int result =
      model.beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  if (result == fcl::BVH_OK) result = model.addSubModel(vertices, corners);
  if (result == fcl::BVH_OK) result = model.endModel();
  if (result != fcl::BVH_OK || model.getNumBVs() == 0)
    throw std::runtime_error("FCL builds no hierarchy of its triangles, code " +
                             std::to_string(result));
  if (const int depth = depthBelow(model, 0); depth >= kWaiting)
    throw std::runtime_error("FCL's hierarchy of its triangles is " + std::to_string(depth) +
                             " levels deep, expected fewer than " + std::to_string(kWaiting));
  nodes_.reserve(idx(model.getNumBVs()));
  for (int i = 0; i < model.getNumBVs(); ++i) {
    const auto& bv = model.getBV(i);
    nodes_.push_back(
        {{bv.bv.min_, bv.bv.max_}, bv.isLeaf() ? -(bv.primitiveId() + 1) : bv.leftChild()});
  }
}

template <class Visit>
void TriangleTree::walk(const Box& box, Visit&& visit) const {
  std::array<int, kWaiting> waiting;
  int count = 0;
  waiting[idx(count++)] = 0;
  while (count > 0) {
    const Node& node = nodes_[idx(waiting[idx(--count)])];
    if (!node.box.overlaps(box)) continue;
    if (node.first < 0) {
      if (!visit(-node.first - 1)) return;
      continue;
    }
    waiting[idx(count++)] = node.first + 1;
    waiting[idx(count++)] = node.first;
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

void TriangleTree::near(const TriangleTree& other, const Transform& X, double reach,
                        std::vector<std::pair<int, int>>& found) const {
  found.clear();
  const Turned there(X, reach), back(X.inverse(), reach);
  // Two nodes, and the box of each in the axes of the other.
  struct Two {
    int i, j;
    Box farHere, nodeThere;
  };
  std::array<Two, 2 * kWaiting> waiting;
  int count = 0;
  const auto wait = [&](const Two& two) {
    if (two.farHere.overlaps(nodes_[idx(two.i)].box) &&
        two.nodeThere.overlaps(other.nodes_[idx(two.j)].box))
      waiting[idx(count++)] = two;
  };
  wait({0, 0, there(other.nodes_[0].box), back(nodes_[0].box)});
  while (count > 0) {
    const Two two = waiting[idx(--count)];
    const Node &node = nodes_[idx(two.i)], &far = other.nodes_[idx(two.j)];
    if (node.first < 0 && far.first < 0) {
      found.push_back({-node.first - 1, -far.first - 1});
      continue;
    }
    const bool goDown =
        far.first < 0 || (node.first >= 0 && (node.box.upper - node.box.lower).squaredNorm() >
                                                 (far.box.upper - far.box.lower).squaredNorm());
    for (const int next : {1, 0}) {
      if (goDown)
        wait({node.first + next, two.j, two.farHere, back(nodes_[idx(node.first + next)].box)});
      else
        wait({two.i, far.first + next, there(other.nodes_[idx(far.first + next)].box),
              two.nodeThere});
    }
  }
}

bool TriangleTree::anyWithin(const Box& box) const {
  bool any = false;
  walk(box, [&](int) {
    any = true;
    return false;
  });
  return any;
}

}  // namespace softgauss::collision::detail
