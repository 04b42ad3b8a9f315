// SPDX-License-Identifier: Apache-2.0
#include "apps/rivals/scene.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace rivals {
namespace {

using nlohmann::json;

double number(const json& j, std::size_t i) { return j.at(i).get<double>(); }
Vector3d vector(const json& j) { return Vector3d(number(j, 0), number(j, 1), number(j, 2)); }
Quaterniond quaternion(const json& j) {
  return Quaterniond(number(j, 0), number(j, 1), number(j, 2), number(j, 3)).normalized();
}

Shape shape(const json& j) {
  const std::string kind = j.at("kind");
  Shape s{kind == "box"      ? ShapeKind::box
          : kind == "sphere" ? ShapeKind::sphere
                             : ShapeKind::capsule,
          vector(j.at("size"))};
  s.pose.linear() = quaternion(j.at("orientation")).toRotationMatrix();
  s.pose.translation() = vector(j.at("position"));
  return s;
}

Body body(const json& j) {
  Body b{j.at("name"),
         j.at("mass"),
         vector(j.at("inertia")),
         {vector(j.at("position")), quaternion(j.at("orientation")), vector(j.at("velocity")),
          vector(j.at("angular_velocity"))},
         {}};
  for (const json& s : j.at("shapes")) b.shapes.push_back(shape(s));
  if (j.contains("force")) b.force = vector(j.at("force"));
  return b;
}

Joint joint(const json& j) {
  const std::string kind = j.at("kind");
  Joint x{kind == "hinge"    ? JointKind::hinge
          : kind == "slider" ? JointKind::slider
          : kind == "ball"   ? JointKind::ball
                             : JointKind::tie,
          j.at("parent"),
          j.at("child"),
          vector(j.at("anchor")),
          vector(j.at("axis")),
          {},
          j.at("force")};
  if (!j.at("range").is_null()) x.range = {number(j.at("range"), 0), number(j.at("range"), 1)};
  if (j.contains("program"))
    for (const json& p : j.at("program")) x.program.emplace_back(number(p, 0), number(p, 1));
  return x;
}

}  // namespace

Isometry3d BodyState::pose() const {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = orientation.toRotationMatrix();
  X.translation() = position;
  return X;
}

double Joint::forceAt(double time) const {
  constexpr double kRounding = 1e-9;  // [s] of a time that is a sum of steps
  double now = force;
  for (const auto& [from, value] : program)
    if (time >= from - kRounding) now = value;
  return now;
}

double Scene::fallSpeed() const {
  const Shape& shape = bodies[0].shapes[0];
  const double under = shape.kind == ShapeKind::box ? shape.size[2] : shape.size[0];
  return std::sqrt(2.0 * gravity.norm() * (bodies[0].start.position[2] - under));
}

double Scene::mass() const {
  double sum = 0.0;
  for (const Body& b : bodies) sum += b.mass;
  return sum;
}

Isometry3d Scene::startOf(int body) const {
  return body < 0 ? Isometry3d::Identity() : bodies[static_cast<std::size_t>(body)].start.pose();
}

double Scene::jointSpeed(const Joint& joint) const {
  const auto pointVelocity = [&](int body) -> std::pair<Vector3d, Vector3d> {
    if (body < 0) return {Vector3d::Zero(), Vector3d::Zero()};
    const BodyState& s = bodies[static_cast<std::size_t>(body)].start;
    return {s.velocity + s.angularVelocity.cross(joint.anchor - s.position), s.angularVelocity};
  };
  const auto [v0, w0] = pointVelocity(joint.parent);
  const auto [v1, w1] = pointVelocity(joint.child);
  return joint.axis.dot(joint.kind == JointKind::slider ? v1 - v0 : w1 - w0);
}

const Joint* Scene::carrier(int body) const {
  for (const Joint& j : joints)
    if (j.child == body && j.kind != JointKind::tie) return &j;
  return nullptr;
}

Scene parseScene(const std::string& text) {
  const json j = json::parse(text);
  Scene s{j.at("name"),
          j.at("measure"),
          vector(j.at("gravity")),
          j.at("friction"),
          j.at("ground"),
          j.at("collide"),
          j.at("duration"),
          j.at("sample"),
          {},
          {}};
  for (const json& b : j.at("bodies")) s.bodies.push_back(body(b));
  for (const json& x : j.at("joints")) s.joints.push_back(joint(x));
  s.restitution = j.value("restitution", 0.0);
  if (j.contains("ground_friction")) s.groundFriction = j.at("ground_friction").get<double>();
  return s;
}

Scene readScene(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read; ./dev rivals writes the scenes");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  try {
    return parseScene(text);
  } catch (const json::exception& e) {
    throw std::runtime_error(path + ": " + e.what());
  }
}

}  // namespace rivals
