// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <asset>: meshes, height fields and the colours of materials.

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "softgauss/engine/model/mass_properties.hpp"
#include "softgauss/io/mesh.hpp"
#include "softgauss/io/mjcf/compiler.hpp"

namespace softgauss::io::mjcf {

/// The attributes of <mesh> that a class may give.
struct MeshAttributes {
  std::array<double, 3> scale{1, 1, 1};
  enum class Inertia { convex, legacy, exact, shell } inertia = Inertia::legacy;
  void read(const Element& element);
};

/// A mesh as its file has it, in a frame F, or with refpos, refquat and scale applied.
struct MeshAsset {
  Element element;
  std::shared_ptr<const Mesh> mesh;
  MeshAttributes::Inertia inertia = MeshAttributes::Inertia::legacy;
  MassProperties unit;  ///< of 1 kg/m³, or of a shell of 1 kg/m²; about its centre of mass
  Transform X_FP;       ///< its principal frame, moments in falling order
  std::string problem;  ///< why it has no mass; empty where it has one

  /// Throws, naming `user` and this mesh, where the mass is asked for and there is none.
  MassProperties solid(const Element& user) const;
  Vector3 inertiaBox() const;                  ///< half extents of the box of the same inertia [m]
  std::pair<Vector3, Vector3> bounds() const;  ///< in the principal frame, the origin within
};

class Assets {
 public:
  /// `readVisuals`: read meshes that are only looked at too.
  Assets(std::filesystem::path model, const Compiler& compiler, std::uintmax_t largestMesh,
         bool readVisuals)
      : model_(std::move(model)),
        compiler_(compiler),
        cache_(largestMesh),
        largestMesh_(largestMesh),
        readVisuals_(readVisuals) {}

  /// <mesh>, over the attributes of its class.
  void addMesh(const Element& element, MeshAttributes attributes);
  void addHeightField(const Element& element);
  void addMaterial(const Element& element, std::optional<std::array<double, 4>> rgba);

  /// Each throws at `user` where there is none of that name. Files are read when asked for.
  const MeshAsset& mesh(const std::string& name, const Element& user);
  std::shared_ptr<const Mesh> heightField(const std::string& name, const Element& user);
  /// The box that weighs as MuJoCo has a height field weigh, once it has been asked for.
  Shape massOfHeightField(const std::string& name) const;
  std::optional<std::array<double, 4>> colour(const std::string& material,
                                              const Element& user) const;
  /// A mesh that is only looked at; without vertices where it is not read.
  std::shared_ptr<const Mesh> visualMesh(const std::string& name, const Element& user);

  std::vector<std::filesystem::path> files() const;  ///< that were read

 private:
  struct GivenMesh {
    Element element;
    MeshAttributes attributes;
  };
  std::shared_ptr<const Mesh> load(const GivenMesh& given);
  Mesh mshMesh(const std::filesystem::path& file);

  std::filesystem::path model_;
  const Compiler& compiler_;
  MeshCache cache_;
  std::uintmax_t largestMesh_;
  bool readVisuals_;
  std::map<std::string, GivenMesh> meshes_;
  std::map<std::string, MeshAsset> read_;
  std::map<std::string, Element> heightFields_;
  std::map<std::string, std::shared_ptr<const Mesh>> landscapes_;
  std::map<std::string, std::optional<std::array<double, 4>>> materials_;
  std::vector<std::filesystem::path> otherFiles_;
};

}  // namespace softgauss::io::mjcf
