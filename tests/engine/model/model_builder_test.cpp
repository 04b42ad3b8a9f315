// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/model_builder.hpp"

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"
#include "tests/support/scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

// ---- Merging
// -------------------------------------------------------------------------------------

TEST(Merging, EqualsTheInertiaByHand) {
  // Two unit cubes of 2 kg and 1 kg side by side along x: centre of mass at 1/3.
  ModelBuilder builder = freeBody(boxLink("a", 2.0, {0.5, 0.5, 0.5}));
  builder.link(boxLink("b", 1.0, {0.5, 0.5, 0.5}));
  builder.joint(jointSpec("glue", JointType::fixed, "a", "b",
                          {axisRotation(Vector3::UnitZ(), M_PI / 2), Vector3(1, 0, 0)}));
  const Model model = builder.build();
  ASSERT_EQ(model.bodyCount(), 2);
  const Body& body = model.bodies[1];
  EXPECT_SMALL(body.mass - 3.0, kRounding);
  EXPECT_APPROX(body.com, Vector3(1.0 / 3.0, 0, 0), kRounding);
  // Cubes: 1/6 m each; parallel axes: 2·(1/3)² + 1·(2/3)² = 2/3 about y and z.
  EXPECT_APPROX(body.I_Bcm.matrix(),
                Matrix3(Vector3(0.5, 0.5 + 2.0 / 3, 0.5 + 2.0 / 3).asDiagonal()), kRounding);
}

TEST(Merging, OfRandomLinksKeepsTheSpatialInertia) {
  for (int seed = 0; seed < 20; ++seed) {
    Random random(seed);
    std::vector<LinkSpec> links;
    std::vector<Transform> poses{Transform{}};
    ModelBuilder builder("merged");
    builder.base = BaseKind::floating;
    for (int i = 0; i < 4; ++i) {
      links.push_back(randomLink("link" + std::to_string(i), random));
      builder.link(links.back());
      if (i == 0) continue;
      const int parent = random.index(i);
      const Transform X{random.rotation(), random.vector3(0.5)};
      poses.push_back(poses[parent] * X);
      builder.joint(jointSpec("joint" + std::to_string(i), JointType::fixed, links[parent].name,
                              links.back().name, X));
    }
    const Model model = builder.build();
    ASSERT_EQ(model.bodyCount(), 2);
    Inertia expected;
    for (int i = 0; i < 4; ++i)
      expected += Inertia::fromCentral(links[i].mass, poses[i] * links[i].com,
                                       rotated(poses[i].R, Symmetric3::fromMatrix(links[i].I_Lcm)));
    const Body& b = model.bodies[1];
    const Inertia actual = Inertia::fromCentral(b.mass, b.com, b.I_Bcm);
    EXPECT_SMALL(actual.mass - expected.mass, kRounding);
    EXPECT_APPROX(actual.h, expected.h, kRounding);
    EXPECT_APPROX(actual.I_O.matrix(), expected.I_O.matrix(), kRounding);
  }
}

TEST(Merging, KeepsNamesAsFramesAndMovesGeometries) {
  ModelBuilder builder = freeBody(boxLink("body", 1.0, {0.1, 0.1, 0.1}));
  builder.link(emptyLink("camera_mount")).link(emptyLink("camera"));
  const Transform X1{axisRotation(Vector3::UnitZ(), M_PI / 2), Vector3(0.2, 0, 0)};
  const Transform X2{Matrix3::Identity(), Vector3(0, 0, 0.1)};
  builder.joint(jointSpec("j1", JointType::fixed, "body", "camera_mount", X1))
      .joint(jointSpec("j2", JointType::fixed, "camera_mount", "camera", X2));
  builder.geometry(
      geometrySpec("camera", Shape::sphere(0.05), 1.0, {Matrix3::Identity(), Vector3(0.01, 0, 0)}));
  const Model model = builder.build();
  const int frame = model.findFrame("camera");
  ASSERT_GE(frame, 0);
  EXPECT_EQ(model.frames[frame].body, 1);
  EXPECT_APPROX(model.frames[frame].X_BF.p, Vector3(0.2, 0, 0.1), kRounding);
  EXPECT_EQ(model.findFrame("nothing"), -1);
  ASSERT_EQ(model.geometries.size(), 1u);
  EXPECT_EQ(model.geometries[0].body, 1);
  EXPECT_EQ(model.geometries[0].link, "camera");
  EXPECT_APPROX(model.geometries[0].X_BG.p, Vector3(0.2, 0.01, 0.1), kRounding);
}

// ---- Structure
// -----------------------------------------------------------------------------------

TEST(Structure, IsDepthFirstWithContiguousSubtrees) {
  for (int seed = 0; seed < 20; ++seed) {
    const Model m = randomForest(seed).build();
    int q = 0, v = 0;
    for (int b = 1; b < m.bodyCount(); ++b) {
      const Body& body = m.bodies[b];
      EXPECT_LT(body.parent, b);
      EXPECT_EQ(body.q, q);
      EXPECT_EQ(body.v, v);
      q += body.joint == JointKind::floating ? 7 : 1;
      v += body.dofs;
      // The subtree is exactly the range [b, subtreeEnd).
      for (int c = 1; c < m.bodyCount(); ++c) {
        bool below = false;
        for (int a = c; a > 0; a = m.bodies[a].parent) below |= a == b;
        EXPECT_EQ(below, c >= b && c < body.subtreeEnd);
      }
      const Tree& tree = m.trees[body.tree];
      EXPECT_TRUE(tree.rootBody <= b && b < tree.bodyEnd);
      EXPECT_TRUE(tree.firstDof <= body.v && body.v + body.dofs <= tree.dofEnd);
      EXPECT_EQ(m.bodies[tree.rootBody].parent, 0);
    }
    EXPECT_EQ(m.nq, q);
    EXPECT_EQ(m.nv, v);
    EXPECT_EQ(m.q0.size(), q);
    EXPECT_EQ(static_cast<int>(m.dofs.size()), v);
    for (int i = 0; i < v; ++i) EXPECT_LT(m.dofs[i].parent, i);
  }
}

TEST(Structure, OfTheHumanoid) {
  const Model m = humanoid().build();
  EXPECT_EQ(m.nv, 27);
  EXPECT_EQ(m.nq, 28);
  EXPECT_EQ(m.trees.size(), 1u);
  EXPECT_SMALL(m.totalMass() - (8 + 16 + 2 * (5 + 3 + 1 + 2 + 1.5)), 1e-12);
}

TEST(PlanarJoint, IsTwoSlidesAndAHinge) {
  Random random(1);
  const Vector3 normal = random.direction();
  const Transform X{random.rotation(), random.vector3(1.0)};
  ModelBuilder builder("puck");
  builder.link(emptyLink("world")).link(boxLink("puck", 1.0, {0.1, 0.1, 0.02}));
  JointSpec joint = jointSpec("air", JointType::planar, "world", "puck", X, normal);
  joint.damping = 0.3;
  builder.joint(joint);
  const Model m = builder.build();
  ASSERT_EQ(m.nv, 3);
  EXPECT_EQ(m.jointNames[1], "air.x");
  EXPECT_EQ(m.jointNames[2], "air.y");
  EXPECT_EQ(m.jointNames[3], "air.rz");
  EXPECT_EQ(m.bodyNames[3], "puck");
  EXPECT_EQ(m.bodies[1].joint, JointKind::prismatic);
  EXPECT_EQ(m.bodies[2].joint, JointKind::prismatic);
  EXPECT_EQ(m.bodies[3].joint, JointKind::revolute);
  for (const Dof& dof : m.dofs) {
    EXPECT_FALSE(dof.actuated);
    EXPECT_EQ(dof.damping, 0.3);
  }
  State s(m);
  s.q << 0.3, -0.2, 0.7;
  Kinematics k(m);
  computeKinematics(m, s, k);
  const Transform moved = X.inverse() * k.X_WB[3];
  // In the plane, by the right length, turned about the normal; x, y and the normal right-handed.
  EXPECT_SMALL(moved.p.dot(normal), kRounding);
  EXPECT_SMALL(moved.p.squaredNorm() - 0.13, kRounding);
  EXPECT_APPROX(moved.R, axisRotation(normal, 0.7), kRounding);
  EXPECT_APPROX(m.bodies[1].axis.cross(m.bodies[2].axis), normal, kRounding);
}

TEST(PlanarJoint, SharesTheNamesOfItsPartsWithNoOther) {
  ModelBuilder builder;
  for (const char* link : {"world", "cart", "arm"}) builder.link(test::sphereLink(link, 1.0, 0.1));
  builder.joint(test::jointSpec("j", JointType::planar, "world", "cart"));
  builder.joint(test::jointSpec("j.rz", JointType::revolute, "cart", "arm"));
  EXPECT_THROW(builder.build(), ModelError);
}

TEST(Base, FollowsItsKind) {
  const auto built = [](const char* name, BaseKind base) {
    ModelBuilder builder("base");
    builder.link(boxLink(name, 1.0, {0.1, 0.1, 0.1}));
    builder.base = base;
    builder.X_WRoot.p = Vector3(1, 2, 3);
    return builder.build();
  };
  EXPECT_EQ(built("body", BaseKind::automatic).nv, 6);
  EXPECT_EQ(built("body", BaseKind::floating).nv, 6);
  EXPECT_EQ(built("body", BaseKind::fixed).nv, 0);
  EXPECT_EQ(built("world", BaseKind::automatic).nv, 0);
  // A root called world is the world, which cannot float.
  EXPECT_THROW(built("world", BaseKind::floating), ModelError);
  EXPECT_EQ(built("body", BaseKind::automatic).q0.head(3), Vector3(1, 2, 3));
  EXPECT_EQ(built("body", BaseKind::fixed).frames[0].X_BF.p, Vector3(1, 2, 3));
  EXPECT_EQ(built("world", BaseKind::automatic).frames[0].X_BF.p, Vector3::Zero());
}

TEST(Base, ExplicitFloatingJointIsHonoured) {
  ModelBuilder builder("explicit");
  builder.link(emptyLink("world")).link(boxLink("body", 1.0, {0.1, 0.1, 0.1}));
  builder.joint(jointSpec("free", JointType::floating, "world", "body",
                          {Matrix3::Identity(), Vector3(0, 0, 2)}));
  const Model m = builder.build();
  EXPECT_EQ(m.nv, 6);
  EXPECT_EQ(m.q0[2], 2.0);
  for (const Dof& dof : m.dofs) EXPECT_FALSE(dof.actuated);
}

// ---- Joints
// --------------------------------------------------------------------------------------

/// World, a link, and a revolute joint about y that `change` edits.
template <class F>
ModelBuilder oneJoint(F&& change) {
  ModelBuilder builder("one joint");
  builder.link(emptyLink("world")).link(sphereLink("bob", 1.0, 0.1, {0, 0, -1}));
  JointSpec joint = jointSpec("hinge", JointType::revolute, "world", "bob", {}, {0, 2, 0});
  change(joint);
  return builder.joint(joint);
}

VectorX startOf(double lower, double upper) {
  return oneJoint([&](JointSpec& j) { j.lower = lower, j.upper = upper; }).build().q0;
}

TEST(InitialConfiguration, IsZeroOrTheMiddleOfARangeWithoutZero) {
  EXPECT_EQ(startOf(-1.0, 2.0)[0], 0.0);
  EXPECT_EQ(startOf(0.0, 2.0)[0], 0.0);
  EXPECT_EQ(startOf(0.5, 2.0)[0], 1.25);
  EXPECT_EQ(startOf(-2.0, -1.0)[0], -1.5);
}

TEST(Joint, KeepsItsNumbers) {
  const Model m = oneJoint([](JointSpec& j) {
                    j.damping = 0.1;
                    j.armature = 0.2;
                    j.dryFriction = 0.3;
                    j.effort = 7.0;
                    j.velocity = 9.0;
                    j.lower = -1.0;
                    j.upper = 2.0;
                  }).build();
  const Dof& dof = m.dofs[0];
  EXPECT_EQ(dof.damping, 0.1);
  EXPECT_EQ(dof.armature, 0.2);
  EXPECT_EQ(dof.dryFriction, 0.3);
  EXPECT_TRUE(dof.actuated);
  EXPECT_EQ(dof.effortLower, -7.0);
  EXPECT_EQ(dof.effortUpper, 7.0);
  EXPECT_EQ(dof.velocityLimit, 9.0);
  ASSERT_EQ(m.ranges.size(), 1u);
  EXPECT_EQ(m.ranges[0].lower, -1.0);
  EXPECT_EQ(m.ranges[0].upper, 2.0);
  EXPECT_EQ(m.bodies[1].axis, Vector3::UnitY());  // normalised
  EXPECT_EQ(m.findJoint("hinge"), 1);
  EXPECT_EQ(m.findJoint("nothing"), -1);
}

TEST(Joint, WithoutEffortIsActuatedWithoutABox) {
  const Model m = oneJoint([](JointSpec&) {}).build();
  EXPECT_TRUE(m.dofs[0].actuated);
  EXPECT_EQ(m.dofs[0].effortUpper, kInfinity);
  EXPECT_EQ(m.dofs[0].effortLower, -kInfinity);
  EXPECT_TRUE(m.warnings.empty());
}

TEST(Joint, WithEffortZeroIsNotActuatedAndAWarningListsIt) {
  ModelBuilder builder = oneJoint([](JointSpec& j) { j.effort = 0.0; });
  const Model m = builder.build();
  EXPECT_FALSE(m.dofs[0].actuated);
  ASSERT_EQ(m.warnings.size(), 1u);
  EXPECT_NE(m.warnings[0].find("hinge"), std::string::npos);
  builder.zeroEffortIsUnlimited = true;
  const Model unlimited = builder.build();
  EXPECT_TRUE(unlimited.dofs[0].actuated);
  EXPECT_EQ(unlimited.dofs[0].effortUpper, kInfinity);
  EXPECT_TRUE(unlimited.warnings.empty());
}

TEST(Joint, ContinuousHasNoRange) {
  const Model m = oneJoint([](JointSpec& j) {
                    j.type = JointType::continuous;
                    j.lower = -1.0;
                    j.upper = 1.0;
                  }).build();
  EXPECT_TRUE(m.ranges.empty());
}

TEST(Joint, ThatMimicsIsNotActuated) {
  ModelBuilder builder = oneJoint([](JointSpec&) {});
  builder.link(sphereLink("second", 1.0, 0.1, {0, 0, -1}));
  JointSpec follower = jointSpec("follower", JointType::revolute, "bob", "second");
  follower.mimic = MimicSpec{"hinge", -2.0, 0.5};
  const Model m = builder.joint(follower).build();
  EXPECT_FALSE(m.dofs[1].actuated);
  ASSERT_EQ(m.couplings.size(), 1u);
  EXPECT_EQ(m.couplings[0].follower, 2);
  EXPECT_EQ(m.couplings[0].leader, 1);
  EXPECT_EQ(m.couplings[0].polynomial, (std::array<double, 5>{0.5, -2.0, 0, 0, 0}));
  EXPECT_EQ(m.q0[1], 0.5) << "it starts where it follows";
}

TEST(Joint, StartsWhereAChainOfCouplingsPutsIt) {
  ModelBuilder builder = chain(4);
  // Listed from the end of the chain to its start.
  const char* joints[] = {"joint0", "joint1", "joint2", "joint3"};
  for (int i = 3; i > 0; --i) {
    CouplingSpec c;
    c.follower = joints[i];
    c.leader = joints[i - 1];
    c.polynomial = {0.1, 2.0, -1.0, 0, 0};
    builder.couple(c);
  }
  CouplingSpec held;
  held.follower = joints[0];
  held.polynomial = {0.3, 5.0, 5.0, 5.0, 5.0};
  const Model m = builder.couple(held).build();
  double q = 0.3;
  for (int i = 0; i < 4; ++i) {
    EXPECT_SMALL(m.q0[i] - q, 1e-15);
    q = 0.1 + 2.0 * q - q * q;
  }
}

TEST(Equality, PointsAndFramesOfMergedLinksBecomeThoseOfTheirBody) {
  ModelBuilder builder = chain(2);
  builder.link(emptyLink("hook"));
  const Transform X_LH{axisRotation(Vector3::UnitZ(), 0.3), {0.1, 0.2, 0.3}};
  builder.joint(jointSpec("on", JointType::fixed, "link1", "hook", X_LH));
  ConnectSpec connect;
  connect.linkA = "hook";
  connect.linkB = "world";
  connect.p_LAP = {0.0, 0.1, 0.0};
  connect.p_LBP = {1.0, 2.0, 3.0};
  WeldSpec weld;
  weld.linkA = "link0";
  weld.linkB = "hook";
  weld.X_LBF.p = {0.5, 0.0, 0.0};
  const Model m = builder.connect(connect).weld(weld).build();
  ASSERT_EQ(m.connections.size(), 1u);
  EXPECT_EQ(m.connections[0].bodyA, 2);
  EXPECT_EQ(m.connections[0].bodyB, 0);
  EXPECT_APPROX(m.connections[0].p_AP, X_LH * connect.p_LAP, 1e-15);
  EXPECT_EQ(m.connections[0].p_BP, connect.p_LBP);
  ASSERT_EQ(m.welds.size(), 1u);
  EXPECT_EQ(m.welds[0].bodyB, 2);
  EXPECT_APPROX(m.welds[0].X_BF.p, X_LH * weld.X_LBF.p, 1e-15);
  EXPECT_APPROX(m.welds[0].X_BF.R, X_LH.R, 1e-15);
}

TEST(EffectNames, AreTheirInverse) {
  for (const EffectName& e : kEffectNames) {
    EXPECT_EQ(effectFromName(e.name), e.effect);
    EXPECT_EQ(effectName(e.effect), e.name);
  }
  EXPECT_FALSE(effectFromName("magic").has_value());
}

// ---- One description beside another ----

TEST(ModelBuilderAdd, TiesAndNamesAreThoseOfTheAdded) {
  ModelBuilder pair("pair");
  pair.link(boxLink("base", 1.0, {0.1, 0.1, 0.1})).link(boxLink("arm", 1.0, {0.1, 0.1, 0.1}));
  pair.joint(jointSpec("hinge", JointType::revolute, "base", "arm"));
  ConnectSpec connect;
  connect.linkA = "arm";
  connect.linkB = "world";
  CouplingSpec couple;
  couple.follower = "hinge";
  WeldSpec weld;
  weld.linkA = "base";
  weld.linkB = "arm";
  pair.connect(connect).couple(couple).weld(weld);
  pair.X_WRoot.p.x() = 7.0;
  pair.geometry(geometrySpec("base", Shape::sphere(0.1)));
  pair.geometry(geometrySpec("arm", Shape::sphere(0.1)));
  PairSpec surface;
  surface.geometryA = "arm";
  surface.geometryB = "base";
  pair.pair(surface);

  const Model model = ModelBuilder("both").add(pair, "left").add(pair, "right").build();
  ASSERT_EQ(model.connections.size(), 2u);
  ASSERT_EQ(model.contactPairs.size(), 2u);
  for (const auto& [i, side] : {std::pair{0u, "left"}, {1u, "right"}}) {
    const std::string prefix = std::string(side) + "/";
    const int arm = model.frames[model.findFrame(prefix + "arm")].body;
    EXPECT_EQ(model.connections[i].bodyA, arm);
    EXPECT_EQ(model.connections[i].bodyB, 0) << "the world is one";
    EXPECT_EQ(model.welds[i].bodyB, arm);
    EXPECT_EQ(model.geometries[model.contactPairs[i].geometryA].link, prefix + "base");
    EXPECT_EQ(model.geometries[model.contactPairs[i].geometryB].link, prefix + "arm");
    EXPECT_EQ(model.couplings[i].follower, model.findJoint(prefix + "hinge"));
    EXPECT_EQ(model.q0[model.bodies[model.frames[model.findFrame(prefix + "base")].body].q], 7.0);
  }
}

}  // namespace
}  // namespace softgauss::test
