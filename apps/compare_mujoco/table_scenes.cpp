// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/table_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "apps/step_benchmark/scaling.hpp"

namespace softgauss::app {
namespace {

constexpr double kDensity = 1000.0;  ///< of what piles up [kg/m³]

/// A shape and the mass and central inertia of its homogeneous body.
struct Solid {
  Shape shape;
  double mass = 0.0;
  Vector3 inertia = Vector3::Zero();
};

Solid solidBox(const Vector3& half) {
  const double mass = 8.0 * kDensity * half.prod();
  const Vector3 squares = half.cwiseAbs2();
  return {Shape::box(half), mass, mass / 3.0 * (Vector3::Constant(squares.sum()) - squares)};
}

Solid solidSphere(double radius) {
  const double mass = kDensity * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
  return {Shape::sphere(radius), mass, Vector3::Constant(0.4 * mass * radius * radius)};
}

/// About z, of a cylinder and two half balls, whose centres are 3/8 r beyond its ends.
Solid solidCapsule(double radius, double halfLength) {
  const double r2 = radius * radius, l = halfLength;
  const double tube = kDensity * std::numbers::pi * r2 * 2.0 * l;
  const double ends = kDensity * 4.0 / 3.0 * std::numbers::pi * r2 * radius;
  const double along = tube * r2 / 2.0 + ends * 0.4 * r2;
  const double across =
      tube * (r2 / 4.0 + l * l / 3.0) + ends * (0.4 * r2 + l * l + 0.75 * l * radius);
  return {Shape::capsule(radius, l), tube + ends, Vector3(across, across, along)};
}

void addSolid(ModelBuilder& builder, const std::string& name, const Solid& solid,
              const Transform& pose) {
  ModelBuilder one("solid");
  one.base = BaseKind::floating;
  one.X_WRoot = pose;
  LinkSpec body;
  body.name = "body";
  body.mass = solid.mass;
  body.I_Lcm = solid.inertia.asDiagonal();
  one.link(body);
  GeometrySpec shape;
  shape.name = "shape";
  shape.link = "body";
  shape.shape = solid.shape;
  one.geometry(shape);
  builder.add(one, name);
}

/// Layers of `rows` by `rows` solids that turn each its own way fall on the ground: capsules, or
/// boxes, capsules and balls by turns.
ModelBuilder heap(int count, int rows, bool capsules) {
  constexpr double kApart = 0.28, kLayer = 0.32, kLowest = 0.25, kAside = 0.03;  // [m]
  const Solid kinds[] = {solidBox({0.12, 0.09, 0.07}), solidCapsule(0.07, 0.08), solidSphere(0.11)};
  ModelBuilder builder("pile");
  builder.base = BaseKind::floating;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> aside(-kAside, kAside);
  for (int i = 0; i < count; ++i) {
    Transform pose;
    Eigen::Vector4d turn;
    for (double& part : turn) part = normal(random);
    pose.R = Quaternion(turn.normalized()).toRotationMatrix();
    const int place = i % (rows * rows);
    pose.p.x() = kApart * (place % rows - rows / 2) + aside(random);
    pose.p.y() = kApart * (place / rows - rows / 2) + aside(random);
    pose.p.z() = kLowest + kLayer * (i / (rows * rows));
    addSolid(builder, fmt::format("solid{}", i), kinds[capsules ? 1 : i % 3], pose);
  }
  addGround(builder);
  return builder;
}

/// As broad as five or six layers make it.
std::unique_ptr<Scene> makePile(int count) {
  const int rows = std::max(2, static_cast<int>(std::lround(std::sqrt(count / 5.5))));
  return makeScene(heap(count, rows, false), false);
}

/// The links of chain() with capsules about them, the first floating, in a line on the ground.
std::unique_ptr<Scene> makeLyingChain(int links) {
  constexpr double kRadius = 0.02, kHalf = 0.028, kLength = 0.1;  // [m]
  constexpr double kPressed = 1e-5;                               // at the start [m]
  ModelBuilder builder("chain");
  builder.base = BaseKind::floating;
  builder.X_WRoot.p.z() = kRadius - kPressed;
  std::string parent;
  for (int i = 0; i < links; ++i) {
    LinkSpec link;
    link.name = fmt::format("link{}", i);
    link.mass = 0.1;
    link.com.x() = 0.5 * kLength;
    link.I_Lcm = Vector3(2e-5, 1e-4, 1e-4).asDiagonal();
    builder.link(link);
    GeometrySpec shape;
    shape.name = fmt::format("shape{}", i);
    shape.link = link.name;
    shape.shape = Shape::capsule(kRadius, kHalf);
    shape.X_LG.p = link.com;
    shape.X_LG.R = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3::UnitY()).matrix();
    builder.geometry(shape);
    if (i > 0) {
      JointSpec joint;
      joint.name = fmt::format("joint{}", i);
      joint.type = JointType::revolute;
      joint.parent = parent;
      joint.child = link.name;
      joint.axis = i % 2 == 0 ? Vector3::UnitY() : Vector3::UnitZ();
      joint.X_PC.p.x() = kLength;
      joint.damping = 0.01;
      builder.joint(joint);
    }
    parent = link.name;
  }
  addGround(builder);
  return makeScene(std::move(builder), false);
}

/// Every joint 0.1 rad or m from where it is, each its own way.
std::unique_ptr<Scene> withPosture(std::unique_ptr<Scene> scene) {
  auto posture = std::make_unique<gdd::Posture>(scene->state.q);
  for (const Body& body : scene->model.bodies)
    if (body.dofs == 1) posture->q[body.q] += 0.1 * std::sin(body.v + 1.0);
  scene->controller = std::make_unique<gdd::GoalDirectedController>(scene->model);
  scene->controller->goals.push_back(std::move(posture));
  return scene;
}

void addRobots(const std::string& robots, std::vector<TableScene>& scenes) {
  struct Passive {
    const char *name, *robot;
    int warmUp, windows, steps;
    bool inverse;
  };
  for (const auto& [name, robot, warmUp, windows, steps, inverse] :
       {Passive{"humanoid moving", "humanoid", 250, 10, 20, true},
        {"humanoid at rest", "humanoid", 2000, 4, 20, false},
        {"hand", "hand", 500, 6, 20, true},
        {"arm", "arm", 500, 6, 50, true}}) {
    TableScene scene{
        name, [=, robot = std::string(robot)] { return makeRobot(robots, robot, robot != "arm"); }};
    scene.warmUp = warmUp;
    scene.windows = windows;
    scene.steps = steps;
    scene.inverse = scene.derivatives = inverse;
    scenes.push_back(std::move(scene));
  }
  for (const std::string robot : {"humanoid", "hand", "arm"}) {
    TableScene scene{robot + " held by torques",
                     [=] { return withPosture(makeRobot(robots, robot, robot != "arm")); }};
    scene.drive = Drive::posture;
    scene.warmUp = 200;
    scene.windows = 10;
    scene.steps = robot == "arm" ? 50 : 20;
    scenes.push_back(std::move(scene));
  }
}

void addReaches(const std::string& robots, std::vector<TableScene>& scenes) {
  struct Reaching {
    std::string robot, link;
    Vector3 target;
    int warmUp, steps;
  };
  for (const auto& [robot, link, target, warmUp, steps] :
       {Reaching{"humanoid", "right_hand", {0.45, -0.25, 1.10}, 50, 20},
        Reaching{"hand", "index_tip", {0.25, 0.08, 0.06}, 100, 20},
        Reaching{"arm", "hand", {0.5, 0.3, 0.5}, 100, 50}}) {
    TableScene scene{robot + " reaching", [=, robot = robot, link = link, target = target] {
                       auto made = makeRobot(robots, robot, robot != "arm");
                       addReach(*made, link, target);
                       return made;
                     }};
    scene.drive = Drive::reach;
    scene.warmUp = warmUp;
    scene.windows = 8;
    scene.steps = steps;
    scenes.push_back(std::move(scene));
  }
}

/// A scene of a curve, larger than quick tables have from `large` on. The larger, the fewer steps.
TableScene onCurve(const std::string& curve, const std::string& what, int size, int large,
                   std::function<std::unique_ptr<Scene>()> make) {
  TableScene scene{what, std::move(make)};
  scene.curve = curve;
  scene.size = size;
  scene.windows = size >= 1000 ? 1 : size >= 200 ? 3 : 6;
  scene.between = size >= 200 ? 0 : 20;
  scene.large = size >= large;
  return scene;
}

/// Each with its islands: they stand apart.
void addHumanoids(const std::string& robots, std::vector<TableScene>& scenes) {
  const int links = static_cast<int>(humanoids(robots, 1).bodies.size()) - 1;
  for (const int n : {2, 5, 10, 20}) {
    TableScene scene = onCurve(kHumanoids, fmt::format("{} humanoids", n), n * links, 5 * links,
                               [=] { return makeHumanoids(robots, n); });
    scene.warmUp = 250;
    scene.windows = 6;
    scene.steps = 10;
    scenes.push_back(std::move(scene));
  }
}

void addCurves(std::vector<TableScene>& scenes) {
  for (const int n : {10, 30, 100, 300, 1000}) {
    TableScene scene = onCurve(kLying, fmt::format("chain of {} links on the ground", n), n, 100,
                               [n] { return makeLyingChain(n); });
    scene.warmUp = n >= 1000 ? 20 : 100;
    scene.steps = std::clamp(1000 / n, 1, 20);
    scene.inverse = n == 100;
    scenes.push_back(std::move(scene));
  }
  for (const int n : {10, 30, 100, 300}) {
    TableScene scene = onCurve(kSwinging, fmt::format("chain of {} links swinging freely", n), n,
                               100, [n] { return makeChain(n); });
    scene.steps = std::clamp(2000 / n, 1, 20);
    scene.inverse = n == 100;
    scenes.push_back(std::move(scene));
  }
  TableScene capsules{"27 capsules that fall apart",
                      [] { return makeScene(heap(27, 3, true), false); }};
  capsules.warmUp = 250;
  capsules.windows = 10;
  capsules.steps = 10;
  scenes.push_back(std::move(capsules));
  for (const int n : {10, 50, 100, 200, 500}) {
    TableScene scene =
        onCurve(kPile, fmt::format("pile of {}", n), n, 50, [n] { return makePile(n); });
    scene.warmUp = 500;
    scene.steps = std::clamp(300 / n, 2, 20);
    scene.inverse = n == 50;
    scenes.push_back(std::move(scene));
  }
  for (const int n : {10, 50, 200, 500}) {
    TableScene scene = onCurve(kBoxes, fmt::format("{} boxes at rest", n), n, 50,
                               [n] { return makeScene(boxesOnGround(n, 0.3), false); });
    scene.warmUp = 200;
    scene.steps = std::clamp(500 / n, 2, 20);
    scene.inverse = n == 50;
    scenes.push_back(std::move(scene));
  }
}

void addExtra(const RobotFile& robot, std::vector<TableScene>& scenes) {
  const std::string name = std::filesystem::path(robot.file).stem().string();
  const auto make = [model = loadRobot(robot, false)] {
    auto scene = makeScene(model);
    scene->state = standingState(scene->model);
    return scene;
  };
  TableScene held{name + " held by torques", [make] { return withPosture(make()); }};
  held.drive = Drive::posture;
  held.warmUp = 200;
  held.windows = 10;
  held.inverse = true;
  scenes.push_back(std::move(held));
  TableScene swung{name + " swung by torques", make};
  swung.drive = Drive::torques;
  swung.windows = 10;
  scenes.push_back(std::move(swung));
}

}  // namespace

std::vector<TableScene> tableScenes(const std::string& robots,
                                    const std::vector<RobotFile>& extra) {
  std::vector<TableScene> scenes;
  addRobots(robots, scenes);
  addCurves(scenes);
  addHumanoids(robots, scenes);
  addReaches(robots, scenes);
  for (const RobotFile& robot : extra) addExtra(robot, scenes);
  return scenes;
}

}  // namespace softgauss::app
