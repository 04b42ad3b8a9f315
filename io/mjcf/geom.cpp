// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/geom.hpp"

#include <fmt/format.h>

#include <cmath>

#include "softgauss/io/mjcf/shell.hpp"

namespace softgauss::io::mjcf {
namespace {

using Type = Geom::Type;

/// `count` sizes above 0.
void expectSizes(const Geom& geom, int count) {
  for (int i = 0; i < count; ++i)
    if (!(geom.size[static_cast<std::size_t>(i)] > 0.0))
      geom.element.fail(fmt::format("size {} is {:g}, expected {} above 0", i + 1,
                                    geom.size[static_cast<std::size_t>(i)],
                                    count == 1 ? "one" : fmt::format("{} numbers", count)));
}

Shape primitive(const Geom& geom) {
  switch (geom.type) {
    case Type::plane:
      return Shape::plane();
    case Type::sphere:
      expectSizes(geom, 1);
      return Shape::sphere(geom.size[0]);
    case Type::capsule:
      expectSizes(geom, 2);
      return Shape::capsule(geom.size[0], geom.size[1]);
    case Type::cylinder:
      expectSizes(geom, 2);
      return Shape::cylinder(geom.size[0], geom.size[1]);
    case Type::box:
      expectSizes(geom, 3);
      return Shape::box({geom.size[0], geom.size[1], geom.size[2]});
    case Type::ellipsoid:
      expectSizes(geom, 3);
      return Shape::ellipsoid({geom.size[0], geom.size[1], geom.size[2]});
    case Type::sdf:
      geom.element.fail("is a signed distance field, which is not simulated; expected a mesh");
    case Type::hfield:
    case Type::mesh:
      break;
  }
  return {};
}

/// Ends of the axis in place of pos, orientation and length.
void placeByEnds(Geom& geom, Transform& X) {
  const std::array<double, 6>& e = *geom.fromto;
  const bool isThreeSized = geom.type == Type::box || geom.type == Type::ellipsoid;
  if (!isThreeSized && geom.type != Type::capsule && geom.type != Type::cylinder)
    geom.element.fail(
        "fromto is for a capsule, cylinder, box or ellipsoid, expected size and pos here");
  if (!geom.pose.pos.isZero(0.0)) geom.element.fail("has pos and fromto, expected one of them");
  const Vector3 from(e[0], e[1], e[2]), to(e[3], e[4], e[5]);
  const double length = (from - to).norm();
  if (!(length > 2e-14)) geom.element.fail("the points of fromto coincide, expected two");
  geom.size[isThreeSized ? 2 : 1] = 0.5 * length;
  if (isThreeSized) geom.size[1] = geom.size[0];
  X.p = 0.5 * (from + to);
  X.R = rotationOfZ((from - to) / length);
}

/// A primitive about a mesh of the same inertia, or about its bounding box.
void fitToMesh(Geom& geom, const Compiler& compiler, const MeshAsset& mesh, Transform& X) {
  Vector3 box = mesh.inertiaBox();
  Vector3 center = Vector3::Zero();
  auto& s = geom.size;
  if (compiler.fitToBox) {
    const auto [low, high] = mesh.bounds();
    center = 0.5 * (low + high);
    box = high - center;
  }
  switch (geom.type) {
    case Type::sphere:
      s[0] = compiler.fitToBox ? box.maxCoeff() : box.mean();
      break;
    case Type::capsule:
    case Type::cylinder:
      s[0] = compiler.fitToBox ? std::max(box.x(), box.y()) : 0.5 * (box.x() + box.y());
      s[1] = box.z();
      if (geom.type == Type::capsule)
        s[1] = compiler.fitToBox ? box.z() - s[0] : std::max(0.0, box.z() - 0.5 * s[0]);
      break;
    default:
      s = {box.x(), box.y(), box.z()};
      break;
  }
  for (double& x : s) x *= geom.fitscale;
  X = X * mesh.X_FP * Transform{Matrix3::Identity(), center};
}

/// Mass and inertia in the geom's own frame, as MuJoCo has them.
MassProperties massOf(const Geom& geom, const Shape& shape, const MeshAsset* mesh) {
  if (geom.mass == 0.0 || (!geom.mass && geom.density == 0.0)) return {};
  if ((geom.mass && *geom.mass < 0.0) || geom.density < 0.0)
    geom.element.fail("mass or density is negative, expected 0 or more");
  if (geom.type == Type::plane) return {};
  if (mesh && geom.isShell)
    geom.element.fail(
        "has shellinertia, which is for primitives; expected inertia=\"shell\" in its <mesh>");
  MassProperties unit = mesh           ? mesh->solid(geom.element)
                        : geom.isShell ? shellOf(shape)
                                       : solidOf(shape, 1.0);
  if (!(unit.mass > 0.0)) return {};
  const double density = geom.mass ? *geom.mass / unit.mass : geom.density;
  unit.mass *= density;
  unit.I_Gcm *= density;
  return unit;
}

}  // namespace

void Geom::read(const Element& e) {
  e.expectAttributes(
      {"name",     "class",    "type",      "contype",    "conaffinity", "condim",       "group",
       "priority", "size",     "material",  "friction",   "mass",        "density",      "solmix",
       "solref",   "solimp",   "margin",    "gap",        "surfacevel",  "adhesion",     "fromto",
       "pos",      "quat",     "axisangle", "xyaxes",     "zaxis",       "euler",        "hfield",
       "mesh",     "fitscale", "rgba",      "fluidshape", "fluidcoef",   "shellinertia", "user"});
  e.expectChildren({});
  element = e;
  e.read("name", name);
  if (const auto word = e.word("type", {"plane", "hfield", "sphere", "capsule", "ellipsoid",
                                        "cylinder", "box", "mesh", "sdf"}))
    type = static_cast<Type>(*word);
  for (const auto& [attribute, value] : {std::pair("contype", &contype),
                                         {"conaffinity", &conaffinity},
                                         {"condim", &condim},
                                         {"group", &group},
                                         {"priority", &priority}})
    e.read(attribute, *value);
  if (condim != 1 && condim != 3 && condim != 4 && condim != 6)
    e.fail(fmt::format("condim is {}, expected 1, 3, 4 or 6", condim));
  e.read("size", size, 1);
  e.read("friction", friction, 1);
  if (std::array<double, 6> ends; e.readAll("fromto", ends)) fromto = ends;
  if (double value; e.read("mass", value)) mass = value;
  for (const auto& [attribute, value] : {std::pair("density", &density),
                                         {"solmix", &solmix},
                                         {"margin", &margin},
                                         {"gap", &gap},
                                         {"adhesion", &adhesion},
                                         {"fitscale", &fitscale}})
    e.read(attribute, *value);
  e.read("surfacevel", surfaceVelocity, 1);
  e.read("shellinertia", isShell);
  if (const auto word = e.word("fluidshape", {"none", "ellipsoid"})) inFluid = *word == 1;
  softness.read(e, "solref", "solimp");
  pose.read(e);
  e.read("mesh", mesh);
  e.read("hfield", hfield);
  e.read("material", material);
  if (std::array<double, 4> colour; e.readAll("rgba", colour)) rgba = colour;
}

Material Geom::surface() const {
  if (adhesion != 0.0 || surfaceVelocity != std::array<double, 6>{})
    element.fail("has adhesion or surfacevel, which are not simulated; expected neither");
  Material m;
  m.slidingFriction = friction[0];
  m.torsionalFriction = friction[1];
  m.rollingFriction = friction[2];
  for (const double mu : friction)
    if (!(mu >= 0.0)) element.fail(fmt::format("friction holds {:g}, expected 0 or more", mu));
  m.condim = condim;
  m.margin = margin;
  m.priority = priority;
  m.mixWeight = solmix;
  m.impedance = softness.impedance(element);
  return m;
}

Solid compileGeom(const Geom& given, const Compiler& compiler, Assets& assets,
                  const Transform& X_BF, const GeomUse& use) {
  Geom geom = given;
  Solid solid;
  Transform X;
  if (geom.fromto)
    placeByEnds(geom, X);
  else
    X = geom.pose.pose(geom.element, compiler);
  const MeshAsset* mesh = nullptr;
  if (!geom.mesh.empty()) {
    if (geom.fromto) geom.element.fail("has a mesh and fromto, expected pos and an orientation");
    if (geom.type != Type::mesh || use.weighs || use.touches)
      mesh = &assets.mesh(geom.mesh, geom.element);
  }
  if (geom.type == Type::mesh) {
    if (geom.mesh.empty())
      geom.element.fail("has no attribute 'mesh', expected the name of a <mesh>");
    solid.shape = Shape::hull(mesh ? mesh->mesh : assets.visualMesh(geom.mesh, geom.element));
  } else if (geom.type == Type::hfield) {
    if (geom.hfield.empty())
      geom.element.fail("has no attribute 'hfield', expected the name of a <hfield>");
    solid.shape = Shape::surface(assets.heightField(geom.hfield, geom.element));
  } else {
    if (mesh) fitToMesh(geom, compiler, *mesh, X);
    solid.shape = primitive(geom);
    mesh = nullptr;
  }
  solid.X_BG = X_BF * X;
  if (!use.weighs) return solid;
  solid.properties = massOf(
      geom, geom.type == Type::hfield ? assets.massOfHeightField(geom.hfield) : solid.shape, mesh);
  solid.properties.com = solid.X_BG * solid.properties.com;
  solid.properties.I_Gcm = solid.X_BG.R * solid.properties.I_Gcm * solid.X_BG.R.transpose();
  return solid;
}

}  // namespace softgauss::io::mjcf
