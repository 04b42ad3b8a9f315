// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Thins the points of a shape on a surface to those that carry as well as all.
///
/// Points whose normals are nearly one are a neighbourhood. Pressure can rest anywhere in the
/// convex hull of its points, so the points inside the rim of that hull, seen along the normal, add
/// nothing, and of those on the rim addReduced() (contact_reduction.hpp) keeps four. A point that
/// is clearly deeper than these stays too. What stays depends on the points and their order alone.

#include <vector>

#include "softgauss/collision/pair_contact.hpp"

namespace softgauss::collision::detail {

/// Keeps its memory from call to call.
class SurfaceReduction {
 public:
  /// Of `points`, with distance < margin, leaves those that stay; returns how many went. `size` [m]
  /// is that of the shape: points that are far nearer to each other are one.
  int reduce(std::vector<PairContact>& points, double margin, double size);

 private:
  /// A point seen along the normal.
  struct Seen {
    double x, y;
    int index;
  };
  void takeNeighbourhood(const std::vector<PairContact>& points, std::size_t first);
  void findRim(const std::vector<PairContact>& points, const Vector3& n);
  void keep(const std::vector<PairContact>& points, const Vector3& n, double margin, double apart);

  std::vector<char> taken_;
  std::vector<int> members_;
  std::vector<Seen> seen_, rim_;
  std::vector<PairContact> kept_;
};

}  // namespace softgauss::collision::detail
