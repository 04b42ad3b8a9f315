// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/mesh_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

namespace softgauss::io::detail {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::size_t h = 0;
    for (const std::int64_t x : cell) h = h * 1000003u ^ std::hash<std::int64_t>{}(x);
    return h;
  }
};

/// Points that are kept, in cells of twice the distance from which points are two.
class KeptPoints {
 public:
  explicit KeptPoints(double apart) : apart_(apart) {}

  std::vector<Vector3> points;

  /// The index of the first point that is as good as x, which else is kept.
  int indexOf(const Vector3& x) {
    const Vector3 scaled = x / (2.0 * apart_);
    Cell own, beside;  // the cell of x, and the one that it is nearer to in each coordinate
    for (int i = 0; i < 3; ++i) {
      own[at(i)] = static_cast<std::int64_t>(std::floor(scaled[i]));
      beside[at(i)] = own[at(i)] + (scaled[i] - std::floor(scaled[i]) < 0.5 ? -1 : 1);
    }
    int found = std::numeric_limits<int>::max();
    for (int corner = 0; corner < 8; ++corner) {
      Cell cell;
      for (int i = 0; i < 3; ++i) cell[at(i)] = (corner >> i & 1) != 0 ? beside[at(i)] : own[at(i)];
      const auto here = cells_.find(cell);
      if (here == cells_.end()) continue;
      for (const int kept : here->second)
        if ((points[at(kept)] - x).cwiseAbs().maxCoeff() <= apart_) found = std::min(found, kept);
    }
    if (found < static_cast<int>(points.size())) return found;
    points.push_back(x);
    cells_[own].push_back(static_cast<int>(points.size()) - 1);
    return static_cast<int>(points.size()) - 1;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  double apart_;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

}  // namespace

void joinRoundedPoints(Mesh& mesh) {
  double size = 0.0;
  for (const Vector3& x : mesh.vertices) {
    if (!x.allFinite()) return;  // whoever reads the mesh refuses it
    size = std::max(size, x.cwiseAbs().maxCoeff());
  }
  const double apart = size * static_cast<double>(std::numeric_limits<float>::epsilon());
  if (!(apart > 0.0)) return;
  KeptPoints kept(apart);
  std::vector<int> place;
  place.reserve(mesh.vertices.size());
  for (const Vector3& x : mesh.vertices) place.push_back(kept.indexOf(x));
  if (kept.points.size() == mesh.vertices.size()) return;
  for (std::array<int, 3>& triangle : mesh.triangles)
    for (int& vertex : triangle) vertex = place[static_cast<std::size_t>(vertex)];
  mesh.vertices = std::move(kept.points);
}

}  // namespace softgauss::io::detail
