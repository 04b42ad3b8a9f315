// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/scene_contacts.hpp"

#include <gtest/gtest.h>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/collision/support.hpp"
#include "softgauss/engine/model/state.hpp"
#include "softgauss/engine/step/step.hpp"
#include "tests/collision/random_pairs.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/sample_models.hpp"

using namespace softgauss;
using namespace softgauss::collision;

namespace {

using test::geometrySpec;
using test::groundSpec;
using test::sphereLink;

/// Free bodies of every shape, thrown together, on the ground.
ModelBuilder heap(int count) {
  using enum ShapeKind;
  RandomPairs random(7);
  ModelBuilder builder("heap");
  builder.geometry(groundSpec(1.0));
  for (int i = 0; i < count; ++i) {
    const std::string name = "body" + std::to_string(i);
    const ShapeKind kinds[] = {sphere, capsule, box, cylinder};
    const ShapeKind kind = kinds[i % 4];
    const Shape shape = i % 5 == 0 ? Shape::hull(boxMesh({0.1, 0.2, 0.3})) : random.shape(kind);
    builder.link(sphereLink(name, 1.0, 0.1)).geometry(geometrySpec(name, shape));
  }
  return builder;
}

/// The scene with every free body at a random pose.
Kinematics scattered(const Model& model, unsigned seed, double size) {
  RandomPairs random(seed);
  State state(model);
  for (const Tree& tree : model.trees) {
    const int q = model.bodies[static_cast<std::size_t>(tree.rootBody)].q;
    const Transform X = random.pose(size);
    state.q.segment<3>(q) = X.p;
    const Quaternion r(X.R);
    state.q.segment<4>(q + 3) << r.w(), r.x(), r.y(), r.z();
  }
  Kinematics kinematics(model);
  computeKinematics(model, state, kinematics);
  return kinematics;
}

void expectSame(const ContactSet& a, const ContactSet& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].geometryA, b.contacts[i].geometryA);
    EXPECT_EQ(a.contacts[i].geometryB, b.contacts[i].geometryB);
    EXPECT_EQ(a.contacts[i].p_WC, b.contacts[i].p_WC);
    EXPECT_EQ(a.contacts[i].n_W, b.contacts[i].n_W);
    EXPECT_EQ(a.contacts[i].distance, b.contacts[i].distance);
  }
}

}  // namespace

TEST(SceneContacts, StandingHumanoidTouchesTheGroundUnderItsFeet) {
  ModelBuilder builder = test::humanoid();
  Model model = builder.build();
  SceneContacts scene(model);
  State state(model);
  Kinematics kinematics(model);
  computeKinematics(model, state, kinematics);
  state.q[2] -= lowestPoint(model, kinematics, 0) + 1e-3;
  computeKinematics(model, state, kinematics);
  EXPECT_NEAR(lowestPoint(model, kinematics, 0), -1e-3, 1e-12);
  ContactSet contacts;
  scene.detect(model, kinematics, contacts);
  ASSERT_EQ(contacts.size(), 8);
  for (const Contact& c : contacts.contacts) {
    EXPECT_EQ(c.bodyA, 0);
    EXPECT_NEAR(c.distance, -1e-3, 1e-9);
    EXPECT_NEAR(c.n_W.z(), 1.0, 1e-12);
  }
}

TEST(SceneContacts, BroadphaseFindsTheSameContactsInTheSameOrder) {
  const Model model = heap(40).build();
  SceneContacts loop(model, 1 << 20), sweep(model, 0);
  ContactSet byLoop, bySweep;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Kinematics kinematics = scattered(model, seed, 1.5);
    loop.detect(model, kinematics, byLoop);
    sweep.detect(model, kinematics, bySweep);
    EXPECT_GT(byLoop.size(), 20);
    EXPECT_EQ(byLoop.pairsTested, bySweep.pairsTested);
    expectSame(byLoop, bySweep);
  }
}

TEST(SceneContacts, AnswersDependOnThePosesAlone) {
  const Model model = heap(20).build();
  SceneContacts used(model), fresh(model);
  ContactSet before, after;
  for (unsigned seed = 1; seed <= 4; ++seed)
    used.detect(model, scattered(model, seed, 1.0), before);
  fresh.detect(model, scattered(model, 4, 1.0), after);
  expectSame(before, after);
}

TEST(SceneContacts, DetectAllocatesNothing) {
  const Model model = heap(30).build();
  std::vector<Kinematics> poses;
  for (unsigned seed = 1; seed <= 5; ++seed) poses.push_back(scattered(model, seed, 1.0));
  for (int broadphasePairs : {0, 1 << 20}) {
    SceneContacts scene(model, broadphasePairs);
    ContactSet contacts;
    for (const Kinematics& k : poses) scene.detect(model, k, contacts);
    const test::AllocationGuard guard;
    for (const Kinematics& k : poses) scene.detect(model, k, contacts);
    EXPECT_EQ(guard.count(), 0);
    EXPECT_GT(contacts.size(), 0);
  }
}

TEST(SceneContacts, ContactsRespectTheMarginsOfBothMaterials) {
  ModelBuilder builder("margin");
  builder.link(sphereLink("ball", 1.0, 0.1));
  GeometrySpec ground = groundSpec(1.0), ball = geometrySpec("ball", Shape::sphere(0.1));
  ground.material.margin = 0.01;
  ball.material.margin = 0.02;
  builder.geometry(ground).geometry(ball);
  builder.X_WRoot.p.z() = 0.129;
  const Model near = builder.build();
  ContactSet contacts;
  const auto detect = [&](const Model& model) {
    Kinematics kinematics(model);
    computeKinematics(model, State(model), kinematics);
    SceneContacts(model).detect(model, kinematics, contacts);
    return contacts.size();
  };
  EXPECT_EQ(detect(near), 1);
  EXPECT_NEAR(contacts.contacts[0].distance, 0.029, 1e-12);
  builder.X_WRoot.p.z() = 0.131;
  EXPECT_EQ(detect(builder.build()), 0);
}

TEST(LowestPoint, IsTheSupportPointDownwards) {
  RandomPairs random(9);
  for (ShapeKind kind :
       {ShapeKind::sphere, ShapeKind::capsule, ShapeKind::cylinder, ShapeKind::box}) {
    for (int i = 0; i < 50; ++i) {
      const Shape shape = random.shape(kind);
      const Transform X = random.pose(1.0);
      EXPECT_NEAR(lowestPoint(shape, X), supportPoint({&shape, nullptr}, X, -Vector3::UnitZ()).z(),
                  1e-12);
    }
  }
  const Shape box = Shape::box({0.1, 0.2, 0.3}), mesh = Shape::hull(boxMesh({0.1, 0.2, 0.3}));
  const Transform X = random.pose(1.0);
  EXPECT_NEAR(lowestPoint(box, X), lowestPoint(mesh, X), 1e-12);
}

// A free block of each shape on a static box: it settles and stays.
TEST(SceneContacts, WhatLiesFlatOnABoxRests) {
  const Shape shapes[] = {Shape::hull(boxMesh({0.1, 0.1, 0.1})), Shape::box({0.1, 0.1, 0.1}),
                          Shape::cylinder(0.1, 0.1)};
  for (const Shape& shape : shapes) {
    ModelBuilder builder("block");
    builder.link(test::boxLink("block", 1.0, {0.1, 0.1, 0.1}));
    builder.geometry(geometrySpec("block", shape));
    builder.geometry(geometrySpec("world", Shape::box({1, 1, 0.5})));
    builder.X_WRoot = turned({0, 0, 1}, 0.3, {0.2, 0.1, 0.6});
    const Model model = builder.build();
    SceneContacts scene(model);
    State state(model);
    Data data(model);
    for (int i = 0; i < 1000; ++i)
      ASSERT_EQ(step(model, {}, state, data, &scene), SolveStatus::converged);
    EXPECT_LT(state.v.norm(), 1e-6);
    EXPECT_LT((state.q.head<2>() - Eigen::Vector2d(0.2, 0.1)).norm(), 1e-4);
    EXPECT_NEAR(state.q[2], 0.6, 1e-3);
    EXPECT_GE(data.contacts.size(), 4);
  }
}

// A pair with a margin of its own is found within that margin, by the broadphase too.
TEST(SceneContacts, FindAPairWithinItsOwnMargin) {
  for (const int broadphasePairs : {0, 1 << 20}) {
    ModelBuilder builder = heap(3);
    for (const char* name : {"left", "right"})
      builder.link(sphereLink(name, 1.0, 0.1)).geometry(geometrySpec(name, Shape::sphere(0.1)));
    PairSpec pair;
    const std::string left = geometrySpec("left", Shape::sphere(0.1)).name;
    pair.geometryA = left;
    pair.geometryB = geometrySpec("right", Shape::sphere(0.1)).name;
    pair.material.margin = 0.02;
    const Model model = builder.pair(pair).build();
    State state(model);
    for (const Tree& tree : model.trees) {
      const int b = tree.rootBody, q = model.bodies[static_cast<std::size_t>(b)].q;
      const std::string& name = model.bodyNames[static_cast<std::size_t>(b)];
      state.q.segment<3>(q) = Vector3(3.0 * b, 0.0, 5.0);
      if (name == "left") state.q.segment<3>(q) = Vector3(0.0, 0.0, 9.0);
      if (name == "right") state.q.segment<3>(q) = Vector3(0.215, 0.0, 9.0);
    }
    Kinematics k(model);
    computeKinematics(model, state, k);
    SceneContacts source(model, broadphasePairs);
    ContactSet contacts;
    source.detect(model, k, contacts);
    ASSERT_EQ(contacts.size(), 1) << broadphasePairs;
    EXPECT_NEAR(contacts.contacts[0].distance, 0.015, 1e-12);
  }
}
