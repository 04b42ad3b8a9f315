// SPDX-License-Identifier: Apache-2.0
/// --infer-inertia: mass and inertia of shapes where a URDF gives none, against closed forms.

#include "softgauss/io/detail/urdf_inertia.hpp"

#include "load_urdf.hpp"
#include "sample_urdf.hpp"
#include "softgauss/engine/model/mass_properties.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::io {
namespace {

const std::string kInertialOfArm =
    "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
    "izz=\"1\"/></inertial>";

UrdfOptions inferring() {
  UrdfOptions options;
  options.inferInertia = true;
  return options;
}

/// The arm of the sample with another <inertial> and collision, besides the base.
Model armWith(const std::string& inertial, const std::string& collision,
              const UrdfOptions& options = inferring()) {
  return load(with(with(kSampleUrdf, kInertialOfArm, inertial),
                   "<collision><geometry><cylinder radius=\"0.1\" length=\"0.5\"/></geometry>"
                   "</collision>",
                   collision),
              options);
}

const std::string kBox =
    "<collision><origin xyz=\"0.1 0 0\" rpy=\"0 0 1.5707963267948966\"/><geometry><box size=\"0.1 "
    "0.2 0.3\"/></geometry></collision>";

// 6 kg; turned about z, the box is 0.2 along x and 0.1 along y.
TEST(UrdfInertia, OfALinkWithoutIsThatOfWaterInItsShapes) {
  const Model m = armWith("", kBox);
  EXPECT_NEAR(m.bodies[2].mass, 6.0, 1e-13);
  EXPECT_APPROX(m.bodies[2].com, Vector3(0.1, 0.0, 0.0), 1e-14);
  EXPECT_APPROX(m.bodies[2].I_Bcm.matrix(), Matrix3(Vector3(0.05, 0.065, 0.025).asDiagonal()),
                1e-14);
  EXPECT_TRUE(hasWarning(m, "those of the shapes, at 1000 kg/m³: 'arm' 6 kg"));
}

// Two balls of radius r = 0.1 at ±0.3 along x: I_yy = 2 m (2/5 r² + 0.3²).
TEST(UrdfInertia, OfSeveralShapesIsTheirSum) {
  std::string balls;
  for (const char* x : {"0.3", "-0.3"})
    balls += std::string("<collision><origin xyz=\"") + x +
             " 0 0\"/><geometry><sphere radius=\"0.1\"/></geometry></collision>";
  const Model m = armWith("", balls);
  const double ball = 4000.0 / 3.0 * M_PI * 1e-3;
  EXPECT_NEAR(m.bodies[2].mass, 2.0 * ball, 1e-13);
  EXPECT_APPROX(m.bodies[2].com, Vector3::Zero().eval(), 1e-14);
  EXPECT_NEAR(m.bodies[2].I_Bcm.yy, 2.0 * ball * (0.4 * 1e-2 + 0.09), 1e-13);
  EXPECT_NEAR(m.bodies[2].I_Bcm.xx, 2.0 * ball * 0.4 * 1e-2, 1e-13);
}

TEST(UrdfInertia, OfALinkWithMassAloneIsScaledToThat) {
  const Model m = armWith(
      "<inertial><mass value=\"3\"/><inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" "
      "izz=\"0\"/></inertial>",
      kBox);
  EXPECT_NEAR(m.bodies[2].mass, 3.0, 1e-13);
  EXPECT_EQ(m.bodies[2].com, Vector3::Zero()) << "the centre of mass is as written";
  EXPECT_NEAR(m.bodies[2].I_Bcm.yy, 0.0325, 1e-13);
  EXPECT_TRUE(hasWarning(m, "at the mass that is written: 'arm'"));
}

TEST(UrdfInertia, OfVisualsCountsWhereNothingCollides) {
  const Model m = armWith("", "<visual><geometry><sphere radius=\"0.1\"/></geometry></visual>");
  EXPECT_NEAR(m.bodies[2].mass, 4000.0 / 3.0 * M_PI * 1e-3, 1e-13);
}

// Bytes of what has mass and inertia do not change, nor does what is fixed to it gain any.
TEST(UrdfInertia, IsLeftWhereThereIsSome) {
  const std::string text = with(
      kSampleUrdf, "</robot>",
      "<link name=\"cover\"><collision><geometry><sphere radius=\"1\"/></geometry></collision>"
      "</link><joint name=\"screws\" type=\"fixed\"><parent link=\"arm\"/><child link=\"cover\"/>"
      "</joint></robot>");
  const Model without = load(text), inferred = load(text, inferring());
  for (int b = 1; b < without.bodyCount(); ++b) {
    EXPECT_EQ(inferred.bodies[b].mass, without.bodies[b].mass);
    EXPECT_EQ(inferred.bodies[b].I_Bcm.matrix(), without.bodies[b].I_Bcm.matrix());
  }
  EXPECT_FALSE(hasWarning(inferred, "shapes, at"));
}

// Half of a cube's surface: 0.2 m about its middle.
TEST(UrdfInertia, OfAnOpenMeshIsThatOfTheBoxAroundIt) {
  const TempFolder folder;
  folder.write("half.obj",
               "v 0 0 0\nv 0.2 0 0\nv 0.2 0.2 0\nv 0 0.2 0\nv 0 0 0.2\nv 0.2 0 0.2\n"
               "f 1 3 2\nf 1 4 3\nf 1 2 6\nf 1 6 5\n");
  const std::string text =
      with(with(kSampleUrdf, kInertialOfArm, ""), "<cylinder radius=\"0.1\" length=\"0.5\"/>",
           "<mesh filename=\"half.obj\"/>");
  const Model m = loadUrdf(folder.write("robot.urdf", text), inferring());
  EXPECT_NEAR(m.bodies[2].mass, 8.0, 1e-5);  // coordinates of meshes are read as floats
  EXPECT_APPROX(m.bodies[2].com, Vector3(0.1, 0.1, 0.1), 1e-6);
}

TEST(UrdfInertia, TheRefusalWithoutNamesTheOption) {
  try {
    armWith("", kBox, {});
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("--infer-inertia"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace softgauss::io
