// SPDX-License-Identifier: Apache-2.0
/// Bad input ends simulate_gdd with exit code 2 and a message that names file, line and element.

#include <regex>

#include "tests/apps/process.hpp"
#include "tests/io/sample_urdf.hpp"

namespace softgauss::test {
namespace {

using io::kSampleUrdf;
using io::with;

struct BadFile {
  const char* name;
  std::string text;
  const char* line;                  ///< of the element at fault; "" where any will do
  std::vector<const char*> mention;  ///< what the message must say
};

void PrintTo(const BadFile& file, std::ostream* out) { *out << file.name; }

/// A second arm on `parent`, called "hand".
std::string handJoint(const std::string& name, const std::string& parent,
                      const std::string& child) {
  return "<joint name=\"" + name + "\" type=\"fixed\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/></joint>\n</robot>";
}

std::vector<BadFile> badFiles() {
  const std::string& s = kSampleUrdf;
  const std::string mass = "<mass value=\"2\"/>";
  const std::string limit = "lower=\"-1\" upper=\"1.5\"";
  return {
      {"BrokenXml", with(s, "</robot>", ""), "", {}},
      {"NotXmlAtAll", "solid cube\n", "", {}},
      {"Empty", "", "", {}},
      {"Cycle", with(s, "</robot>", handJoint("back", "arm", "base")), "", {"base"}},
      {"TwoParents",
       with(with(s, "</robot>", "<link name=\"other\"/>" + handJoint("mount", "base", "other")),
            "</robot>", handJoint("grip", "other", "arm")),
       "",
       {"arm"}},
      {"MissingCollisionMesh",
       with(s, "<cylinder radius=\"0.1\" length=\"0.5\"/>", "<mesh filename=\"no_such.stl\"/>"),
       "15",
       {"no_such.stl", "arm"}},
      {"NegativeMass", with(s, mass, "<mass value=\"-2\"/>"), "4", {"base", "-2"}},
      {"NegativeMoment", with(s, "ixx=\"0.1\"", "ixx=\"-0.1\""), "4", {"base", "-0.1"}},
      {"InertiaNotPositiveDefinite", with(s, "ixy=\"0\"", "ixy=\"0.5\""), "4", {"base"}},
      {"MovingBodyWithoutInertia",
       with(s,
            "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" "
            "iyz=\"0\" izz=\"1\"/></inertial>",
            ""),
       "",
       {"arm"}},
      {"NotANumber", with(s, mass, "<mass value=\"nan\"/>"), "7", {"base", "nan"}},
      {"NoNumber", with(s, mass, "<mass value=\"two\"/>"), "7", {"base", "two"}},
      {"UnknownJointType",
       with(s, "type=\"revolute\"", "type=\"hinged\""),
       "17",
       {"shoulder", "hinged"}},
      {"LowerAboveUpper", with(s, limit, "lower=\"2\" upper=\"1.5\""), "22", {"shoulder"}},
      {"UnknownParent",
       with(s, "parent link=\"base\"", "parent link=\"bass\""),
       "",
       {"shoulder", "bass"}},
  };
}

class BadFileTest : public testing::TestWithParam<BadFile> {};

TEST_P(BadFileTest, EndsWithCodeTwoAndNamesFileLineAndElement) {
  const BadFile& bad = GetParam();
  const io::TempFolder folder;
  const std::string file = folder.write("robot.urdf", bad.text);
  for (const char* mode : {"--passive", "--explain"}) {
    const Outcome outcome = simulate({file, mode});
    EXPECT_EQ(outcome.exitCode, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    const std::string place = file + ":" + bad.line;
    EXPECT_EQ(outcome.err.rfind(place, 0), 0u) << "begins with " << place << "\n" << outcome.err;
    for (const char* word : bad.mention)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " in\n" << outcome.err;
    // file:line: element: problem; a tree as a whole has no line.
    EXPECT_TRUE(std::regex_search(outcome.err, std::regex("^[^:]+(:[0-9]+)?: [^:]+: .")))
        << outcome.err;
  }
}

INSTANTIATE_TEST_SUITE_P(SimulateGdd, BadFileTest, testing::ValuesIn(badFiles()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(BadInput, MissingFile) {
  const Outcome outcome = simulate({"no/such/robot.urdf", "--passive"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_EQ(outcome.err.rfind("no/such/robot.urdf", 0), 0u) << outcome.err;
}

TEST(BadInput, MissingVisualMeshIsOnlyAWarning) {
  const io::TempFolder folder;
  const std::string file = folder.write(
      "robot.urdf", with(kSampleUrdf, "<sphere radius=\"0.3\"/>", "<mesh filename=\"no.stl\"/>"));
  const std::string summary = folder.path() / "summary.json";
  const Outcome outcome = simulate({file, "--passive", "--duration", "0.01", "--summary", summary});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
}

// A heavy link on a massless one is a joint of two degrees of freedom; the other way it is an
// error.
TEST(BadInput, MasslessLinkIsFineUnderAHeavyOne) {
  const io::TempFolder folder;
  const std::string tail =
      "<link name=\"tip\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link><joint name=\"wrist\" "
      "type=\"continuous\"><parent link=\"stage\"/><child link=\"tip\"/><axis xyz=\"1 0 "
      "0\"/></joint></robot>";
  const std::string stage =
      "<link name=\"stage\"/><joint name=\"elbow\" type=\"continuous\"><parent link=\"arm\"/>"
      "<child link=\"stage\"/><axis xyz=\"0 1 0\"/></joint>";
  const std::string good = folder.write("good.urdf", with(kSampleUrdf, "</robot>", stage + tail));
  EXPECT_EQ(simulate({good, "--passive", "--duration", "0.01", "--quiet"}).exitCode, 0);
  const std::string bad =
      folder.write("bad.urdf", with(kSampleUrdf, "</robot>", stage + "</robot>"));
  const Outcome outcome = simulate({bad, "--passive"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("stage"), std::string::npos) << outcome.err;
}

struct BadOption {
  std::vector<std::string> arguments;
  std::string mention;
};

TEST(BadInput, CommandLinesThatCannotBeRun) {
  const std::string arm = dataFile("robots/arm.urdf"), body = dataFile("robots/humanoid.urdf");
  const BadOption cases[] = {
      {{arm, "--pasive"}, "pasive"},
      {{arm, "--passive", "--duration", "-1"}, "duration"},
      {{arm, "--passive", "--duration", "soon"}, "duration"},
      {{arm, "--passive", "--timestep", "0"}, "timestep"},
      {{arm, "--passive", "--timestep", "nan"}, "timestep"},
      {{arm, "--passive", "--duration", "inf"}, "duration"},
      {{arm, "--passive", "--base", "flying"}, "flying"},
      {{arm, "--passive", "--integrator", "magic"}, "magic"},
      {{arm, "--reach", "hand=0,0,0", "--gdd-solver", "both"}, "both"},
      {{arm, "--passive", "--effects", "gravity,magic"}, "magic"},
      {{arm, "--passive", "--ground", "deep"}, "deep"},
      {{body, "--passive", "--base-height", "high"}, "base-height"},
      {{arm}, "nothing to do"},
      {{}, "MODEL"},
      {{arm, "--reach", "claw=0,0,0"}, "claw"},
      {{arm, "--reach", "hand"}, "hand"},
      {{arm, "--reach", "hand=0,0"}, "0,0"},
      {{arm, "--reach", "hand=0,0,0,0"}, "0,0,0,0"},
      {{arm, "--reach", "hand=0,0,up"}, "up"},
      {{arm, "--reach", "hand=0,0,nan"}, "nan"},
      {{arm, "--reach", "hand=0,0,inf"}, "inf"},
      {{arm, "--reach", "hand=0,0,1e999"}, "1e999"},
      {{arm, "--reach", "hand:0,0=0,0,0"}, "0,0"},
      {{arm, "--reach", "hand=0.5,0.3,0.5", "--passive"}, "one of"},
      {{arm, "--passive", "--q0", "elbow"}, "elbow"},
      {{arm, "--passive", "--q0", "elbow=bent"}, "bent"},
      {{arm, "--passive", "--q0", "elbow=nan"}, "nan"},
      {{arm, "--passive", "--q0", "nose=1"}, "nose"},
      {{arm, "--torques", "no_such.csv"}, "no_such.csv"},
      {{arm, "--goals", "no_such.yaml"}, "no_such.yaml"},
      {{arm, "--passive", "--duration", "0.01", "--log", "/no/such/folder/log.csv"}, "log.csv"},
      {{arm, "--passive", "--duration", "0.01", "--summary", "/no/such/folder/s.json"}, "s.json"},
  };
  for (const BadOption& bad : cases) {
    const Outcome outcome = simulate(bad.arguments);
    std::string line;
    for (const std::string& a : bad.arguments) line += a + " ";
    EXPECT_EQ(outcome.exitCode, 2) << line << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(bad.mention), std::string::npos) << line << "\n" << outcome.err;
  }
}

}  // namespace
}  // namespace softgauss::test
