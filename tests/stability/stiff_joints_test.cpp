// SPDX-License-Identifier: Apache-2.0
/// Family 5: joints whose damping or springs are stiff against the step.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/stability/trial.hpp"

namespace softgauss::test {
namespace {

/// Three links of 0.2 m and 1 kg on hinges about y, hanging out horizontally.
ModelBuilder arm(double damping, double h) {
  ModelBuilder builder("arm");
  builder.link(emptyLink("world"));
  std::string parent = "world";
  for (int i = 0; i < 3; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(boxLink(name, 1.0, {0.1, 0.02, 0.02}, {0.1, 0.0, 0.0}));
    Transform X;
    if (i > 0) X.p = Vector3(0.2, 0.0, 0.0);
    JointSpec joint = jointSpec("hinge" + std::to_string(i), JointType::continuous, parent, name, X,
                                Vector3::UnitY());
    joint.damping = damping;
    builder.joint(joint);
    parent = name;
  }
  builder.options.timestep = h;
  return builder;
}

// Damping up to h d/I = 10⁴, thrown at 10 rad/s: the energy never rises, and each joint ends at the
// creep g_i/d under its own weight.
TEST(StiffJoints, DampingBringsToRestWithoutOvershoot) {
  // M_ii of the last hinge: 1 kg × (0.1² + (0.2² + 0.04²)/12) kg m².
  const double inertia = 0.01 + (0.04 + 0.0016) / 12.0;
  for (const double h : {0.0005, 0.002, 0.005, 0.01, 0.02})
    for (const double ratio : {1.0, 1e2, 1e4}) {
      const double d = ratio * inertia / h;
      Trial t("h d/I = " + std::to_string(static_cast<int>(ratio)), arm(d, h));
      t.state.v.setConstant(10.0);
      t.mayGain = 1e-9 * t.energy().total();
      t.run(1.0);
      if (ratio == 1.0) continue;  // not stiff: the links may still throw each other
      t.expect("speed", t.fastest, 10.0, "rad/s");
      // Weight on the first hinge: 3 kg × g × 0.3 m at most.
      t.expect("creep", t.state.v.cwiseAbs().maxCoeff(), 1.01 * 3.0 * 9.81 * 0.3 / d, "rad/s");
    }
}

}  // namespace
}  // namespace softgauss::test
