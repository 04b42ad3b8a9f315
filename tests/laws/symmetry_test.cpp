// SPDX-License-Identifier: Apache-2.0
/// The step does not know how bodies are numbered, where the world's origin is, or which way its
/// axes point.

#include <algorithm>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

// ---- Relabelling
// ---------------------------------------------------------------------------------

/// A tree with two arms on a floating base, each in its own order of listing.
ModelBuilder twoArms(bool swapped) {
  ModelBuilder builder = freeBody(boxLink("base", 3.0, {0.2, 0.1, 0.1}));
  builder.X_WRoot.p = Vector3(0, 0, 0.3);
  builder.geometry(groundSpec(0.7));
  builder.geometry(geometrySpec("base", Shape::box({0.2, 0.1, 0.1})));
  const auto arm = [&](const std::string& s, double side) {
    builder.link(boxLink(s + "upper", 1.0, {0.03, 0.03, 0.1}, {0, 0, -0.1}));
    builder.link(sphereLink(s + "lower", 0.7, 0.08, {0, 0.05, -0.2}));
    JointSpec shoulder =
        jointSpec(s + "shoulder", JointType::revolute, "base", s + "upper",
                  {Matrix3::Identity(), Vector3(0, side * 0.15, 0)}, Vector3(1, side * 0.3, 0));
    shoulder.lower = -0.1;
    shoulder.upper = 0.1;
    shoulder.damping = 0.05;
    JointSpec elbow = jointSpec(s + "elbow", JointType::prismatic, s + "upper", s + "lower",
                                {Matrix3::Identity(), Vector3(0, 0, -0.05)}, Vector3(0, side, 1));
    elbow.armature = 0.02;
    builder.joint(shoulder).joint(elbow);
    builder.geometry(geometrySpec(s + "lower", Shape::sphere(0.12), 0.4,
                                  {Matrix3::Identity(), Vector3(0, 0.05, -0.2)}));
  };
  if (swapped) {
    arm("left_", 1.0);
    arm("right_", -1.0);
  } else {
    arm("right_", -1.0);
    arm("left_", 1.0);
  }
  return builder;
}

TEST(Step, InvariantUnderRelabelling) {
  Scene a(twoArms(false).build(), std::make_shared<SampleContacts>());
  Scene b(twoArms(true).build(), std::make_shared<SampleContacts>());
  ASSERT_NE(a.model.jointNames, b.model.jointNames);

  // Dof i of scene a is dof map[i] of scene b; q goes alike, shifted by the quaternion.
  std::vector<int> map(a.model.nv);
  for (int body = 1; body < a.model.bodyCount(); ++body) {
    const int other = b.model.findJoint(a.model.jointNames[body]);
    ASSERT_GE(other, 0);
    for (int i = 0; i < a.model.bodies[body].dofs; ++i)
      map[a.model.bodies[body].v + i] = b.model.bodies[other].v + i;
  }
  const VectorX v = Random(3).vector(a.model.nv, 1.0);
  const auto mapped = [&](const VectorX& x) {
    VectorX y(x.size());
    for (int i = 0; i < a.model.nv; ++i) y[map[i]] = x[i];
    return y;
  };
  a.state.v = v;
  b.state.v = mapped(v);
  a.input.tau = Random(4).vector(a.model.nv, 2.0);
  b.input.tau = mapped(a.input.tau);

  int contacts = 0, limits = 0;
  for (int i = 0; i < 200; ++i) {
    a.step();
    b.step();
    contacts += a.data->stats.contacts;
    limits += a.data->constraints.jointLimit.rowCount();
    ASSERT_EQ(a.data->stats.contacts, b.data->stats.contacts) << "step " << i;
  }
  EXPECT_GT(contacts, 100);
  EXPECT_GT(limits, 50);
  // The order of sums differs, and 200 steps of contacts multiply rounding.
  EXPECT_APPROX(b.state.v, mapped(a.state.v), 1e-10);
  EXPECT_APPROX(b.state.q.head(7), a.state.q.head(7), 1e-10);
}

// ---- Moving the world
// ----------------------------------------------------------------------------

/// The scene of `builder` in a world that X_NW turned and moved; what points in world axes turns
/// along.
State movedState(const Model& model, const State& state, const Transform& X_NW) {
  State moved = state;
  for (const Body& body : model.bodies) {
    if (body.joint != JointKind::floating) continue;
    const Vector3 p = state.q.segment<3>(body.q), v = state.v.segment<3>(body.v);
    const Quaternion r(state.q[body.q + 3], state.q[body.q + 4], state.q[body.q + 5],
                       state.q[body.q + 6]);
    const Quaternion turned = Quaternion(X_NW.R) * r;
    moved.q.segment<3>(body.q) = X_NW * p;
    moved.q.segment<4>(body.q + 3) << turned.w(), turned.x(), turned.y(), turned.z();
    moved.v.segment<3>(body.v) = X_NW.R * v;
  }
  return moved;
}

void expectSameMotion(Scene& a, Scene& b, const Transform& X_NW, int steps, double tolerance) {
  b.state = movedState(a.model, a.state, X_NW);
  b.input.tau = movedState(a.model, State(a.model), X_NW).v;  // zero, and of the right size
  int contacts = 0;
  for (int i = 0; i < steps; ++i) {
    a.step();
    b.step();
    contacts += a.data->stats.contacts;
    ASSERT_EQ(a.data->stats.contacts, b.data->stats.contacts) << "step " << i;
  }
  EXPECT_GT(contacts, steps / 2);
  const State expected = movedState(a.model, a.state, X_NW);
  EXPECT_APPROX(b.state.v, expected.v, tolerance);
  // Quaternions may differ in sign: compare as rotations.
  EXPECT_SMALL(positionDifference(a.model, expected.q, b.state.q).cwiseAbs().maxCoeff(), tolerance);
}

Transform randomPose(std::uint64_t seed) {
  Random random(seed);
  return {random.rotation(), random.vector3(3.0)};
}

/// A humanoid that falls on the ground, all of it turned and moved by X_NW.
Scene fallingHumanoid(const Transform& X_NW, bool frictionless) {
  ModelBuilder source = humanoid();
  source.options.gravity = X_NW.R * source.options.gravity;
  Model model = source.build();
  for (Geometry& g : model.geometries) {
    if (g.body == 0) g.X_BG = X_NW * g.X_BG;
    if (frictionless) g.material.condim = 1;
  }
  auto contacts = std::make_shared<SampleContacts>();
  contacts->tangentOfPlane = true;  // the pyramid turns with the world
  contacts->spheresTouch = frictionless;
  return Scene(std::move(model), contacts);
}

TEST(Step, InvariantUnderWorldRotationThatTurnsTheTangents) {
  const Transform X_NW = randomPose(5);
  Scene a = fallingHumanoid({}, false), b = fallingHumanoid(X_NW, false);
  a.state.v = Random(6).vector(a.model.nv, 0.5);
  // Rounding of 1e-16 grows by the stiffness of the contacts over 150 steps.
  expectSameMotion(a, b, X_NW, 150, 1e-9);
}

TEST(Step, InvariantUnderAnyWorldRotationWithoutFriction) {
  const Transform X_NW = randomPose(7);
  Scene a = fallingHumanoid({}, true), b = fallingHumanoid(X_NW, true);
  a.state.v = Random(8).vector(a.model.nv, 0.5);
  expectSameMotion(a, b, X_NW, 150, 1e-9);
}

// A quarter turn about the vertical maps the default tangents onto ± each other.
TEST(Step, InvariantUnderAQuarterTurnOfTheDefaultPyramid) {
  const Transform X_NW{Eigen::AngleAxisd(M_PI / 2, Vector3::UnitZ()).toRotationMatrix(),
                       Vector3(1, 2, 0)};
  Scene a = fallingHumanoid({}, false), b = fallingHumanoid(X_NW, false);
  a.contacts = b.contacts = std::make_shared<SampleContacts>();
  a.state.v = Random(9).vector(a.model.nv, 0.5);
  expectSameMotion(a, b, X_NW, 150, 1e-9);
}

}  // namespace
}  // namespace softgauss::test
