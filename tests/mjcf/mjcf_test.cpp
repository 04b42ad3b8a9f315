// SPDX-License-Identifier: Apache-2.0
/// What an MJCF file comes to as a scene: names, states, contacts, actuators, and what is told.

#include "softgauss/io/mjcf.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/model/model_hash.hpp"
#include "softgauss/io/simulation/scene.hpp"

namespace softgauss::test {
namespace {

namespace fs = std::filesystem;
const fs::path kFiles = fs::path(SOFTGAUSS_SOURCE_DIR) / "tests/mjcf/files";

/// A file in a folder of its own, removed at the end.
struct TempMjcf {
  explicit TempMjcf(const std::string& text) {
    folder = fs::temp_directory_path() / ("mjcf_test_" + std::to_string(getpid()));
    fs::create_directories(folder);
    file = folder / "model.xml";
    std::ofstream(file) << text;
  }
  ~TempMjcf() { fs::remove_all(folder); }
  fs::path folder, file;
};

std::string problemOf(const fs::path& file) {
  try {
    loadScene(file);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

bool collide(const Scene& scene, const std::string& a, const std::string& b) {
  const auto& geometries = scene.model.geometries;
  const auto& pairs = scene.contacts->filter().pairs;
  return std::any_of(pairs.begin(), pairs.end(), [&](const collision::GeometryPair& p) {
    const std::string &first = geometries[static_cast<std::size_t>(p.a)].name,
                      &second = geometries[static_cast<std::size_t>(p.b)].name;
    return (first == a && second == b) || (first == b && second == a);
  });
}

// contype, conaffinity, <pair>, <exclude> and the joint between neighbours say who may touch.
TEST(Mjcf, PairsAreThoseOfTheFile) {
  const auto scene = loadScene(kFiles / "contacts.xml");
  EXPECT_TRUE(collide(*scene, "floor", "ball_"));  // a body has the name
  EXPECT_TRUE(collide(*scene, "hand_", "ball_"));
  EXPECT_FALSE(collide(*scene, "floor", "hand_"));  // no bit in common
  EXPECT_FALSE(collide(*scene, "arm_", "ball_"));   // excluded
  EXPECT_TRUE(collide(*scene, "skin", "ball_"));    // excluded too, and a pair
  EXPECT_FALSE(collide(*scene, "floor", "skin"));   // visual
  EXPECT_FALSE(collide(*scene, "arm_", "hand_"));   // a joint between them
  EXPECT_GT(scene->contacts->filter().disjointPairs, 0);
}

TEST(Mjcf, SurfacesAreThoseOfTheFile) {
  const Model model = loadScene(kFiles / "contacts.xml")->model;
  const auto surfaceOf = [&](const std::string& name) {
    for (const Geometry& g : model.geometries)
      if (g.name == name) return g.material;
    ADD_FAILURE() << name;
    return Material{};
  };
  const Material floor = surfaceOf("floor");
  EXPECT_EQ(floor.slidingFriction, 0.7);
  EXPECT_EQ(floor.torsionalFriction, 0.01);
  EXPECT_EQ(floor.rollingFriction, 0.002);
  EXPECT_EQ(floor.priority, 2);
  EXPECT_EQ(floor.condim, 4);
  const Material arm = surfaceOf("arm_");
  EXPECT_EQ(arm.impedance.timeConstant, 0.01);
  EXPECT_EQ(arm.impedance.dampingRatio, 0.8);
  EXPECT_EQ(arm.impedance.dMin, 0.8);
  EXPECT_EQ(arm.impedance.dMax, 0.9);
  EXPECT_EQ(arm.impedance.width, 0.001);
  EXPECT_EQ(arm.mixWeight, 2.0);
  EXPECT_EQ(surfaceOf("hand_").margin, 0.002);
  ASSERT_EQ(model.contactPairs.size(), 1u);
  EXPECT_EQ(model.contactPairs[0].material.slidingFriction, 0.5);
  EXPECT_EQ(model.contactPairs[0].material.rollingFriction, 0.001);
}

TEST(Mjcf, StartsAtItsReferencesOrInAKeyframe) {
  SimulationOptions options;
  const auto zero = loadScene(kFiles / "keyframes.xml");
  EXPECT_EQ(zero->initial.q[2], 1.0);
  options.state = "home";
  const auto home = loadScene(kFiles / "keyframes.xml", options);
  EXPECT_EQ(home->initial.q[2], 0.9);
  EXPECT_NEAR(home->initial.q[3], std::sqrt(0.5), 1e-15);
  EXPECT_EQ(home->initial.q[7], 0.5);
  EXPECT_EQ(home->initial.v[6], -0.2);
  options.state = "2";
  EXPECT_EQ(loadScene(kFiles / "keyframes.xml", options)->initial.q[2], 2.0);
  options.state = "hone";
  try {
    loadScene(kFiles / "keyframes.xml", options);
    ADD_FAILURE();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'home'"), std::string::npos)
        << error.what();
  }
  const auto reference = loadScene(kFiles / "joint_reference.xml");
  EXPECT_NEAR(reference->initial.q[0], 25.0 * M_PI / 180.0, 1e-15);
}

TEST(Mjcf, SitesAreFramesThatGoalsMayName) {
  const Model model = loadScene(kFiles / "frames.xml")->model;
  const int tip = model.findFrame("tip");
  ASSERT_GE(tip, 0);
  EXPECT_EQ(model.frames[static_cast<std::size_t>(tip)].body, model.findJoint("a"));
}

TEST(Mjcf, OptionsOfTheFileAreTakenOrTold) {
  const auto scene = loadScene(kFiles / "options.xml");
  const Options& o = scene->model.options;
  EXPECT_EQ(o.timestep, 0.001);
  EXPECT_EQ(o.gravity, Vector3(1, -2, -5));
  EXPECT_EQ(o.cone, Cone::elliptic);
  EXPECT_EQ(o.impedanceRatio, 3.0);
  EXPECT_EQ(o.integrator, Integrator::leapfrog);
  EXPECT_FALSE(o.effects.has(Effect::spring));
  std::string notes;
  for (const std::string& note : scene->notes) notes += note + "\n";
  for (const char* word : {"implicitfast", "leapfrog", "1 sensor", "1 camera", "1 light", "mocap"})
    EXPECT_NE(notes.find(word), std::string::npos) << word << " in " << notes;
  SimulationOptions options;
  options.likeMujoco = true;
  EXPECT_EQ(loadScene(kFiles / "options.xml", options)->model.options.integrator,
            Integrator::semiImplicitEuler);
}

TEST(Mjcf, ActuatorsComeToForces) {
  const auto scene = loadScene(kFiles / "actuators.xml");
  ASSERT_EQ(scene->actuators.size(), 6u);
  const io::SceneActuator& grip = scene->actuators[3];
  ASSERT_EQ(grip.joints.size(), 2u);
  EXPECT_EQ(grip.joints[1].second, -1.4);
  EXPECT_EQ(grip.lower, -3.0);
  EXPECT_EQ(grip.upper, 4.0);
  EXPECT_EQ(scene->actuators[2].lower, -5.0);  // of the joint, within forcerange
  EXPECT_EQ(scene->actuators[4].upper, kInfinity);
  const Model& model = scene->model;
  const auto actuated = [&](const char* joint) {
    return model
        .dofs[static_cast<std::size_t>(
            model.bodies[static_cast<std::size_t>(model.findJoint(joint))].v)]
        .actuated;
  };
  EXPECT_TRUE(actuated("motor"));
  EXPECT_FALSE(actuated("free"));
}

// With l = gear q: kp, kd by gear², the force by gear, set points by 1/gear; zeros of ctrl are
// clamped to its range, and a keyframe has its own.
TEST(Mjcf, ServosOfJointsHaveTheGainsOfTheFile) {
  const TempMjcf model(R"(<mujoco>
  <compiler angle="radian"/>
  <worldbody>
    <body><joint name="position" axis="0 1 0"/><geom size="0.1" pos="0.3 0 0"/></body>
    <body pos="1 0 0"><joint name="velocity" axis="0 1 0"/><geom size="0.1" pos="0.3 0 0"/></body>
    <body pos="2 0 0"><joint name="ratio" axis="0 1 0"/><geom size="0.1" pos="0.3 0 0"/></body>
    <body pos="3 0 0"><joint name="uneven" axis="0 1 0"/><geom size="0.1" pos="0.3 0 0"/></body>
    <body pos="4 0 0"><joint name="general" axis="0 1 0"/><geom size="0.1" pos="0.3 0 0"/></body>
  </worldbody>
  <actuator>
    <position joint="position" kp="40" kv="3" gear="2" forcerange="-8 8" ctrlrange="0.2 1"/>
    <velocity joint="velocity" kv="5" gear="-2"/>
    <position joint="ratio" kp="40" dampratio="1"/>
    <position joint="uneven" kp="40" forcerange="-8 9"/>
    <general joint="general" biastype="affine" gainprm="30" biasprm="6 -15 -2"/>
  </actuator>
  <keyframe><key name="home" ctrl="0.5 3 7 0 1"/></keyframe>
</mujoco>)");
  SimulationOptions home;
  home.state = "home";
  const auto zero = loadScene(model.file), key = loadScene(model.file, home);
  const auto servo = [](const softgauss::Scene& scene, const char* joint) {
    const Body& body = scene.model.bodies[idx(scene.model.findJoint(joint))];
    return scene.model.dofs[idx(body.v)].servo;
  };
  EXPECT_EQ(servo(*zero, "position").kp, 160.0);
  EXPECT_EQ(servo(*zero, "position").kd, 12.0);
  EXPECT_EQ(servo(*zero, "position").effort, 16.0);
  EXPECT_EQ(servo(*zero, "position").setPoint, 0.1);
  EXPECT_EQ(servo(*key, "position").setPoint, 0.25);
  EXPECT_EQ(servo(*zero, "velocity").kp, 0.0);
  EXPECT_EQ(servo(*zero, "velocity").kd, 20.0);
  EXPECT_EQ(servo(*key, "velocity").setPointRate, -1.5);
  const double mass = 1000.0 * 4.0 / 3.0 * 3.14159265358979 * 1e-3;
  const double inertia = mass * (0.09 + 0.4 * 0.01);
  EXPECT_NEAR(servo(*zero, "ratio").kd / (2.0 * std::sqrt(40.0 * inertia)), 1.0, 1e-12);
  EXPECT_FALSE(servo(*zero, "uneven").exists());
  // f = 30 u + 6 − 15 q − 2 v.
  EXPECT_EQ(servo(*key, "general").kp, 15.0);
  EXPECT_EQ(servo(*key, "general").kd, 2.0);
  EXPECT_NEAR(servo(*key, "general").setPoint, 36.0 / 15.0, 1e-15);
  SimulationOptions passive;
  passive.withoutServos = true;
  EXPECT_FALSE(servo(*loadScene(model.file, passive), "position").exists());
  std::string notes;
  for (const std::string& note : zero->notes) notes += note;
  EXPECT_NE(notes.find("1 servo of the file"), std::string::npos) << notes;
}

// A file that includes itself, or another twice, or one elsewhere, ends.
TEST(Mjcf, IncludesEnd) {
  const TempMjcf itself("<mujoco><include file=\"model.xml\"/></mujoco>");
  EXPECT_NE(problemOf(itself.file).find("included a second time"), std::string::npos);
  const TempMjcf outside("<mujoco><include file=\"../other.xml\"/></mujoco>");
  EXPECT_NE(problemOf(outside.file).find("outside of the folder"), std::string::npos);
  const TempMjcf absolute("<mujoco><include file=\"/etc/passwd\"/></mujoco>");
  EXPECT_NE(problemOf(absolute.file).find("outside of the folder"), std::string::npos);
}

// The same model again, in the same numbers.
TEST(Mjcf, IsReadTheSameEachTime) {
  for (const auto& entry : fs::directory_iterator(kFiles))
    if (entry.path().extension() == ".xml") {
      EXPECT_EQ(hash(io::readMjcf(entry.path()).scene.builder.build()),
                hash(io::readMjcf(entry.path()).scene.builder.build()))
          << entry.path();
    }
}

}  // namespace
}  // namespace softgauss::test
