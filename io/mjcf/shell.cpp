// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/shell.hpp"

#include <cmath>

namespace softgauss::io::mjcf {
namespace {

MassProperties symmetric(double mass, double across, double along) {
  MassProperties p;
  p.mass = mass;
  p.I_Gcm.diagonal() << across, across, along;
  return p;
}

/// A tube of half-length l, open at its ends.
MassProperties tube(double r, double l) {
  const double mass = 4.0 * M_PI * r * l;
  return symmetric(mass, mass * (0.5 * r * r + l * l / 3.0), mass * r * r);
}

MassProperties capsuleShell(double r, double l) {
  MassProperties p = tube(r, l);
  // Two hemispheres, of which each has its centre of mass half a radius beyond the tube's end.
  const double caps = 4.0 * M_PI * r * r, beyond = 0.5 * r;
  const double own = caps * 2.0 / 3.0 * r * r;
  const double moved = caps * ((l + beyond) * (l + beyond) - beyond * beyond);
  p.mass += caps;
  p.I_Gcm.diagonal() += Vector3(own + moved, own + moved, own);
  return p;
}

MassProperties cylinderShell(double r, double l) {
  MassProperties p = tube(r, l);
  const double discs = 2.0 * M_PI * r * r;
  p.mass += discs;
  p.I_Gcm.diagonal() += discs * Vector3(0.25 * r * r + l * l, 0.25 * r * r + l * l, 0.5 * r * r);
  return p;
}

/// Two plates across each axis.
MassProperties boxShell(const Vector3& half) {
  MassProperties p;
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double mass = 8.0 * half[a] * half[b];
    const double aa = half[a] * half[a] / 3.0, bb = half[b] * half[b] / 3.0;
    const double out = half[axis] * half[axis];
    p.mass += mass;
    p.I_Gcm(axis, axis) += mass * (aa + bb);
    p.I_Gcm(a, a) += mass * (bb + out);
    p.I_Gcm(b, b) += mass * (aa + out);
  }
  return p;
}

/// The area by Thomsen's formula, and the moments of a layer of a millionth of a metre, as MuJoCo
/// has them: neither has a closed form.
MassProperties ellipsoidShell(const Vector3& h) {
  constexpr double kPower = 1.6075, kLayer = 1e-6;
  const auto product = [&](int i, int j) { return std::pow(h[i] * h[j], kPower); };
  const double mass =
      4.0 * M_PI * std::pow((product(0, 1) + product(1, 2) + product(2, 0)) / 3.0, 1.0 / kPower);
  const MassProperties inner = solidOf(Shape::ellipsoid(h), 1.0),
                       outer = solidOf(Shape::ellipsoid(h + Vector3::Constant(kLayer)), 1.0);
  MassProperties p;
  p.mass = mass;
  p.I_Gcm = (outer.I_Gcm - inner.I_Gcm) * (mass / (outer.mass - inner.mass));
  return p;
}

}  // namespace

MassProperties shellOf(const Shape& shape) {
  const double r = shape.radius, l = shape.halfLength;
  switch (shape.kind) {
    case ShapeKind::sphere: {
      const double mass = 4.0 * M_PI * r * r;
      return symmetric(mass, mass * 2.0 / 3.0 * r * r, mass * 2.0 / 3.0 * r * r);
    }
    case ShapeKind::capsule:
      return capsuleShell(r, l);
    case ShapeKind::cylinder:
      return cylinderShell(r, l);
    case ShapeKind::box:
      return boxShell(shape.halfExtents);
    case ShapeKind::ellipsoid:
      return ellipsoidShell(shape.halfExtents);
    case ShapeKind::plane:
    case ShapeKind::mesh:
    case ShapeKind::triangles:
      break;
  }
  return {};
}

}  // namespace softgauss::io::mjcf
