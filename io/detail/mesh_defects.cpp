// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/mesh_defects.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

std::string place(const Mesh& mesh, int vertex) {
  const Vector3& x = mesh.vertices[idx(vertex)];
  return fmt::format("({} {} {})", shortNumber(x.x()), shortNumber(x.y()), shortNumber(x.z()));
}

std::string triangle(const Mesh& mesh, int index) {
  const std::array<int, 3>& t = mesh.triangles[idx(index)];
  return fmt::format("triangle {}, {} {} {}", index + 1, place(mesh, t[0]), place(mesh, t[1]),
                     place(mesh, t[2]));
}

}  // namespace

std::vector<std::string> describeDefects(const Mesh& mesh, const SurfaceDefects& defects) {
  std::vector<std::string> found;
  const auto add = [&](int count, const char* noun, const char* what, const std::string& first) {
    if (count > 0)
      found.push_back(
          fmt::format("{} {} ({})", counted(static_cast<std::size_t>(count), noun), what, first));
  };
  if (defects.openEdges > 0)
    add(defects.openEdges, "edge", "at holes",
        fmt::format("the first from {} to {}", place(mesh, defects.openEdge[0]),
                    place(mesh, defects.openEdge[1])));
  if (defects.turnedEdges > 0)
    add(defects.turnedEdges, "edge", "between triangles that face opposite sides",
        "most of them about " + triangle(mesh, defects.turnedTriangle));
  if (defects.insideOutShells > 0)
    add(defects.insideOutShells, "shell", "of triangles that face inwards",
        "one with " + triangle(mesh, defects.insideOutTriangle));
  return found;
}

void UnsoundHulls::look(const Mesh& mesh, const std::string& owner) {
  const SurfaceDefects defects = surfaceDefects(mesh);
  if (defects.openEdges + defects.turnedEdges == 0) return;
  found_.push_back(fmt::format("{} ({}: {})", owner,
                               std::filesystem::path(mesh.file).filename().string(),
                               listed(describeDefects(mesh, defects))));
}

void UnsoundHulls::appendTo(std::vector<std::string>& warnings) const {
  if (!found_.empty())
    warnings.push_back(
        "collide as the convex hulls of meshes that are not closed, or whose triangles face mixed "
        "sides: " +
        listed(found_, 6));
}

}  // namespace softgauss::io::detail
