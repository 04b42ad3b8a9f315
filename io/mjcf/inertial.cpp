// SPDX-License-Identifier: Apache-2.0
/// <inertial>, or the geoms of a body in its place: mass, centre of mass, inertia.

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/io/mjcf/body.hpp"
#include "softgauss/io/mjcf/principal_axes.hpp"

namespace softgauss::io::mjcf {
namespace {

constexpr double kNoMass = 1e-14;  // [kg] of a geom that is left out

/// Inertia by its principal axes R.
struct Inertial {
  double mass = 0.0;
  Vector3 com = Vector3::Zero(), moments = Vector3::Zero();
  Matrix3 R = Matrix3::Identity();
  Matrix3 tensor = Matrix3::Zero();  ///< R diag(moments) Rᵀ

  void setTensor(const Matrix3& I) {
    const PrincipalAxes principal = principalAxes(I);
    R = principal.R;
    setMoments(principal.moments);
  }
  void setMoments(const Vector3& of) {
    moments = of;
    tensor = R * moments.asDiagonal() * R.transpose();
  }
};

Inertial readInertial(const Element& e, const Compiler& compiler) {
  e.expectAttributes({"pos", "quat", "mass", "diaginertia", "axisangle", "xyaxes", "zaxis", "euler",
                      "fullinertia"});
  e.expectChildren({});
  for (const char* needed : {"pos", "mass"})
    if (!e.has(needed)) e.fail(fmt::format("has no attribute '{}'", needed));
  Inertial result;
  e.read("mass", result.mass);
  PoseAttributes pose;
  pose.read(e);
  const Transform X = pose.pose(e, compiler);
  result.com = X.p;
  result.R = X.R;
  if (std::array<double, 6> full; e.readAll("fullinertia", full)) {
    for (const char* other : {"quat", "axisangle", "xyaxes", "zaxis", "euler", "diaginertia"})
      if (e.has(other)) e.fail(fmt::format("has fullinertia and {}, expected one of them", other));
    Matrix3 I;
    I << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
    result.setTensor(I);
  } else if (Vector3 moments; e.read("diaginertia", moments)) {
    result.setMoments(moments);
  }
  if (result.mass < 0.0 || result.moments.minCoeff() < 0.0)
    e.fail(
        fmt::format("has a mass of {:g} kg and moments of inertia {:g}, {:g}, {:g}, expected none "
                    "below 0",
                    result.mass, result.moments.x(), result.moments.y(), result.moments.z()));
  return result;
}

/// The sum of the solids that weigh; of one alone, itself.
Inertial sumOf(const std::vector<Solid>& solids) {
  Inertial result;
  int count = 0;
  for (const Solid& solid : solids) {
    if (!(solid.properties.mass > kNoMass)) continue;
    ++count;
    result.mass += solid.properties.mass;
    result.com += solid.properties.mass * solid.properties.com;
  }
  if (!(result.mass > 0.0)) return result;
  result.com /= result.mass;
  Matrix3 I = Matrix3::Zero();
  for (const Solid& solid : solids) {
    if (!(solid.properties.mass > kNoMass)) continue;
    const Vector3 r = solid.properties.com - result.com;
    I += solid.properties.I_Gcm +
         solid.properties.mass * (r.squaredNorm() * Matrix3::Identity() - r * r.transpose());
  }
  result.setTensor(I);
  if (count == 1) result.tensor = I;
  return result;
}

/// boundmass, boundinertia and balanceinertia.
void adjust(Inertial& inertial, const Body& body, const Compiler& compiler) {
  const Element& e = body.inertial ? *body.inertial : body.element;
  inertial.mass = std::max(inertial.mass, compiler.boundMass);
  if (compiler.boundInertia > inertial.moments.minCoeff())
    inertial.setMoments(inertial.moments.cwiseMax(compiler.boundInertia));
  constexpr double kRounding = 1e-12;
  const double sum = inertial.moments.sum(), most = inertial.moments.maxCoeff();
  if (2.0 * most <= sum + kRounding * sum) return;
  if (!compiler.balanceInertia)
    e.fail(
        fmt::format("has moments of inertia {:g}, {:g}, {:g}, of which the largest exceeds the "
                    "sum of the others: no body has these; expected others, or "
                    "balanceinertia=\"true\" in <compiler>, which takes their mean",
                    inertial.moments.x(), inertial.moments.y(), inertial.moments.z()));
  inertial.setMoments(Vector3::Constant(sum / 3.0));
}

}  // namespace

void weighBodies(std::vector<Body>& bodies, const Compiler& compiler, Assets& assets,
                 const std::set<std::string>& paired) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& body = bodies[i];
    const bool fromGeoms =
        i > 0 && (compiler.inertiaFromGeom == Choice::yes ||
                  (compiler.inertiaFromGeom == Choice::automatic && !body.inertial));
    bool weighs = false;
    for (const auto& [geom, X_BF] : body.geoms) {
      const bool counts = fromGeoms && geom.group >= compiler.inertiaGroups[0] &&
                          geom.group <= compiler.inertiaGroups[1];
      const bool touches = !geom.isVisual() || paired.count(geom.name) > 0;
      body.solids.push_back(compileGeom(geom, compiler, assets, X_BF, {counts, touches}));
      weighs = weighs || body.solids.back().properties.mass > kNoMass;
    }
    body.link.name = body.name;
    body.link.where = body.element.where;
    if (i == 0) continue;
    Inertial inertial;
    if (body.inertial) inertial = readInertial(*body.inertial, compiler);
    if (weighs) inertial = sumOf(body.solids);
    // MuJoCo leaves the body's own pose there; it counts where boundmass gives a mass.
    if (!weighs && !body.inertial) inertial.com = body.pos;
    adjust(inertial, body, compiler);
    body.link.mass = inertial.mass;
    body.link.com = inertial.com;
    body.link.I_Lcm = inertial.tensor;
  }
  if (!(compiler.totalMass > 0.0)) return;
  double total = 0.0;
  for (const Body& body : bodies) total += body.link.mass;
  for (Body& body : bodies) {
    const double scale = total > 0.0 ? compiler.totalMass / total : 1.0;
    body.link.mass *= scale;
    body.link.I_Lcm *= scale;
  }
}

}  // namespace softgauss::io::mjcf
