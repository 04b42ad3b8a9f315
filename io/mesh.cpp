// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/mesh_file.hpp"
#include "softgauss/io/detail/mesh_import.hpp"
#include "softgauss/io/detail/mesh_points.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io {
namespace {

void scale(Mesh& mesh, const Vector3& factors) {
  for (Vector3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(factors);
  if (factors.prod() < 0.0)
    for (std::array<int, 3>& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace

Mesh readMesh(const std::filesystem::path& path, const Vector3& factors, std::uintmax_t largest) {
  const detail::MeshFile file = detail::loadMeshFile(path, largest);
  if (file.format == ".obj") detail::checkObj(file);
  if (file.format == ".dae") detail::checkDae(file);
  Mesh mesh = detail::importMesh(file, largest);
  detail::joinRoundedPoints(mesh);
  mesh.file = path.string();
  if (mesh.triangles.empty()) detail::failMesh(path, "holds no triangle");
  scale(mesh, factors);
  for (const Vector3& vertex : mesh.vertices)
    if (!(vertex.cwiseAbs().maxCoeff() <= detail::kLargestNumber))
      detail::failMesh(path, fmt::format("has a coordinate of {:g} m, expected at most {:g}",
                                         vertex.cwiseAbs().maxCoeff(), detail::kLargestNumber));
  if (const std::uintmax_t most = std::max(largest, kLargestMesh) / kBytesOfTriangle;
      mesh.triangles.size() > most)
    detail::failMesh(path, fmt::format("has {} triangles, expected at most {}; simplify it, or "
                                       "--largest-mesh allows more",
                                       mesh.triangles.size(), most));
  return mesh;
}

std::shared_ptr<const Mesh> MeshCache::get(const std::filesystem::path& file,
                                           const Vector3& factors) {
  std::shared_ptr<const Mesh>& scaled = scaled_[{file, {factors.x(), factors.y(), factors.z()}}];
  if (scaled) return scaled;
  std::shared_ptr<const Mesh>& original = files_[file];
  if (!original) original = std::make_shared<const Mesh>(readMesh(file, Vector3::Ones(), largest_));
  if (factors == Vector3::Ones()) return scaled = original;
  Mesh copy = *original;
  scale(copy, factors);
  return scaled = std::make_shared<const Mesh>(std::move(copy));
}

std::vector<std::filesystem::path> MeshCache::files() const {
  std::vector<std::filesystem::path> files;
  for (const auto& [file, mesh] : files_) files.push_back(file);
  return files;
}

}  // namespace softgauss::io
