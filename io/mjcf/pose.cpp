// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/pose.hpp"

#include <cmath>

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::io::mjcf {
namespace {

constexpr double kSmallestAxis = 1e-14;

Vector3 unitAxis(const Element& element, const Vector3& axis, const char* what) {
  if (!(axis.norm() > kSmallestAxis))
    element.fail(std::string(what) + " has no direction, expected an axis of some length");
  return axis.normalized();
}

/// A lower-case letter turns about the axis where it is then, an upper-case one about the frame's.
Matrix3 eulerRotation(const Vector3& angles, const std::string& sequence) {
  Matrix3 R = Matrix3::Identity();
  for (int i = 0; i < 3; ++i) {
    const char letter = sequence[static_cast<std::size_t>(i)];
    const bool moves = letter >= 'x';
    const Matrix3 turn = axisRotation(Vector3::Unit(letter - (moves ? 'x' : 'X')), angles[i]);
    R = moves ? Matrix3(R * turn) : Matrix3(turn * R);
  }
  return R;
}

}  // namespace

Matrix3 rotationOfZ(const Vector3& v) {
  const Vector3 axis = Vector3::UnitZ().cross(v);
  const double sine = axis.norm();
  if (sine < 1e-10) return v.z() < 0.0 ? axisRotation(Vector3::UnitX(), M_PI) : Matrix3::Identity();
  return axisRotation(axis / sine, std::atan2(sine, v.z()));
}

void PoseAttributes::read(const Element& element) {
  element.read("pos", pos);
  int given = element.readAll("quat", quat) ? 1 : 0;
  if (given && quat == std::array<double, 4>{})
    element.fail("quat is zero, expected a quaternion w x y z of some length");
  const auto alternative = [&](const char* name, std::size_t count, Kind of) {
    if (!element.has(name)) return;
    ++given;
    kind = of;
    numbers = {};
    if (element.read(name, numbers, count) != count)
      element.fail(std::string(name) + " has more than " + std::to_string(count) + " numbers");
  };
  alternative("axisangle", 4, Kind::axisangle);
  alternative("xyaxes", 6, Kind::xyaxes);
  alternative("zaxis", 3, Kind::zaxis);
  alternative("euler", 3, Kind::euler);
  if (given > 1)
    element.fail("has several orientations, expected one of quat, axisangle, xyaxes, zaxis, euler");
}

Transform PoseAttributes::pose(const Element& element, const Compiler& compiler) const {
  Transform X;
  X.p = pos;
  const Vector3 first(numbers[0], numbers[1], numbers[2]);
  switch (kind) {
    case Kind::quat:
      X.R = Quaternion(quat[0], quat[1], quat[2], quat[3]).normalized().toRotationMatrix();
      break;
    case Kind::axisangle:
      X.R = axisRotation(unitAxis(element, first, "axisangle"), compiler.radians(numbers[3]));
      break;
    case Kind::xyaxes: {
      const Vector3 x = unitAxis(element, first, "the x axis of xyaxes");
      const Vector3 given(numbers[3], numbers[4], numbers[5]);
      const Vector3 y = unitAxis(element, given - x * x.dot(given), "the y axis of xyaxes");
      X.R << x, y, x.cross(y);
      break;
    }
    case Kind::zaxis:
      X.R = rotationOfZ(unitAxis(element, first, "zaxis"));
      break;
    case Kind::euler:
      X.R = eulerRotation(
          {compiler.radians(first.x()), compiler.radians(first.y()), compiler.radians(first.z())},
          compiler.eulerseq);
      break;
  }
  return X;
}

}  // namespace softgauss::io::mjcf
