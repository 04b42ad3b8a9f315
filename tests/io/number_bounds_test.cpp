// SPDX-License-Identifier: Apache-2.0
/// Every number of a file has bounds, within which its square and its products are finite.

#include "scene_folder.hpp"
#include "softgauss/io/goals.hpp"
#include "softgauss/io/height_field.hpp"
#include "softgauss/io/torque_table.hpp"

namespace softgauss::test {
namespace {

struct Place {
  const char* text;  ///< NUMBER stands for the number
  const char* key;
  bool fromZero;  ///< as small as one likes
};

/// Where scenes have numbers of each kind.
constexpr Place kPlaces[] = {
    {"timestep: NUMBER", "'timestep'", false},
    {"gravity: [0, 0, NUMBER]", "'gravity'", true},
    {"ground: NUMBER", "'ground'", true},
    {"ground: {height: NUMBER}", "'ground.height'", true},
    {"materials: {m: {friction: NUMBER}}", "'materials.m.friction'", true},
    {"materials: {m: {time_constant: NUMBER}}", "'materials.m.time_constant'", false},
    {"materials: {m: {stiffness: NUMBER}}", "'materials.m.stiffness'", false},
    {"materials: {m: {impedance: {width: NUMBER}}}", "'materials.m.impedance.width'", false},
    {"objects:\n  - {name: o, sphere: {radius: NUMBER}}", "'sphere.radius'", false},
    {"objects:\n  - {name: o, sphere: {radius: 1}, mass: NUMBER}", "'mass'", false},
    {"objects:\n  - {name: o, sphere: {radius: 1}, position: [0, NUMBER, 0]}", "'position'", true},
    {"objects:\n  - {name: o, capsule: {radius: 1, length: NUMBER}}", "'capsule.length'", false},
    {"robots:\n  - {urdf: sample.urdf, joint_velocities: {shoulder: NUMBER}}",
     "'joint_velocities.shoulder'", true},
    {"robots:\n  - {urdf: sample.urdf, joint_parameters: {shoulder: {armature: NUMBER}}}",
     "'joint_parameters.shoulder.armature'", true},
    {"robots: [{urdf: sample.urdf}]\nactuators:\n  - {name: a, joints: {shoulder: NUMBER}}",
     "'joints.shoulder'", false},
    {"robots: [{urdf: sample.urdf}]\nactuators:\n  - {name: a, joints: {shoulder: 1}, effort: "
     "NUMBER}",
     "'effort'", true},
    {"robots: [{urdf: sample.urdf}]\nactuators:\n  - {name: a, joints: {shoulder: 1}, bounds: [0, "
     "NUMBER]}",
     "'bounds'", true},
    {"robots: [{urdf: sample.urdf}]\nconstraints:\n  - couple: {follower: shoulder, polynomial: "
     "[0, NUMBER]}",
     "'couple.polynomial'", true},
    {"robots: [{urdf: sample.urdf}]\nwrenches:\n  - {link: arm, force: [NUMBER, 0, 0]}", "'force'",
     true},
    {"objects:\n  - {name: o, cylinder: {radius: NUMBER, length: 1}}", "'cylinder.radius'", false},
    {"options: {impedance_ratio: NUMBER}", "'options.impedance_ratio'", false},
    {"options: {tolerance: NUMBER}", "'options.tolerance'", true},
};

std::string with(const Place& place, const std::string& number) {
  std::string text = place.text;
  text.replace(text.find("NUMBER"), 6, number);
  if (text.find("robots:") == std::string::npos && text.find("objects:") == std::string::npos)
    text += "\nrobots: [{urdf: sample.urdf}]";
  return text + "\n";
}

TEST(NumberBounds, HoldEverywhereInAScene) {
  for (const Place& place : kPlaces) {
    std::vector<std::string> numbers = {"1e13", "1e155", "1e300", "-1e300"};
    if (!place.fromZero) numbers.insert(numbers.end(), {"1e-13", "1e-155", "1e-300", "5e-324"});
    for (const std::string& number : numbers) {
      const std::string scene = with(place, number), message = refusal(scene);
      EXPECT_NE(message.find("scene.yaml:"), std::string::npos) << message;
      EXPECT_NE(message.find(place.key), std::string::npos) << scene << "  -> " << message;
      EXPECT_NE(message.find("found '" + number + "'"), std::string::npos) << message;
    }
  }
}

// What is refused is beyond the bounds, and no more than that.
TEST(NumberBounds, LeaveNumbersWithinThemAlone) {
  for (const char* number : {"1e12", "1e-12", "-1e12", "-1e-12"}) {
    const SceneFolder folder(
        std::string(
            "robots: [{urdf: sample.urdf}]\nactuators:\n  - {name: a, joints: {shoulder: ") +
        number + "}}\n");
    const io::SceneFile scene = folder.read();
    const Model model = scene.builder.build();
    const gdd::ControlLimits limits = io::controlLimits(model, scene.actuators);
    ASSERT_TRUE(limits.transmission);
    EXPECT_EQ(limits.transmission->T()(6, 6), std::strtod(number, nullptr));
    EXPECT_NEAR((limits.transmission->T() * limits.transmission->C())(6, 6), 1.0, 1e-15);
  }
}

/// The message with which `read` refuses a file.
template <class Read>
std::string refusalOf(Read&& read) {
  try {
    read();
  } catch (const ModelError& error) {
    return error.what();
  }
  return {};
}

TEST(NumberBounds, HoldInTables) {
  const SceneFolder folder("robots: [{urdf: sample.urdf}]\n");
  const Model model = folder.read().builder.build();
  const io::TempFolder tables;
  for (const char* row : {"0,1e13", "0,-1e300", "1e300,0"}) {
    const auto table = tables.write("t.csv", std::string("time_s,u:shoulder\n") + row + "\n");
    const std::string message = refusalOf([&] { io::TorqueTable::read(table, model); });
    EXPECT_NE(message.find("t.csv:2: "), std::string::npos) << row << ": " << message;
    EXPECT_NE(message.find("1e+12"), std::string::npos) << row << ": " << message;
  }
  const auto heights = tables.write("h.csv", "0,0\n0,1e13\n");
  EXPECT_NE(refusalOf([&] { io::readHeights(heights); }).find("h.csv:2: "), std::string::npos);
}

TEST(NumberBounds, HoldInGoals) {
  const SceneFolder folder("robots: [{urdf: sample.urdf}]\n");
  const Model model = folder.read().builder.build();
  const io::TempFolder files;
  for (const char* keys : {"weight: 1e13", "weight: 1e300", "stiffness: 1e300",
                           "minimum_jerk: {duration: 1e-200}", "minimum_jerk: {duration: 1e-13}"}) {
    const auto goals = files.write(
        "g.yaml",
        std::string("goals:\n  - reach: {link: arm, target: [0, 0, 1],\n      ") + keys + "}\n");
    const std::string message = refusalOf([&] { io::readGoals(goals, model, State(model)); });
    EXPECT_NE(message.find("g.yaml:3: goal 1 'reach': key '"), std::string::npos) << message;
    EXPECT_NE(message.find("1e+12"), std::string::npos) << keys << ": " << message;
  }
}

// A byte that is no UTF-8 would go into logs, summaries and pages.
TEST(NumberBounds, TextIsUtf8OrRefusedWithItsLine) {
  EXPECT_NE(refusal("# a\nobjects:\n  - {name: \"b\xff\", sphere: {radius: 1}}\n")
                .find("scene.yaml:3: YAML: found the byte 0xff"),
            std::string::npos);
  for (const char* good : {"\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\xa4\x96"}) {
    const SceneFolder folder(std::string("objects:\n  - {name: ") + good +
                             ", sphere: {radius: 1}}");
    EXPECT_GE(folder.read().builder.build().findFrame(good), 0);
  }
  // Too long a form, a surrogate, beyond Unicode, cut off.
  for (const char* bad :
       {"\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82"})
    EXPECT_NE(refusal(std::string("objects:\n  - {name: \"") + bad + "\", sphere: {radius: 1}}\n")
                  .find("no UTF-8"),
              std::string::npos);
}

}  // namespace
}  // namespace softgauss::test
