// SPDX-License-Identifier: Apache-2.0
/// Actuators of a scene: what drives which joint, and what is refused.

#include "softgauss/io/actuators.hpp"

#include "scene_folder.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// A pan and a tilt joint and a slide, one of which has no effort of its own, and a mimic joint.
const char* const kWrist = R"(<robot name="wrist">
  <link name="world"/>
  <link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="c"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="d"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="pan" type="revolute"><parent link="world"/><child link="a"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="5" velocity="1"/></joint>
  <joint name="tilt" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="7" velocity="1"/></joint>
  <joint name="copy" type="revolute"><parent link="c"/><child link="d"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="5" velocity="1"/><mimic joint="pan"/></joint>
</robot>)";

std::string sceneWith(const std::string& actuators, const std::string& name = "") {
  return "robots: [{" + name + "urdf: sample.urdf}]\nactuators:\n" + actuators;
}

std::string refused(const std::string& actuators) {
  const SceneFolder folder(sceneWith(actuators), kWrist);
  try {
    folder.read();
  } catch (const ModelError& error) {
    return error.what();
  }
  ADD_FAILURE() << "read without complaint:\n" << actuators;
  return {};
}

TEST(SceneActuators, DriveTheJointsTheyName) {
  const SceneFolder folder(sceneWith("  - {name: l, joints: {r/pan: 2, r/tilt: 3}, effort: 4}\n"
                                     "  - {name: r, joints: {r/tilt: -1}, bounds: [-1, 6]}\n",
                                     "name: r, "),
                           kWrist);
  const io::SceneFile scene = folder.read();
  const Model model = scene.builder.build();
  const gdd::ControlLimits limits = io::controlLimits(model, scene.actuators);
  const int pan = model.bodies[model.findJoint("r/pan")].v;
  const int tilt = model.bodies[model.findJoint("r/tilt")].v;
  const int slide = model.bodies[model.findJoint("r/slide")].v;
  // Both are actuated, without a box of their own: the actuators have one.
  for (const int dof : {pan, tilt}) {
    EXPECT_TRUE(model.dofs[dof].actuated);
    EXPECT_EQ(model.dofs[dof].effortUpper, kInfinity);
  }
  EXPECT_EQ(limits.upper[slide], 7.0);
  ASSERT_TRUE(limits.transmission);
  ASSERT_EQ(limits.transmission->actuators().size(), 2u);
  const int l = limits.transmission->coordinateOf(0), r = limits.transmission->coordinateOf(1);
  EXPECT_EQ(limits.lower[l], -4.0);
  EXPECT_EQ(limits.upper[l], 4.0);
  EXPECT_EQ(limits.lower[r], -1.0);
  EXPECT_EQ(limits.upper[r], 6.0);
  const MatrixX& T = limits.transmission->T();
  EXPECT_EQ(T(pan, l), 2.0);
  EXPECT_EQ(T(tilt, l), 3.0);
  EXPECT_EQ(T(pan, r), 0.0);
  EXPECT_EQ(T(tilt, r), -1.0);
}

TEST(SceneActuators, NoneLeavesTheBoxOfTheModel) {
  const SceneFolder folder("robots: [{urdf: sample.urdf}]\n", kWrist);
  const io::SceneFile scene = folder.read();
  const Model model = scene.builder.build();
  EXPECT_FALSE(model.dofs[1].actuated);
  EXPECT_FALSE(io::controlLimits(model, scene.actuators).transmission);
}

TEST(SceneActuators, RefusalsNameFileLineAndActuator) {
  const std::pair<const char*, const char*> cases[] = {
      {"  - {name: l}\n", "scene.yaml:3: actuator 1: key 'joints'"},
      {"  - {joints: {pan: 1}}\n", "scene.yaml:3: actuator 1: key 'name'"},
      {"  - {name: l, joints: {}}\n", "found no joint"},
      {"  - {name: l, joints: {pam: 1}}\n", "key 'joints.pam': found no joint"},
      {"  - {name: l, joints: {copy: 1}}\n", "mimics 'pan'"},
      {"  - {name: l, joints: {pan: 0}}\n", "key 'joints.pan': found '0'"},
      {"  - {name: l, joints: {pan: 1}, effort: -2}\n", "key 'effort'"},
      {"  - {name: l, joints: {pan: 1}, bounds: [1]}\n", "expected two finite numbers"},
      {"  - {name: l, joints: {pan: 1}, bounds: [2, 1]}\n", "lower bound 2 above the upper one 1"},
      {"  - {name: l, joints: {pan: 1}, bounds: [0, 1], effort: 3}\n", "found beside bounds"},
      {"  - {name: l, joints: {pan: 1}, gear: 3}\n", "key 'gear'"},
      {"  - {name: l, joints: {pan: 1}}\n  - {name: l, joints: {tilt: 1}}\n", "a second time"},
      {"  - {name: l, joints: {pan: 1, tilt: 2}}\n  - {name: r, joints: {pan: -2, tilt: -4}}\n",
       "scene.yaml:4: actuator 'r': pulls as a combination of 'l' does"}};
  for (const auto& [actuators, words] : cases) {
    const std::string message = refused(actuators);
    EXPECT_NE(message.find(words), std::string::npos) << message << "\nfor\n" << actuators;
  }
}

}  // namespace
}  // namespace softgauss::test
