// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A model to log, and records of it.

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/io/log.hpp"

namespace softgauss::io {

/// A floating base with one hinge whose name needs quotes, and one that is not actuated.
inline ModelBuilder logBuilder() {
  ModelBuilder builder("log");
  for (const char* name : {"base", "arm", "hand"}) {
    LinkSpec link;
    link.name = name;
    link.mass = 1.0;
    link.I_Lcm = Matrix3::Identity();
    builder.link(link);
  }
  JointSpec joint;
  joint.name = "left, \"elbow\"";
  joint.type = JointType::revolute;
  joint.parent = "base";
  joint.child = "arm";
  builder.joint(joint);
  joint.name = "wrist";
  joint.type = JointType::prismatic;
  joint.parent = "arm";
  joint.child = "hand";
  joint.effort = 0.0;
  builder.joint(joint);
  return builder;
}

inline Model logModel() { return logBuilder().build(); }

inline Model touchingLogModel() {
  ModelBuilder builder = logBuilder();
  for (const char* link : {"arm", "world", "arm"}) {
    GeometrySpec shape;
    shape.link = link;
    shape.shape = Shape::sphere(0.1);
    builder.geometry(shape);
  }
  return builder.build();
}

inline StepRecord randomRecord(const Model& m, std::mt19937_64& random) {
  const auto number = [&] {
    for (;;) {
      const double x = std::bit_cast<double>(random());
      if (std::isfinite(x)) return x;
    }
  };
  StepRecord r;
  r.q = VectorX::NullaryExpr(m.nq, number);
  r.v = VectorX::NullaryExpr(m.nv, number);
  r.a = VectorX::NullaryExpr(m.nv, number);
  r.u = VectorX::NullaryExpr(m.nv, number);
  r.contacts = static_cast<int>(random() % 100);
  r.energy = number();
  r.maxPenetration = number();
  return r;
}

}  // namespace softgauss::io
