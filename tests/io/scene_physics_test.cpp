// SPDX-License-Identifier: Apache-2.0
/// Springs, surfaces of pairs, options and wrenches of scene files.

#include <cmath>

#include "scene_folder.hpp"
#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/engine.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

// The arm turns about its centre of mass with I = 1 kg m²: a = −k (q − q_s).
TEST(SceneFile, SpringsPullJointsToTheirReference) {
  const SceneFolder folder(
      "gravity: [0, 0, 0]\n"
      "robots:\n"
      "  - {urdf: sample.urdf, base: fixed, joints: {shoulder: 0.7}, joint_parameters:\n"
      "     {shoulder: {stiffness: 3, spring_reference: 0.2, friction: 0}}}\n");
  const io::SceneFile scene = folder.read();
  Model model = scene.builder.build();
  model.options.integrator = Integrator::semiImplicitEuler;
  model.options.implicitInSolve = false;
  State state = scene.initialState(model);
  Data data(model);
  step(model, {}, state, data, nullptr);
  EXPECT_SMALL(data.forward.a[0] + 3.0 * (0.7 - 0.2), 1e-14);
}

// A servo of the arm, whose effort is 40 in the URDF: I = 1 kg m², f = kp (u − q) far from it.
TEST(SceneFile, ServosDriveJoints) {
  const auto servoOf = [](const std::string& keys) {
    const SceneFolder folder(
        "robots:\n  - {urdf: sample.urdf, base: fixed, joint_parameters: {shoulder: {servo: {" +
        keys + "}}}}\n");
    const io::SceneFile scene = folder.read();
    const Model model = scene.builder.build();
    return model.dofs[0].servo;
  };
  const Servo servo = servoOf("kp: 200, kd: 10, effort: 5, set_point: 0.3, set_point_rate: 0.1");
  EXPECT_EQ(servo.kp, 200.0);
  EXPECT_EQ(servo.kd, 10.0);
  EXPECT_EQ(servo.effort, 5.0);
  EXPECT_EQ(servo.setPoint, 0.3);
  EXPECT_EQ(servo.setPointRate, 0.1);
  const auto model = SceneFolder("robots:\n  - {urdf: sample.urdf, base: fixed}\n").read();
  EXPECT_EQ(servoOf("kd: 10").effort, model.builder.build().dofs[0].effortUpper);
}

const std::string kPairs =
    "materials:\n"
    "  ice: {friction: 0.05, condim: 1}\n"
    "  rubber: {friction: 1.3, margin: 0.002, time_constant: 0.01}\n"
    "robots:\n"
    "  - {name: a, urdf: sample.urdf, material: rubber}\n"
    "objects:\n"
    "  - {name: ball, sphere: {radius: 0.1}, material: ice}\n"
    "  - {name: floor, plane: {}}\n";

/// The sample with two shapes on its arm.
SceneFolder pairScene(const std::string& pairs) {
  return SceneFolder(kPairs + pairs,
                     io::with(io::kSampleUrdf, "<collision><geometry><cyl",
                              "<collision><origin xyz=\"0 0 9\"/><geometry><sphere "
                              "radius=\"0.1\"/></geometry></collision><collision><geometry><cyl"));
}

TEST(SceneFile, PairsHaveTheSurfaceThatTheyAreGiven) {
  const SceneFolder folder = pairScene(
      "pairs:\n"
      "  - {a: a/arm, b: ball, friction: 0.2}\n"
      "  - {a: ground, b: a/arm, material: ice, margin: 0.01}\n"
      "  - {a: floor, b: ball, condim: 6, impedance: {width: 0.5}}\n");
  io::SceneFile scene = folder.read();
  GeometrySpec ground;  // as the program adds it
  ground.name = "ground";
  ground.link = "world";
  ground.shape = Shape::plane();
  const Model model = scene.builder.geometry(ground).build();
  int named = 0;
  for (int i = 0; i < static_cast<int>(model.geometries.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(model.geometries.size()); ++j) {
      const Geometry &a = model.geometries[i], &b = model.geometries[j];
      const auto are = [&](const std::string& x, const std::string& y) {
        const auto is = [](const Geometry& g, const std::string& n) {
          return g.link == n || g.name == n;
        };
        return (is(a, x) && is(b, y)) || (is(a, y) && is(b, x));
      };
      Material expected = mixMaterials(a.material, b.material);
      if (are("a/arm", "ball")) expected.slidingFriction = 0.2;
      if (are("a/arm", "ground")) {
        expected = Material{};
        expected.slidingFriction = 0.05;
        expected.condim = 1;
        expected.margin = 0.01;
      }
      if (are("floor", "ball")) {
        expected.condim = 6;
        expected.impedance.width = 0.5;
      }
      for (const auto& [x, y] : {std::pair{i, j}, {j, i}}) {
        const Material m = pairMaterial(model, x, y);
        EXPECT_EQ(m.slidingFriction, expected.slidingFriction) << a.name << " - " << b.name;
        EXPECT_EQ(m.condim, expected.condim);
        EXPECT_EQ(m.margin, expected.margin);
        EXPECT_EQ(m.impedance.timeConstant, expected.impedance.timeConstant);
        EXPECT_EQ(m.impedance.width, expected.impedance.width);
      }
      named += are("a/arm", "ball") || are("a/arm", "ground") || are("floor", "ball") ? 1 : 0;
    }
  EXPECT_EQ(named, 5) << "two shapes of the arm with two others, and the ball on the floor";
  EXPECT_EQ(model.contactPairs.size(), 5u);
}

TEST(SceneFile, GroundIsOfTheDefaultMaterial) {
  const SceneFolder folder(
      "materials: {default: {friction: 0.3}}\nobjects: [{name: ball, sphere: {radius: 1}}]\n");
  EXPECT_EQ(folder.read().groundMaterial.slidingFriction, 0.3);
}

TEST(SceneFile, OptionsAreThoseOfTheModel) {
  const std::string robot = "robots: [{urdf: sample.urdf}]\n";
  const io::SceneFile plainScene = SceneFolder(robot).read();
  const Options& plain = plainScene.builder.options;
  EXPECT_EQ(plain.effects, EffectSet::all());
  EXPECT_EQ(plain.integrator, Integrator::leapfrog);
  EXPECT_TRUE(plain.implicitInSolve);
  EXPECT_TRUE(plain.constraintModel == ConstraintModel::softgauss);
  EXPECT_EQ(plainScene.gddSolver, std::nullopt);
  const io::SceneFile scene =
      SceneFolder(robot +
                  "options: {integrator: semi-implicit-euler, tolerance: 1e-9, max_iterations: 7,\n"
                  "  impedance_ratio: 4, effects: [gravity, joint_limit], compatibility: mujoco,\n"
                  "  cone: elliptic, exact_diagonal: true,\n"
                  "  gdd_solver: augmented-lagrangian}\n")
          .read();
  const Options& o = scene.builder.options;
  EXPECT_EQ(scene.gddSolver, gdd::GddSolver::augmentedLagrangian);
  EXPECT_EQ(o.tolerance, 1e-9);
  EXPECT_EQ(o.maxIterations, 7);
  EXPECT_EQ(o.impedanceRatio, 4.0);
  EXPECT_FALSE(o.implicitInSolve);
  EXPECT_FALSE(o.constraintModel == ConstraintModel::softgauss);
  EXPECT_EQ(o.cone, Cone::elliptic);
  EXPECT_TRUE(o.exactDiagonal);
  EffectSet two = EffectSet::none();
  two.insert(Effect::gravity);
  two.insert(Effect::jointLimit);
  EXPECT_EQ(o.effects, two);
}

// ---- Wrenches -----------------------------------------------------------------------------------

/// Runs a scene as the program does, without contacts.
struct Simulation {
  explicit Simulation(const std::string& text)
      : folder(text),
        scene(folder.read()),
        model(scene.builder.build()),
        schedule(model, scene.wrenches),
        state(scene.initialState(model)),
        data(model) {}

  void advance(int steps) {
    Input input;
    for (int i = 0; i < steps; ++i) {
      computeKinematics(model, state, data.kinematics);
      schedule.at(state.time, model.options.timestep, data.kinematics, input.wrenches);
      step(model, input, state, data, nullptr);
    }
  }
  SceneFolder folder;
  io::SceneFile scene;
  Model model;
  io::WrenchSchedule schedule;
  State state;
  Data data;
};

const std::string kBall =
    "timestep: 0.01\ngravity: [0, 0, 0]\nground: none\n"
    "objects: [{name: ball, sphere: {radius: 0.1}, mass: 2, rpy: [0.4, 1.1, -2]}]\n";

// An impulse F Δt. Summed up, the steps end before 0.1 and 0.12 s and after 0.06 and 0.3 s.
TEST(SceneWrench, GivesItsImpulse) {
  Simulation run(kBall +
                 "wrenches:\n"
                 "  - {link: ball, force: [3, 0, -1], moment: [0, 0.02, 0], start: 0.1, end: 0.3}\n"
                 "  - {link: ball, force: [0, 8, 0], start: 0.06, end: 0.12}\n");
  run.advance(6);
  EXPECT_TRUE(run.state.v.isZero(0.0)) << "before the start";
  run.advance(54);
  EXPECT_APPROX(run.state.v.head<3>(), Vector3(3 * 0.2, 8 * 0.06, -1 * 0.2) / 2.0, 1e-13);
  // I = 2/5 m r² about every axis.
  const Vector3 omega(0, 0.02 * 0.2 / (0.4 * 2.0 * 0.01), 0);
  EXPECT_APPROX(run.data.kinematics.V[1].angular, omega, 1e-12);
}

// At a point of the link it has the moment r × f of that moment's pose.
TEST(SceneWrench, ActsAtThePointOfItsLink) {
  Simulation run(kBall +
                 "wrenches: [{link: ball, force: [3, -2, 1], point: [0.1, 0.2, -0.3]}]\n"
                 "options: {integrator: semi-implicit-euler}\n");  // at the pose of its start
  run.state.v.tail<3>() = Vector3(1.0, -2.0, 0.5);
  for (int i = 0; i < 20; ++i) {
    const Quaternion q(run.state.q[3], run.state.q[4], run.state.q[5], run.state.q[6]);
    run.advance(1);
    const Vector3 r_B(0.1, 0.2, -0.3);
    const Vector3 moment_B = r_B.cross(q.conjugate() * Vector3(3, -2, 1));
    EXPECT_APPROX(run.data.forward.a.tail<3>(), moment_B / (0.4 * 2.0 * 0.01), 1e-11);
    EXPECT_APPROX(run.data.forward.a.head<3>(), Vector3(3, -2, 1) / 2.0, 1e-13);
  }
}

TEST(SceneWrench, IsAnEffectThatCanBeSwitchedOff) {
  Simulation run(kBall +
                 "wrenches: [{link: ball, force: [3, -2, 1]}]\noptions: {effects: [coriolis]}\n");
  run.advance(5);
  EXPECT_TRUE(run.state.v.isZero(0.0));
}

TEST(SceneFile, RefusalsOfPairsOptionsAndWrenches) {
  const std::string ball = "objects: [{name: ball, sphere: {radius: 1}}]\n";
  const std::string fixed = "objects: [{name: wall, sphere: {radius: 1}, fixed: true}]\n";
  const std::pair<std::string, std::string> cases[] = {
      {ball + "pairs: {a: ball}", "key 'pairs': found a map"},
      {ball + "pairs: [{a: ball, friction: 1}]", ":2: pair 1: key 'b': found no such key"},
      {ball + "pairs: [{a: ball, b: bal}]", "key 'b': found 'bal', expected the name of a link"},
      {ball + "pairs: [{a: ball, b: ball, friction: 1}]", "key 'b': found 'ball' as in a"},
      {ball + "pairs: [{a: ball, b: ground}]", "found nothing else, expected a material or"},
      {ball + "pairs: [{a: ball, b: ground, friction: nan}]", "key 'friction': found 'nan'"},
      {ball + "pairs: [{a: ball, b: ground, frction: 1}]", "key 'frction': found an unknown key"},
      {ball + "pairs: [{a: ball, b: ground, material: ice}]", "key 'material': found 'ice'"},
      {ball + "pairs: [{a: ball, b: ground, gap: 1}]", "key 'gap': is not known"},
      {"ground: none\n" + ball + "pairs: [{a: ball, b: ground, friction: 1}]",
       "key 'b': found 'ground'"},
      {"objects:\n  - {name: x, sphere: {radius: 1}}\n  - {name: y, sphere: {radius: 1}}\n"
       "pairs: [{a: x, b: y, friction: 1}, {a: y, b: x, condim: 1}]",
       ":4: pair 'y' - 'x': is given twice"},
      {"objects: [{name: ground, sphere: {radius: 1}}]", "other than world and ground"},
      {ball + "options: [tolerance]", "key 'options': found a list"},
      {ball + "options: {cone: round}",
       "key 'options.cone': found 'round', expected one of pyramidal, elliptic"},
      {ball + "options: {gdd_solver: both}",
       "key 'options.gdd_solver': found 'both', expected one of active-set, augmented-lagrangian"},
      {"objects: [{name: b, sphere: {radius: 1e-200}}]", "key 'sphere.radius': found '1e-200'"},
      {"a: &a [*a]", "an alias inside of what it stands for"},
      {ball + "options: {exact_diagonal: 1}", "key 'options.exact_diagonal': found"},
      {ball + "options: {friction: 1}", "key 'options.friction': found an unknown key"},
      {ball + "options: {integrator: magic}", "key 'options.integrator': found 'magic'"},
      {ball + "options: {tolerance: -1}", "key 'options.tolerance': found '-1'"},
      {ball + "options: {max_iterations: 1.5}", "expected a whole number from 1"},
      {ball + "options: {max_iterations: 1e99}", "expected a whole number from 1"},
      {ball + "options: {impedance_ratio: 0}", "key 'options.impedance_ratio': found '0'"},
      {ball + "options: {effects: gravity}", "found 'gravity', expected auto or a list"},
      {ball + "options: {effects: [gravity, gravty]}", "did you mean 'gravity'?"},
      {ball + "options: {compatibility: bullet}", "expected one of none, mujoco"},
      {ball + "wrenches: [ball]", "wrench 1: found 'ball', expected a map"},
      {ball + "wrenches: [{force: [0, 0, 1]}]", "key 'link': found no such key"},
      {ball + "wrenches: [{link: ball}]", "key 'force': found no such key"},
      {ball + "wrenches: [{link: ground, force: [0, 0, 1]}]", "key 'link': found 'ground'"},
      {ball + "wrenches: [{link: ball, force: [0, 0, .inf]}]", "key 'force': found"},
      {ball + "wrenches: [{link: ball, force: 3}]", "key 'force': found '3', expected three"},
      {ball + "wrenches: [{link: ball, force: [0, 0, 1], start: -1}]", "key 'start': found '-1'"},
      {ball + "wrenches: [{link: ball, force: [0, 0, 1], start: 2, end: 2}]",
       "key 'end': found '2', expected more than the start, 2 s"},
      {ball + "wrenches: [{link: ball, force: [0, 0, 1], until: 2}]", "found an unknown key"},
  };
  for (const auto& [scene, words] : cases) {
    const std::string message = refusal(scene);
    EXPECT_NE(message.find("scene.yaml:"), std::string::npos) << message;
    EXPECT_NE(message.find(words), std::string::npos) << scene << "\n  -> " << message;
  }
  const SceneFolder folder(fixed + "wrenches: [{link: wall, force: [0, 0, 1]}]");
  const io::SceneFile scene = folder.read();
  EXPECT_THROW(io::WrenchSchedule(scene.builder.build(), scene.wrenches), ModelError);
}

}  // namespace
}  // namespace softgauss::test
