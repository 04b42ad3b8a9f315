// SPDX-License-Identifier: Apache-2.0
/// What URDF 1.1 and 1.2 add to 1.0.

#include "load_urdf.hpp"
#include "sample_urdf.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "tests/support/random.hpp"

namespace softgauss::io {
namespace {

std::string ofVersion(const std::string& version, const std::string& text = kSampleUrdf) {
  return with(text, "name=\"sample\"", "name=\"sample\" version=\"" + version + "\"");
}

/// The pose of the shoulder by a quaternion, x y z w.
std::string turnedBy(const Quaternion& q) {
  char text[160];
  std::snprintf(text, sizeof text, "quat_xyzw=\"%.17g %.17g %.17g %.17g\"", q.x(), q.y(), q.z(),
                q.w());
  return ofVersion("1.1", with(kSampleUrdf, "rpy=\"0.1 0.2 0.3\"", text));
}

// Also at a pitch of a quarter turn, where roll and yaw are one. The matrix has the rounding of the
// quaternion's products, some 1e-16.
TEST(UrdfVersion, OneOneHasQuaternions) {
  test::Random random(5);
  std::vector<Quaternion> turns = {Quaternion(rpyRotation({0.4, 0.5 * M_PI, 0.0})),
                                   Quaternion(rpyRotation({0.4, -0.5 * M_PI, 1.0})),
                                   Quaternion(rpyRotation({0, 0, M_PI}))};
  for (int i = 0; i < 20; ++i)
    turns.push_back(quaternionExp(
        3.0 * Vector3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))));
  for (const Quaternion& q : turns) {
    const Model m = load(turnedBy(q));
    EXPECT_LT((m.bodies[2].X_PB.R - q.toRotationMatrix()).norm(), 1e-14);
    EXPECT_TRUE(m.warnings.empty());
  }
}

TEST(UrdfVersion, EveryPoseMayHaveAQuaternion) {
  const std::string half = "quat_xyzw=\"0 0 1 0\"";
  std::string text = ofVersion("1.2");
  text = with(text, "rpy=\"0 0 1.5707963267948966\"", "quat_xyzw=\"0 0 0.7071 0.7071\"");
  text = with(text, "<collision><origin xyz=\"1 2 3\"/>",
              "<collision><origin xyz=\"1 2 3\" " + half + "/>");
  text = with(text, "<visual>", "<visual><origin " + half + "/>");
  const Model m = load(text);
  const Matrix3 turned = Vector3(-1, -1, 1).asDiagonal();
  EXPECT_TRUE(m.geometries[0].X_BG.R.isApprox(turned, 1e-15));
  EXPECT_TRUE(m.visuals[0].X_BG.R.isApprox(turned, 1e-15));
  EXPECT_NEAR(m.bodies[1].I_Bcm.xx, 0.2, 1e-15) << "four digits are meant to be a unit quaternion";
}

// Many a file of none or of 1.0 has them too.
TEST(UrdfVersion, CapsulesAreReadInEvery) {
  for (const char* version : {"1.0", "1.1", "1.2"}) {
    const Model m = load(ofVersion(version, with(kSampleUrdf, "<cylinder", "<capsule")));
    EXPECT_EQ(m.geometries[1].shape.kind, ShapeKind::capsule);
    EXPECT_EQ(m.geometries[1].shape.radius, 0.1);
    EXPECT_EQ(m.geometries[1].shape.halfLength, 0.25) << "the length is without the caps";
    EXPECT_TRUE(m.warnings.empty());
  }
}

TEST(UrdfVersion, LimitsWithoutEffectAreNamed) {
  const Model m = load(
      ofVersion("1.2", with(kSampleUrdf, "velocity=\"3\"",
                            "velocity=\"3\" acceleration=\"5\" deceleration=\"6\" jerk=\"100\"")));
  EXPECT_EQ(m.dofs[6].velocityLimit, 3.0);
  for (const char* name : {"'acceleration'", "'deceleration'", "'jerk'"})
    EXPECT_TRUE(hasWarning(m, name)) << name;
}

// In a visual alone a pose that is not read moves nothing.
TEST(UrdfVersion, QuaternionOfAVisualInOneZeroIsToldAndNotShown) {
  const Model m = load(with(kSampleUrdf, "<visual>", "<visual><origin quat_xyzw=\"0 0 1 0\"/>"));
  EXPECT_TRUE(m.visuals.empty());
  EXPECT_TRUE(hasWarning(m, "quat_xyzw is of URDF 1.1"));
}

}  // namespace
}  // namespace softgauss::io
