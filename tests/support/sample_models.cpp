// SPDX-License-Identifier: Apache-2.0
#include "tests/support/sample_models.hpp"

namespace softgauss::test {

LinkSpec boxLink(const std::string& name, double mass, const Vector3& half, const Vector3& com) {
  LinkSpec link = emptyLink(name);
  link.mass = mass;
  link.com = com;
  const Vector3 s = half.cwiseProduct(half) * mass / 3.0;
  link.I_Lcm = Vector3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal();
  return link;
}

LinkSpec sphereLink(const std::string& name, double mass, double radius, const Vector3& com) {
  LinkSpec link = emptyLink(name);
  link.mass = mass;
  link.com = com;
  link.I_Lcm = 0.4 * mass * radius * radius * Matrix3::Identity();
  return link;
}

LinkSpec emptyLink(const std::string& name) {
  LinkSpec link;
  link.name = name;
  return link;
}

LinkSpec randomLink(const std::string& name, Random& random) {
  LinkSpec link = emptyLink(name);
  link.mass = random.uniform(0.3, 3.0);
  link.com = random.vector3(0.1);
  // Moments Σ m (y² + z²), … of masses spread along three axes.
  Vector3 spread;
  for (double& s : spread) s = link.mass * random.uniform(0.001, 0.02);
  const Matrix3 R = random.rotation();
  const Matrix3 I =
      R *
      Vector3(spread.y() + spread.z(), spread.x() + spread.z(), spread.x() + spread.y())
          .asDiagonal() *
      R.transpose();
  link.I_Lcm = 0.5 * (I + I.transpose());
  return link;
}

JointSpec jointSpec(const std::string& name, JointType type, const std::string& parent,
                    const std::string& child, const Transform& X_PC, const Vector3& axis) {
  JointSpec joint;
  joint.name = name;
  joint.type = type;
  joint.parent = parent;
  joint.child = child;
  joint.X_PC = X_PC;
  joint.axis = axis;
  return joint;
}

GeometrySpec geometrySpec(const std::string& link, const Shape& shape, double friction,
                          const Transform& X_LG) {
  GeometrySpec g;
  g.name = link + "/shape";
  g.link = link;
  g.X_LG = X_LG;
  g.shape = shape;
  g.material.slidingFriction = friction;
  return g;
}

GeometrySpec groundSpec(double friction, const Matrix3& R_WG) {
  return geometrySpec("world", Shape::plane(), friction, {R_WG, Vector3::Zero()});
}

ModelBuilder chain(int n) {
  ModelBuilder builder("chain");
  builder.link(emptyLink("world"));
  std::string parent = "world";
  for (int i = 0; i < n; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(boxLink(name, 1.0, {0.02, 0.02, 0.1}, {0, 0, -0.1}));
    const Transform X_PC{Matrix3::Identity(), Vector3(0, 0, i == 0 ? 0.0 : -0.2)};
    builder.joint(jointSpec("joint" + std::to_string(i), JointType::continuous, parent, name, X_PC,
                            i % 2 == 0 ? Vector3::UnitY() : Vector3::UnitX()));
    parent = name;
  }
  return builder;
}

ModelBuilder pendulum(double length, double mass, double radius, double armature, double damping) {
  ModelBuilder builder("pendulum");
  builder.link(emptyLink("world")).link(sphereLink("bob", mass, radius, {0, 0, -length}));
  JointSpec hinge = jointSpec("hinge", JointType::continuous, "world", "bob", {}, Vector3::UnitY());
  hinge.armature = armature;
  hinge.damping = damping;
  builder.joint(hinge);
  return builder;
}

ModelBuilder freeBody(const LinkSpec& body) {
  ModelBuilder builder("free body");
  builder.link(body);
  builder.base = BaseKind::floating;
  return builder;
}

ModelBuilder sphereOnPlane(double radius, double mass, double friction, const Matrix3& R_WG) {
  ModelBuilder builder = freeBody(sphereLink("body", mass, radius));
  builder.geometry(groundSpec(friction, R_WG));
  builder.geometry(geometrySpec("body", Shape::sphere(radius), friction));
  builder.X_WRoot = {R_WG, radius * R_WG.col(2)};
  return builder;
}

ModelBuilder boxOnPlane(const Vector3& half, double mass, double friction, const Matrix3& R_WG) {
  ModelBuilder builder = freeBody(boxLink("body", mass, half));
  builder.geometry(groundSpec(friction, R_WG));
  builder.geometry(geometrySpec("body", Shape::box(half), friction));
  builder.X_WRoot = {R_WG, half.z() * R_WG.col(2)};
  return builder;
}

namespace {

/// Adds limbs to the humanoid.
class BodyBuilder {
 public:
  explicit BodyBuilder(ModelBuilder& builder) : builder_(builder) {}

  /// A hinge with a range and a little damping; `mass` 0 makes a link without inertia, else a
  /// capsule from the joint to `end` [m].
  void limb(const std::string& name, const std::string& parent, const Vector3& at,
            const Vector3& axis, double lower, double upper, double mass = 0.0,
            const Vector3& end = Vector3::Zero(), double radius = 0.05) {
    JointSpec joint =
        jointSpec(name, JointType::revolute, parent, name, {Matrix3::Identity(), at}, axis);
    joint.lower = lower;
    joint.upper = upper;
    joint.damping = 0.5;
    joint.armature = 0.01;
    joint.effort = 60.0;
    builder_.joint(joint);
    if (mass == 0.0) {
      builder_.link(emptyLink(name));
      return;
    }
    const double half = 0.5 * end.norm();
    const Matrix3 R = Quaternion::FromTwoVectors(Vector3::UnitZ(), end).toRotationMatrix();
    LinkSpec link = boxLink(name, mass, {0.7 * radius, 0.7 * radius, half + radius}, 0.5 * end);
    link.I_Lcm = (R * link.I_Lcm * R.transpose()).eval();
    link.I_Lcm = (0.5 * (link.I_Lcm + link.I_Lcm.transpose())).eval();
    builder_.link(link);
    builder_.geometry(geometrySpec(name, Shape::capsule(radius, half), 1.0, {R, 0.5 * end}));
  }

  void ball(const std::string& link, double radius, const Vector3& at) {
    GeometrySpec g = geometrySpec(link, Shape::sphere(radius), 1.0, {Matrix3::Identity(), at});
    g.name = link + "/ball";
    builder_.geometry(g);
  }

 private:
  ModelBuilder& builder_;
};

}  // namespace

ModelBuilder humanoid() {
  ModelBuilder builder("humanoid");
  builder.base = BaseKind::floating;
  builder.X_WRoot.p = Vector3(0, 0, 0.9);
  builder.geometry(groundSpec(0.8));
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  builder.link(boxLink("pelvis", 8.0, {0.07, 0.14, 0.08}));
  builder.geometry(geometrySpec("pelvis", Shape::box({0.07, 0.14, 0.08}), 1.0));
  BodyBuilder body(builder);

  body.limb("abdomen_z", "pelvis", {0, 0, 0.1}, z, -0.8, 0.8);
  body.limb("abdomen_y", "abdomen_z", {0, 0, 0}, y, -1.3, 0.5);
  body.limb("chest", "abdomen_y", {0, 0, 0.02}, x, -0.6, 0.6, 16.0, {0, 0, 0.3}, 0.11);
  body.ball("chest", 0.1, {0, 0, 0.55});
  for (const double side : {-1.0, 1.0}) {
    const std::string s = side < 0 ? "right_" : "left_";
    body.limb(s + "hip_x", "pelvis", {0, 0.1 * side, -0.04}, x, -0.5, 0.5);
    body.limb(s + "hip_z", s + "hip_x", {0, 0, 0}, z, -0.8, 0.6);
    body.limb(s + "thigh", s + "hip_z", {0, 0, 0}, y, -1.9, 0.4, 5.0, {0, 0, -0.38}, 0.06);
    body.limb(s + "shin", s + "thigh", {0, 0, -0.4}, y, 0.0, 2.6, 3.0, {0, 0, -0.36}, 0.05);
    body.ball(s + "shin", 0.06, {0, 0, 0});
    body.limb(s + "ankle", s + "shin", {0, 0, -0.4}, y, -0.8, 0.8);
    JointSpec foot = jointSpec(s + "foot", JointType::revolute, s + "ankle", s + "foot", {}, x);
    foot.lower = -0.6;
    foot.upper = 0.6;
    foot.damping = 0.5;
    foot.armature = 0.01;
    const Vector3 sole(0.1, 0.045, 0.02), center(0.03, 0, -0.04);
    builder.joint(foot).link(boxLink(s + "foot", 1.0, sole, center));
    builder.geometry(
        geometrySpec(s + "foot", Shape::box(sole), 1.0, {Matrix3::Identity(), center}));

    body.limb(s + "shoulder", "chest", {0, 0.2 * side, 0.33}, x, -1.5, 1.5);
    body.limb(s + "upper_arm", s + "shoulder", {0, 0, 0}, y, -2.8, 1.0, 2.0, {0, 0, -0.27}, 0.04);
    body.limb(s + "forearm", s + "upper_arm", {0, 0, -0.29}, y, -2.3, 0.0, 1.5, {0, 0, -0.2}, 0.03);
    body.ball(s + "forearm", 0.05, {0, 0, -0.27});
  }
  return builder;
}

}  // namespace softgauss::test
