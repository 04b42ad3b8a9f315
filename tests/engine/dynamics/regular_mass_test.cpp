// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/regular_mass.hpp"

#include <cmath>

#include "softgauss/engine/constraints/inverse_weight.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

/// A body on hinges about z, x and z, massless links between: M is singular where the outer axes
/// fall together, at q_x = 0. There the first pivot is I sin² q_x of I.
Model gimbal(double armature = 0.0) {
  ModelBuilder builder("gimbal");
  builder.link(emptyLink("world")).link(emptyLink("a")).link(emptyLink("b"));
  builder.link(sphereLink("ball", 1.0, 0.1));
  const char* links[] = {"world", "a", "b", "ball"};
  for (int i = 0; i < 3; ++i) {
    JointSpec hinge = jointSpec("hinge" + std::to_string(i), JointType::continuous, links[i],
                                links[i + 1], {}, i == 1 ? Vector3::UnitX() : Vector3::UnitZ());
    hinge.armature = armature;
    builder.joint(hinge);
  }
  return builder.build();
}

TEST(RegularMass, IsDecidedBesideTheDiagonal) {
  const Model m = gimbal();
  for (const double offset : {0.0, 1e-9, 1e-8}) {
    const auto why = findSingularMass(m, Vector3(0.3, offset, -0.2));
    ASSERT_TRUE(why) << offset;
    EXPECT_EQ(why->element, "joint 'hinge0'");
    EXPECT_EQ(why->link, "a");
  }
  for (const double offset : {1e-6, 0.1, 1.5})
    EXPECT_FALSE(findSingularMass(m, Vector3(0.3, offset, -0.2))) << offset;
  EXPECT_FALSE(findSingularMass(gimbal(1e-9), Vector3::Zero())) << "armature resists";
}

// Where all joints at zero make M singular, weights are of q0.
TEST(RegularMass, WeightsAreOfTheStartWhereZeroIsSingular) {
  Model m = gimbal();
  EXPECT_THROW(InverseWeights{m}, ModelError);
  m.q0 = Vector3(0.0, 0.5 * M_PI, 0.0);
  // Three axes at right angles through the centre of a ball: each feels its moment of inertia.
  const double moment = 0.4 * 1.0 * 0.1 * 0.1;
  for (const double weight : InverseWeights(m).dof)
    EXPECT_NEAR(weight * moment, 1.0, 1e-12) << "one over the moment of inertia";
}

TEST(RegularMass, NamesARootWithoutMassThatFloats) {
  ModelBuilder builder("r");
  builder.link(emptyLink("base")).link(boxLink("arm", 1.0, {0.1, 0.2, 0.3}));
  builder.joint(jointSpec("j", JointType::revolute, "base", "arm"));
  const Model m = builder.build();
  const auto why = findSingularMass(m, m.q0);
  ASSERT_TRUE(why);
  EXPECT_EQ(why->element, "link 'base'");
  EXPECT_NE(why->problem.find("has no mass and floats"), std::string::npos) << why->problem;
  EXPECT_NE(why->problem.find("--base fixed"), std::string::npos) << why->problem;
}

// A slider's rail with moments of inertia but no mass: it and the cart slide in the same way.
TEST(RegularMass, NamesAFloatingRootThatHasMomentsButNoMass) {
  ModelBuilder builder("r");
  LinkSpec rail = emptyLink("rail");
  rail.I_Lcm = Matrix3::Identity();
  builder.link(rail).link(boxLink("cart", 1.0, {0.1, 0.2, 0.3}));
  builder.joint(jointSpec("slide", JointType::prismatic, "rail", "cart"));
  const Model m = builder.build();
  const auto why = findSingularMass(m, m.q0);
  ASSERT_TRUE(why);
  EXPECT_EQ(why->element, "link 'rail'");
  EXPECT_NE(why->problem.find("has no mass and floats"), std::string::npos) << why->problem;
  EXPECT_NE(why->problem.find("--base fixed"), std::string::npos) << why->problem;
}

// What overwhelms all else by its mass or its distance is named, not what it overwhelms.
TEST(RegularMass, NamesTheLinkWithTheNumbersOfAnotherWorld) {
  for (const double distance : {1e9, 1e11}) {
    ModelBuilder builder("far");
    LinkSpec far = boxLink("far", 1.0, {0.1, 0.1, 0.1});
    far.com = Vector3(distance, 0.0, 0.0);
    builder.link(boxLink("base", 1.0, {0.1, 0.1, 0.1})).link(far);
    builder.joint(jointSpec("j", JointType::revolute, "base", "far", {}, Vector3::UnitY()));
    const Model m = builder.build();
    const auto why = findSingularMass(m, m.q0);
    ASSERT_TRUE(why);
    EXPECT_EQ(why->link, "far") << why->problem;
  }
}

TEST(RegularMass, InverseThatOverflowsIsNone) {
  ModelBuilder builder("tiny");
  LinkSpec tiny = emptyLink("tiny");
  tiny.mass = 1e-320;
  tiny.I_Lcm = 1e-320 * Matrix3::Identity();
  builder.link(boxLink("base", 1.0, {0.1, 0.1, 0.1})).link(tiny);
  builder.joint(jointSpec("j", JointType::revolute, "base", "tiny", {}, Vector3::UnitY()));
  const Model m = builder.build();
  const auto why = findSingularMass(m, m.q0);
  ASSERT_TRUE(why);
  EXPECT_EQ(why->link, "tiny");
}

}  // namespace
}  // namespace softgauss::test
