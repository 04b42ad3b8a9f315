// SPDX-License-Identifier: Apache-2.0
/// Joints that follow others beyond their own range: told by name, and obedient.

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

struct Range {
  double lower = -kInfinity, upper = kInfinity;
};

void addJoint(ModelBuilder& builder, const std::string& name, const Range& range,
              const std::optional<MimicSpec>& mimic = {}) {
  builder.link(sphereLink(name + "_link", 1.0, 0.1));
  const bool limited = range.lower > -kInfinity;
  JointSpec spec = jointSpec(name, limited ? JointType::revolute : JointType::continuous, "world",
                             name + "_link");
  if (limited) spec.lower = range.lower, spec.upper = range.upper;
  spec.mimic = mimic;
  builder.joint(spec);
}

ModelBuilder pair(const Range& leader, const Range& follower, double multiplier, double offset) {
  ModelBuilder builder("pair");
  builder.link(emptyLink("world"));
  addJoint(builder, "follower", follower, MimicSpec{"leader", multiplier, offset});
  addJoint(builder, "leader", leader);
  return builder;
}

/// Whether a joint that was given a range has none.
bool yields(const Model& model, const std::string& joint) {
  for (const JointRange& range : model.ranges)
    if (range.body == model.findJoint(joint)) return false;
  return true;
}

bool tells(const Model& model, const std::string& word) {
  for (const std::string& warning : model.warnings)
    if (warning.find(word) != std::string::npos) return true;
  return false;
}

TEST(FollowerRange, YieldsWhereTheLeaderAsksForMore) {
  const Model model = pair({0.0, 1.0}, {-0.5, 0.1}, -0.8, 0.0).build();
  EXPECT_TRUE(yields(model, "follower"));
  EXPECT_FALSE(yields(model, "leader"));
  EXPECT_TRUE(tells(model, "'follower' has -0.5 … 0.1, and 'leader' asks for -0.8 … 0"));
}

TEST(FollowerRange, StaysWhereTheLeaderAsksForNoMore) {
  const Model model = pair({0.0, 1.0}, {-0.8, 0.0}, -0.8, 0.0).build();
  EXPECT_FALSE(yields(model, "follower"));
  EXPECT_TRUE(model.warnings.empty());
}

// A screw goes as far as its nut does.
TEST(FollowerRange, OfALeaderWithoutOneStopsBoth) {
  const Model model = pair({}, {-0.5, 0.5}, 0.01, 0.0).build();
  EXPECT_FALSE(yields(model, "follower"));
  EXPECT_TRUE(model.warnings.empty());
}

TEST(FollowerRange, YieldsWhereTheStartIsOutside) {
  const Model model = pair({}, {0.5, 1.0}, 1.0, 0.2).build();
  EXPECT_TRUE(yields(model, "follower"));
  EXPECT_TRUE(tells(model, "0.2 at the start"));
}

// What one that follows is asked for, it asks of those that follow it.
TEST(FollowerRange, YieldsAlongChains) {
  ModelBuilder builder = pair({0.0, 1.0}, {0.0, 2.0}, 2.0, 0.0);
  addJoint(builder, "last", {0.0, 1.5}, MimicSpec{"follower", 1.0, 0.0});
  const Model model = builder.build();
  EXPECT_FALSE(yields(model, "follower"));
  EXPECT_TRUE(yields(model, "last"));
  EXPECT_TRUE(tells(model, "'follower' asks for 0 … 2"));
}

TEST(FollowerRange, KnowsCurves) {
  for (const double bend : {0.5, 2.0}) {
    ModelBuilder builder = pair({-1.0, 1.0}, {-1.0, 1.0}, 1.0, 0.0);
    builder.findJoint("follower")->mimic.reset();
    CouplingSpec cam;
    cam.follower = "follower", cam.leader = "leader";
    cam.polynomial = {0.0, 0.0, bend, 0.0, 0.0};
    EXPECT_EQ(yields(builder.couple(cam).build(), "follower"), bend > 1.0);
  }
}

// Pushed to its own end, the leader takes the follower with it, past the range that yields; in
// MuJoCo's model both hold, and the two part.
TEST(FollowerRange, ThatYieldsHoldsNobody) {
  for (const bool mujoco : {false, true})
    for (const Integrator integrator : {Integrator::semiImplicitEuler, Integrator::leapfrog}) {
      ModelBuilder builder = pair({0.0, 1.0}, {-0.3, 0.3}, 0.8, 0.0);
      builder.options.integrator = integrator;
      builder.options.useMujocoModel(mujoco);
      Scene s(builder.build());
      s.input.tau[s.model.bodies[s.model.findJoint("leader")].v] = 0.05;
      s.steps(1500);
      const double leader = s.state.q[s.model.bodies[s.model.findJoint("leader")].q];
      const double follower = s.state.q[s.model.bodies[s.model.findJoint("follower")].q];
      if (mujoco) {
        EXPECT_LT(leader, 0.9);
      } else {
        EXPECT_SMALL(leader - 1.0, 0.02);
        EXPECT_SMALL(follower - 0.8 * leader, 1e-3);
      }
      EXPECT_EQ(s.model.warnings.empty(), mujoco);
    }
}

}  // namespace
}  // namespace softgauss::test
