// SPDX-License-Identifier: Apache-2.0
#include "io/mesh.hpp"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "engine/core/check.hpp"
#include "io/detail/text.hpp"

namespace softgauss::io {
namespace {

struct CornerHash {
  std::size_t operator()(const std::array<double, 3>& x) const {
    std::size_t h = 0;
    for (const double value : x) h = h * 1000003u ^ std::hash<double>{}(value);
    return h;
  }
};

/// Gathers the triangles of a scene in one mesh, in the coordinates of the file.
class Collector {
 public:
  Collector(const aiScene& scene, Mesh& mesh) : scene_(scene), mesh_(mesh) {}

  void add(const aiNode& node, const aiMatrix4x4& X_FileParent) {
    const aiMatrix4x4 X_FileNode = X_FileParent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      add(*scene_.mMeshes[node.mMeshes[i]], X_FileNode);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], X_FileNode);
  }

 private:
  void add(const aiMesh& part, const aiMatrix4x4& X_FileNode) {
    const std::size_t first = mesh_.triangles.size();
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;
      std::array<int, 3> triangle;
      for (unsigned k = 0; k < 3; ++k)
        triangle[k] = vertex(X_FileNode * part.mVertices[face.mIndices[k]]);
      mesh_.triangles.push_back(triangle);
    }
    const std::optional<Eigen::Vector4d> rgba = colour(*scene_.mMaterials[part.mMaterialIndex]);
    if (rgba && mesh_.triangles.size() > first)
      mesh_.parts.push_back(
          {static_cast<int>(first), static_cast<int>(mesh_.triangles.size() - first), *rgba});
  }

  /// The diffuse colour that the file gives; nothing where assimp made the material up.
  static std::optional<Eigen::Vector4d> colour(const aiMaterial& material) {
    aiString name;
    if (material.Get(AI_MATKEY_NAME, name) == AI_SUCCESS &&
        std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME)
      return std::nullopt;
    aiColor4D diffuse;
    if (material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) != AI_SUCCESS) return std::nullopt;
    float opacity = 1.0f;
    material.Get(AI_MATKEY_OPACITY, opacity);
    return Eigen::Vector4d(diffuse.r, diffuse.g, diffuse.b, opacity);
  }

  int vertex(const aiVector3D& corner) {
    // Adding zero makes one of the two zeros.
    const std::array<double, 3> x = {static_cast<double>(corner.x) + 0.0,
                                     static_cast<double>(corner.y) + 0.0,
                                     static_cast<double>(corner.z) + 0.0};
    const auto [it, isNew] = index_.try_emplace(x, static_cast<int>(mesh_.vertices.size()));
    if (isNew) mesh_.vertices.emplace_back(x[0], x[1], x[2]);
    return it->second;
  }

  const aiScene& scene_;
  Mesh& mesh_;
  std::unordered_map<std::array<double, 3>, int, CornerHash> index_;
};

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& problem) {
  throw ModelError({file.string(), 0}, "mesh", problem);
}

/// A letter of A to Z made small.
char small(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// The extension; keeps assimp from guessing a format by the content of a file that is something
/// else.
std::string formatOf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), small);
  if (extension != ".stl" && extension != ".obj" && extension != ".dae")
    fail(file, fmt::format("unknown format '{}', expected .stl, .obj or .dae", extension));
  return extension;
}

/// The text of an ASCII STL in small letters, which assimp's reader wants; nothing for other files.
std::optional<std::string> smallStl(const std::filesystem::path& file) {
  std::optional<std::string> text = detail::readFile(file.string());
  // A binary one holds zero bytes, whatever it begins with.
  if (!text || text->find('\0') != std::string::npos) return std::nullopt;
  std::transform(text->begin(), text->end(), text->begin(), small);
  const std::size_t begin = text->find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || text->compare(begin, 5, "solid") != 0) return std::nullopt;
  return text->substr(begin);
}

void scale(Mesh& mesh, const Vector3& factors) {
  for (Vector3& vertex : mesh.vertices) vertex = vertex.cwiseProduct(factors);
  if (factors.prod() < 0.0)
    for (std::array<int, 3>& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace

Mesh readMesh(const std::filesystem::path& file, const Vector3& factors) {
  const std::string format = formatOf(file);
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_SortByPType;
  std::optional<std::string> text;
  if (format == ".stl") text = smallStl(file);
  const aiScene* scene =
      text ? importer.ReadFileFromMemory(text->data(), text->size(), kSteps, "stl")
           : importer.ReadFile(file.string(), kSteps);
  if (!scene || !scene->mRootNode)
    fail(file, fmt::format("cannot be read: {}", importer.GetErrorString()));

  Mesh mesh;
  mesh.file = file.string();
  Collector(*scene, mesh).add(*scene->mRootNode, aiMatrix4x4());
  if (mesh.triangles.empty()) fail(file, "holds no triangle");
  scale(mesh, factors);
  for (const Vector3& vertex : mesh.vertices)
    if (!vertex.allFinite()) fail(file, "has a coordinate that is not finite");
  return mesh;
}

std::shared_ptr<const Mesh> MeshCache::get(const std::filesystem::path& file,
                                           const Vector3& factors) {
  std::shared_ptr<const Mesh>& scaled = scaled_[{file, {factors.x(), factors.y(), factors.z()}}];
  if (scaled) return scaled;
  std::shared_ptr<const Mesh>& original = files_[file];
  if (!original) original = std::make_shared<const Mesh>(readMesh(file));
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
