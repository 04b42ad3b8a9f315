// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/urdf.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "softgauss/engine/dynamics/coupled_mass.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/mesh_defects.hpp"
#include "softgauss/io/detail/other_formats.hpp"
#include "softgauss/io/detail/resources.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/unit_mistakes.hpp"
#include "softgauss/io/detail/urdf_check.hpp"
#include "softgauss/io/detail/urdf_description.hpp"
#include "softgauss/io/detail/urdf_inertia.hpp"
#include "softgauss/io/mesh.hpp"

namespace softgauss::io {
namespace {

using detail::UrdfDescription;
using detail::UrdfShape;

/// Turns shapes into the specs of a builder, meshes read.
class ShapeReader {
 public:
  ShapeReader(const std::filesystem::path& urdf, const UrdfOptions& options)
      : finder_(urdf, options.packagePaths), meshes_(options.largestMesh), options_(options) {}

  /// Throws where the mesh is missing or cannot be read.
  GeometrySpec collision(const UrdfShape& shape, const std::string& link, std::size_t index,
                         const std::optional<double>& friction) {
    GeometrySpec spec;
    spec.name = fmt::format("{}/{}", link, index);
    spec.link = link;
    spec.X_LG = shape.X_LG;
    spec.shape = shape.shape;
    spec.where = shape.element.where();
    const auto material = options_.linkMaterials.find(link);
    spec.material = material == options_.linkMaterials.end() ? options_.material : material->second;
    if (friction && material == options_.linkMaterials.end() && options_.material == Material{}) {
      spec.material.slidingFriction = *friction;
      spec.material.priority = 1;  // else the larger friction of two surfaces counts
    }
    if (shape.shape.kind != ShapeKind::mesh) return spec;
    spec.shape = options_.meshes == MeshUse::triangles ? Shape::surface(mesh(shape))
                                                       : Shape::hull(mesh(shape));
    spec.automaticMesh = options_.meshes == MeshUse::automatic;
    if (options_.meshes == MeshUse::hull)
      unsoundHulls_.look(*spec.shape.mesh, "link '" + link + "'");
    return spec;
  }

  /// The shape with its mesh read, as its solid.
  Shape solid(const UrdfShape& shape) {
    return shape.shape.isMesh() ? Shape::surface(mesh(shape)) : shape.shape;
  }

  /// Nothing, and a note, where a visual cannot be shown: that never stops a simulation.
  std::optional<VisualSpec> visual(const UrdfShape& shape, const std::string& link,
                                   const UrdfDescription& urdf) {
    VisualSpec spec;
    spec.link = link;
    spec.X_LG = shape.X_LG;
    spec.shape = shape.shape;
    try {
      if (shape.defect) throw *shape.defect;
      if (shape.shape.kind == ShapeKind::mesh) spec.shape.mesh = visualMesh(shape);
    } catch (const ModelError& error) {
      notShown_.emplace_back(error.what());
      return std::nullopt;
    }
    if (!spec.shape.mesh && shape.shape.kind == ShapeKind::mesh) return std::nullopt;
    const auto named = urdf.colours.find(shape.material);
    if (shape.rgba)
      spec.rgba = *shape.rgba;
    else if (named != urdf.colours.end())
      spec.rgba = named->second;
    return spec;
  }

  std::vector<std::filesystem::path> filesRead() const { return meshes_.files(); }

  void appendWarnings(ModelBuilder& builder) const {
    if (!missing_.empty())
      builder.warning(fmt::format("{} not found, not shown: {}",
                                  detail::counted(missing_.size(), "visual mesh file"),
                                  detail::listed(missing_, 3)));
    for (const auto& [package, folder] : byTheirEnd_)
      builder.warning(
          fmt::format("package '{}' is in none of the folders that are looked through: its files "
                      "are taken from {}, by the ends of their paths",
                      package, folder));
    for (const std::string& text : notShown_) builder.warning("not shown: " + text);
    std::vector<std::string> warnings;
    unsoundHulls_.appendTo(warnings);
    for (std::string& warning : warnings) builder.warning(std::move(warning));
  }

 private:
  detail::FoundFile find(const std::string& uri) {
    detail::FoundFile found = finder_.find(uri);
    if (!found.package.empty()) byTheirEnd_.emplace(found.package, found.folder.string());
    return found;
  }

  std::shared_ptr<const Mesh> mesh(const UrdfShape& shape) {
    const detail::FoundFile found = find(shape.meshUri);
    std::error_code ignored;
    for (const std::string& place : found.searched)
      if (found.path.empty() && std::filesystem::exists(place, ignored))
        shape.element.fail(fmt::format("mesh '{}' {}", shape.meshUri, detail::inputProblem(place)));
    if (found.path.empty())
      shape.element.fail(fmt::format(
          "mesh '{}' not found, expected it as one of: {}{}", shape.meshUri,
          detail::listed(found.searched, 20),
          shape.meshUri.find("://") == std::string::npos
              ? ""
              : "; where the folder of its package lies elsewhere, give the folder above it with "
                "--package-path"));
    return readMesh(found.path, shape);
  }

  std::shared_ptr<const Mesh> visualMesh(const UrdfShape& shape) {
    const detail::FoundFile found = find(shape.meshUri);
    if (found.path.empty()) {
      missing_.push_back(shape.meshUri);
      return nullptr;
    }
    if (options_.visualMeshes) return readMesh(found.path, shape);
    Mesh unread;
    unread.file = found.path.string();
    return std::make_shared<const Mesh>(std::move(unread));
  }

  std::shared_ptr<const Mesh> readMesh(const std::filesystem::path& path, const UrdfShape& shape) {
    try {
      return meshes_.get(path, shape.scale);
    } catch (const ModelError& error) {
      shape.element.fail(error.what());
    }
  }

  detail::ResourceFinder finder_;
  MeshCache meshes_;
  const UrdfOptions& options_;
  std::vector<std::string> missing_, notShown_;
  std::map<std::string, std::string> byTheirEnd_;  ///< package, folder of its files
  detail::UnsoundHulls unsoundHulls_;
};

/// With links and joints, as yet without shapes.
ModelBuilder begun(const UrdfDescription& urdf, const UrdfOptions& options) {
  ModelBuilder builder(urdf.name);
  builder.base = options.base;
  builder.zeroEffortIsUnlimited = options.zeroEffortIsUnlimited;
  for (const detail::UrdfLink& link : urdf.links) builder.link(link.spec);
  for (const JointSpec& joint : urdf.joints) builder.joint(joint);
  return builder;
}

}  // namespace

ModelBuilder readUrdf(const std::filesystem::path& file, const UrdfOptions& options,
                      UrdfContents* contents) {
  const std::string text = detail::readInput(file.string(), "a URDF file");
  const std::string name = detail::inputName(file.string());
  detail::refuseOtherFormats(name, text);
  const detail::XmlFile xml(name, text);
  UrdfDescription urdf = detail::describeUrdf(xml.robot());

  ModelBuilder builder = begun(urdf, options);
  if (const std::string refusal = detail::compareWithUrdfdom(xml, urdf); !refusal.empty()) {
    // The builder names the line of most things that urdfdom refuses.
    builder.build();
    xml.robot().fail("urdfdom refuses the file: " + refusal);
  }

  ShapeReader shapes(file, options);
  if (options.inferInertia) {
    for (std::string& told :
         detail::inferInertia(urdf, options.base == BaseKind::fixed,
                              [&](const UrdfShape& shape) { return shapes.solid(shape); }))
      urdf.warnings.push_back(std::move(told));
    builder = begun(urdf, options);
  }
  for (detail::UrdfLink& link : urdf.links) {
    for (std::size_t i = 0; i < link.collisions.size(); ++i) {
      if (link.collisions[i].isPoint) continue;
      GeometrySpec collision =
          shapes.collision(link.collisions[i], link.spec.name, i, link.friction);
      link.collisions[i].shape.mesh = collision.shape.mesh;
      builder.geometry(std::move(collision));
    }
    for (UrdfShape& shape : link.visuals)
      if (std::optional<VisualSpec> visual = shapes.visual(shape, link.spec.name, urdf)) {
        shape.shape.mesh = visual->shape.mesh;
        builder.visual(std::move(*visual));
      }
  }
  for (const std::string& warning : urdf.warnings) builder.warning(warning);
  for (const std::string& warning : detail::unitMistakes(xml.robot(), urdf))
    builder.warning(warning);
  shapes.appendWarnings(builder);

  if (contents) {
    contents->links = static_cast<int>(urdf.links.size());
    contents->joints = static_cast<int>(urdf.joints.size());
    contents->mass = 0.0;
    contents->files = shapes.filesRead();
    contents->files.push_back(file);
    contents->linkNames.clear();
    contents->scalarJoints.clear();
    contents->places.clear();
    contents->meshPlaces.clear();
    for (const detail::UrdfLink& link : urdf.links) {
      contents->mass += link.spec.mass;
      contents->linkNames.push_back(link.spec.name);
      contents->places.emplace(link.spec.name, link.spec.where);
      for (const UrdfShape& shape : link.collisions)
        if (shape.shape.mesh)
          contents->meshPlaces.emplace(shape.shape.mesh->file,
                                       std::pair(shape.element.where(), shape.element.label()));
    }
    contents->floatingLink.clear();
    for (const JointSpec& joint : urdf.joints) {
      if (joint.type == JointType::floating) contents->floatingLink = joint.child;
      if (joint.type == JointType::revolute || joint.type == JointType::continuous ||
          joint.type == JointType::prismatic)
        contents->scalarJoints.push_back(joint.name);
    }
  }
  return builder;
}

Model loadUrdf(const std::filesystem::path& file, const UrdfOptions& options) {
  Model model = readUrdf(file, options).build();
  regulariseCoupledJoints(model, model.q0);
  return model;
}

}  // namespace softgauss::io
