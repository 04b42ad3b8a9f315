// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/support/sample_models.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

using test::boxLink;
using test::emptyLink;
using test::geometrySpec;
using test::groundSpec;
using test::jointSpec;
using test::sphereLink;

Transform offset(double x, double z = 0.0) { return {Matrix3::Identity(), Vector3(x, 0, z)}; }

/// Balls "a0", "a1", … of radius 0.1 in a row along x, joined by hinges.
void addRow(ModelBuilder& builder, const std::string& name, int count, double spacing) {
  for (int i = 0; i < count; ++i) {
    const std::string link = name + std::to_string(i);
    builder.link(sphereLink(link, 1.0, 0.1));
    builder.geometry(geometrySpec(link, Shape::sphere(0.1)));
    if (i > 0)
      builder.joint(jointSpec(link + "_hinge", JointType::revolute, name + std::to_string(i - 1),
                              link, offset(spacing)));
  }
}

bool tests(const Model& model, const PairFilter& filter, const std::string& linkA,
           const std::string& linkB) {
  return std::any_of(filter.pairs.begin(), filter.pairs.end(), [&](const GeometryPair& p) {
    const std::string& a = model.geometries[static_cast<std::size_t>(p.a)].link;
    const std::string& b = model.geometries[static_cast<std::size_t>(p.b)].link;
    return (a == linkA && b == linkB) || (a == linkB && b == linkA);
  });
}

const ExcludedPair* findExcluded(const PairFilter& filter, const std::string& linkA,
                                 const std::string& linkB) {
  for (const ExcludedPair& p : filter.excluded)
    if ((p.linkA == linkA && p.linkB == linkB) || (p.linkA == linkB && p.linkB == linkA)) return &p;
  return nullptr;
}

}  // namespace

TEST(Filter, NeighboursAreOutAndOthersIn) {
  ModelBuilder builder;
  addRow(builder, "a", 3, 0.3);
  builder.geometry(groundSpec(1.0));
  const Model model = builder.build();
  const SceneContacts scene(model);
  EXPECT_FALSE(tests(model, scene.filter(), "a0", "a1"));
  EXPECT_TRUE(tests(model, scene.filter(), "a0", "a2"));
  EXPECT_TRUE(tests(model, scene.filter(), "world", "a0"));
  EXPECT_TRUE(tests(model, scene.filter(), "world", "a1"));
  ASSERT_NE(findExcluded(scene.filter(), "a0", "a1"), nullptr);
  EXPECT_EQ(findExcluded(scene.filter(), "a0", "a1")->reason, ExclusionReason::adjacent);
}

TEST(Filter, EmptyLinksOfAJointAreLookedThrough) {
  ModelBuilder builder;
  builder.link(boxLink("pelvis", 5.0, {0.1, 0.1, 0.1})).link(emptyLink("hip1"));
  builder.link(emptyLink("hip2")).link(boxLink("thigh", 3.0, {0.1, 0.1, 0.1}));
  builder.joint(jointSpec("x", JointType::revolute, "pelvis", "hip1", {}, Vector3::UnitX()));
  builder.joint(jointSpec("y", JointType::revolute, "hip1", "hip2", {}, Vector3::UnitY()));
  builder.joint(jointSpec("z", JointType::revolute, "hip2", "thigh", {}, Vector3::UnitZ()));
  builder.geometry(geometrySpec("pelvis", Shape::sphere(0.1)));
  builder.geometry(geometrySpec("thigh", Shape::sphere(0.1)));
  const Model model = builder.build();
  const SceneContacts scene(model);
  EXPECT_TRUE(scene.filter().pairs.empty());
  ASSERT_EQ(scene.filter().excluded.size(), 1u);
  EXPECT_EQ(scene.filter().excluded[0].reason, ExclusionReason::adjacent);
}

TEST(Filter, LinksOverlappingAtTheStartAreOutWithTheirDepth) {
  ModelBuilder builder;
  addRow(builder, "a", 4, 0.09);  // a0 and a2 overlap by 0.02, a0 and a3 do not
  const Model model = builder.build();
  const SceneContacts scene(model);
  const ExcludedPair* pair = findExcluded(scene.filter(), "a0", "a2");
  ASSERT_NE(pair, nullptr);
  EXPECT_EQ(pair->reason, ExclusionReason::overlapsInitially);
  EXPECT_NEAR(pair->depth, 0.02, 1e-12);
  EXPECT_NE(describe(*pair).find("20 mm"), std::string::npos) << describe(*pair);
  EXPECT_TRUE(tests(model, scene.filter(), "a0", "a3"));
}

TEST(Filter, AllShapesOfOverlappingLinksGoTogether) {
  ModelBuilder builder;
  addRow(builder, "a", 3, 0.09);
  builder.geometry(geometrySpec("a2", Shape::sphere(0.02), 1.0, offset(0.5)));
  const SceneContacts scene(builder.build());
  EXPECT_EQ(findExcluded(scene.filter(), "a0", "a2")->geometryPairs, 2);
}

TEST(Filter, LinksThatMerelyTouchAtTheStartStayIn) {
  ModelBuilder builder;
  addRow(builder, "a", 3, 0.09999);  // fingers drawn closed
  const Model model = builder.build();
  EXPECT_TRUE(tests(model, SceneContacts(model).filter(), "a0", "a2"));
}

TEST(Filter, DifferentRobotsAndTheGroundMayOverlapAtTheStart) {
  ModelBuilder builder;
  addRow(builder, "a", 1, 0.0);
  addRow(builder, "b", 1, 0.0);
  builder.geometry(groundSpec(1.0));
  const Model model = builder.build();
  const SceneContacts scene(model);
  EXPECT_TRUE(tests(model, scene.filter(), "a0", "b0"));
  EXPECT_TRUE(tests(model, scene.filter(), "world", "a0"));
  EXPECT_TRUE(scene.filter().excluded.empty());
}

TEST(Filter, StaticBaseIsAdjacentToItsFirstMovingLinkOnly) {
  ModelBuilder builder;
  addRow(builder, "a", 3, 0.25);
  builder.base = BaseKind::fixed;
  builder.geometry(groundSpec(1.0));
  const Model model = builder.build();
  const SceneContacts scene(model);
  EXPECT_FALSE(tests(model, scene.filter(), "a0", "a1"));
  EXPECT_TRUE(tests(model, scene.filter(), "a0", "a2"));
  EXPECT_TRUE(tests(model, scene.filter(), "world", "a1"));   // the ground is no base
  EXPECT_FALSE(tests(model, scene.filter(), "world", "a0"));  // both fixed
}

/// A robot of one rail and a lift, beside things that are fixed to the world, all of which overlap
/// at the start. A link that hangs from "world" has no base.
ModelBuilder cartAmongFixedThings(const std::string& root) {
  const auto fixed = [](const std::string& link) {
    ModelBuilder builder;
    builder.base = BaseKind::fixed;
    return builder.link(sphereLink(link, 1.0, 0.1))
        .geometry(geometrySpec(link, Shape::sphere(0.1)));
  };
  ModelBuilder robot = fixed(root);
  for (const char* link : {"cart", "lift", "post"})
    robot.link(sphereLink(link, 1.0, 0.1)).geometry(geometrySpec(link, Shape::sphere(0.1)));
  robot.joint(jointSpec("rail", JointType::prismatic, root, "cart", offset(0.05)));
  robot.joint(jointSpec("up", JointType::prismatic, "cart", "lift", offset(0.05)));
  robot.joint(jointSpec("bolt", JointType::fixed, root, "post"));
  ModelBuilder other = fixed("base");
  other.link(sphereLink("arm", 1.0, 0.1));
  other.joint(jointSpec("hinge", JointType::revolute, "base", "arm"));
  ModelBuilder scene;
  scene.add(robot, "c").add(fixed("wall"), "").add(other, "other");
  return scene;
}

TEST(Filter, FixedThingsAreTestedWithTheFirstLinkAndWithWhatStartsInsideThem) {
  for (const char* root : {"base", "world"}) {
    const Model model = cartAmongFixedThings(root).build();
    const SceneContacts scene(model);
    for (const char* link : {"c/cart", "c/lift"})
      for (const char* thing : {"wall", "other/base"})
        EXPECT_TRUE(tests(model, scene.filter(), link, thing)) << root << link << thing;
  }
}

TEST(Filter, ABaseIsWhatTheFirstJointHangsFrom) {
  for (const char* root : {"base", "world"}) {
    const Model model = cartAmongFixedThings(root).build();
    const SceneContacts scene(model);
    const bool isWorld = root == std::string("world");
    for (const std::string& thing : {std::string("c/") + root, std::string("c/post")})
      for (const char* link : {"c/cart", "c/lift"})
        EXPECT_EQ(tests(model, scene.filter(), link, thing), isWorld) << link << thing;
    const std::optional<std::string> told = baseWarning(scene.filter());
    ASSERT_EQ(told.has_value(), !isWorld);
    if (isWorld) continue;
    for (const char* words :
         {"c/base – c/cart: joined by a joint", "c/post – c/lift: overlap by 100 mm at the start"})
      EXPECT_NE(told->find(words), std::string::npos) << words << *told;
    EXPECT_EQ(told->find("wall"), std::string::npos) << *told;
  }
}

TEST(Filter, EffectsSwitchTheirPairsOff) {
  ModelBuilder builder;
  addRow(builder, "a", 3, 0.3);
  addRow(builder, "b", 1, 0.3);
  builder.geometry(groundSpec(1.0));
  const auto count = [&](Effect off) {
    builder.options.effects = EffectSet::all();
    builder.options.effects.remove(off);
    const Model model = builder.build();
    const SceneContacts scene(model);
    EXPECT_EQ(scene.filter().pairs.size() + static_cast<std::size_t>(scene.filter().effectOffPairs),
              8u);
    return scene.filter().effectOffPairs;
  };
  EXPECT_EQ(count(Effect::gravity), 0);
  EXPECT_EQ(count(Effect::selfCollision), 1);
  EXPECT_EQ(count(Effect::groundContact), 4);
  EXPECT_EQ(count(Effect::objectContact), 3);
}

TEST(Filter, PlanesComeFirstAndKindsAreOrdered) {
  ModelBuilder builder = test::humanoid();
  const Model model = builder.build();
  const SceneContacts scene(model);
  bool planesOver = false;
  for (const GeometryPair& p : scene.filter().pairs) {
    const Shape& a = model.geometries[static_cast<std::size_t>(p.a)].shape;
    const Shape& b = model.geometries[static_cast<std::size_t>(p.b)].shape;
    EXPECT_LE(a.kind, b.kind);
    const bool plane = a.kind == ShapeKind::plane;
    EXPECT_FALSE(plane && planesOver);
    planesOver = planesOver || !plane;
  }
}

// The limbs of a fixed base are trees of their own, and yet one robot.
TEST(Filter, LimbsOfAFixedBaseAreOneRobot) {
  for (const BaseKind base : {BaseKind::fixed, BaseKind::floating}) {
    ModelBuilder builder;
    builder.base = base;
    for (const char* name : {"base", "left", "right"}) {
      LinkSpec link;
      link.name = name;
      link.mass = 1.0;
      link.I_Lcm = Matrix3::Identity();
      builder.link(link);
      GeometrySpec shape;
      shape.name = shape.link = name;
      shape.shape = Shape::sphere(0.1);
      builder.geometry(shape);
      if (link.name == "base") continue;
      JointSpec joint;
      joint.name = link.name + "_joint";
      joint.type = JointType::revolute;
      joint.parent = "base";
      joint.child = name;
      joint.X_PC.p.x() = link.name == "left" ? 0.45 : 0.55;  // the limbs overlap by 0.1 m
      builder.joint(joint);
    }
    const Model model = builder.build();
    const int left = model.findJoint("left_joint"), right = model.findJoint("right_joint");
    EXPECT_EQ(contactEffect(model, left, right), Effect::selfCollision);
    const auto distance = [](const GeometryPair&) { return -0.1; };
    EXPECT_TRUE(makePairFilter(model, distance).pairs.empty());
  }
}

TEST(Filter, LinksThatAreKeptApartAreOutEachWayAndTold) {
  ModelBuilder builder;
  addRow(builder, "a", 5, 0.3);
  builder.keepApart("a4", "a0").keepApart("a1", "a3").keepApart("a0", "nothing");
  const Model model = builder.build();
  const SceneContacts scene(model);
  EXPECT_FALSE(tests(model, scene.filter(), "a0", "a4"));
  EXPECT_FALSE(tests(model, scene.filter(), "a3", "a1"));
  EXPECT_TRUE(tests(model, scene.filter(), "a0", "a2"));
  EXPECT_TRUE(tests(model, scene.filter(), "a0", "a3"));
  const ExcludedPair* pair = findExcluded(scene.filter(), "a0", "a4");
  ASSERT_NE(pair, nullptr);
  EXPECT_EQ(pair->reason, ExclusionReason::disabled);
  EXPECT_EQ(pair->geometryPairs, 1);
  EXPECT_NE(describe(*pair).find("never tested"), std::string::npos) << describe(*pair);
}
