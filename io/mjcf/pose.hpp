// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Poses: pos, and one of quat, axisangle, xyaxes, zaxis and euler.

#include "softgauss/io/mjcf/compiler.hpp"
#include "softgauss/io/mjcf/xml.hpp"

namespace softgauss::io::mjcf {

/// The attributes of a pose, laid over those of a default class.
struct PoseAttributes {
  Vector3 pos = Vector3::Zero();
  std::array<double, 4> quat{1, 0, 0, 0};
  enum class Kind { quat, axisangle, xyaxes, zaxis, euler } kind = Kind::quat;
  std::array<double, 6> numbers{};  ///< of the kind, where it is not quat

  void read(const Element& element);
  Transform pose(const Element& element, const Compiler& compiler) const;
};

/// The least rotation that takes z to v, |v| > 0; half a turn about x where v is −z.
Matrix3 rotationOfZ(const Vector3& v);

}  // namespace softgauss::io::mjcf
