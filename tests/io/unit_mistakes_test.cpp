// SPDX-License-Identifier: Apache-2.0
/// Numbers in other units than meant are told with the value that was probably meant, and used as
/// written.

#include "load_urdf.hpp"
#include "sample_urdf.hpp"
#include "scene_folder.hpp"

namespace softgauss::io {
namespace {

const std::string kRange = "lower=\"-1\" upper=\"1.5\"";

TEST(UnitMistakes, AreNotSeenInWhatIsRight) {
  for (const char* range : {"lower=\"-6.2832\" upper=\"6.2832\"", "lower=\"-9\" upper=\"9\"",
                            "lower=\"-1e16\" upper=\"1e16\""})
    EXPECT_TRUE(load(with(kSampleUrdf, kRange, range)).warnings.empty()) << range;
  for (const char* rpy : {"0.1 -6.2832 3.1416", "0 0 0"})
    EXPECT_TRUE(load(with(kSampleUrdf, "0.1 0.2 0.3\"", std::string(rpy) + "\"")).warnings.empty())
        << rpy;
}

TEST(UnitMistakes, RangesOfDegrees) {
  const Model m = load(with(kSampleUrdf, kRange, "lower=\"-90\" upper=\"180\""));
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_TRUE(hasWarning(
      m, "joint 'shoulder' -90 .. 180 rad (-1.5708 .. 3.14159 rad if it is in degrees)"));
  EXPECT_EQ(m.ranges[0].upper, 180.0) << "nothing is mended";
  EXPECT_TRUE(load(with(with(kSampleUrdf, kRange, "lower=\"-90\" upper=\"180\""), "\"revolute\"",
                        "\"prismatic\""))
                  .warnings.empty())
      << "metres are no angles";
}

TEST(UnitMistakes, PosesOfDegrees) {
  const Model m = load(with(with(kSampleUrdf, "rpy=\"0.1 0.2 0.3\"", "rpy=\"0 0 90\""), "<visual>",
                            "<visual><origin rpy=\"-45 0 0\"/>"));
  EXPECT_TRUE(hasWarning(m, "line 20 '0 0 90' (0 0 1.5708 rad if it is in degrees)"));
  EXPECT_TRUE(hasWarning(m, "line 11 '-45 0 0' (-0.785398 0 0 rad if it is in degrees)"));
  const test::SceneFolder scene(
      "robots: [{urdf: sample.urdf, rpy: [0, 0, 180]}]\n"
      "objects:\n  - {name: ball, sphere: {radius: 1}, rpy: [0, 90, 0]}\n"
      "  - {name: other, sphere: {radius: 1}, rpy: [0, 1.5, 0]}\n");
  const Model model = scene.read().builder.build();
  EXPECT_TRUE(hasWarning(model, "line 1 (0 0 3.14159 rad"));
  EXPECT_TRUE(hasWarning(model, "line 3 (0 1.5708 0 rad"));
  EXPECT_FALSE(hasWarning(model, "line 4"));
}

/// The arm's inertia, of a cylinder of 1 kg, 0.1 m and 0.5 m: 0.0233 kg m² across.
Model withMoment(const std::string& moment) {
  return load(with(kSampleUrdf, "ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"",
                   "ixx=\"" + moment + "\" ixy=\"0\" ixz=\"0\" iyy=\"" + moment +
                       "\" iyz=\"0\" izz=\"" + moment + "\""));
}

// m R² with R² = 0.25² + 0.1² is 0.0725 kg m², of all mass at the farthest points; it is told from
// 20 times that on.
TEST(UnitMistakes, InertiaThatNoBodyOfThatMassAndSizeHas) {
  EXPECT_TRUE(withMoment("1.44").warnings.empty());
  EXPECT_TRUE(hasWarning(withMoment("1.46"), "link 'arm' has 1.46 kg m²"));
  const std::pair<const char*, const char*> units[] = {
      {"233", "kg cm²"}, {"23300", "kg mm²"}, {"233000", "g cm²"}, {"23300000", "g mm²"}};
  for (const auto& [moment, unit] : units)
    EXPECT_TRUE(hasWarning(withMoment(moment), std::string("(0.0233 kg m² if it is in ") + unit))
        << withMoment(moment).warnings.front();
}

// Without shapes the extent of the robot, here 0.9 m, bounds a link: 0.81 kg m² and 20 times that.
TEST(UnitMistakes, InertiaOfALinkWithoutShapes) {
  const auto withoutShape = [](const std::string& moment) {
    return load(
        "<robot name='r'><link name='base'/><link name='arm'><inertial><mass value='1'/>"
        "<inertia ixx='" +
        moment + "' ixy='0' ixz='0' iyy='" + moment + "' iyz='0' izz='" + moment +
        "'/></inertial></link><joint name='j' type='fixed'><origin xyz='0 0 0.9'/>"
        "<parent link='base'/><child link='arm'/></joint></robot>");
  };
  EXPECT_FALSE(hasWarning(withoutShape("16"), "no body of that mass and size"));
  EXPECT_TRUE(hasWarning(withoutShape("17"), "link 'arm' has 17 kg m², 1 kg within 0.9 m"));
}

/// The sample with a cube of `size` as a mesh in place of its box.
Model withCube(const std::string& size) {
  const TempFolder folder;
  std::string text;
  for (const char* corner : {"0 0 0", "S 0 0", "0 S 0", "0 0 S", "S S S"})
    for (const char c : std::string("v ") + corner + "\n")
      text += c == 'S' ? size : std::string(1, c);
  folder.write("c.obj", text + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 2 5 4\nf 3 4 5\n");
  return loadUrdf(folder.write(
      "r.urdf", with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>", "<mesh filename=\"c.obj\"/>")));
}

TEST(UnitMistakes, MeshesOfMillimetres) {
  EXPECT_FALSE(hasWarning(withCube("0.3"), "meshes far larger"));
  EXPECT_FALSE(hasWarning(withCube("3"), "meshes far larger"));
  const Model m = withCube("300");
  EXPECT_TRUE(hasWarning(
      m, "'c.obj' of link 'base', 519.615 m (0.519615 m with scale=\"0.001 0.001 0.001\")"));
  double largest = 0.0;
  for (const Vector3& vertex : m.geometries[0].shape.mesh->vertices)
    largest = std::max(largest, vertex.x());
  EXPECT_EQ(largest, 300.0) << "nothing is mended";
}

}  // namespace
}  // namespace softgauss::io
