// SPDX-License-Identifier: Apache-2.0
#include "engine/model/closed_surface.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace softgauss {
namespace {

const Vector3& corner(const Mesh& mesh, int vertex) {
  return mesh.vertices[static_cast<std::size_t>(vertex)];
}

/// Of each edge {lower, higher vertex}, how often it is run through upwards and downwards.
std::map<std::pair<int, int>, std::pair<int, int>> edgesOf(const Mesh& mesh) {
  std::map<std::pair<int, int>, std::pair<int, int>> edges;
  for (const std::array<int, 3>& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      if (from == to) continue;  // of a triangle without area
      auto& [up, down] = edges[std::minmax(from, to)];
      ++(from < to ? up : down);
    }
  return edges;
}

/// Triangles that share vertices.
struct Shell {
  double volume = 0.0;  ///< six times
  Eigen::AlignedBox3d box;
};

std::vector<Shell> shellsOf(const Mesh& mesh) {
  std::vector<int> above(mesh.vertices.size());
  std::iota(above.begin(), above.end(), 0);
  const auto root = [&](int v) {
    while (above[static_cast<std::size_t>(v)] != v)
      v = above[static_cast<std::size_t>(v)] =
          above[static_cast<std::size_t>(above[static_cast<std::size_t>(v)])];
    return v;
  };
  for (const std::array<int, 3>& t : mesh.triangles)
    for (const int vertex : {t[1], t[2]})
      above[static_cast<std::size_t>(root(vertex))] = root(t[0]);
  std::map<int, Shell> shells;
  for (const std::array<int, 3>& t : mesh.triangles) {
    Shell& shell = shells[root(t[0])];
    // From a point of the shell itself, so that far away nothing cancels.
    const Vector3 origin = corner(mesh, root(t[0]));
    const Vector3 a = corner(mesh, t[0]) - origin, b = corner(mesh, t[1]) - origin,
                  c = corner(mesh, t[2]) - origin;
    shell.volume += a.dot(b.cross(c));
    for (const int vertex : t) shell.box.extend(corner(mesh, vertex));
  }
  std::vector<Shell> all;
  for (const auto& [vertex, shell] : shells) all.push_back(shell);
  return all;
}

}  // namespace

SurfaceDefects surfaceDefects(const Mesh& mesh) {
  SurfaceDefects defects;
  for (const auto& [edge, runs] : edgesOf(mesh)) {
    const auto& [up, down] = runs;
    if (up != down) ++((up + down) % 2 == 1 ? defects.openEdges : defects.turnedEdges);
  }
  if (defects.any()) return defects;
  const std::vector<Shell> shells = shellsOf(mesh);
  for (const Shell& shell : shells) {
    const bool isCavity = std::any_of(shells.begin(), shells.end(), [&](const Shell& other) {
      return other.volume > 0.0 && other.box.contains(shell.box);
    });
    if (shell.volume < 0.0 && !isCavity) ++defects.insideOutShells;
  }
  return defects;
}

}  // namespace softgauss
