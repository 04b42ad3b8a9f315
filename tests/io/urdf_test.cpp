// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "load_urdf.hpp"
#include "sample_urdf.hpp"
#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::io {
namespace {

/// One triangle, as an STL file.
const char* const kTriangle =
    "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid t\n";

TEST(UrdfContent, EveryPhysicsElementArrives) {
  const Model m = load(kSampleUrdf);
  EXPECT_EQ(m.name, "sample");
  EXPECT_TRUE(m.warnings.empty()) << m.warnings.front();
  ASSERT_EQ(m.bodyCount(), 3);
  ASSERT_EQ(m.nv, 7);

  const Body& base = m.bodies[1];
  EXPECT_EQ(base.joint, JointKind::floating);
  EXPECT_EQ(base.mass, 2.0);
  EXPECT_EQ(base.com, Vector3(0.1, 0.2, 0.3));
  // A quarter turn about z exchanges the moments about x and y.
  EXPECT_NEAR(base.I_Bcm.xx, 0.2, 1e-15);
  EXPECT_NEAR(base.I_Bcm.yy, 0.1, 1e-15);
  EXPECT_NEAR(base.I_Bcm.zz, 0.25, 1e-15);
  EXPECT_NEAR(base.I_Bcm.xy, 0.0, 1e-15);

  const Body& arm = m.bodies[2];
  EXPECT_EQ(arm.joint, JointKind::revolute);
  EXPECT_EQ(arm.axis, Vector3::UnitZ());
  EXPECT_EQ(arm.X_PB.p, Vector3(0, 0, 0.5));
  EXPECT_TRUE(arm.X_PB.R.isApprox(rpyRotation({0.1, 0.2, 0.3}), 1e-15));
  const Dof& dof = m.dofs[6];
  EXPECT_TRUE(dof.actuated);
  EXPECT_EQ(dof.effortLower, -5.0);
  EXPECT_EQ(dof.effortUpper, 5.0);
  EXPECT_EQ(dof.velocityLimit, 3.0);
  EXPECT_EQ(dof.damping, 0.5);
  EXPECT_EQ(dof.dryFriction, 0.25);
  ASSERT_EQ(m.ranges.size(), 1u);
  EXPECT_EQ(m.ranges[0].lower, -1.0);
  EXPECT_EQ(m.ranges[0].upper, 1.5);

  ASSERT_EQ(m.geometries.size(), 2u);
  EXPECT_EQ(m.geometries[0].name, "base/0");
  EXPECT_EQ(m.geometries[0].X_BG.p, Vector3(1, 2, 3));
  EXPECT_EQ(m.geometries[0].shape.kind, ShapeKind::box);
  EXPECT_EQ(m.geometries[0].shape.halfExtents, Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(m.geometries[1].shape.kind, ShapeKind::cylinder);
  EXPECT_EQ(m.geometries[1].shape.halfLength, 0.25);
  ASSERT_EQ(m.visuals.size(), 1u);
  EXPECT_EQ(m.visuals[0].shape.kind, ShapeKind::sphere);
  EXPECT_EQ(m.visuals[0].rgba, Eigen::Vector4d(1, 0, 0, 0.5));
}

TEST(UrdfContent, NumbersMayBeSeparatedByAnyBlanks) {
  const Model m = load(with(with(kSampleUrdf, "\"0.2 0.4 0.6\"", "\" 0.2\t0.4\n  0.6 \""),
                            "length=\"0.5\"", "length=\"0.5 \""));
  EXPECT_EQ(m.geometries[0].shape.halfExtents, Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(m.geometries[1].shape.halfLength, 0.25);
}

TEST(UrdfContent, ContentsCountTheFile) {
  const TempFolder folder;
  UrdfContents contents;
  readUrdf(folder.write("robot.urdf", kSampleUrdf), {}, &contents);
  EXPECT_EQ(contents.links, 2);
  EXPECT_EQ(contents.joints, 1);
  EXPECT_EQ(contents.mass, 3.0);
}

TEST(UrdfContent, RootCalledWorldIsFixedAndAFloatingJointIsNotDoubled) {
  EXPECT_EQ(load(with(with(kSampleUrdf, "name=\"base\"", "name=\"world\""), "parent link=\"base\"",
                      "parent link=\"world\""))
                .nv,
            1);
  const Model m = load(
      with(kSampleUrdf, "</robot>",
           "<link name=\"world\"/><joint name=\"free\" type=\"floating\"><parent link=\"world\"/>"
           "<child link=\"base\"/></joint></robot>"));
  EXPECT_EQ(m.nv, 7);
  EXPECT_EQ(m.jointNames[1], "free");
}

TEST(UrdfLimit, WithoutEffortHasNoBox) {
  for (const char* limit : {"lower=\"-1\" upper=\"1.5\"", "velocity=\"1\"", ""}) {
    const Model m =
        load(with(kSampleUrdf, "lower=\"-1\" upper=\"1.5\" effort=\"5\" velocity=\"3\"", limit));
    EXPECT_TRUE(m.dofs[6].actuated);
    EXPECT_EQ(m.dofs[6].effortUpper, kInfinity);
  }
  const Model m = load(
      with(kSampleUrdf, "<limit lower=\"-1\" upper=\"1.5\" effort=\"5\" velocity=\"3\"/>", ""));
  EXPECT_TRUE(m.dofs[6].actuated);
  EXPECT_TRUE(m.ranges.empty());
  EXPECT_TRUE(hasWarning(m, "no lower and upper limit")) << "a revolute joint turns freely";
}

TEST(UrdfLimit, OfEffortZeroIsNotActuatedUnlessAskedFor) {
  const std::string text = with(kSampleUrdf, "effort=\"5\"", "effort=\"0\"");
  const Model m = load(text);
  EXPECT_FALSE(m.dofs[6].actuated);
  EXPECT_TRUE(hasWarning(m, "shoulder"));
  UrdfOptions options;
  options.zeroEffortIsUnlimited = true;
  const Model unlimited = load(text, options);
  EXPECT_TRUE(unlimited.dofs[6].actuated);
  EXPECT_EQ(unlimited.dofs[6].effortUpper, kInfinity);
}

TEST(UrdfLimit, WithOneEndTakesZeroForTheOtherAndSaysSo) {
  const Model m = load(with(kSampleUrdf, " upper=\"1.5\"", ""));
  ASSERT_EQ(m.ranges.size(), 1u);
  EXPECT_EQ(m.ranges[0].upper, 0.0);
  EXPECT_TRUE(hasWarning(m, "shoulder"));
}

TEST(UrdfLimit, OfANegativeVelocityIsNoneAndSaysSo) {
  const Model m = load(with(kSampleUrdf, "velocity=\"3\"", "velocity=\"-1\""));
  EXPECT_EQ(m.dofs[6].velocityLimit, kInfinity);
  EXPECT_TRUE(hasWarning(m, "a negative velocity limit is taken as none: shoulder (-1)"));
}

TEST(UrdfLimit, OfAContinuousJointIsNoRange) {
  const Model m = load(with(kSampleUrdf, "type=\"revolute\"", "type=\"continuous\""));
  EXPECT_TRUE(m.ranges.empty());
  EXPECT_EQ(m.dofs[6].effortUpper, 5.0);
  EXPECT_TRUE(hasWarning(m, "shoulder"));
}

TEST(UrdfJoint, FixedOnesMayCarryAZeroAxisAndAnEmptyLimit) {
  const Model m =
      load(with(kSampleUrdf, "</robot>",
                "<link name=\"tip\"/><joint name=\"end\" type=\"fixed\"><parent link=\"arm\"/>"
                "<child link=\"tip\"/><axis xyz=\"0 0 0\"/><limit lower=\"0\" "
                "upper=\"0\"/></joint></robot>"));
  EXPECT_EQ(m.nv, 7);
  EXPECT_GE(m.findFrame("tip"), 0);
}

TEST(UrdfJoint, MimicFollowerIsCoupledAndPassive) {
  const Model m = load(with(
      kSampleUrdf, "</robot>",
      "<link name=\"tip\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link><joint name=\"end\" type=\"continuous\">"
      "<parent link=\"arm\"/><child link=\"tip\"/>"
      "<mimic joint=\"shoulder\" multiplier=\"-2\" offset=\"0.5\"/></joint></robot>"));
  ASSERT_EQ(m.couplings.size(), 1u);
  EXPECT_EQ(m.couplings[0].follower, m.findJoint("end"));
  EXPECT_EQ(m.couplings[0].leader, m.findJoint("shoulder"));
  EXPECT_EQ(m.couplings[0].polynomial, (std::array<double, 5>{0.5, -2.0, 0, 0, 0}));
  EXPECT_FALSE(m.dofs[7].actuated);
  EXPECT_FALSE(hasWarning(m, "mimic"));
}

TEST(UrdfWarning, CountsWhatIsNotRead) {
  const Model m = load(with(kSampleUrdf, "</robot>",
                            "<gazebo/><gazebo/><transmission><joint name=\"x\"/></transmission>"
                            "</robot>"));
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_EQ(m.warnings[0], "ignored: 2 <gazebo>, 1 <transmission>");
}

TEST(UrdfWarning, SaysWhatOfGazeboIsPhysics) {
  const Model m = load(with(kSampleUrdf, "</robot>",
                            "<gazebo reference=\"arm\"><mu1>0.3</mu1><kp>1e6</kp><material>Red"
                            "</material></gazebo><gazebo><selfCollide>1</selfCollide></gazebo>"
                            "</robot>"));
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_EQ(m.warnings[0],
            "ignored: 2 <gazebo> but for mu1 and mu2 (of its physics kp, selfCollide)");
}

// As text or as an attribute. With a priority, for of two surfaces else the larger friction counts.
TEST(UrdfFriction, IsThatOfGazeboWhereNobodyElseGivesIt) {
  const std::string text =
      with(kSampleUrdf, "</robot>",
           "<gazebo reference=\"arm\"><mu1>0.3</mu1><mu2 value=\"0.2\"/></gazebo></robot>");
  const Model m = load(text);
  EXPECT_EQ(m.geometries[0].material, Material{});
  EXPECT_EQ(m.geometries[1].material.slidingFriction, 0.2);
  EXPECT_EQ(m.geometries[1].material.priority, 1);
  EXPECT_TRUE(hasWarning(m, "mu1 and mu2 differ, the smaller is taken: arm"));
  UrdfOptions options;
  options.material.slidingFriction = 0.5;
  EXPECT_EQ(load(text, options).geometries[1].material, options.material);
  options = {};
  options.linkMaterials["arm"].slidingFriction = 0.7;
  EXPECT_EQ(load(text, options).geometries[1].material, options.linkMaterials["arm"]);
}

TEST(UrdfWarning, APoseOfZeroWhereNoneIsReadMovesNothing) {
  const Model m = load(with(with(kSampleUrdf, "<axis", "<axis rpy=\"0 0.0 0\""), "<inertial><mass",
                            "<origin xyz=\"0 0 0\" quat_xyzw=\"0 0 0 1\"/><inertial><mass"));
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_EQ(m.warnings[0], "ignored: 1 <origin>, 1 attribute 'rpy' of <axis>");
}

TEST(UrdfWarning, ForInertiaThatNoBodyCanHave) {
  EXPECT_TRUE(hasWarning(load(with(kSampleUrdf, "izz=\"0.25\"", "izz=\"0.31\"")), "base"));
}

TEST(UrdfMesh, IsFoundRelativeToTheFileByFileAndByPackage) {
  const TempFolder folder;
  folder.write("robots/pkg/meshes/t.stl", kTriangle);
  folder.write("elsewhere/other/t.stl", kTriangle);
  const std::string absolute = "file://" + (folder.path() / "robots/pkg/meshes/t.stl").string();
  const auto loadMesh = [&](const std::string& uri) {
    UrdfOptions options;
    options.packagePaths.push_back(folder.path() / "elsewhere");
    return loadUrdf(folder.write("robots/pkg/urdf/r.urdf",
                                 with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>",
                                      "<mesh filename=\"" + uri + "\" scale=\"2 3 4\"/>")),
                    options);
  };
  for (const std::string& uri :
       {std::string("../meshes/t.stl"), absolute, std::string("package://pkg/meshes/t.stl"),
        std::string("package://other/t.stl")}) {
    const Model m = loadMesh(uri);
    ASSERT_EQ(m.geometries[0].shape.kind, ShapeKind::mesh) << uri;
    EXPECT_EQ(m.geometries[0].shape.mesh->vertices.size(), 3u);
    EXPECT_EQ(m.geometries[0].shape.mesh->vertices[1], Vector3(2, 0, 0));
  }
  EXPECT_THROW(loadMesh("package://missing/t.stl"), ModelError);
}

// As exporters of Gazebo and of Windows write them; a file that is called so comes first.
TEST(UrdfMesh, MayBeNamedAsAModelByPercentsAndByBackslashes) {
  const TempFolder folder;
  folder.write("pkg/my meshes/t.stl", kTriangle);
  folder.write("pkg/a%20b.stl", kTriangle);
  folder.write("pkg/a b.stl", kTriangle);
  const auto found = [&](const std::string& uri) {
    const Model m =
        loadUrdf(folder.write("pkg/r.urdf", with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>",
                                                 "<mesh filename=\"" + uri + "\"/>")));
    return std::filesystem::path(m.geometries[0].shape.mesh->file).lexically_normal();
  };
  for (const char* uri : {"model://pkg/my meshes/t.stl", "package://pkg/my%20meshes/t.stl",
                          "my%20meshes\\t.stl", "package:///pkg/my meshes/t.stl",
                          "package:\\\\pkg\\my meshes\\t.stl", "model://pkg/my%20meshes%2Ft.stl"})
    EXPECT_EQ(found(uri), folder.path() / "pkg/my meshes/t.stl") << uri;
  EXPECT_EQ(found("a%20b.stl"), folder.path() / "pkg/a%20b.stl");
  EXPECT_THROW(found("a%2xb.stl"), ModelError);
  EXPECT_THROW(found("a%"), ModelError);
}

// A clone in a folder of another name: the longest end of the path that is a file counts, and one
// line says so. A package that is there is not left for another's files.
TEST(UrdfMesh, OfAPackageWithoutAFolderIsFoundByTheEndOfItsPath) {
  const TempFolder folder;
  folder.write("clone-of-it/visual/t.stl", kTriangle);
  folder.write("clone-of-it/meshes/visual/t.stl", kTriangle);
  folder.write("clone-of-it/urdf/t.stl", kTriangle);
  const auto loadMesh = [&](const std::string& uri) {
    return loadUrdf(folder.write(
        "clone-of-it/urdf/r.urdf",
        with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>", "<mesh filename=\"" + uri + "\"/>")));
  };
  const auto file = [&](const Model& m) { return m.geometries[0].shape.mesh->file; };
  const std::string clone = folder.path() / "clone-of-it";
  const Model m = loadMesh("package://my_robot/meshes/visual/t.stl");
  EXPECT_EQ(file(m), clone + "/meshes/visual/t.stl");
  EXPECT_EQ(std::count(m.warnings.begin(), m.warnings.end(),
                       "package 'my_robot' is in none of the folders that are looked through: its "
                       "files are taken from " +
                           clone + ", by the ends of their paths"),
            1);
  EXPECT_EQ(file(loadMesh("package://my_robot/assets/visual/t.stl")), clone + "/visual/t.stl");
  EXPECT_EQ(file(loadMesh("package://my_robot/assets%2Fvisual/t.stl")), clone + "/visual/t.stl");
  EXPECT_EQ(file(loadMesh("file:" + clone + "/urdf/t.stl")), clone + "/urdf/t.stl");
  EXPECT_THROW(loadMesh("package://clone-of-it/assets/t.stl"), ModelError);
  EXPECT_THROW(loadMesh("package://my_robot/meshes/u.stl"), ModelError);
}

TEST(UrdfMesh, PackagePathsAreSoughtInOrder) {
  const TempFolder folder;
  folder.write("a/pkg/t.stl", kTriangle);
  folder.write("b/pkg/t.stl", kTriangle);
  folder.write("pkg/t.stl", kTriangle);
  const auto file = folder.write("r.urdf", with(kSampleUrdf, "<box size=\"0.2 0.4 0.6\"/>",
                                                "<mesh filename=\"package://pkg/t.stl\"/>"));
  UrdfOptions options;
  const auto found = [&] { return loadUrdf(file, options).geometries[0].shape.mesh->file; };
  EXPECT_EQ(found(), (folder.path() / "pkg/t.stl").string());
  setenv("ROS_PACKAGE_PATH", ("/nowhere::" + (folder.path() / "b").string()).c_str(), 1);
  EXPECT_EQ(found(), (folder.path() / "b/pkg/t.stl").string());
  options.packagePaths = {folder.path() / "a/pkg/"};  // the package itself, with a slash
  EXPECT_EQ(found(), (folder.path() / "a/pkg/t.stl").string());
  unsetenv("ROS_PACKAGE_PATH");
}

TEST(UrdfMesh, OfAVisualMayBeMissing) {
  const Model m = load(
      with(kSampleUrdf, "<sphere radius=\"0.3\"/>", "<mesh filename=\"package://none/t.stl\"/>"));
  EXPECT_TRUE(m.visuals.empty());
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_EQ(m.warnings[0], "1 visual mesh file not found, not shown: package://none/t.stl");
}

TEST(UrdfVisual, ThatIsFaultyStopsNothingAndIsNamed) {
  const std::string whole =
      "<visual><geometry><sphere radius=\"0.3\"/></geometry><material name=\"red\"/></visual>";
  for (const char* faulty :
       {"<visual/>", "<visual><geometry/></visual>",
        "<visual><geometry><ball/></geometry></visual>",
        "<visual><geometry><box size=\"1 2\"/></geometry></visual>",
        "<visual><geometry><mesh filename=\"\"/></geometry></visual>",
        "<visual><geometry><sphere radius=\"0\"/></geometry></visual>",
        "<visual><origin xyz=\"a\"/><geometry><sphere radius=\"1\"/></geometry></visual>",
        "<visual><geometry><sphere radius=\"1\"/></geometry><geometry/></visual>"}) {
    const Model m = load(with(kSampleUrdf, whole, whole + faulty));
    EXPECT_EQ(m.visuals.size(), 1u) << faulty;
    EXPECT_TRUE(hasWarning(m, "not shown: ")) << faulty;
    EXPECT_TRUE(hasWarning(m, "robot.urdf:11")) << faulty;
  }
  const Model m = load(with(kSampleUrdf, "<material name=\"red\">",
                            "<material/><material><color/></material>"
                            "<material name=\"red\">"));
  EXPECT_EQ(m.visuals[0].rgba, Eigen::Vector4d(1, 0, 0, 0.5));
  EXPECT_EQ(m.warnings.size(), 1u) << "the colour that is empty";
}

TEST(UrdfMesh, OfAVisualIsReadOnlyWhenAskedFor) {
  const TempFolder folder;
  folder.write("t.stl", kTriangle);
  folder.write("broken.stl", "nonsense");
  const auto visual = [&](const std::string& mesh, bool read) {
    UrdfOptions options;
    options.visualMeshes = read;
    return loadUrdf(folder.write("r.urdf", with(kSampleUrdf, "<sphere radius=\"0.3\"/>",
                                                "<mesh filename=\"" + mesh + "\"/>")),
                    options);
  };
  EXPECT_TRUE(visual("t.stl", false).visuals[0].shape.mesh->vertices.empty());
  EXPECT_EQ(visual("t.stl", true).visuals[0].shape.mesh->vertices.size(), 3u);
  const Model broken = visual("broken.stl", true);
  EXPECT_TRUE(broken.visuals.empty());
  EXPECT_TRUE(hasWarning(broken, "broken.stl"));
}

}  // namespace
}  // namespace softgauss::io
