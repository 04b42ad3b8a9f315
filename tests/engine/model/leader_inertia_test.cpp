// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/detail/leader_inertia.hpp"

#include "softgauss/engine/dynamics/regular_mass.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

/// A knob without mass, by which `count` arms turn `slope` times as far. An arm is a rod of 0.6 kg
/// and 1 m on its end.
Model knob(int count, double slope) {
  ModelBuilder builder("knob");
  builder.link(emptyLink("world")).link(emptyLink("knob"));
  builder.joint(jointSpec("turn", JointType::revolute, "world", "knob"));
  for (int i = 0; i < count; ++i) {
    LinkSpec arm = emptyLink("arm" + std::to_string(i));
    arm.mass = 0.6;
    arm.com = Vector3(0.5, 0.0, 0.0);
    arm.I_Lcm = Vector3(1e-4, 0.05, 0.05).asDiagonal();
    builder.link(arm);
    JointSpec joint = jointSpec("follow" + std::to_string(i), JointType::revolute, "world",
                                arm.name, {}, Vector3::UnitZ());
    joint.mimic = MimicSpec{"turn", slope, 0.1};
    builder.joint(joint);
  }
  return builder.build();
}

TEST(LeaderInertia, IsAHundredthOfWhatFollows) {
  constexpr double kRod = 0.6 / 3.0;  // m l²/3 about the end
  for (const auto& [count, slope] : {std::pair{1, 1.0}, {1, -0.5}, {3, 2.0}}) {
    const Model m = knob(count, slope);
    const int turn = m.bodies[static_cast<std::size_t>(m.findJoint("turn"))].v;
    EXPECT_NEAR(m.dofs[static_cast<std::size_t>(turn)].armature,
                detail::kLeaderShare * count * slope * slope * kRod, 1e-12);
    EXPECT_FALSE(findSingularMass(m, m.q0));
    ASSERT_EQ(m.warnings.size(), 1u);
    EXPECT_NE(m.warnings[0].find(": turn ("), std::string::npos) << m.warnings[0];
  }
}

TEST(LeaderInertia, IsLeftAloneWhereTheLeaderMovesMass) {
  ModelBuilder builder("arms");
  builder.link(emptyLink("world"));
  for (const char* name : {"first", "second"}) {
    builder.link(boxLink(name, 1.0, {0.1, 0.1, 0.1}));
    JointSpec joint = jointSpec(std::string("j_") + name, JointType::revolute, "world", name);
    if (std::string(name) == "second") joint.mimic = MimicSpec{"j_first", 1.0, 0.0};
    builder.joint(joint);
  }
  const Model m = builder.build();
  for (const Dof& dof : m.dofs) EXPECT_EQ(dof.armature, 0.0);
  EXPECT_TRUE(m.warnings.empty());
}

TEST(LeaderInertia, CannotComeFromNothing) {
  EXPECT_THROW(knob(0, 1.0), ModelError) << "nothing follows";
  EXPECT_THROW(knob(1, 0.0), ModelError) << "what follows does not turn";
}

}  // namespace
}  // namespace softgauss::test
