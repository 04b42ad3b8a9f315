// SPDX-License-Identifier: Apache-2.0
#include "tests/islands/crowd.hpp"

#include <algorithm>

namespace softgauss::test {

ModelBuilder ground() {
  ModelBuilder builder("crowd");
  builder.geometry(groundSpec(0.8));
  return builder;
}

namespace {

void addSolid(ModelBuilder& builder, const std::string& name, const Shape& shape,
              const Transform& X_WB) {
  ModelBuilder one(name);
  one.base = BaseKind::floating;
  one.X_WRoot = X_WB;
  one.link(shape.kind == ShapeKind::box ? boxLink(name, 1.0, shape.halfExtents)
                                        : sphereLink(name, 1.0, shape.radius));
  one.geometry(geometrySpec(name, shape, 0.8));
  builder.add(one, "");
}

void addCreatureAt(ModelBuilder& builder, const std::string& name, const Transform& X_WB) {
  ModelBuilder one(name);
  one.base = BaseKind::floating;
  one.X_WRoot = X_WB;
  const Shape limb = Shape::capsule(0.04, 0.08);
  std::string parent;
  for (int i = 0; i < 4; ++i) {
    const std::string link = name + "_" + std::to_string(i);
    one.link(boxLink(link, 0.5, Vector3(0.04, 0.04, 0.12)));
    one.geometry(geometrySpec(link, limb, 0.8));
    if (i > 0) {
      JointSpec joint = jointSpec(link + "_joint", JointType::revolute, parent, link,
                                  {Matrix3::Identity(), Vector3(0, 0, 0.25)},
                                  i % 2 ? Vector3::UnitX() : Vector3::UnitY());
      joint.damping = 0.05;
      one.joint(joint);
    }
    parent = link;
  }
  builder.add(one, "");
}

}  // namespace

void addCube(ModelBuilder& builder, const std::string& name, const Vector3& p) {
  addSolid(builder, name, Shape::box(Vector3::Constant(0.1)), {Matrix3::Identity(), p});
}

void addCreature(ModelBuilder& builder, const std::string& name, const Vector3& p) {
  addCreatureAt(builder, name, Transform{Matrix3::Identity(), p});
}

ModelBuilder stacks() {
  ModelBuilder builder = ground();
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 2; ++k)
      addCube(builder, "cube" + std::to_string(i) + std::to_string(k),
              Vector3(1.0 * i, 0.0, 0.1 + 0.2 * k));
  return builder;
}

ModelBuilder robotsAndCubes() {
  ModelBuilder builder = ground();
  addCreature(builder, "lying", Vector3(0.0, 0.0, 0.05));
  addCube(builder, "lower", Vector3(2.0, 0.0, 0.1));
  addCube(builder, "upper", Vector3(2.0, 0.0, 0.3));
  addCreature(builder, "lifted", Vector3(2.0, 0.0, 0.5));
  addCube(builder, "alone", Vector3(4.0, 0.0, 0.1));
  return builder;
}

ModelBuilder heap(int count, std::uint64_t seed) {
  Random random(seed);
  ModelBuilder builder = ground();
  const int side = std::max(1, static_cast<int>(std::cbrt(count)));
  for (int i = 0; i < count; ++i) {
    const Vector3 cell(i % side, i / side % side, i / (side * side));
    const Transform X_WB{random.rotation(),
                         0.45 * cell + random.vector3(0.04) + Vector3(0.0, 0.0, 0.5)};
    const std::string name = "unit" + std::to_string(i);
    switch (i % 4) {
      case 0:
        addSolid(builder, name, Shape::box(Vector3(0.1, 0.08, 0.06)), X_WB);
        break;
      case 1:
        addSolid(builder, name, Shape::sphere(0.1), X_WB);
        break;
      case 2:
        addSolid(builder, name, Shape::capsule(0.06, 0.08), X_WB);
        break;
      default:
        addCreatureAt(builder, name, X_WB);
    }
  }
  return builder;
}

}  // namespace softgauss::test
