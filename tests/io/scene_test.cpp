// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/scene.hpp"

#include "scene_folder.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/gdd/goals/reach.hpp"
#include "softgauss/io/goals.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

const char* const kTwoRobots = R"(# a comment
name: meeting
timestep: 0.001
gravity: [0, 0, -1.62]
ground: {height: -0.5, material: ice}
materials:
  ice: {friction: 0.05, condim: 1}
  rubber: {friction: 1.3, time_constant: 0.01, impedance: {minimum: 0.8, width: 0.002}}
robots:
  - {name: a, urdf: sample.urdf, position: [1, 2, 3], rpy: [0, 0, 1.5707963267948966], material: rubber,
     joints: {shoulder: 0.8}, joint_velocities: {shoulder: -0.3}, velocity: [0.1, 0, 0], angular_velocity: [1, 0, 0]}
  - {name: b, urdf: sample.urdf, base: fixed, position: [-1, 0, 0], materials: {arm: ice}}
objects:
  - {name: ball, sphere: {radius: 0.1}, mass: 2, velocity: [0, 0, 4], material: rubber}
  - {name: wall, box: {size: [0.2, 4, 2]}, position: [5, 0, 0.5], fixed: true, color: [1, 0, 0]}
goals:
  - reach: {link: a/arm, target: [0, 0, 1]}
)";

TEST(SceneFile, HoldsRobotsAndObjectsEachUnderItsName) {
  const SceneFolder folder(kTwoRobots);
  const io::SceneFile scene = folder.read();
  const Model model = scene.builder.build();
  EXPECT_EQ(model.name, "meeting");
  EXPECT_EQ(model.options.timestep, 0.001);
  EXPECT_EQ(model.options.gravity.z(), -1.62);
  ASSERT_TRUE(scene.ground.has_value());
  EXPECT_EQ(*scene.ground, -0.5);
  EXPECT_EQ(scene.groundMaterial.condim, 1);
  for (const char* link : {"a/base", "a/arm", "b/base", "b/arm", "ball", "wall"})
    EXPECT_GE(model.findFrame(link), 0) << link;
  EXPECT_GE(model.findJoint("a/shoulder"), 0);
  EXPECT_GE(model.findJoint("b/shoulder"), 0);
  EXPECT_EQ(model.frames[model.findFrame("b/base")].body, 0);
  EXPECT_EQ(model.frames[model.findFrame("wall")].body, 0);
  EXPECT_EQ(model.visuals.back().link, "wall");
  const Body& ball = model.bodies[model.findJoint("ball")];
  EXPECT_EQ(ball.mass, 2.0);
  EXPECT_SMALL(ball.I_Bcm.xx - 0.4 * 2.0 * 0.01, 1e-15);

  for (const Geometry& geometry : model.geometries) {
    const double friction = geometry.link.rfind("a/", 0) == 0 || geometry.name == "ball" ? 1.3
                            : geometry.link == "b/arm"                                   ? 0.05
                                                                                         : 1.0;
    EXPECT_EQ(geometry.material.slidingFriction, friction) << geometry.name;
    if (geometry.name != "ball") continue;
    EXPECT_EQ(geometry.material.impedance.timeConstant, 0.01);
    EXPECT_EQ(geometry.material.impedance.dMin, 0.8);
    EXPECT_EQ(geometry.material.impedance.dMax, 0.95);
  }
}

TEST(SceneFile, StartsAsWritten) {
  const SceneFolder folder(kTwoRobots);
  const io::SceneFile scene = folder.read();
  const Model model = scene.builder.build();
  const State state = scene.initialState(model);
  Kinematics k(model);
  computeKinematics(model, state, k);
  const Transform X = framePose(model, k, model.findFrame("a/base"));
  EXPECT_APPROX(X.p, Vector3(1, 2, 3), 1e-15);
  EXPECT_APPROX(X.R, rpyRotation({0, 0, 1.5707963267948966}), 1e-15);
  EXPECT_APPROX(framePose(model, k, model.findFrame("b/base")).p, Vector3(-1, 0, 0), 1e-15);
  EXPECT_EQ(state.q[model.bodies[model.findJoint("a/shoulder")].q], 0.8);
  EXPECT_EQ(state.v[model.bodies[model.findJoint("a/shoulder")].v], -0.3);
  const int base = model.frames[model.findFrame("a/base")].body;
  EXPECT_APPROX(pointVelocity(model, k, base, X.p), Vector3(0.1, 0, 0), 1e-15);
  EXPECT_APPROX(k.V[base].angular, Vector3(1, 0, 0), 1e-15);
  EXPECT_APPROX(k.V[model.findJoint("ball")].linear, Vector3(0, 0, 4), 1e-15);

  // What has a position keeps it; the ball, which has none, stands on the ground.
  ASSERT_EQ(scene.starts.size(), 2u);
  EXPECT_FALSE(scene.starts[0].onGround);
  EXPECT_TRUE(scene.starts[1].onGround);

  ASSERT_TRUE(scene.hasGoals);
  const auto goals = io::readGoals(folder.file, model, state);
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_EQ(goals[0]->name(), "reach a/arm");
}

// One robot needs no name, and is then the robot as if loaded alone.
TEST(SceneFile, OfOneNamelessRobotIsTheRobot) {
  const SceneFolder folder("robots: [{urdf: sample.urdf}]");
  const Model scene = folder.read().builder.build();
  const Model alone = io::loadUrdf(folder.file.parent_path() / "sample.urdf");
  EXPECT_EQ(scene.bodyNames, alone.bodyNames);
  EXPECT_EQ(scene.jointNames, alone.jointNames);
  EXPECT_EQ(scene.q0, alone.q0);
  EXPECT_EQ(scene.warnings, alone.warnings);
  ASSERT_EQ(scene.bodies.size(), alone.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    EXPECT_EQ(scene.bodies[b].mass, alone.bodies[b].mass);
    EXPECT_EQ(scene.bodies[b].robot, alone.bodies[b].robot);
  }
}

// Two that do not touch move as each does alone.
TEST(SceneFile, RobotsApartMoveAsEachAlone) {
  const SceneFolder folder(
      "gravity: [0, 0, 0]\n"
      "robots:\n"
      "  - {name: a, urdf: sample.urdf, position: [0, 0, 1], joint_velocities: {shoulder: 1}}\n"
      "  - {name: b, urdf: sample.urdf, position: [9, 0, 1], joint_velocities: {shoulder: -2}}\n");
  const io::SceneFile scene = folder.read();
  const Model both = scene.builder.build();
  State together = scene.initialState(both);
  Data data(both);
  for (int i = 0; i < 100; ++i) step(both, {}, together, data, nullptr);
  const double speeds[] = {1.0, -2.0};
  for (int robot = 0; robot < 2; ++robot) {
    ModelBuilder builder = io::readUrdf(folder.file.parent_path() / "sample.urdf");
    builder.options.gravity.setZero();
    builder.X_WRoot.p = Vector3(9.0 * robot, 0, 1);
    const Model model = builder.build();
    State state(model);
    Data own(model);
    state.v[model.bodies[model.findJoint("shoulder")].v] = speeds[robot];
    for (int i = 0; i < 100; ++i) step(model, {}, state, own, nullptr);
    EXPECT_APPROX(together.v.segment(robot * model.nv, model.nv), state.v, 1e-13);
    EXPECT_APPROX(together.q.segment(robot * model.nq, model.nq), state.q, 1e-13);
  }
}

TEST(SceneFile, RefusalsNameTheLineThePartAndTheKey) {
  const std::string robot = "  - {name: a, urdf: sample.urdf";
  const std::pair<std::string, std::string> cases[] = {
      {"objects: []", "scene: holds nothing"},
      {"robot: []", "key 'robot': found an unknown key, expected one of name"},
      {"robots: 3", "key 'robots': found '3', expected a list"},
      {"robots: [3]", "robot 1: found '3', expected a map"},
      {"robots:\n  - {urdf: no.urdf}", ":2: robot 1: key 'urdf': found no file"},
      {"robots:\n  - {name: a}", "key 'urdf': found no such key"},
      {"robots:\n" + robot + "}\n  - {urdf: sample.urdf}",
       ":3: robot 2: key 'name': found no such"},
      {"robots:\n" + robot + "}\n" + robot + "}",
       ":3: robot 2: key 'name': found 'a' a second time"},
      {"robots:\n  - {name: a/b, urdf: sample.urdf}", "found 'a/b', expected a name without '/'"},
      {"robots:\n" + robot + ", base: flying}",
       "key 'base': found 'flying', expected one of fixed"},
      {"robots:\n" + robot + ", position: [1, 2]}", "key 'position': found a list of 2"},
      {"robots:\n" + robot + ", quaternion: [1, 1, 0, 0]}", "of length 1"},
      {"robots:\n" + robot + ", rpy: [0, 0, 0], quaternion: [1, 0, 0, 0]}", "beside rpy in line 2"},
      {"robots:\n" + robot + ", joints: {shouldr: 1}}", "did you mean 'shoulder'?"},
      {"robots:\n" + robot + ", joints: {shoulder: fast}}", "key 'joints.shoulder': found 'fast'"},
      {"robots:\n" + robot + ", material: ice}",
       "key 'material': found 'ice', expected one of default"},
      {"robots:\n" + robot + ", materials: {hip: default}}", "key 'materials.hip': found no link"},
      {"robots:\n" + robot + ", base: fixed, velocity: [1, 0, 0]}", "is for what floats"},
      {"objects:\n  - {name: x}", "key 'sphere': found no such key, expected a shape"},
      {"objects:\n  - {name: x, sphere: {radius: 0}}", "key 'sphere.radius': found '0'"},
      {"objects:\n  - {name: x, box: {size: [1, -1, 1]}}", "key 'box.size': found a length of 0"},
      {"objects:\n  - {name: x, sphere: {radius: 1}, box: {size: [1, 1, 1]}}",
       "expected one shape"},
      {"objects:\n  - {name: x, sphere: {radius: 1}, mass: 1, density: 1}", "found beside mass"},
      {"objects:\n  - {name: x, sphere: {radius: 1}, mass: 1, fixed: true}", "is for what moves"},
      {"objects:\n  - {name: x, sphere: {radius: 1}, fixed: maybe}", "expected true or false"},
      {"objects:\n  - {name: x, sphere: {radius: 1}, color: [2, 0, 0]}", "outside 0 to 1"},
      {"objects:\n  - {name: x, plane: {}, fixed: false}", "found a plane that moves"},
      {"objects:\n  - {name: x, mesh: {file: no.stl}}", "key 'mesh.file': found no file"},
      {"materials: {ice: {condim: 2}}", "key 'materials.ice.condim': found '2', expected one of 1"},
      {"materials: {ice: {impedance: {maximum: 1}}}",
       "key 'materials.ice.impedance.maximum': found"},
      {"materials: {ice: {impedance: {power: 0.5}}}", "expected a number >= 1"},
      {"materials: {ice: {stiffness: 0}}", "key 'materials.ice.stiffness': found '0'"},
      {"materials: {ice: {rest_depth: -1}}", "key 'materials.ice.rest_depth': found '-1'"},
      {"materials: {ice: {damping: 3}}",
       "key 'materials.ice.damping': found without stiffness [N/m] or rest_depth [m]"},
      {"materials: {ice: {stiffness: 1, rest_depth: 1}}",
       "key 'materials.ice.rest_depth': found beside stiffness"},
      {"materials: {ice: {stiffness: 1, damping: 1, damping_ratio: 1}}",
       "key 'materials.ice.damping_ratio': found beside damping in line 1"},
      {"materials: {ice: {stiffness: 1, impedance: {minimum: 0.5}}}",
       "key 'materials.ice.impedance': found beside stiffness"},
      {"materials: {ice: {reference_stiffness: 100}}",
       "key 'materials.ice.reference_damping': found no such key"},
      {"materials: {ice: {reference_stiffness: -1, reference_damping: 0}}",
       "key 'materials.ice.reference_stiffness': found '-1'"},
      {"materials:\n  ice: {time_constant: 1,\n   reference_stiffness: 1, reference_damping: 0}",
       "key 'materials.ice.time_constant': found beside reference_stiffness in line 3"},
      {"robots:\n" + robot + ", joint_parameters: {shoulder: {friction: -1}}}",
       "key 'joint_parameters.shoulder.friction': found '-1'"},
      {"robots:\n" + robot + "}\nconstraints:\n  - glue: {}", ":4: constraint 1: key 'glue'"},
      {"robots:\n" + robot + "}\nconstraints:\n  - connect: {link_a: a/arm}",
       "key 'connect.link_b': found no such key"},
      {"robots:\n" + robot + "}\nconstraints:\n  - connect: {link_a: a/arm, link_b: b/arm}",
       ":4: "},
      {"robots:\n" + robot + "}\nconstraints:\n  - couple: {follower: a/elbow}", ":4: "},
      {"robots:\n" + robot +
           "}\nconstraints:\n  - couple: {follower: a/shoulder, offset: 1, polynomial: [1]}",
       "key 'couple.offset': found beside polynomial"},
      {"robots:\n" + robot +
           "}\nconstraints:\n  - weld: {link_a: a/arm, link_b: world, pose_a: {x: 1}}",
       "key 'weld.pose_a.x': found an unknown key"},
      {"robots:\n" + robot + ", joint_parameters: {shoulder: {stiffness: -1}}}",
       "key 'joint_parameters.shoulder.stiffness': found '-1', expected a finite number >= 0"},
      {"robots:\n" + robot + ", joint_parameters: {shoulder: {spring_reference: 1}}}",
       "key 'joint_parameters.shoulder.spring_reference': found without a stiffness"},
      {"robots:\n" + robot + ", joint_parameters: {shoulder: {servo: {effort: 1}}}}",
       "key 'joint_parameters.shoulder.servo.kp': found no gain, expected a kp"},
      {"robots:\n" + robot + ", joint_parameters: {shoulder: {servo: {kp: -1}}}}",
       "key 'joint_parameters.shoulder.servo.kp': found '-1'"},
      {"robots:\n" + robot + ", joint_parameters: {shoulder: {servo: {kv: 1}}}}",
       "key 'joint_parameters.shoulder.servo.kv': found an unknown key"},
      {"materials: {ice: {gap: 0.1}}", "key 'materials.ice.gap': is not known: in MuJoCo 3.9"},
      {"ground: [0]", "key 'ground': found a list of 1, expected a height [m], none"},
      {"timestep: 0", "key 'timestep': found '0', expected a finite number > 0"},
  };
  for (const auto& [scene, words] : cases) {
    const std::string message = refusal(scene);
    EXPECT_NE(message.find("scene.yaml:"), std::string::npos) << message;
    EXPECT_NE(message.find(words), std::string::npos) << scene << "\n  -> " << message;
  }
}

TEST(SceneFile, MaterialsMayHaveSprings) {
  const SceneFolder folder(
      "materials:\n"
      "  a: {stiffness: 2.0e+4, damping: 30}\n"
      "  b: {stiffness: 500}\n"
      "  c: {rest_depth: 0.001, damping_ratio: 0.2}\n"
      "  d: {rest_depth: 0.001, damping: 0}\n"
      "objects:\n"
      "  - {name: a, sphere: {radius: 0.1}, material: a}\n"
      "  - {name: b, sphere: {radius: 0.1}, material: b}\n"
      "  - {name: c, sphere: {radius: 0.1}, material: c}\n"
      "  - {name: d, sphere: {radius: 0.1}, material: d}\n"
      "  - {name: e, sphere: {radius: 0.1}}\n");
  const Model model = folder.read().builder.build();
  ASSERT_EQ(model.geometries.size(), 5u);
  const auto spring = [&](int i) { return model.geometries[i].material.spring; };
  EXPECT_EQ(spring(0), (ContactSpring{2e4, 0.0, 30.0, 0.0}));
  EXPECT_EQ(spring(1), (ContactSpring{500.0, 0.0, 0.0, 1.0})) << "critical by default";
  EXPECT_EQ(spring(2), (ContactSpring{0.0, 1e-3, 0.0, 0.2}));
  EXPECT_EQ(spring(3), (ContactSpring{0.0, 1e-3, 0.0, 0.0}));
  EXPECT_FALSE(spring(4));
}

TEST(SceneFile, ConstraintsTieWhatTheyName) {
  const SceneFolder folder(
      "robots:\n"
      "  - {name: a, urdf: sample.urdf, joint_parameters: {shoulder: {friction: 0.7, armature: "
      "0.2}}}\n"
      "  - {name: b, urdf: sample.urdf, position: [2, 0, 0]}\n"
      "constraints:\n"
      "  - connect: {link_a: a/arm, link_b: world, point_a: [0.1, 0, 0], point_b: [0, 0, 1],\n"
      "              time_constant: 0.05}\n"
      "  - connect: {link_a: b/arm, link_b: world, reference_stiffness: 900, reference_damping: "
      "60}\n"
      "  - weld: {link_a: a/base, link_b: b/base, pose_b: {position: [-2, 0, 0]}, torque_scale: "
      "0.5}\n"
      "  - couple: {follower: b/shoulder, leader: a/shoulder, multiplier: -2, offset: 0.1}\n"
      "  - couple: {follower: a/shoulder, polynomial: [0.3]}\n");
  const Model model = folder.read().builder.build();
  ASSERT_EQ(model.connections.size(), 2u);
  EXPECT_EQ(model.connections[0].bodyA, model.frames[model.findFrame("a/arm")].body);
  EXPECT_EQ(model.connections[0].bodyB, 0);
  EXPECT_APPROX(model.connections[0].p_BP, Vector3(0, 0, 1), 1e-15);
  EXPECT_EQ(model.connections[0].impedance.timeConstant, 0.05);
  EXPECT_FALSE(model.connections[0].impedance.direct);
  EXPECT_EQ(model.connections[1].impedance.direct, (ReferenceSpring{900.0, 60.0}));
  ASSERT_EQ(model.welds.size(), 1u);
  EXPECT_APPROX(model.welds[0].X_BF.p, Vector3(-2, 0, 0), 1e-15);
  EXPECT_EQ(model.welds[0].torqueScale, 0.5);
  ASSERT_EQ(model.couplings.size(), 2u);
  EXPECT_EQ(model.couplings[0].leader, model.findJoint("a/shoulder"));
  EXPECT_EQ(model.couplings[0].follower, model.findJoint("b/shoulder"));
  EXPECT_EQ(model.couplings[0].value(0.5), 0.1 - 2.0 * 0.5);
  EXPECT_EQ(model.couplings[1].leader, 0);
  EXPECT_EQ(model.couplings[1].value(9.0), 0.3);
  const Dof& dof = model.dofs[model.bodies[model.findJoint("a/shoulder")].v];
  EXPECT_EQ(dof.dryFriction, 0.7);
  EXPECT_EQ(dof.armature, 0.2);
  EXPECT_EQ(dof.damping, 0.5) << "as the URDF says";
}

// An alias of aliases would fill the memory.
TEST(SceneFile, AliasesThatMultiplyAreRefused) {
  std::string text = "a: &a [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n";
  for (char c = 'b'; c <= 'i'; ++c) {
    text += std::string(1, c) + ": &" + c + " [";
    for (int i = 0; i < 10; ++i)
      text += std::string(i ? ", " : "") + "*" + static_cast<char>(c - 1);
    text += "]\n";
  }
  EXPECT_NE(refusal(text).find("more than 3000000 values"), std::string::npos);
}

}  // namespace
}  // namespace softgauss::test
