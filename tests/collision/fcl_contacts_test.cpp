// SPDX-License-Identifier: Apache-2.0
/// Contacts through FCL, beside our own: the same bodies touch, and come to the same rest.
#include "softgauss/collision/fcl_contacts.hpp"

#include <gtest/gtest.h>

#include <set>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_surfaces.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

using collision::FclContacts;
using collision::SceneContacts;

const Vector3 kHalf(0.06, 0.05, 0.04);

std::vector<Shape> bodies() {
  return {Shape::sphere(0.05), Shape::capsule(0.04, 0.06), Shape::cylinder(0.05, 0.04),
          Shape::box(kHalf), Shape::hull(boxSurface(kHalf))};
}

Scene rest(const ModelBuilder& builder, bool throughFcl) {
  Scene s(builder.build());
  if (throughFcl)
    s.contacts = std::make_shared<FclContacts>(s.model);
  else
    s.contacts = std::make_shared<SceneContacts>(s.model);
  s.steps(2000);
  return s;
}

double weightOf(const Scene& s) {
  double sum = 0.0;
  const PyramidalContact& contact = s.data->constraints.contact;
  for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i)
    sum += std::abs(contact.force(i).z());
  return sum;
}

/// Geometries that are deeper in each other.
std::set<std::pair<int, int>> touching(const ContactSet& set, double deeper) {
  std::set<std::pair<int, int>> pairs;
  for (const Contact& c : set.contacts)
    if (c.distance < -deeper) pairs.insert({c.geometryA, c.geometryB});
  return pairs;
}

ModelBuilder freeAt(const Shape& shape, const Transform& X_WB) {
  ModelBuilder one = freeBody(boxLink("body", 1.0, kHalf));
  one.X_WRoot = X_WB;
  return one.geometry(geometrySpec("body", shape));
}

}  // namespace

// Every kind of body on every kind of ground: depths within 0.2 mm, the same weight is carried.
TEST(FclContacts, BodiesComeToTheSameRest) {
  const Vector3 slab(0.5, 0.4, 0.1);
  const Shape grounds[] = {Shape::plane(), Shape::box(slab), Shape::hull(boxSurface(slab)),
                           Shape::surface(boxSurface(slab, 5))};
  for (const Shape& ground : grounds)
    for (const Shape& shape : bodies()) {
      SCOPED_TRACE(testing::Message() << "body " << static_cast<int>(shape.kind) << " on "
                                      << static_cast<int>(ground.kind));
      ModelBuilder builder = freeBody(boxLink("body", 1.0, kHalf));
      const double top = ground.kind == ShapeKind::plane ? 0.0 : slab.z();
      // A capsule lies down.
      const bool lies = shape.kind == ShapeKind::capsule;
      if (lies) builder.X_WRoot.R = Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()).matrix();
      const double high = shape.kind == ShapeKind::box || shape.kind == ShapeKind::mesh ? kHalf.z()
                          : shape.kind == ShapeKind::sphere                             ? 0.05
                                                                                        : 0.04;
      builder.X_WRoot.p = Vector3(0.013, 0.021, top + high - 1e-4);
      builder.geometry(geometrySpec("body", shape, 0.8));
      builder.geometry(geometrySpec("world", ground, 0.8));
      const Scene own = rest(builder, false), fcl = rest(builder, true);
      EXPECT_SMALL((own.state.q - fcl.state.q).head<3>().norm(), 2e-4);
      EXPECT_GT(own.data->stats.contacts, 0);
      EXPECT_SMALL(weightOf(fcl) / weightOf(own) - 1.0, 0.01);
      EXPECT_SMALL(weightOf(own) / 9.81 - 1.0, 0.01);
    }
}

// A heap at random: which geometries touch is the same, but where they hardly do.
TEST(FclContacts, TheSamePairsTouch) {
  ModelBuilder builder("heap");
  for (int i = 0; i < 40; ++i) {
    Random random(static_cast<std::uint64_t>(i));
    ModelBuilder one("one");
    one.base = BaseKind::floating;
    one.X_WRoot = {random.rotation(), Vector3(0.0, 0.0, 0.15) + random.vector3(0.15)};
    one.link(boxLink("body", 1.0, kHalf));
    one.geometry(geometrySpec("body", bodies()[static_cast<std::size_t>(i % 5)]));
    builder.add(one, "object" + std::to_string(i));
  }
  builder.geometry(groundSpec(0.8));
  const Model model = builder.build();
  SceneContacts own(model);
  FclContacts fcl(model);
  Kinematics kinematics(model);
  computeKinematics(model, State(model), kinematics);
  ContactSet ours, theirs, again;
  own.detect(model, kinematics, ours);
  fcl.detect(model, kinematics, theirs);
  fcl.detect(model, kinematics, again);
  EXPECT_GT(touching(ours, 1e-4).size(), 40u);
  for (const auto& pair : touching(ours, 1e-4)) EXPECT_EQ(touching(theirs, 0).count(pair), 1u);
  for (const auto& pair : touching(theirs, 1e-4)) EXPECT_EQ(touching(ours, 0).count(pair), 1u);
  EXPECT_EQ(fcl.pairsFailed(), 0);
  // The same bits, and in the same order.
  ASSERT_EQ(again.contacts.size(), theirs.contacts.size());
  for (std::size_t i = 0; i < again.contacts.size(); ++i) {
    EXPECT_EQ(again.contacts[i].p_WC, theirs.contacts[i].p_WC);
    EXPECT_EQ(again.contacts[i].geometryB, theirs.contacts[i].geometryB);
  }
}

// The same with surfaces of triangles, hollow ones, in each other and among convex bodies: FCL is
// asked about the triangles. Of their hulls more pairs would touch.
TEST(FclContacts, TheSameSurfacesTouch) {
  const Shape shapes[] = {Shape::surface(ringSurface(0.1, 0.02, 24, 12)),
                          Shape::surface(clampSurface({0.1, 0.05, 0.08}, 0.02)),
                          Shape::surface(washerSurface(0.08, 0.05, 0.02)),
                          Shape::sphere(0.03),
                          Shape::box({0.03, 0.04, 0.05}),
                          Shape::cylinder(0.03, 0.05)};
  int pairs = 0, ofHulls = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    ModelBuilder builder("heap");
    for (int i = 0; i < 18; ++i)
      builder.add(freeAt(shapes[i % 6], {random.rotation(), random.vector3(0.16)}),
                  "object" + std::to_string(i));
    const auto detect = [](const Model& model, auto& source) {
      Kinematics kinematics(model);
      computeKinematics(model, State(model), kinematics);
      ContactSet set;
      source.detect(model, kinematics, set);
      return set;
    };
    Model model = builder.build();
    SceneContacts own(model);
    FclContacts fcl(model);
    const ContactSet ours = detect(model, own), theirs = detect(model, fcl);
    EXPECT_EQ(fcl.pairsFailed(), 0);
    for (const auto& pair : touching(ours, 1e-4)) EXPECT_EQ(touching(theirs, 0).count(pair), 1u);
    for (const auto& pair : touching(theirs, 1e-4)) EXPECT_EQ(touching(ours, 0).count(pair), 1u);
    pairs += static_cast<int>(touching(theirs, 1e-4).size());
    for (Geometry& g : model.geometries)
      if (g.shape.kind == ShapeKind::triangles) g.shape.kind = ShapeKind::mesh;
    SceneContacts hulls(model);
    ofHulls += static_cast<int>(touching(detect(model, hulls), 1e-4).size());
  }
  EXPECT_GT(pairs, 200);
  EXPECT_GT(ofHulls, pairs + pairs / 10);
}

// What lies within a closed surface touches none of its triangles, and is pushed out all the same.
TEST(FclContacts, WhatLiesWithinASurfaceIsPushedOut) {
  const Shape ring = Shape::surface(ringSurface(0.1, 0.02, 24, 12));
  for (const Shape& inner : {Shape::sphere(0.005), Shape::surface(ballSurface(0.005, 5, 6))}) {
    ModelBuilder builder("two");
    builder.add(freeAt(ring, {}), "ring");
    builder.add(freeAt(inner, {Matrix3::Identity(), Vector3(0.1, 0.0, 0.0)}), "inner");
    builder.add(freeAt(inner, {Matrix3::Identity(), Vector3(0.0, 0.0, 0.0)}), "beside");
    const Model model = builder.build();
    FclContacts fcl(model);
    Kinematics kinematics(model);
    computeKinematics(model, State(model), kinematics);
    ContactSet set;
    fcl.detect(model, kinematics, set);
    ASSERT_GT(set.contacts.size(), 0u);
    EXPECT_EQ(touching(set, 0.004).size(), 1u);
    for (const Contact& c : set.contacts) EXPECT_EQ(c.bodyA + c.bodyB, 3);
  }
}

}  // namespace softgauss::test
