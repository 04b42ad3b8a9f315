// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mesh_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/mesh_file.hpp"
#include "softgauss/io/detail/mesh_import.hpp"

namespace softgauss::io {
namespace {

namespace fs = std::filesystem;

/// Whether it is worth a second look: files without images are many.
bool mayHaveImages(const detail::MeshFile& file) {
  const auto has = [&](const char* text) { return file.text.find(text) != std::string::npos; };
  if (file.format == ".dae") return has("<texture");
  return file.format == ".obj" && has("mtllib") && has("vt ");
}

/// Where a file that a mesh names is.
fs::path placeOf(const Mesh& mesh, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return fs::path(mesh.file).parent_path() / name;
}

/// The bytes of an image. Throws ModelError.
std::string imageBytes(const fs::path& path, std::uintmax_t largest) {
  std::string bytes = detail::readMeshBytes(path, largest);
  if (!imageType(bytes)) detail::failMesh(path, "found neither PNG nor JPEG, expected one of them");
  return bytes;
}

/// A mirrored mesh has its triangles turned, and so its corners.
void turnAs(const Mesh& mesh, const std::vector<std::array<int, 3>>& asRead, MeshImages& images) {
  for (std::size_t t = 0; t < asRead.size(); ++t)
    if (mesh.triangles[t][1] != asRead[t][1])
      std::swap(images.places[3 * t + 1], images.places[3 * t + 2]);
}

MeshImages read(const Mesh& mesh, std::uintmax_t largest) {
  const detail::MeshFile file = detail::loadMeshFile(mesh.file, largest);
  if (!mayHaveImages(file)) return {};
  if (file.format == ".obj") detail::checkObj(file);
  if (file.format == ".dae") detail::checkDae(file);
  auto [again, images] = detail::importWithImages(file, largest);
  if (again.triangles.size() != mesh.triangles.size() || again.parts.size() != mesh.parts.size())
    detail::failMesh(mesh.file, "has changed since it was read");
  turnAs(mesh, again.triangles, images);
  for (std::size_t i = 0; i < images.images.size(); ++i) {
    MeshImages::Image& image = images.images[i];
    const fs::path path = placeOf(mesh, image.file);
    image.file = path.string();
    try {
      image.bytes = imageBytes(path, largest);
    } catch (const ModelError& error) {
      images.notShown.push_back(fmt::format("an image of {}: {}", mesh.file, error.what()));
      std::replace(images.ofPart.begin(), images.ofPart.end(), static_cast<int>(i), -1);
    }
  }
  return std::move(images);
}

}  // namespace

const char* imageType(const std::string& bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
  return nullptr;
}

MeshImages imagesOf(const Mesh& mesh, std::uintmax_t largest) {
  if (mesh.file.empty() || mesh.parts.empty()) return {};
  try {
    return read(mesh, largest);
  } catch (const ModelError& error) {
    MeshImages none;
    none.notShown.push_back(fmt::format("images of {}: {}", mesh.file, error.what()));
    return none;
  }
}

}  // namespace softgauss::io
