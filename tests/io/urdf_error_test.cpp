// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "sample_urdf.hpp"
#include "softgauss/io/urdf.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

/// What loading the text ends in; file names without their folder.
std::string errorOfUrdf(const std::string& text) {
  const TempFolder folder;
  const std::string file = folder.write("bad.urdf", text).string();
  try {
    loadUrdf(file);
  } catch (const ModelError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(file)) << message;
    return message.substr(file.size() - std::string("bad.urdf").size());
  }
  return "no error";
}

struct BadInput {
  const char* name;
  const char* from;  ///< replaced in the sample
  const char* to;
  const char* message;  ///< how the message begins
};

void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

class Urdf : public testing::TestWithParam<BadInput> {};

TEST_P(Urdf, RefusesWithFileLineAndElement) {
  const BadInput& bad = GetParam();
  const std::string message = errorOfUrdf(with(kSampleUrdf, bad.from, bad.to));
  EXPECT_TRUE(message.starts_with(bad.message)) << message << "\nexpected " << bad.message;
}

const BadInput kBadInputs[] = {
    // XML
    {"Truncated", "</robot>\n", "", "bad.urdf:2: XML: an element is not closed"},
    {"Mismatched", "</joint>", "</jiont>", "bad.urdf:17: XML: an element is closed by another"},
    {"AttributeWithoutQuotes", "value=\"2\"", "value=2", "bad.urdf:7: XML: broken attribute"},
    {"OpenComment", "<link name=\"arm\">", "<!-- <link name=\"arm\">",
     "bad.urdf:13: XML: a comment is not closed"},
    {"AnotherFormat", "<robot name=\"sample\">", "<sdf/><robot name=\"sample\">",
     "bad.urdf:2: file: is SDF, the format of Gazebo, which is not read; expected a URDF"},
    {"TwoRobots", "</robot>", "</robot>\n<robot/>", "bad.urdf:26: <robot>: follows </robot>"},
    // Names and structure
    {"RobotWithoutName", " name=\"sample\"", "", "bad.urdf:2: robot: has no attribute 'name'"},
    {"LinkWithoutName", "<link name=\"arm\">", "<link>",
     "bad.urdf:13: link: has no attribute 'name'"},
    {"EmptyName", "name=\"arm\"", "name=\"\"", "bad.urdf:13: link: attribute 'name' is empty"},
    {"DuplicateLink", "name=\"arm\"", "name=\"base\"",
     "bad.urdf:19: joint 'shoulder': child: link 'arm' does not exist"},
    {"DuplicateLinkOnly", "</robot>", "<link name=\"arm\"/></robot>",
     "bad.urdf:25: link 'arm': is defined twice, first (line 13)"},
    {"UnknownLink", "child link=\"arm\"", "child link=\"amr\"",
     "bad.urdf:19: joint 'shoulder': child: link 'amr' does not exist, did you mean 'arm'?"},
    {"NoParent", "<parent link=\"base\"/>", "", "bad.urdf:17: joint 'shoulder': has no <parent>"},
    {"TwoParentElements", "<parent link=\"base\"/>",
     "<parent link=\"base\"/><parent link=\"arm\"/>",
     "bad.urdf:18: joint 'shoulder': parent: is written twice, first in line 18"},
    {"SelfLoop", "child link=\"arm\"", "child link=\"base\"",
     "bad.urdf:17: joint 'shoulder': joins link 'base' to itself"},
    {"Cycle", "</robot>",
     "<joint name=\"back\" type=\"fixed\"><parent link=\"arm\"/><child "
     "link=\"base\"/></joint></robot>",
     "bad.urdf:25: joint 'back': link 'base' is part of a cycle"},
    {"TwoParents", "</robot>",
     "<joint name=\"two\" type=\"fixed\"><parent link=\"base\"/><child "
     "link=\"arm\"/></joint></robot>",
     "bad.urdf:25: joint 'two': link 'arm' has two parents"},
    {"DuplicateJoint", "</robot>",
     "<link name=\"tip\"/><joint name=\"shoulder\" type=\"fixed\"><parent link=\"arm\"/>"
     "<child link=\"tip\"/></joint></robot>",
     "bad.urdf:25: joint 'shoulder': is defined twice"},
    {"SecondRoot", "</robot>", "<link name=\"loose\"/></robot>",
     "bad.urdf:25: link 'loose': is a second root beside 'base' (line 4)"},
    // Inertia
    {"NoMass", "<mass value=\"2\"/>", "", "bad.urdf:5: link 'base': inertial: has no <mass>"},
    {"NegativeMass", "value=\"2\"", "value=\"-2\"", "bad.urdf:4: link 'base': mass is -2 kg"},
    {"NanMass", "value=\"2\"", "value=\"nan\"",
     "bad.urdf:7: link 'base': inertial: mass: value is 'nan', expected one finite number"},
    {"HalfNumber", "value=\"2\"", "value=\"2e\"",
     "bad.urdf:7: link 'base': inertial: mass: value is '2e'"},
    {"Hexadecimal", "value=\"2\"", "value=\"0x1\"",
     "bad.urdf:7: link 'base': inertial: mass: value is '0x1'"},
    {"NegativeMoment", "ixx=\"0.1\"", "ixx=\"-0.1\"",
     "bad.urdf:4: link 'base': inertia has a negative principal moment"},
    {"MissingProduct", " ixy=\"0\"", "",
     "bad.urdf:8: link 'base': inertial: inertia: has no attribute 'ixy'"},
    {"ZeroMomentOnMovingBody", "ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\"",
     "ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\"", "bad.urdf:13: link 'arm': moves, and its inertia"},
    // Shapes
    {"TwoNumbers", "size=\"0.2 0.4 0.6\"", "size=\"0.2 0.4\"",
     "bad.urdf:10: link 'base': collision: geometry: box: size is '0.2 0.4', expected three"},
    {"Commas", "size=\"0.2 0.4 0.6\"", "size=\"0,2 0,4 0,6\"",
     "bad.urdf:10: link 'base': collision: geometry: box: size is '0,2 0,4 0,6'"},
    {"ZeroSize", "size=\"0.2 0.4 0.6\"", "size=\"0.2 0 0.6\"",
     "bad.urdf:10: link 'base': collision: geometry: box: the smallest size is 0 m"},
    {"NegativeRadius", "cylinder radius=\"0.1\"", "cylinder radius=\"-0.1\"",
     "bad.urdf:15: link 'arm': collision: geometry: cylinder: radius is -0.1 m"},
    {"NoLength", " length=\"0.5\"", "",
     "bad.urdf:15: link 'arm': collision: geometry: cylinder: has no attribute 'length'"},
    {"Cone", "<cylinder radius", "<cone radius",
     "bad.urdf:15: link 'arm': collision: geometry: cone: unknown geometry, expected box"},
    {"FrictionText", "</robot>", "<gazebo reference=\"arm\"><mu1>much</mu1></gazebo></robot>",
     "bad.urdf:25: gazebo of 'arm': mu1 is 'much', expected one number"},
    {"NoGeometry", "<geometry><box size=\"0.2 0.4 0.6\"/></geometry>", "",
     "bad.urdf:10: link 'base': collision: has no <geometry>"},
    {"EmptyGeometry", "<box size=\"0.2 0.4 0.6\"/>", "",
     "bad.urdf:10: link 'base': collision: geometry: holds 0 shapes"},
    {"MissingMesh", "<box size=\"0.2 0.4 0.6\"/>", "<mesh filename=\"meshes/no.stl\"/>",
     "bad.urdf:10: link 'base': collision: mesh 'meshes/no.stl' not found, expected it as one of"},
    {"ZeroScale", "<box size=\"0.2 0.4 0.6\"/>", "<mesh filename=\"a.stl\" scale=\"1 0 1\"/>",
     "bad.urdf:10: link 'base': collision: geometry: mesh: scale holds a zero"},
    // Joints
    {"UnknownType", "type=\"revolute\"", "type=\"revolut\"",
     "bad.urdf:17: joint 'shoulder': unknown type 'revolut', expected one of fixed"},
    {"NoType", " type=\"revolute\"", "", "bad.urdf:17: joint 'shoulder': has no attribute 'type'"},
    {"ZeroAxis", "axis xyz=\"0 0 2\"", "axis xyz=\"0 0 0\"",
     "bad.urdf:21: joint 'shoulder': axis: xyz is zero, expected a direction"},
    {"NotFiniteOrigin", "xyz=\"0 0 0.5\"", "xyz=\"0 0 inf\"",
     "bad.urdf:20: joint 'shoulder': origin: xyz is '0 0 inf'"},
    {"LowerAboveUpper", "lower=\"-1\"", "lower=\"2\"",
     "bad.urdf:22: joint 'shoulder': limit: lower 2 > upper 1.5, expected lower <= upper"},
    {"NegativeEffort", "effort=\"5\"", "effort=\"-5\"",
     "bad.urdf:17: joint 'shoulder': effort is -5"},
    {"NegativeDamping", "damping=\"0.5\"", "damping=\"-0.5\"",
     "bad.urdf:17: joint 'shoulder': damping is -0.5"},
    {"NegativeFriction", "friction=\"0.25\"", "friction=\"-1\"",
     "bad.urdf:17: joint 'shoulder': friction is -1"},
    {"UnknownMimic", "<dynamics", "<mimic joint=\"elbow\"/><dynamics",
     "bad.urdf:23: joint 'shoulder': mimic: joint 'elbow' is not a revolute"},
    {"MimicOfItself", "<dynamics", "<mimic joint=\"shoulder\"/><dynamics",
     "bad.urdf:23: joint 'shoulder': mimic: a joint cannot mimic itself"},
    {"FloatingOnMovingLink", "type=\"revolute\"", "type=\"floating\"",
     "bad.urdf:17: joint 'shoulder': a floating joint hangs from 'base', which moves"},
    {"Xacro", "value=\"2\"", "value=\"${mass}\"",
     "bad.urdf:7: link 'base': inertial: mass: value is '${mass}', expected one finite number "
     "(a xacro expression: run xacro first)"},
    {"Version", "name=\"sample\"", "name=\"sample\" version=\"x\"",
     "bad.urdf:2: robot: version is 'x', expected 1.0, 1.1 or 1.2"},
    {"LaterVersion", "name=\"sample\"", "name=\"sample\" version=\"1.3\"",
     "bad.urdf:2: robot: version is '1.3', expected 1.0, 1.1 or 1.2"},
    // Poses that would be left out
    {"QuaternionOfAJoint", "rpy=\"0.1 0.2 0.3\"", "quat_xyzw=\"0 0 0 1\"",
     "bad.urdf:20: joint 'shoulder': origin: quat_xyzw is of URDF 1.1, and the file is of 1.0"},
    {"QuaternionOfAnInertia", "rpy=\"0 0 1.5707963267948966\"", "quat_xyzw=\"0 0 0 1\"",
     "bad.urdf:6: link 'base': inertial: origin: quat_xyzw is of URDF 1.1"},
    {"QuaternionOfAShape", "<origin xyz=\"1 2 3\"/>", "<origin quat_xyzw=\"0 0 0 1\"/>",
     "bad.urdf:10: link 'base': collision: origin: quat_xyzw is of URDF 1.1"},
    {"UnknownPose", "rpy=\"0.1 0.2 0.3\"", "quaternion=\"0 0 0 1\"",
     "bad.urdf:20: joint 'shoulder': origin: attribute 'quaternion' is not known"},
    {"PoseOfNoOrigin", "type=\"revolute\"", "type=\"revolute\" rpy=\"0 0 1\"",
     "bad.urdf:17: robot: joint: attribute 'rpy' is not read here; expected <origin"},
    {"OriginOfALink", "<link name=\"arm\">", "<link name=\"arm\"><origin xyz=\"0 0 1\"/>",
     "bad.urdf:13: robot: link: origin: attribute 'xyz' is not read here; expected <origin"},
    {"QuaternionBesideRpy", "rpy=\"0.1 0.2 0.3\"", "rpy=\"0 0 0\" quat_xyzw=\"0 0 0 1\"",
     "bad.urdf:20: joint 'shoulder': origin: holds rpy and quat_xyzw"},
};

INSTANTIATE_TEST_SUITE_P(BadInput, Urdf, testing::ValuesIn(kBadInputs),
                         [](const auto& test) { return test.param.name; });

TEST(UrdfFile, ThatIsNotThereIsNamed) {
  EXPECT_THROW(
      {
        try {
          loadUrdf("no/such/robot.urdf");
        } catch (const ModelError& error) {
          EXPECT_STREQ(error.what(),
                       "no/such/robot.urdf: file: cannot be read: No such file or directory, "
                       "expected a URDF file");
          throw;
        }
      },
      ModelError);
}

TEST(UrdfFile, EmptyOrBinaryIsRefused) {
  EXPECT_TRUE(errorOfUrdf("").starts_with("bad.urdf:1: XML: is empty"));
  EXPECT_TRUE(
      errorOfUrdf(std::string("\n\n<robot\0", 9)).starts_with("bad.urdf:3: XML: holds a zero"));
  EXPECT_TRUE(errorOfUrdf("solid cube").starts_with("bad.urdf:1: XML:"));
}

TEST(UrdfFile, WithoutLinksOrMassIsRefused) {
  EXPECT_EQ(errorOfUrdf("<robot name='r'/>"),
            "bad.urdf:1: robot: has no <link>, expected at least one");
  EXPECT_TRUE(errorOfUrdf("<robot name='r'><link name='ghost'/></robot>")
                  .starts_with("bad.urdf:1: link 'ghost': moves on joint 'ghost' but neither"));
}

TEST(UrdfFile, OfVersionOneOneHasQuaternionsOfLengthOne) {
  const std::string version =
      with(kSampleUrdf, "name=\"sample\"", "name=\"sample\" version=\"1.1\"");
  for (const char* quaternion : {"0 0 0 2", "0 0 0", "0 0 0 0", "0 0 0 x", ""}) {
    const std::string message = errorOfUrdf(
        with(version, "rpy=\"0.1 0.2 0.3\"", std::string("quat_xyzw=\"") + quaternion + "\""));
    EXPECT_TRUE(message.starts_with("bad.urdf:20: joint 'shoulder': origin: quat_xyzw is '"))
        << message;
  }
}

TEST(UrdfFile, ErrorsPrintNothing) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  errorOfUrdf(with(kSampleUrdf, "</robot>", "<link name=\"arm\"/></robot>"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace softgauss::io
