// SPDX-License-Identifier: Apache-2.0
#include "tests/stability/random_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::test {
namespace {

/// The height of the lowest point of a shape at X_WG [m].
double lowestPoint(const Shape& s, const Transform& X_WG) {
  const Vector3 up = X_WG.R.row(2).transpose();  // the vertical in the shape
  switch (s.kind) {
    case ShapeKind::capsule:
      return X_WG.p.z() - s.radius - s.halfLength * std::abs(up.z());
    case ShapeKind::cylinder:
      return X_WG.p.z() - s.radius * std::hypot(up.x(), up.y()) - s.halfLength * std::abs(up.z());
    case ShapeKind::box:
      return X_WG.p.z() - s.halfExtents.dot(up.cwiseAbs());
    default:
      return X_WG.p.z() - s.radius;
  }
}

struct WebBox {
  std::string name;
  Vector3 half = Vector3::Zero();
  Transform X_WB;
};

/// A point a quarter of the box's half extents outside of a face.
Vector3 pointOn(const WebBox& box, Random& random) {
  Vector3 p = 1.25 * random.vector3(1.0).cwiseProduct(box.half);
  const int face = random.index(3);
  p[face] = std::copysign(1.25 * box.half[face], p[face]);
  return p;
}

/// `web` with one more box, tied to the world or to one of `boxes`, to which it is added.
ModelBuilder withOneMore(ModelBuilder web, std::vector<WebBox>& boxes, Random& random) {
  WebBox box;
  box.name = "box" + std::to_string(boxes.size());
  for (double& half : box.half) half = random.uniform(0.03, 0.12);
  box.X_WB.R = random.rotation();
  box.X_WB.p = random.vector3(0.5);
  ConnectSpec tie;
  tie.linkA = box.name, tie.linkB = "world";
  const auto tieToWorld = [&] {
    tie.p_LAP = pointOn(box, random);
    tie.p_LBP = box.X_WB * tie.p_LAP;
  };
  if (boxes.empty() || random.chance(0.3)) {
    tieToWorld();
  } else {  // it is where their points meet
    const WebBox& other = boxes[random.index(static_cast<int>(boxes.size()))];
    tie.linkB = other.name;
    tie.p_LAP = pointOn(box, random);
    tie.p_LBP = pointOn(other, random);
    box.X_WB.p = other.X_WB * tie.p_LBP - box.X_WB.R * tie.p_LAP;
  }
  const double mass = decades(random, 0.01, 10.0);
  addBody(web, box.name, Shape::box(box.half), mass, box.X_WB, 0.8);
  web.connect(tie);
  if (random.chance(0.3)) {
    tie.linkB = "world";
    tieToWorld();
    web.connect(tie);
  }
  boxes.push_back(box);
  return web;
}

/// One of five shapes, of `size` [m].
Shape thrownShape(int kind, double size, Random& random) {
  const double ratio = random.uniform(0.0, 1.0);
  switch (kind) {
    case 0:
      return Shape::cylinder(size, size * (0.5 + 2.0 * ratio));
    case 1:  // a coin
      return Shape::cylinder(size, size * (0.05 + 0.15 * ratio));
    case 2:
      return Shape::capsule(size, size * (0.5 + 2.0 * ratio));
    case 3:
      return Shape::box(size * Vector3(1.0, 0.2 + 0.8 * ratio, random.uniform(0.1, 1.0)));
    default:
      return Shape::sphere(size);
  }
}

/// Of a box that holds it [m³].
double roughVolume(const Shape& s) {
  if (s.kind == ShapeKind::box) return 8.0 * s.halfExtents.prod();
  return 8.0 * s.radius * s.radius * std::max(s.radius, s.halfLength);
}

}  // namespace

ModelBuilder numbered(const std::string& kind, int seed, double timestep) {
  return with(ModelBuilder(kind + " " + std::to_string(seed)), timestep,
              seed % 2 ? Cone::elliptic : Cone::pyramidal);
}

Impedance anyImpedance(Random& random, bool direct) {
  Impedance p;
  p.dMin = p.dMax = decades(random, 1e-4, 0.9);
  p.timeConstant = decades(random, 1e-4, 0.05);
  if (direct) {
    const double K = random.uniform(100.0, 40000.0);
    p.direct = ReferenceSpring{K, 2.0 * std::sqrt(K) * random.uniform(1.0, 2.0)};
  }
  return p;
}

void layGround(RandomScene& scene, double clearance) {
  Kinematics kinematics(scene.model);
  computeKinematics(scene.model, scene.state, kinematics);
  double low = kInfinity;
  for (const Geometry& g : scene.model.geometries)
    if (g.body > 0) low = std::min(low, lowestPoint(g.shape, kinematics.X_WB[g.body] * g.X_BG));
  for (Geometry& g : scene.model.geometries)
    if (g.shape.kind == ShapeKind::plane) g.X_BG.p.z() = low - clearance;
}

bool overlaps(RandomScene& scene) {
  layGround(scene, 1.0);
  Kinematics kinematics(scene.model);
  computeKinematics(scene.model, scene.state, kinematics);
  ContactSet contacts;
  collision::SceneContacts(scene.model).detect(scene.model, kinematics, contacts);
  return !contacts.contacts.empty();
}

RandomScene randomWeb(int seed, double timestep) {
  Random random(seed);
  const int count = 3 + random.index(8);
  const double clearance = random.uniform(0.02, 0.5);
  ModelBuilder web = numbered("web", seed, timestep);
  web.geometry(groundSpec(0.8));
  std::vector<WebBox> boxes;
  while (static_cast<int>(boxes.size()) < count) {
    std::vector<WebBox> more = boxes;
    const ModelBuilder next = withOneMore(web, more, random);
    RandomScene scene(next);
    if (overlaps(scene)) continue;
    web = next;
    boxes = more;
  }
  RandomScene scene(web);
  layGround(scene, clearance);
  return scene;
}

RandomScene randomPair(int seed, double timestep, double ratio, double turn) {
  Random random(seed);
  ModelBuilder builder = numbered("pair", seed, timestep);
  ConnectSpec tie;
  tie.impedance = anyImpedance(random, seed % 5 == 4);
  const double heavy = decades(random, 1.0, ratio);
  const bool first = random.chance(0.5);
  builder.geometry(groundSpec(0.8));
  addBody(builder, "a", Shape::box(Vector3::Constant(0.1)), first ? heavy : 1.0,
          {Matrix3::Identity(), Vector3(0, 0, 0.5)});
  addBody(builder, "b", Shape::box(Vector3::Constant(0.1)), first ? 1.0 : heavy,
          {Matrix3::Identity(), Vector3(0.21, 0, 0.5)});
  tie.linkA = "a", tie.linkB = "b";
  tie.p_LAP = Vector3(0.12, 0, 0.05), tie.p_LBP = Vector3(-0.09, 0, 0.05);
  builder.connect(tie);
  RandomScene scene(builder);
  const Vector3 omega = random.vector3(turn), v = random.vector3(1.0);
  scene.state.v << v, omega, v + omega.cross(Vector3(0.21, 0, 0)), omega;
  return scene;
}

void softenContacts(Model& pair, int seed) {
  if (seed % 4 < 2) return;
  for (Geometry& g : pair.geometries) g.material.impedance = pair.connections[0].impedance;
}

RandomScene randomCrank(int seed, double timestep) {
  Random random(seed);
  const double rod = decades(random, 0.003, 0.05), speed = random.uniform(10.0, 60.0);
  const double flywheel = decades(random, 0.1, 20.0), slider = decades(random, 0.02, 2.0);
  const double radius = random.uniform(0.02, 0.1), length = radius + random.uniform(0.05, 0.3);
  ModelBuilder builder = with(ModelBuilder("crank " + std::to_string(seed)), timestep);
  builder.base = BaseKind::floating;
  builder.options.gravity.setZero();
  builder.link(boxLink("base", 1000.0, Vector3::Constant(0.5)));
  builder.link(boxLink("flywheel", flywheel, Vector3(radius, 0.01, radius)));
  builder.link(boxLink("slider", slider, Vector3::Constant(0.02)));
  builder.link(boxLink("rod", rod, Vector3(0.5 * length, 0.005, 0.005)));
  builder.joint(jointSpec("axle", JointType::continuous, "base", "flywheel", {}, Vector3::UnitY()));
  Transform dead;
  dead.p.x() = radius + length;
  JointSpec rail =
      jointSpec("rail", JointType::prismatic, "base", "slider", dead, Vector3::UnitX());
  rail.lower = -1.0, rail.upper = 1.0;
  builder.joint(rail);
  for (const std::string end : {"flywheel", "slider"}) {
    ConnectSpec tie;
    tie.linkA = "rod", tie.p_LAP.x() = (end == "slider" ? 0.5 : -0.5) * length;
    tie.linkB = end, tie.p_LBP.x() = end == "slider" ? 0.0 : radius;
    builder.connect(tie);
  }
  RandomScene scene(builder);
  const Model& m = scene.model;
  const Body& free = m.bodies[m.frames[m.findFrame("rod")].body];
  scene.state.q[free.q] = radius + 0.5 * length;
  scene.state.v[free.v + 2] = -0.5 * speed * radius;
  scene.state.v[free.v + 4] = -speed * radius / length;
  scene.state.v[m.bodies[m.findJoint("axle")].v] = speed;
  return scene;
}

RandomScene randomThrown(int seed, double timestep) {
  Random random(seed);
  ModelBuilder builder = numbered("thrown", seed, timestep);
  const double friction = decades(random, 0.1, 2.0), clearance = decades(random, 0.001, 0.3);
  const int kind = random.index(5);
  const double size = decades(random, 0.006, 0.1);
  const Shape shape = thrownShape(kind, size, random);
  const double density = decades(random, 300.0, 8000.0);
  const Matrix3 R =
      seed % 4 < 2 ? quaternionExp(random.vector3(0.05)).toRotationMatrix() : random.rotation();
  builder.geometry(groundSpec(friction));
  addBody(builder, "thrown", shape, density * roughVolume(shape), {R, Vector3::Zero()}, friction);
  RandomScene scene(builder);
  const double rate = random.uniform(0.0, 100.0);
  const Vector3 axis = random.direction(), v = random.vector3(2.0);
  scene.state.v << v.x(), v.y(), -std::abs(v.z()), rate * axis;
  layGround(scene, clearance);
  return scene;
}

}  // namespace softgauss::test
