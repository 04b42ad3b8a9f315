// SPDX-License-Identifier: Apache-2.0
#include "apps/step_benchmark/scenes.hpp"

#include <fmt/format.h>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss::app {

void addGround(ModelBuilder& builder) {
  GeometrySpec plane;
  plane.name = "ground";
  plane.link = "world";
  plane.shape = Shape::plane();
  builder.geometry(plane);
}

std::unique_ptr<Scene> makeScene(Model model) {
  auto scene = std::make_unique<Scene>();
  scene->model = std::move(model);
  scene->contacts = std::make_unique<collision::SceneContacts>(scene->model);
  scene->data = std::make_unique<Data>(scene->model);
  scene->state = State(scene->model);
  return scene;
}

std::unique_ptr<Scene> makeScene(ModelBuilder builder, bool ground) {
  if (ground) addGround(builder);
  std::unique_ptr<Scene> scene = makeScene(builder.build());
  const Body& root = scene->model.bodies[scene->model.trees.front().rootBody];
  if (ground && root.joint == JointKind::floating) {
    computeKinematics(scene->model, scene->state, scene->data->kinematics);
    scene->state.q[root.q + 2] -= collision::lowestPoint(scene->model, scene->data->kinematics, 0);
  }
  return scene;
}

std::unique_ptr<Scene> makeRobot(const std::string& folder, const std::string& name, bool ground) {
  return makeScene(io::readUrdf(folder + "/" + name + ".urdf"), ground);
}

ModelBuilder chain(int links) {
  ModelBuilder builder("chain");
  LinkSpec link;
  link.name = "world";
  builder.link(link);
  for (int i = 0; i < links; ++i) {
    LinkSpec next;
    next.name = fmt::format("link{}", i);
    next.mass = 0.1;
    next.com = Vector3(0.05, 0.0, 0.0);
    next.I_Lcm = Vector3(2e-5, 1e-4, 1e-4).asDiagonal();
    builder.link(next);
    JointSpec joint;
    joint.name = fmt::format("joint{}", i);
    joint.type = JointType::revolute;
    joint.parent = link.name;
    joint.child = next.name;
    joint.axis = i % 2 == 0 ? Vector3::UnitY() : Vector3::UnitZ();
    if (i > 0) joint.X_PC.p = Vector3(0.1, 0.0, 0.0);
    joint.damping = 0.01;
    builder.joint(joint);
    link = next;
  }
  return builder;
}

std::unique_ptr<Scene> makeChain(int links) { return makeScene(chain(links), false); }

void addReach(Scene& scene, const std::string& link, const Vector3& target) {
  scene.controller = std::make_unique<gdd::GoalDirectedController>(scene.model);
  scene.controller->goals.push_back(std::make_unique<gdd::Reach>(scene.model, link, target));
  scene.controller->goals.push_back(std::make_unique<gdd::VirtualDamping>());
}

ModelBuilder freeBoxes(int count, double height, double spacing, const Vector3& from) {
  ModelBuilder builder("boxes");
  builder.base = BaseKind::floating;
  for (int i = 0; i < count; ++i) {
    ModelBuilder one("box");
    one.base = BaseKind::floating;
    one.X_WRoot.p = from + Vector3(spacing * (i % 5), spacing * (i / 5), height);
    LinkSpec link;
    link.name = "body";
    link.mass = 1.0;
    link.com = Vector3(0.0, 0.0, 0.01);  // off its origin, so that M is not diagonal
    link.I_Lcm = 0.0067 * Matrix3::Identity();
    one.link(link);
    GeometrySpec shape;
    shape.name = "shape";
    shape.link = "body";
    shape.shape = Shape::box(Vector3(0.1, 0.1, 0.1));
    one.geometry(shape);
    builder.add(one, fmt::format("box{}", i));
  }
  return builder;
}

}  // namespace softgauss::app
