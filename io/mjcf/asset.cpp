// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/asset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/height_field.hpp"
#include "softgauss/io/mjcf/mesh_mass.hpp"
#include "softgauss/io/mjcf/msh.hpp"
#include "softgauss/io/mjcf/pose.hpp"

namespace softgauss::io::mjcf {
namespace {

template <class Map>
std::string offeredOf(const std::string& name, const Map& map) {
  std::vector<std::string> names;
  for (const auto& [known, value] : map) names.push_back(known);
  return detail::offered(name, names);
}

/// The name of an asset: its own, or that of its file without folder and extension.
std::string nameOf(const Element& element) {
  const std::string name = element.has("name")
                               ? element.requiredText("name")
                               : std::filesystem::path(element.text("file")).stem().string();
  if (name.empty()) element.fail("has no name and no file, expected one of them");
  return name;
}

Mesh inlineMesh(const Element& element) {
  const std::vector<double> vertices = *element.numbers("vertex");
  const std::vector<double> faces = element.numbers("face").value_or(std::vector<double>());
  if (vertices.size() < 12 || vertices.size() % 3 != 0)
    element.fail(fmt::format("vertex has {} numbers, expected three for each of four or more",
                             vertices.size()));
  Mesh mesh;
  mesh.file = element.label();
  for (std::size_t i = 0; i < vertices.size(); i += 3)  // MuJoCo holds them in single precision
    mesh.vertices.push_back(Eigen::Vector3f(static_cast<float>(vertices[i]),
                                            static_cast<float>(vertices[i + 1]),
                                            static_cast<float>(vertices[i + 2]))
                                .cast<double>());
  if (faces.size() % 3 != 0 || faces.empty())
    element.fail(
        fmt::format("face has {} numbers, expected three for each triangle; the hull of "
                    "points without faces is not worked out",
                    faces.size()));
  for (std::size_t i = 0; i < faces.size(); i += 3) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double index = faces[i + k];
      if (!(index >= 0.0 && index < static_cast<double>(mesh.vertices.size())) ||
          index != std::floor(index))
        element.fail(fmt::format("face names the vertex {:g}, expected 0 to {}", index,
                                 mesh.vertices.size() - 1));
      triangle[k] = static_cast<int>(index);
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

constexpr double kMostElevations = 4e6;

/// size of <hfield>: half extents, elevation, base.
std::array<double, 4> sizeOf(const Element& element) {
  std::array<double, 4> size{};
  if (!element.readAll("size", size))
    element.fail("has no attribute 'size', expected four numbers");
  for (const double s : size)
    if (!(s > 0.0)) element.fail(fmt::format("size holds {:g}, expected four numbers above 0", s));
  return size;
}

}  // namespace

void MeshAttributes::read(const Element& element) {
  element.readAll("scale", scale);
  if (const auto word = element.word("inertia", {"convex", "legacy", "exact", "shell"}))
    inertia = static_cast<Inertia>(*word);
}

MassProperties MeshAsset::solid(const Element& user) const {
  if (!problem.empty())
    user.fail(fmt::format("needs the mass of {} (line {}), which {}", element.label(),
                          element.where.line, problem));
  return unit;
}

Vector3 MeshAsset::inertiaBox() const {
  const Matrix3 moments = X_FP.R.transpose() * unit.I_Gcm * X_FP.R;
  const Vector3 m = moments.diagonal();
  Vector3 half;
  for (int i = 0; i < 3; ++i)
    half[i] = 0.5 * std::sqrt(std::max(0.0, 6.0 * (m.sum() - 2.0 * m[i]) / unit.mass));
  return half;
}

std::pair<Vector3, Vector3> MeshAsset::bounds() const {
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();
  const Transform X_PF = X_FP.inverse();
  for (const Vector3& vertex : mesh->vertices) {
    low = low.cwiseMin(X_PF * vertex);
    high = high.cwiseMax(X_PF * vertex);
  }
  return {low, high};
}

void Assets::addMesh(const Element& element, MeshAttributes attributes) {
  element.expectAttributes({"name", "class", "content_type", "file", "vertex", "normal", "texcoord",
                            "face", "refpos", "refquat", "scale", "smoothnormal", "maxhullvert",
                            "inertia", "builtin", "params", "material"});
  element.expectChildren({});
  attributes.read(element);
  for (const double s : attributes.scale)
    if (s == 0.0) element.fail("scale holds 0, expected other numbers");
  if (element.has("builtin"))
    element.fail("is builtin, which is not read; expected a file, or vertex and face");
  if (element.has("file") == element.has("vertex"))
    element.fail("expected either a file, or vertex and face");
  if (!meshes_.emplace(nameOf(element), GivenMesh{element, attributes}).second)
    element.fail("has the name of another mesh, expected one of its own");
}

void Assets::addHeightField(const Element& element) {
  element.expectAttributes({"name", "content_type", "file", "nrow", "ncol", "size", "elevation"});
  element.expectChildren({});
  if (!heightFields_.emplace(nameOf(element), element).second)
    element.fail("has the name of another height field, expected one of its own");
}

void Assets::addMaterial(const Element& element, std::optional<std::array<double, 4>> rgba) {
  if (std::array<double, 4> own; element.readAll("rgba", own)) rgba = own;
  materials_[element.requiredText("name")] = rgba;
}

std::shared_ptr<const Mesh> Assets::load(const GivenMesh& given) {
  const Element& element = given.element;
  Mesh mesh;
  if (element.has("vertex")) {
    mesh = inlineMesh(element);
  } else {
    const std::filesystem::path file = compiler_.meshFile(model_, element.requiredText("file"));
    if (const std::string problem = detail::inputProblem(file.string()); !problem.empty())
      element.fail(
          fmt::format("file {} {}, expected a mesh there (STL, OBJ or MSH; from the model's "
                      "folder, in the compiler's meshdir)",
                      detail::quotedText(file.string()), problem));
    try {
      mesh = isMsh(file) ? mshMesh(file) : *cache_.get(file, Vector3::Ones());
    } catch (const ModelError& error) {
      element.fail(error.what());
    }
  }
  Vector3 refpos = Vector3::Zero();
  element.read("refpos", refpos);
  PoseAttributes turn;
  if (element.readAll("refquat", turn.quat) && turn.quat == std::array<double, 4>{})
    element.fail("refquat is zero, expected a quaternion of some length");
  const Matrix3 R = turn.pose(element, compiler_).R;
  const auto& s = given.attributes.scale;
  for (Vector3& v : mesh.vertices)
    v = (R.transpose() * (v - refpos)).cwiseProduct(Vector3(s[0], s[1], s[2]));
  if (s[0] * s[1] * s[2] < 0.0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return std::make_shared<const Mesh>(std::move(mesh));
}

Mesh Assets::mshMesh(const std::filesystem::path& file) {
  Mesh mesh = readMsh(file, largestMesh_);
  otherFiles_.push_back(file);
  return mesh;
}

const MeshAsset& Assets::mesh(const std::string& name, const Element& user) {
  if (const auto known = read_.find(name); known != read_.end()) return known->second;
  const auto given = meshes_.find(name);
  if (given == meshes_.end())
    user.fail(fmt::format("mesh {} does not exist{}", detail::quotedText(name),
                          offeredOf(name, meshes_)));
  MeshAsset& asset = read_[name];
  asset.element = given->second.element;
  asset.inertia = given->second.attributes.inertia;
  asset.mesh = load(given->second);
  weighMesh(asset);
  return asset;
}

std::shared_ptr<const Mesh> Assets::visualMesh(const std::string& name, const Element& user) {
  if (readVisuals_) return mesh(name, user).mesh;
  const auto given = meshes_.find(name);
  if (given == meshes_.end())
    user.fail(fmt::format("mesh {} does not exist{}", detail::quotedText(name),
                          offeredOf(name, meshes_)));
  Mesh mesh;
  mesh.file = given->second.element.has("file")
                  ? compiler_.meshFile(model_, given->second.element.text("file")).string()
                  : given->second.element.label();
  return std::make_shared<const Mesh>(std::move(mesh));
}

std::shared_ptr<const Mesh> Assets::heightField(const std::string& name, const Element& user) {
  if (const auto known = landscapes_.find(name); known != landscapes_.end()) return known->second;
  const auto given = heightFields_.find(name);
  if (given == heightFields_.end())
    user.fail(fmt::format("height field {} does not exist{}", detail::quotedText(name),
                          offeredOf(name, heightFields_)));
  const Element& element = given->second;
  const std::array<double, 4> size = sizeOf(element);
  Heights heights;
  if (element.has("file")) {
    const std::filesystem::path file = compiler_.meshFile(model_, element.requiredText("file"));
    if (file.extension() != ".png")
      element.fail(
          fmt::format("file {} is no .png, and MuJoCo's own format is not read; expected a "
                      "grey .png, or nrow, ncol and elevation",
                      detail::quotedText(file.string())));
    try {
      heights = readHeights(file, PngLevels::red);  // of colours, as MuJoCo
    } catch (const ModelError& error) {
      element.fail(error.what());
    }
    otherFiles_.push_back(file);
  } else {
    element.read("nrow", heights.rows);
    element.read("ncol", heights.columns);
    const auto count = static_cast<double>(heights.rows) * heights.columns;
    const bool fits = heights.rows >= 2 && heights.columns >= 2 && count <= kMostElevations;
    if (element.has("elevation"))
      heights.values = *element.numbers("elevation");
    else if (fits)
      heights.values.assign(static_cast<std::size_t>(count), 0.0);  // level
    if (!fits || count != static_cast<double>(heights.values.size()))
      element.fail(
          fmt::format("has {} elevations for {} rows and {} columns, expected one for each "
                      "of at least 2 by 2",
                      heights.values.size(), heights.rows, heights.columns));
  }
  const auto [low, high] = std::minmax_element(heights.values.begin(), heights.values.end());
  const double least = *low, span = *high - *low;
  for (double& value : heights.values) value = span > 0.0 ? (value - least) / span : 0.0;
  auto mesh = std::make_shared<const Mesh>(
      heightFieldMesh(heights, 2.0 * size[0], 2.0 * size[1], size[2], size[3]));
  return landscapes_[name] = mesh;
}

Shape Assets::massOfHeightField(const std::string& name) const {
  const std::array<double, 4> size = sizeOf(heightFields_.at(name));
  return Shape::box({size[0], size[1], 0.25 * size[2] + 0.5 * size[3]});
}

std::optional<std::array<double, 4>> Assets::colour(const std::string& material,
                                                    const Element& user) const {
  const auto found = materials_.find(material);
  if (found == materials_.end())
    user.fail(fmt::format("material {} does not exist{}", detail::quotedText(material),
                          offeredOf(material, materials_)));
  return found->second;
}

std::vector<std::filesystem::path> Assets::files() const {
  std::vector<std::filesystem::path> all = cache_.files();
  all.insert(all.end(), otherFiles_.begin(), otherFiles_.end());
  return all;
}

}  // namespace softgauss::io::mjcf
