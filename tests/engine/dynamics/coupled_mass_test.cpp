// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/coupled_mass.hpp"

#include <cmath>

#include "softgauss/engine/dynamics/regular_mass.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

/// Three links of 1 m in a plane, of which the last one alone has mass; stretched at zero, where
/// its joints move it in two ways. With `follows` the last joint follows the one before.
Model finger(bool follows) {
  ModelBuilder builder("finger");
  builder.link(emptyLink("world")).link(emptyLink("first")).link(emptyLink("second"));
  builder.link(boxLink("tip", 1.0, {0.5, 0.1, 0.1}));
  const char* links[] = {"world", "first", "second", "tip"};
  for (int i = 0; i < 3; ++i) {
    JointSpec joint = jointSpec("j" + std::to_string(i), JointType::revolute, links[i],
                                links[i + 1], {}, Vector3::UnitZ());
    joint.X_PC.p = Vector3(i > 0 ? 1.0 : 0.0, 0.0, 0.0);
    if (i == 2 && follows) joint.mimic = MimicSpec{"j1", 0.8, 0.0};
    builder.joint(joint);
  }
  return builder.build();
}

TEST(CoupledMass, IsSteadiedWhereItsCouplingsMakeItRegular) {
  Model m = finger(true);
  ASSERT_TRUE(findSingularMass(m, m.q0));
  const Model before = m;
  regulariseCoupledJoints(m, m.q0);
  EXPECT_FALSE(findSingularMass(m, m.q0));
  ASSERT_EQ(m.warnings.size(), before.warnings.size() + 1);
  EXPECT_NE(m.warnings.back().find(": j1 j2"), std::string::npos) << m.warnings.back();
  // M_ii of a box at (2, 0, 0) from j0, (1, 0, 0) from j1 and about j2.
  const double own = (0.5 * 0.5 + 0.1 * 0.1) / 3.0;
  EXPECT_EQ(m.dofs[0].armature, 0.0) << "it is not coupled";
  EXPECT_NEAR(m.dofs[1].armature, kCoupledShare * (own + 1.0), 1e-12);
  EXPECT_NEAR(m.dofs[2].armature, kCoupledShare * own, 1e-12);
}

TEST(CoupledMass, IsLeftAloneElsewhere) {
  for (const bool follows : {false, true}) {
    Model m = finger(follows);
    const Vector3 bent(0.0, follows ? 0.5 : 0.0, follows ? 0.4 : 0.0);
    regulariseCoupledJoints(m, bent);
    for (const Dof& dof : m.dofs) EXPECT_EQ(dof.armature, 0.0) << follows;
    EXPECT_TRUE(m.warnings.empty());
  }
}

}  // namespace
}  // namespace softgauss::test
