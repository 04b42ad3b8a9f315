// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/closed_surface.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "softgauss/engine/core/index.hpp"

namespace softgauss {
namespace {

/// A triangle runs through an edge.
struct Run {
  int low, high;  ///< vertices
  bool upwards;   ///< from the lower to the higher one
  int triangle;
};

/// Sorted by edge, then by triangle.
std::vector<Run> runsOf(const Mesh& mesh) {
  std::vector<Run> runs;
  runs.reserve(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = mesh.triangles[i][k], to = mesh.triangles[i][(k + 1) % 3];
      if (from == to) continue;  // of a triangle without area
      runs.push_back({std::min(from, to), std::max(from, to), from < to, static_cast<int>(i)});
    }
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return runs;
}

void findEdges(const Mesh& mesh, SurfaceDefects& defects) {
  const std::vector<Run> runs = runsOf(mesh);
  std::vector<int> turnedEdges(mesh.triangles.size(), 0);  // of each triangle
  for (std::size_t first = 0, end = 0; first < runs.size(); first = end) {
    int surplus = 0;
    for (end = first; end < runs.size() && runs[end].low == runs[first].low &&
                      runs[end].high == runs[first].high;
         ++end)
      surplus += runs[end].upwards ? 1 : -1;
    if (surplus == 0) continue;
    if ((end - first) % 2 == 1) {
      if (defects.openEdges++ > 0) continue;
      defects.openEdge[0] = runs[first].low;
      defects.openEdge[1] = runs[first].high;
    } else {
      ++defects.turnedEdges;
      for (std::size_t i = first; i < end; ++i) ++turnedEdges[idx(runs[i].triangle)];
    }
  }
  if (defects.turnedEdges > 0)
    defects.turnedTriangle = static_cast<int>(
        std::max_element(turnedEdges.begin(), turnedEdges.end()) - turnedEdges.begin());
}

/// Triangles that share vertices.
struct Shell {
  int triangle = -1;    ///< the first
  double volume = 0.0;  ///< six times
  Eigen::AlignedBox3d box;
};

std::vector<Shell> shellsOf(const Mesh& mesh) {
  std::vector<int> above(mesh.vertices.size());
  std::iota(above.begin(), above.end(), 0);
  const auto root = [&](int v) {
    while (above[idx(v)] != v) v = above[idx(v)] = above[idx(above[idx(v)])];
    return v;
  };
  for (const std::array<int, 3>& t : mesh.triangles)
    for (const int vertex : {t[1], t[2]}) above[idx(root(vertex))] = root(t[0]);
  std::vector<Shell> all(mesh.vertices.size());  // at their roots
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::array<int, 3>& t = mesh.triangles[i];
    Shell& shell = all[idx(root(t[0]))];
    if (shell.triangle < 0) shell.triangle = static_cast<int>(i);
    // From a point of the shell itself, so that far away nothing cancels.
    const Vector3& origin = mesh.vertices[idx(root(t[0]))];
    const Vector3 a = mesh.vertices[idx(t[0])] - origin, b = mesh.vertices[idx(t[1])] - origin,
                  c = mesh.vertices[idx(t[2])] - origin;
    shell.volume += a.dot(b.cross(c));
    for (const int vertex : t) shell.box.extend(mesh.vertices[idx(vertex)]);
  }
  std::erase_if(all, [](const Shell& shell) { return shell.triangle < 0; });
  return all;
}

void findShells(const Mesh& mesh, SurfaceDefects& defects) {
  std::vector<Shell> solid, inwards;
  for (const Shell& shell : shellsOf(mesh)) (shell.volume > 0.0 ? solid : inwards).push_back(shell);
  // The largest first: what has a cavity is found soon.
  std::stable_sort(solid.begin(), solid.end(),
                   [](const Shell& a, const Shell& b) { return a.volume > b.volume; });
  for (const Shell& shell : inwards) {
    const bool isCavity = std::any_of(solid.begin(), solid.end(), [&](const Shell& other) {
      return other.box.contains(shell.box);
    });
    if (shell.volume < 0.0 && !isCavity && defects.insideOutShells++ == 0)
      defects.insideOutTriangle = shell.triangle;
  }
}

}  // namespace

SurfaceDefects surfaceDefects(const Mesh& mesh) {
  SurfaceDefects defects;
  findEdges(mesh, defects);
  if (!defects.any()) findShells(mesh, defects);
  return defects;
}

}  // namespace softgauss
