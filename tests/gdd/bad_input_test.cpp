// SPDX-License-Identifier: Apache-2.0
/// A controlled step refuses what does not fit the model, and tells what it is.
#include <gtest/gtest.h>

#include "tests/gdd/robot_scene.hpp"

namespace softgauss::test {
namespace {

/// The step is refused for this, the state stays as it was, and `mend` lets it go on.
template <class Mend>
void expectRefusedFor(RobotScene& r, BadInputKind kind, const std::string& said, Mend&& mend) {
  const std::uint64_t before = hash(r.state);
  EXPECT_EQ(r.step(), SolveStatus::badInput) << said;
  EXPECT_EQ(r.data.stats.badInput.kind, kind);
  EXPECT_EQ(describe(r.model, r.data.stats.badInput), said);
  EXPECT_EQ(hash(r.state), before);
  mend();
  EXPECT_FALSE(isRefused(r.step())) << "it goes on after a refusal";
}

TEST(GddBadInput, IsToldOfEachPart) {
  for (const auto solver : {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian}) {
    RobotScene r("arm");
    r.controller.solver = solver;
    r.addReach("hand", {0.4, 0.1, 0.5});
    r.addDamping();
    ASSERT_FALSE(isRefused(r.step()));
    const int nv = r.model.nv;
    const std::string expected = " numbers, expected " + std::to_string(nv);

    r.input.tau.setZero(2);
    expectRefusedFor(r, BadInputKind::tau, "Input::tau: found 2" + expected,
                     [&] { r.input.tau.resize(0); });

    const VectorX v = r.state.v;
    r.state.v.conservativeResize(3);
    expectRefusedFor(r, BadInputKind::v, "State::v: found 3" + expected, [&] { r.state.v = v; });

    const VectorX gddA = r.state.warmstart.gddA;
    r.state.warmstart.gddA.setZero(1);
    expectRefusedFor(r, BadInputKind::warmStart, "the warm start: found 1" + expected,
                     [&] { r.state.warmstart.gddA = gddA; });

    const gdd::ControlLimits limits = r.controller.limits;
    r.controller.limits.upper.conservativeResize(4);
    expectRefusedFor(r, BadInputKind::controlLimitsSize, "ControlLimits: found 4" + expected,
                     [&] { r.controller.limits = limits; });

    r.controller.limits.lower[1] = 2.0;
    r.controller.limits.upper[1] = 1.0;
    const std::string joint = r.model.jointNames[r.model.dofs[1].body];
    expectRefusedFor(r, BadInputKind::controlLimits,
                     "ControlLimits: found bounds of dof 1 at joint '" + joint +
                         "' that cross or are not numbers, expected lower ≤ upper",
                     [&] { r.controller.limits = limits; });
  }
}

}  // namespace
}  // namespace softgauss::test
