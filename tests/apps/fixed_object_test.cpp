// SPDX-License-Identifier: Apache-2.0
/// What is fixed to the world stops what moves: also the first link of a robot, and what starts
/// inside it.

#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

/// The last value of a column after a passive run.
double endOf(const std::string& scene, const std::string& column, const std::string& duration) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv";
  const Outcome outcome =
      simulate({scene, "--passive", "--duration", duration, "--log", log, "--quiet"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv csv((readFile(log)));
  return csv.number(static_cast<int>(csv.rows.size()) - 1, column);
}

/// A box on a rail along x that hangs from `root`, with `more` in that link and beside it.
std::string cart(const std::string& root, const std::string& inRoot = "",
                 const std::string& more = "") {
  return "<robot name=\"cart\"><link name=\"" + root + "\">" + inRoot +
         "</link><link name=\"cart\"><inertial><mass value=\"1\"/><inertia ixx=\"0.01\" "
         "iyy=\"0.01\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry>"
         "<box size=\"0.1 0.1 0.1\"/></geometry></collision></link><joint name=\"rail\" "
         "type=\"prismatic\"><parent link=\"" +
         root + "\"/><child link=\"cart\"/><axis xyz=\"1 0 0\"/></joint>" + more + "</robot>";
}

/// Where five newton have driven the cart after two seconds: 10 m if nothing stops it.
double driven(const std::string& urdf, const std::string& more) {
  const io::TempFolder folder;
  folder.write("cart.urdf", urdf);
  return endOf(folder.write("scene.yaml",
                            "ground: none\ngravity: [0, 0, 0]\n"
                            "robots:\n  - {name: c, urdf: cart.urdf, base: fixed}\n" +
                                more + "wrenches: [{link: c/cart, force: [5, 0, 0]}]\n"),
               "q:c/rail", "2");
}

const std::string kWall =
    "<collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"0.2 0.2 0.2\"/>"
    "</geometry></collision>";

// It rests on the surface but for the depth that its weight sinks it in by, which is well below a
// hundredth of its radius.
TEST(FixedObject, CarriesWhatStartsInsideIt) {
  for (const char* start : {"0.09995", "0.0998", "0.09"}) {
    const io::TempFolder folder;
    const std::string scene =
        folder.write("scene.yaml",
                     "ground: none\nobjects:\n"
                     "  - {name: ball, sphere: {radius: 0.1}, mass: 1, position: [0, 0, " +
                         std::string(start) +
                         "]}\n  - {name: table, box: {size: [4, 2, 0.2]}, fixed: true, "
                         "position: [0, 0, -0.1]}\n");
    EXPECT_NEAR(endOf(scene, "q:ball.z", "1"), 0.1, 1e-3) << start;
  }
}

// The face of the wall is 0.35 m ahead of the cart's; five newton sink it in by less than 1 cm.
TEST(FixedObject, StopsTheFirstLinkOfAFixedRobot) {
  const std::string wall =
      "objects: [{name: wall, box: {size: [0.2, 0.2, 0.2]}, fixed: true, position: [0.5, 0, 0]}]\n";
  const std::string link = "<link name=\"wall\">" + kWall + "</link>";
  const std::string bolted =
      link +
      "<joint name=\"bolt\" type=\"fixed\"><parent link=\"world\"/><child link=\"wall\"/></joint>";
  EXPECT_NEAR(driven(cart("world"), wall), 0.35, 0.01) << "an object";
  EXPECT_NEAR(driven(cart("base"), wall), 0.35, 0.01) << "an object, and a root of another name";
  EXPECT_NEAR(driven(cart("world", kWall), ""), 0.35, 0.01) << "a shape of the link 'world'";
  EXPECT_NEAR(driven(cart("world", "", bolted), ""), 0.35, 0.01) << "a link fixed to 'world'";
  EXPECT_GT(driven(cart("base", kWall), ""), 9.0) << "its own base does not";
}

TEST(FixedObject, TheBaseOfAnotherRobotStopsARobot) {
  const io::TempFolder folder;
  const std::string other = folder.write("other.urdf", cart("base", kWall));
  EXPECT_NEAR(driven(cart("base"), "  - {name: other, urdf: " + other + ", base: fixed}\n"), 0.35,
              0.01);
}

TEST(FixedObject, ThatIsNotTestedIsToldInTheWarnings) {
  const io::TempFolder folder;
  const auto warnings = [&](const std::string& urdf) {
    const std::string summary = folder.path() / "summary.json";
    const Outcome outcome =
        simulate({folder.write("cart.urdf", urdf), "--passive", "--base", "fixed", "--duration",
                  "0.01", "--summary", summary, "--quiet"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return nlohmann::json::parse(readFile(summary))["warnings"].dump();
  };
  const std::string told = "base – cart: joined by a joint";
  EXPECT_NE(warnings(cart("base", kWall)).find(told), std::string::npos);
  EXPECT_EQ(warnings(cart("base")).find("never tested"), std::string::npos);
  EXPECT_EQ(warnings(cart("world", kWall)).find("never tested"), std::string::npos);
}

}  // namespace
}  // namespace softgauss::test
