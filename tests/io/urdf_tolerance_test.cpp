// SPDX-License-Identifier: Apache-2.0
/// What real files hold that no other reader minds: it loads, and is told by name.

#include <algorithm>

#include "load_urdf.hpp"
#include "sample_urdf.hpp"

namespace softgauss::io {
namespace {

const std::string kLimit = "<limit lower=\"-1\" upper=\"1.5\" effort=\"5\" velocity=\"3\"/>";

/// The sample with a link fixed to its base.
std::string withHead(const std::string& inertial) {
  return with(kSampleUrdf, "</robot>",
              "<joint name=\"neck\" type=\"fixed\"><parent link=\"base\"/><child link=\"head\"/>"
              "</joint><link name=\"head\">" +
                  inertial + "</link></robot>");
}

std::string inertial(const std::string& mass, const std::string& ixx, const std::string& ixz) {
  return "<inertial><mass value=\"" + mass + "\"/><inertia ixx=\"" + ixx + "\" ixy=\"0\" ixz=\"" +
         ixz + "\" iyy=\"1e-6\" iyz=\"0\" izz=\"1e-6\"/></inertial>";
}

std::string refusalOfUrdf(const std::string& text) {
  try {
    load(text);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

// The inertia of a merged body is the sum of its links': one of them may be out of rounding.
TEST(UrdfTolerance, NegativeMomentsOfAPartOfASoundBodyAreTold) {
  for (const std::string& part :
       {std::string("<inertial><mass value=\"1.3\"/><inertia ixx=\"0\" ixy=\"0\" ixz=\"2.4e-35\" "
                    "iyy=\"0\" iyz=\"0\" izz=\"0\"/></inertial>"),
        inertial("0.1", "-3.5e-8", "0")}) {
    const Model m = load(withHead(part));
    EXPECT_TRUE(hasWarning(m, "negative principal moment")) << part;
    EXPECT_TRUE(hasWarning(m, ": head")) << part;
  }
  EXPECT_FALSE(hasWarning(load(withHead(inertial("0.1", "1e-6", "0"))), "negative principal"));
}

TEST(UrdfTolerance, NegativeMomentsOfAnUnsoundBodyAreRefusedAtTheirLink) {
  const std::string message = refusalOfUrdf(withHead(inertial("0.1", "-7", "0")));
  EXPECT_NE(message.find("robot.urdf:25: link 'head': inertia has a negative principal moment (-7"),
            std::string::npos)
      << message;
}

TEST(UrdfTolerance, ElementsOfOtherToolsAreIgnoredInOneWarning) {
  const std::string text =
      with(with(kSampleUrdf, "<robot name=\"sample\">",
                "<robot name=\"sample\" xmlns:drake=\"http://drake.mit.edu\">"),
           "<box size=\"0.2 0.4 0.6\"/>",
           "<box size=\"0.2 0.4 0.6\"/><drake:declare_convex/><ext:skin depth='1'/>");
  const Model m = load(text);
  ASSERT_EQ(m.geometries.size(), 2u);
  EXPECT_EQ(m.geometries[0].shape.kind, ShapeKind::box);
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_TRUE(hasWarning(m, "1 <drake:declare_convex>, 1 <ext:skin>"));
  // Without a prefix it may be a second shape.
  EXPECT_NE(refusalOfUrdf(with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>",
                               "<box size=\"0.2 0.4 0.6\"/><convex/>"))
                .find("holds 2 shapes"),
            std::string::npos);
}

TEST(UrdfTolerance, ShapesOfNoSizeAreLeftOut) {
  for (const char* shape : {"<sphere radius=\"0\"/>", "<box size=\"0 0 0\"/>",
                            "<cylinder radius=\"0\" length=\"0\"/>"}) {
    const Model m = load(with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>", shape));
    ASSERT_EQ(m.geometries.size(), 1u) << shape;
    EXPECT_EQ(m.geometries[0].link, "arm");
    EXPECT_TRUE(hasWarning(m,
                           "shapes of no size, which touch nothing and are left out: line 10: "
                           "base"));
  }
  // What has an extent and no volume would be missed.
  for (const char* shape : {"<box size=\"0.1 0.1 0\"/>", "<cylinder radius=\"0\" length=\"1\"/>",
                            "<sphere radius=\"-0.1\"/>"})
    EXPECT_NE(refusalOfUrdf(with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>", shape))
                  .find("expected more than 0"),
              std::string::npos)
        << shape;
}

TEST(UrdfTolerance, LimitsWithoutEffortOrVelocityAreTold) {
  const std::string none = "<limit lower=\"-1\" upper=\"1.5\" velocity=\"0\"/>";
  const Model m = load(with(kSampleUrdf, kLimit, none));
  EXPECT_TRUE(hasWarning(m,
                         "no effort in <limit>, so the controls of these joints have no bound: "
                         "shoulder"));
  EXPECT_TRUE(hasWarning(m, "a velocity limit of 0 is taken as none: shoulder"));
  EXPECT_EQ(m.dofs[6].effortUpper, kInfinity);
  EXPECT_EQ(m.dofs[6].velocityLimit, kInfinity);
  EXPECT_TRUE(load(with(kSampleUrdf, kLimit,
                        "<limit lower=\"-1\" upper=\"1.5\" effort=\"1e30\" "
                        "velocity=\"1e16\"/>"))
                  .warnings.empty())
      << "what stands for no limit";
}

TEST(UrdfTolerance, AMimicThatItsLeaderDoesNotMoveIsTold) {
  const std::string second =
      "<link name=\"tip\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link><joint name=\"wrist\" type=\"revolute\">"
      "<parent link=\"arm\"/><child link=\"tip\"/><limit lower=\"-1\" upper=\"1\" velocity=\"1\"/>"
      "<mimic joint=\"shoulder\" multiplier=\"M\" offset=\"0.3\"/></joint></robot>";
  const std::string text = with(kSampleUrdf, "</robot>", second);
  const Model m = load(with(text, "\"M\"", "\"0\""));
  EXPECT_TRUE(hasWarning(m, "mimic with multiplier 0"));
  EXPECT_TRUE(hasWarning(m, "does: wrist"));
  EXPECT_FALSE(hasWarning(m, "no effort")) << "what follows has no control";
  EXPECT_FALSE(hasWarning(load(with(text, "\"M\"", "\"0.5\"")), "mimic with multiplier 0"));
}

TEST(UrdfTolerance, DefectsOfVisualsStopNothing) {
  for (const char* visual :
       {"<visual/>", "<visual><geometry/></visual>",
        "<visual><origin quat_xyzw=\"1\"/><geometry><sphere radius=\"1\"/></geometry></visual>",
        "<visual><geometry><box size=\"1 1\"/></geometry></visual>",
        "<visual><geometry><mesh filename=\"\"/></geometry></visual>",
        "<visual><geometry><mesh filename=\"\xff\"/></geometry></visual>",
        "<visual><geometry><torus/></geometry></visual>",
        "<visual><geometry><sphere radius=\"1\"/></geometry><material><color rgba=\"x\"/>"
        "</material></visual>"}) {
    UrdfOptions options;
    options.visualMeshes = true;
    EXPECT_NO_THROW(
        load(with(kSampleUrdf, "<link name=\"arm\">", std::string("<link name=\"arm\">") + visual),
             options))
        << visual;
  }
}

// ---- Text

TEST(UrdfText, NamesThatAreNoUtf8AreRefused) {
  const std::string message =
      refusalOfUrdf(with(with(kSampleUrdf, "<link name=\"arm\">", "<link name=\"a\xff\xfem\">"),
                         "child link=\"arm\"", "child link=\"a\xff\xfem\""));
  EXPECT_NE(message.find("robot.urdf:13: link: name is 'a"), std::string::npos) << message;
  EXPECT_NE(message.find("no UTF-8"), std::string::npos) << message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\xff'), 0) << "messages are UTF-8";
  EXPECT_NO_THROW(
      load(with(kSampleUrdf, "<link name=\"base\">", "<!-- of a caf\xe9 --><link name=\"base\">")))
      << "comments may be anything";
  EXPECT_NO_THROW(load(with(with(kSampleUrdf, "<link name=\"arm\">", "<link name=\"Ärmel\">"),
                            "child link=\"arm\"", "child link=\"Ärmel\"")));
}

TEST(UrdfText, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(load("\xEF\xBB\xBF" + kSampleUrdf).nv, load(kSampleUrdf).nv);
  EXPECT_NE(refusalOfUrdf("\xFF\xFE<").find(":1: XML: is UTF-16, expected UTF-8"),
            std::string::npos);
}

TEST(UrdfText, IsCutInMessages) {
  const std::string name(100000, 'x');
  for (const std::string& text :
       {with(kSampleUrdf, "value=\"2\"", "value=\"" + name + "\""),
        with(kSampleUrdf, "parent link=\"base\"", "parent link=\"" + name + "\""),
        with(kSampleUrdf, "type=\"revolute\"", "type=\"" + name + "\""),
        with(kSampleUrdf, "size=\"0.2", "size=\"" + name)})
    EXPECT_LT(refusalOfUrdf(text).size(), 600u);
}

TEST(UrdfText, NumbersAreBounded) {
  for (const auto& [from, to, words] :
       {std::tuple{"value=\"2\"", "value=\"1e13\"", ":7: link 'base': inertial: mass: value holds"},
        {"size=\"0.2", "size=\"1e100", ":10: link 'base': collision: geometry: box: size holds"},
        {"xyz=\"0 0 0.5\"", "xyz=\"0 0 1e300\"", ":20: joint 'shoulder': origin: xyz holds 1e+300"},
        {"damping=\"0.5\"", "damping=\"1e14\"", ":23: joint 'shoulder': dynamics: damping holds"}})
    EXPECT_NE(refusalOfUrdf(with(kSampleUrdf, from, to)).find(words), std::string::npos)
        << refusalOfUrdf(with(kSampleUrdf, from, to));
}

}  // namespace
}  // namespace softgauss::io
