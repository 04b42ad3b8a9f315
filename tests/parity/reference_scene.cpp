// SPDX-License-Identifier: Apache-2.0
#include "tests/parity/reference_scene.hpp"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string_view>

#include "softgauss/engine/model/model_builder.hpp"

namespace softgauss::test {
namespace {

using Json = nlohmann::json;

/// Throws when `object` has a key besides those listed.
void allowKeys(const Json& object, std::initializer_list<std::string_view> keys) {
  for (const auto& [key, value] : object.items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw std::runtime_error("this engine's scenes have no '" + key + "' in " + object.dump());
}

template <int n>
Eigen::Matrix<double, n, 1> vectorOf(const Json& list) {
  if (list.size() != n) throw std::runtime_error("expected " + std::to_string(n) + " numbers");
  Eigen::Matrix<double, n, 1> x;
  for (int i = 0; i < n; ++i) x[i] = list[static_cast<std::size_t>(i)].get<double>();
  return x;
}

Transform poseOf(const Json& item) {
  Transform X;
  if (item.contains("position")) X.p = vectorOf<3>(item["position"]);
  if (item.contains("quaternion")) {
    const Eigen::Vector4d q = vectorOf<4>(item["quaternion"]);
    X.R = Quaternion(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }
  return X;
}

Impedance impedanceOf(const Json& item) {
  Impedance p;
  if (item.contains("solref")) {
    const Eigen::Vector2d solref = vectorOf<2>(item["solref"]);
    if (solref.minCoeff() > 0.0) {
      p.timeConstant = solref[0];
      p.dampingRatio = solref[1];
    } else if (solref.maxCoeff() <= 0.0) {
      p.direct = {-solref[0], -solref[1]};
    } else {
      throw std::runtime_error("solref of two signs");
    }
  }
  if (item.contains("solimp")) {
    const Eigen::Matrix<double, 5, 1> solimp = vectorOf<5>(item["solimp"]);
    p.dMin = solimp[0];
    p.dMax = solimp[1];
    p.width = solimp[2];
    p.midpoint = solimp[3];
    p.power = solimp[4];
  }
  return p;
}

LinkSpec linkOf(const Json& item) {
  allowKeys(item, {"name", "mass", "com", "inertia"});
  LinkSpec link;
  link.name = item.at("name");
  link.mass = item.value("mass", 0.0);
  if (link.mass == 0.0) return link;
  link.com = vectorOf<3>(item.at("com"));
  const Eigen::Matrix<double, 6, 1> I = vectorOf<6>(item.at("inertia"));
  link.I_Lcm = Symmetric3{I[0], I[1], I[2], I[3], I[4], I[5]}.matrix();
  return link;
}

JointSpec jointOf(const Json& item) {
  allowKeys(item, {"name", "type", "parent", "child", "position", "quaternion", "axis", "range",
                   "damping", "armature", "dryFriction", "stiffness", "springReference", "margin",
                   "solref", "solimp"});
  static const std::map<std::string, JointType> types = {{"fixed", JointType::fixed},
                                                         {"revolute", JointType::revolute},
                                                         {"prismatic", JointType::prismatic},
                                                         {"floating", JointType::floating}};
  JointSpec joint;
  joint.name = item.at("name");
  joint.type = types.at(item.at("type"));
  joint.parent = item.at("parent");
  joint.child = item.at("child");
  joint.X_PC = poseOf(item);
  if (item.contains("axis")) joint.axis = vectorOf<3>(item["axis"]);
  if (item.contains("range")) {
    const Eigen::Vector2d range = vectorOf<2>(item["range"]);
    joint.lower = range[0];
    joint.upper = range[1];
  }
  joint.damping = item.value("damping", 0.0);
  joint.armature = item.value("armature", 0.0);
  joint.dryFriction = item.value("dryFriction", 0.0);
  joint.stiffness = item.value("stiffness", 0.0);
  joint.springReference = item.value("springReference", 0.0);
  joint.frictionImpedance = impedanceOf(item);
  return joint;
}

Shape shapeOf(const Json& item) {
  const std::string kind = item.at("kind");
  if (kind == "plane") return Shape::plane();
  if (kind == "sphere") return Shape::sphere(item.at("radius"));
  if (kind == "capsule") return Shape::capsule(item.at("radius"), item.at("halfLength"));
  if (kind == "cylinder") return Shape::cylinder(item.at("radius"), item.at("halfLength"));
  if (kind == "box") return Shape::box(vectorOf<3>(item.at("halfExtents")));
  throw std::runtime_error("a shape of kind '" + kind + "'");
}

GeometrySpec geometryOf(const Json& item) {
  allowKeys(item, {"name", "link", "kind", "radius", "halfLength", "halfExtents", "position",
                   "quaternion", "friction", "condim", "margin", "priority", "solmix", "solref",
                   "solimp"});
  GeometrySpec g;
  g.name = item.at("name");
  g.link = item.at("link");
  g.X_LG = poseOf(item);
  g.shape = shapeOf(item);
  if (item.contains("friction")) {
    const Vector3 friction = vectorOf<3>(item["friction"]);
    g.material.slidingFriction = friction[0];
    g.material.torsionalFriction = friction[1];
    g.material.rollingFriction = friction[2];
  }
  g.material.condim = item.value("condim", g.material.condim);
  g.material.margin = item.value("margin", g.material.margin);
  g.material.priority = item.value("priority", g.material.priority);
  g.material.mixWeight = item.value("solmix", g.material.mixWeight);
  g.material.impedance = impedanceOf(item);
  return g;
}

/// MuJoCo ties sites: the first is A.
void addEquality(ModelBuilder& builder, const Json& item) {
  const std::string kind = item.at("kind");
  if (kind == "joint") {
    allowKeys(item, {"kind", "follower", "leader", "polynomial", "solref", "solimp"});
    CouplingSpec spec;
    spec.follower = item.at("follower");
    spec.leader = item.at("leader");
    spec.polynomial = item.at("polynomial").get<std::array<double, 5>>();
    spec.impedance = impedanceOf(item);
    builder.couple(spec);
    return;
  }
  allowKeys(item, {"kind", "linkA", "positionA", "quaternionA", "linkB", "positionB", "quaternionB",
                   "solref", "solimp"});
  const auto frame = [&](const std::string& side) {
    Json pose;
    if (item.contains("position" + side)) pose["position"] = item["position" + side];
    if (item.contains("quaternion" + side)) pose["quaternion"] = item["quaternion" + side];
    return poseOf(pose);
  };
  if (kind == "weld") {
    WeldSpec spec;
    spec.linkA = item.at("linkA");
    spec.linkB = item.at("linkB");
    spec.X_LAF = frame("A");
    spec.X_LBF = frame("B");
    spec.impedance = impedanceOf(item);
    builder.weld(spec);
  } else if (kind == "connect") {
    ConnectSpec spec;
    spec.linkA = item.at("linkA");
    spec.linkB = item.at("linkB");
    spec.p_LAP = frame("A").p;
    spec.p_LBP = frame("B").p;
    spec.impedance = impedanceOf(item);
    builder.connect(spec);
  } else {
    throw std::runtime_error("an equality of kind '" + kind + "'");
  }
}

}  // namespace

Model referenceModel(const std::string& name, const Json& scene, const Json& options) {
  allowKeys(scene, {"links", "joints", "geometries", "equalities"});
  allowKeys(options, {"timestep", "gravity", "cone", "impratio", "diagexact"});
  ModelBuilder builder(name);
  builder.base = BaseKind::fixed;
  builder.options.timestep = options.at("timestep");
  builder.options.gravity = vectorOf<3>(options.at("gravity"));
  builder.options.cone = options.at("cone") == "elliptic" ? Cone::elliptic : Cone::pyramidal;
  builder.options.exactDiagonal = options.value("diagexact", false);
  builder.options.impedanceRatio = options.at("impratio");
  builder.options.useMujocoModel();
  LinkSpec world;
  world.name = "world";
  builder.link(world);
  for (const Json& item : scene.at("links")) builder.link(linkOf(item));
  for (const Json& item : scene.at("joints")) builder.joint(jointOf(item));
  for (const Json& item : scene.at("geometries")) builder.geometry(geometryOf(item));
  for (const Json& item : scene.at("equalities")) addEquality(builder, item);
  Model model = builder.build();
  // A URDF has neither margin nor softness of a range, so the builder takes none.
  for (const Json& item : scene.at("joints"))
    for (JointRange& range : model.ranges)
      if (model.jointNames[static_cast<std::size_t>(range.body)] == item.at("name")) {
        range.margin = item.value("margin", range.margin);
        range.impedance = impedanceOf(item);
      }
  return model;
}

}  // namespace softgauss::test
