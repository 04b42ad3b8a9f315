// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/mesh_import.hpp"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstring>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/child_process.hpp"
#include "softgauss/io/printable.hpp"

namespace softgauss {

template <class Archive>
void archive(Archive& a, MeshPart& part) {
  auto& [firstTriangle, triangles, rgba] = part;
  a(firstTriangle, triangles, rgba);
}

namespace io {

template <class Archive>
void archive(Archive& a, MeshImages::Image& image) {
  a(image.file);
}

template <class Archive>
void archive(Archive& a, MeshImages& images) {
  a(images.images, images.ofPart, images.places);
}

}  // namespace io

}  // namespace softgauss

namespace softgauss::io::detail {
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
  /// `images`: null where nobody looks.
  Collector(const aiScene& scene, Mesh& mesh, MeshImages* images)
      : scene_(scene), mesh_(mesh), images_(images) {}

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
      for (unsigned k = 0; images_ && k < 3; ++k)
        images_->places.push_back(place(part, face.mIndices[k]));
    }
    const aiMaterial& material = *scene_.mMaterials[part.mMaterialIndex];
    const std::optional<Eigen::Vector4d> rgba = colour(material);
    if (!rgba || mesh_.triangles.size() == first) return;
    mesh_.parts.push_back(
        {static_cast<int>(first), static_cast<int>(mesh_.triangles.size() - first), *rgba});
    if (images_) images_->ofPart.push_back(part.HasTextureCoords(0) ? image(material) : -1);
  }

  static std::array<float, 2> place(const aiMesh& part, unsigned corner) {
    if (!part.HasTextureCoords(0)) return {0.0f, 0.0f};
    const aiVector3D& uv = part.mTextureCoords[0][corner];
    return {uv.x, uv.y};
  }

  /// The index of the material's image, −1 without one.
  int image(const aiMaterial& material) {
    aiString file;
    if (material.GetTexture(aiTextureType_DIFFUSE, 0, &file) != AI_SUCCESS) return -1;
    std::vector<MeshImages::Image>& all = images_->images;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const auto& image) { return image.file == file.C_Str(); });
    const auto index = static_cast<int>(found - all.begin());
    if (found == all.end()) all.push_back({file.C_Str(), {}});
    return index;
  }

  /// The diffuse colour that the file gives; nothing where assimp made the material up.
  static std::optional<Eigen::Vector4d> colour(const aiMaterial& material) {
    aiString name;
    if (material.Get(AI_MATKEY_NAME, name) == AI_SUCCESS &&
        std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME)
      return std::nullopt;
    aiColor4D diffuse;
    if (material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) != AI_SUCCESS) return std::nullopt;
    float opacity = diffuse.a;  // as glTF has it; what the other formats say of it counts alone
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
  MeshImages* images_;
  std::unordered_map<std::array<double, 3>, int, CornerHash> index_;
};

/// Bytes as a file that is open for reading.
class BytesStream : public Assimp::IOStream {
 public:
  explicit BytesStream(std::string bytes) : own_(std::move(bytes)), bytes_(own_) {}
  explicit BytesStream(std::string_view bytes) : bytes_(bytes) {}
  BytesStream(const BytesStream&) = delete;
  BytesStream& operator=(const BytesStream&) = delete;

  std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(buffer, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : bytes_.size();
    if (offset > bytes_.size() - from) return aiReturn_FAILURE;
    at_ = from + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string own_;
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// The files that assimp sees: the mesh, which is in memory, and regular files of bounded size.
class Files : public Assimp::IOSystem {
 public:
  Files(const MeshFile& mesh, std::uintmax_t largest) : mesh_(mesh), largest_(largest) {}

  bool Exists(const char* name) const override {
    std::error_code ignored;
    return name == mesh_.path.string() || std::filesystem::is_regular_file(name, ignored);
  }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    if (name == mesh_.path.string()) return new BytesStream(std::string_view(mesh_.text));
    try {
      return new BytesStream(readMeshBytes(name, largest_));
    } catch (const ModelError&) {
      return nullptr;  // assimp goes on without what it cannot open
    }
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  const MeshFile& mesh_;
  std::uintmax_t largest_;
};

/// Why the file cannot be read, or nothing.
std::string import(const MeshFile& file, std::uintmax_t largest, Mesh& mesh,
                   MeshImages* images = nullptr) {
  Assimp::Importer importer;
  importer.SetIOHandler(new Files(file, largest));  // which it deletes
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene =
      importer.ReadFile(file.path.string(), aiProcess_Triangulate | aiProcess_SortByPType);
  if (!scene || !scene->mRootNode)
    return fmt::format("cannot be read: {}", printable(importer.GetErrorString()));
  Collector(*scene, mesh, images).add(*scene->mRootNode, aiMatrix4x4());
  return {};
}

// ---- A mesh as bytes, from a child of this process to it

// What comes of a file that has broken the importer may be anything, and is read as such.

bool fits(const Mesh& mesh) {
  const auto within = [](int i, std::size_t size) {
    return i >= 0 && static_cast<std::size_t>(i) < size;
  };
  for (const std::array<int, 3>& triangle : mesh.triangles)
    for (const int vertex : triangle)
      if (!within(vertex, mesh.vertices.size())) return false;
  for (const MeshPart& part : mesh.parts)
    if (!within(part.firstTriangle, mesh.triangles.size()) || part.triangles < 0 ||
        static_cast<std::size_t>(part.triangles) >
            mesh.triangles.size() - static_cast<std::size_t>(part.firstTriangle))
      return false;
  return true;
}

bool fits(const Mesh& mesh, const MeshImages& images) {
  const auto count = static_cast<int>(images.images.size());
  return images.ofPart.size() == mesh.parts.size() &&
         images.places.size() == 3 * mesh.triangles.size() &&
         std::all_of(images.ofPart.begin(), images.ofPart.end(),
                     [&](int image) { return image >= -1 && image < count; });
}

std::string bytesOf(const MeshFile& file, std::uintmax_t largest, bool withImages) {
  Mesh mesh;
  MeshImages images;
  const std::string problem = import(file, largest, mesh, withImages ? &images : nullptr);
  ByteWriter bytes;
  bytes(problem, mesh.vertices, mesh.triangles, mesh.parts, images);
  return bytes.bytes();
}

/// By a child of this process. Throws ModelError.
std::pair<Mesh, MeshImages> importInChild(const MeshFile& file, std::uintmax_t largest,
                                          bool withImages) {
  Mesh mesh;
  MeshImages images;
  const ChildResult child = runInChild([&] { return bytesOf(file, largest, withImages); }, {});
  std::string problem, failure = child.failure;
  try {
    ByteReader bytes(child.bytes);
    if (failure.empty()) bytes(problem, mesh.vertices, mesh.triangles, mesh.parts, images);
    bytes.expect(fits(mesh) && (!withImages || !problem.empty() || fits(mesh, images)));
  } catch (const BytesError&) {
    failure = "loses its way";
  }
  if (!failure.empty())
    failMesh(file.path,
             fmt::format("cannot be read: the importer {}; try .stl, or a mesh tool that "
                         "writes the file anew",
                         failure));
  if (!problem.empty()) failMesh(file.path, problem);
  return {std::move(mesh), std::move(images)};
}

}  // namespace

Mesh importMesh(const MeshFile& file, std::uintmax_t largest) {
  if (file.format == ".stl") {
    Mesh mesh;
    if (const std::string problem = import(file, largest, mesh); !problem.empty())
      failMesh(file.path, problem);
    return mesh;
  }
  return importInChild(file, largest, false).first;
}

std::pair<Mesh, MeshImages> importWithImages(const MeshFile& file, std::uintmax_t largest) {
  return importInChild(file, largest, true);
}

}  // namespace softgauss::io::detail
