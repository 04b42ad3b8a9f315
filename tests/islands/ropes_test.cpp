// SPDX-License-Identifier: Apache-2.0
/// Forces of connections are part of the state: saved states and copies go on with them.

#include <gtest/gtest.h>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// 10 kg that swing from level on three bars of 0.1 kg and 0.1 m, faster than 10 ms follow (6.8), a
/// cube that falls onto them, and one that lies beside.
Model ropeAndCubes() {
  constexpr double kHalf = 0.05;
  ModelBuilder builder = ground();
  builder.options.timestep = 0.01;
  builder.options.substepAngle = kInfinity;  // else each island goes in parts of its own
  std::string above = "world";
  Vector3 end(0.0, 0.0, 1.0), place = end;
  const auto hang = [&](const LinkSpec& link, double half) {
    ModelBuilder one(link.name);
    one.base = BaseKind::floating;
    one.X_WRoot = Transform{Matrix3::Identity(), place + Vector3(half, 0.0, 0.0)};
    one.link(link);
    if (half == 0.0) one.geometry(geometrySpec(link.name, Shape::sphere(0.08), 0.8));
    builder.add(one, "");
    ConnectSpec tie;
    tie.linkA = link.name, tie.p_LAP = Vector3(-half, 0.0, 0.0);
    tie.linkB = above, tie.p_LBP = end;
    builder.connect(tie);
    above = link.name, end = Vector3(half, 0.0, 0.0);
    place.x() += 2.0 * half;
  };
  addCube(builder, "beside", Vector3(-1.0, 0.0, 0.1));
  for (int i = 0; i < 3; ++i)
    hang(boxLink("bar" + std::to_string(i), 0.1, Vector3(kHalf, 0.01, 0.01)), kHalf);
  hang(sphereLink("load", 10.0, 0.08), 0.0);
  addCube(builder, "late", Vector3(0.05, 0.0, 1.3));
  return builder.build();
}

TEST(Ropes, ASavedStateGoesOnToTheSameBits) {
  const Model model = ropeAndCubes();
  collision::SceneContacts contacts(model);
  Data data(model), other(model);
  State state(model);
  int held = 0;
  for (int i = 0; i < 60; ++i) {
    State resumed = restore(model, save(model, state));
    ASSERT_EQ(hash(resumed), hash(state));
    ASSERT_EQ(step(model, {}, state, data, &contacts), SolveStatus::converged);
    ASSERT_EQ(step(model, {}, resumed, other, &contacts), SolveStatus::converged);
    ASSERT_EQ(hash(resumed), hash(state)) << i;
    held += data.stats.stabilisedBodies;
  }
  EXPECT_GT(held, 30);
}

}  // namespace
}  // namespace softgauss::test
