// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The triangles of a hierarchy that are nearest to a box, or to those of another hierarchy: depth
/// first, the nearer child first, leaving out what is farther than the best so far.

#include <algorithm>
#include <array>

#include "softgauss/collision/detail/fcl_triangle_tree.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision::detail {

/// Distance of two boxes, squared [m²]; 0 where they overlap.
inline double gapSquared(const Box& a, const Box& b) {
  return (a.lower - b.upper).cwiseMax(b.lower - a.upper).cwiseMax(0.0).squaredNorm();
}

/// Calls exact(triangle, best), which returns the distance of a triangle or anything ≥ best, for
/// those that may be nearer to what is within `box` than `best`. Returns the least.
template <class Exact>
double nearestTriangle(const TriangleTree& tree, const Box& box, double best, Exact&& exact) {
  struct Waiting {
    int node;
    double gap2;
  };
  std::array<Waiting, TriangleTree::kDepth + 1> waiting;
  const auto& nodes = tree.nodes();
  int count = 0;
  waiting[idx(count++)] = {0, gapSquared(nodes[0].box, box)};
  while (count > 0 && best > 0.0) {
    const auto [at, gap2] = waiting[idx(--count)];
    if (gap2 >= best * best) continue;
    const int first = nodes[idx(at)].first;
    if (first < 0) {
      best = std::min(best, exact(-first - 1, best));
      continue;
    }
    Waiting near{first, gapSquared(nodes[idx(first)].box, box)};
    Waiting far{first + 1, gapSquared(nodes[idx(first + 1)].box, box)};
    if (far.gap2 < near.gap2) std::swap(near, far);
    waiting[idx(count++)] = far;
    waiting[idx(count++)] = near;
  }
  return best;
}

/// The same for pairs of a triangle of this tree and one of another at pose X in the axes of this:
/// exact(triangle, other, best).
template <class Exact>
double nearestTriangles(const TriangleTree& tree, const TriangleTree& other, const Transform& X,
                        double best, Exact&& exact) {
  struct Waiting {
    int i, j;
    double gap2;
  };
  const Matrix3 extent = X.R.cwiseAbs();
  const auto turned = [&](const Box& box) -> Box {
    const Vector3 centre = X * Vector3(0.5 * (box.lower + box.upper));
    const Vector3 half = 0.5 * (extent * (box.upper - box.lower));
    return {centre - half, centre + half};
  };
  std::array<Waiting, 2 * TriangleTree::kDepth + 1> waiting;
  const auto &nodes = tree.nodes(), &others = other.nodes();
  const auto pair = [&](int i, int j) -> Waiting {
    return {i, j, gapSquared(nodes[idx(i)].box, turned(others[idx(j)].box))};
  };
  int count = 0;
  waiting[idx(count++)] = pair(0, 0);
  while (count > 0 && best > 0.0) {
    const auto [i, j, gap2] = waiting[idx(--count)];
    if (gap2 >= best * best) continue;
    const TriangleTree::Node &node = nodes[idx(i)], &far = others[idx(j)];
    if (node.first < 0 && far.first < 0) {
      best = std::min(best, exact(-node.first - 1, -far.first - 1, best));
      continue;
    }
    const bool goDown =
        far.first < 0 || (node.first >= 0 && (node.box.upper - node.box.lower).squaredNorm() >
                                                 (far.box.upper - far.box.lower).squaredNorm());
    Waiting one = goDown ? pair(node.first, j) : pair(i, far.first);
    Waiting two = goDown ? pair(node.first + 1, j) : pair(i, far.first + 1);
    if (two.gap2 < one.gap2) std::swap(one, two);
    waiting[idx(count++)] = two;
    waiting[idx(count++)] = one;
  }
  return best;
}

}  // namespace softgauss::collision::detail
