// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <joint> and <freejoint>: hinges, slides and free joints.

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/mjcf/compiler.hpp"
#include "softgauss/io/mjcf/softness.hpp"

namespace softgauss::io::mjcf {

struct Joint {
  Element element;  ///< where it is written
  std::string name;
  enum class Type { free, ball, slide, hinge } type = Type::hinge;
  Vector3 pos = Vector3::Zero(), axis = Vector3::UnitZ();
  std::array<double, 2> range{}, forceRange{}, springDamper{};
  Choice limited = Choice::automatic, forceLimited = Choice::automatic;
  Softness limit, friction;
  std::array<double, 3> stiffness{}, damping{};  ///< and coefficients of a polynomial
  double margin = 0.0, reference = 0.0, springReference = 0.0, armature = 0.0, frictionLoss = 0.0;
  bool gravityByActuator = false;

  bool isScalar() const { return type == Type::hinge || type == Type::slide; }
  void read(const Element& element);
  void readFree(const Element& element);
  /// Angles in radians, and the frame of a <frame> applied. Throws where it cannot be expressed.
  void compile(const Compiler& compiler, const Transform& X_BF);
  /// Without its name, its links and its pose.
  JointSpec spec(const Compiler& compiler) const;
};

}  // namespace softgauss::io::mjcf
