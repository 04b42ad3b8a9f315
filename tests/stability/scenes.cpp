// SPDX-License-Identifier: Apache-2.0
#include "tests/stability/scenes.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::test {
namespace {

Matrix3 inertiaOf(const Shape& s, double mass) {
  const double r2 = s.radius * s.radius;
  switch (s.kind) {
    case ShapeKind::sphere:
      return Matrix3::Identity() * 0.4 * mass * r2;
    case ShapeKind::cylinder:
    case ShapeKind::capsule: {  // a capsule as the cylinder that holds it
      const double half = s.halfLength + (s.kind == ShapeKind::capsule ? s.radius : 0.0);
      const double across = mass * (0.25 * r2 + half * half / 3.0);
      return Vector3(across, across, 0.5 * mass * r2).asDiagonal();
    }
    default: {
      const Vector3 square = s.halfExtents.cwiseAbs2();
      return Vector3(Vector3::Constant(square.sum()) - square).asDiagonal() * Matrix3::Identity() *
             (mass / 3.0);
    }
  }
}

}  // namespace

void addBody(ModelBuilder& builder, const std::string& name, const Shape& shape, double mass,
             const Transform& X_WB, double friction) {
  LinkSpec link;
  link.name = name;
  link.mass = mass;
  link.I_Lcm = inertiaOf(shape, mass);
  ModelBuilder one(name);
  one.base = BaseKind::floating;
  one.X_WRoot = X_WB;
  one.link(link);
  one.geometry(geometrySpec(name, shape, friction));
  builder.add(one, "");
}

ModelBuilder tower(const std::vector<double>& masses) {
  constexpr double kHalf = 0.1;
  ModelBuilder builder("tower");
  builder.geometry(groundSpec(1.0));
  for (std::size_t i = 0; i < masses.size(); ++i)
    addBody(builder, "box" + std::to_string(i), Shape::box(Vector3::Constant(kHalf)), masses[i],
            {Matrix3::Identity(), Vector3(0, 0, (2.0 * static_cast<double>(i) + 1.0) * kHalf)});
  return builder;
}

ModelBuilder levelArm() {
  ModelBuilder builder("arm");
  builder.link(emptyLink("world"));
  std::string parent = "world";
  for (int i = 0; i < 3; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(boxLink(name, 1.0, {0.1, 0.02, 0.02}, {0.1, 0.0, 0.0}));
    builder.joint(jointSpec("hinge" + std::to_string(i), JointType::continuous, parent, name,
                            {Matrix3::Identity(), Vector3(i > 0 ? 0.2 : 0.0, 0, 0)},
                            Vector3::UnitY()));
    parent = name;
  }
  return builder;
}

double tilt(Trial& trial, const std::string& link) {
  return std::acos(std::min(1.0, trial.rotation(link)(2, 2)));
}

double decades(Random& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

double widestTie(Trial& t) {
  computeKinematics(t.model, t.state, t.data->kinematics);
  const std::vector<Transform>& X_WB = t.data->kinematics.X_WB;
  double off = 0.0;
  for (const Connection& c : t.model.connections)
    off = std::max(off, (X_WB[c.bodyA] * c.p_AP - X_WB[c.bodyB] * c.p_BP).norm());
  for (const Weld& w : t.model.welds)
    off = std::max(off, (X_WB[w.bodyA] * w.X_AF.p - X_WB[w.bodyB] * w.X_BF.p).norm());
  return off;
}

}  // namespace softgauss::test
