// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <geom>: shapes that touch, weigh and are looked at.

#include <optional>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/mjcf/asset.hpp"
#include "softgauss/io/mjcf/pose.hpp"
#include "softgauss/io/mjcf/softness.hpp"

namespace softgauss::io::mjcf {

struct Geom {
  Element element;
  std::string name;
  enum class Type { plane, hfield, sphere, capsule, ellipsoid, cylinder, box, mesh, sdf };
  Type type = Type::sphere;
  int contype = 1, conaffinity = 1, condim = 3, group = 0, priority = 0;
  std::array<double, 3> size{}, friction{1, 0.005, 0.0001};
  std::optional<std::array<double, 6>> fromto;
  std::optional<double> mass;
  double density = 1000.0, solmix = 1.0, margin = 0.0, gap = 0.0, adhesion = 0.0, fitscale = 1.0;
  std::array<double, 6> surfaceVelocity{};
  bool isShell = false, inFluid = false;
  Softness softness;
  PoseAttributes pose;
  std::string mesh, hfield, material;
  std::optional<std::array<double, 4>> rgba;

  void read(const Element& element);
  /// Nothing may touch it, unless a <pair> says so.
  bool isVisual() const { return contype == 0 && conaffinity == 0; }
  Material surface() const;
};

/// A geom that has been worked out.
struct Solid {
  Transform X_BG;  ///< in the body; of a mesh that its inertia centres, that of the mesh's file
  Shape shape;
  MassProperties properties;  ///< in the body's frame; mass 0 where it weighs nothing
};

/// What a geom is for, besides being looked at.
struct GeomUse {
  bool weighs = false, touches = true;
};
Solid compileGeom(const Geom& geom, const Compiler& compiler, Assets& assets, const Transform& X_BF,
                  const GeomUse& use);

}  // namespace softgauss::io::mjcf
