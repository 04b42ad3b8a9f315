// SPDX-License-Identifier: Apache-2.0
/// Pairs that are set aside while they are far apart change no bit.

#include <gtest/gtest.h>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

using collision::SceneContacts;

/// Boxes, balls and capsules thrown on the ground, from rest heights of up to 1 m.
Model heap(int count) {
  ModelBuilder builder("heap");
  for (int i = 0; i < count; ++i) {
    Random random(i);
    ModelBuilder one("one");
    one.base = BaseKind::floating;
    one.X_WRoot = {random.rotation(), Vector3(0.25 * (i % 4), 0.25 * (i / 4), 0.4)};
    one.link(sphereLink("body", 1.0, 0.1));
    const Shape shapes[] = {Shape::box({0.08, 0.06, 0.1}), Shape::sphere(0.1),
                            Shape::capsule(0.05, 0.08)};
    one.geometry(geometrySpec("body", shapes[i % 3]));
    builder.add(one, "object" + std::to_string(i));
  }
  builder.geometry(groundSpec(0.8));
  return builder.build();
}

/// The same scene with and without pruning, below and above the size that sweeps.
struct Pair {
  Scene pruned, plain;
  SceneContacts* source;

  Pair(const Model& model, int broadphasePairs) : pruned(model), plain(model) {
    const auto with = std::make_shared<SceneContacts>(pruned.model, broadphasePairs, true);
    source = with.get();
    pruned.contacts = with;
    plain.contacts = std::make_shared<SceneContacts>(plain.model, broadphasePairs, false);
  }
};

TEST(NearPairs, SameBitsWithAndWithoutPruning) {
  for (const int broadphasePairs : {0, 100000}) {
    Pair pair(heap(12), broadphasePairs);
    Random random(1);
    pair.pruned.state.v = pair.plain.state.v = random.vector(pair.pruned.model.nv, 1.0);
    int touching = 0;
    for (int i = 0; i < 500; ++i) {
      pair.pruned.step();
      pair.plain.step();
      ASSERT_EQ(pair.pruned.data->stats.contacts, pair.plain.data->stats.contacts) << i;
      ASSERT_EQ(hash(pair.pruned.state), hash(pair.plain.state)) << "step " << i;
      touching += pair.pruned.data->stats.contacts > 0;
    }
    EXPECT_GT(touching, 200);
    EXPECT_LT(pair.source->sweeps(), 250);  // 500 without pruning
    EXPECT_GT(pair.source->sweeps(), 2);
  }
}

// States in any order: the list does not trust that one follows from the other.
TEST(NearPairs, HoldForStatesInAnyOrder) {
  for (const int broadphasePairs : {0, 100000}) {
    Pair pair(heap(12), broadphasePairs);
    Random random(2);
    int contacts = 0;
    const State start = pair.pruned.state;
    for (int i = 0; i < 300; ++i) {
      // Small and large jumps.
      const double size = std::pow(10.0, random.uniform(-4.0, 0.0));
      State& state = pair.pruned.state;
      if (i % 10 == 0) state = start;
      integratePosition(pair.pruned.model, random.vector(pair.pruned.model.nv, size), 1.0, state.q);
      pair.plain.state = state;
      pair.pruned.stages();
      pair.plain.stages();
      const auto &a = pair.pruned.data->contacts.contacts, &b = pair.plain.data->contacts.contacts;
      ASSERT_EQ(a.size(), b.size()) << i;
      for (std::size_t k = 0; k < a.size(); ++k) {
        ASSERT_EQ(a[k].geometryA, b[k].geometryA);
        ASSERT_EQ(a[k].geometryB, b[k].geometryB);
        ASSERT_EQ(a[k].distance, b[k].distance);
      }
      contacts += static_cast<int>(a.size());
    }
    EXPECT_GT(contacts, 100);
  }
}

// At rest near pairs are found once.
TEST(NearPairs, AreFoundOnceAtRest) {
  Scene s(boxOnPlane({0.1, 0.1, 0.1}, 1.0, 1.0).build());
  const auto source = std::make_shared<SceneContacts>(s.model);
  s.contacts = source;
  s.steps(200);
  EXPECT_GT(s.data->stats.contacts, 0);
  EXPECT_EQ(source->sweeps(), 1);
}

// Of some trees: those of all that none of the others has part in, wherever these are thought to
// be.
TEST(NearPairs, AmongSomeTreesAreThoseOfAll) {
  for (const int broadphasePairs : {0, 100000}) {
    Scene s(heap(12));
    const auto source = std::make_shared<SceneContacts>(s.model, broadphasePairs, true);
    s.contacts = source;
    TreeSelection some(s.model);
    ContactSet all, among;
    int found = 0, left = 0;
    for (int i = 0; i < 300; ++i) {
      s.step();
      source->detect(s.model, s.data->kinematics, all);
      some.select(s.model, [&](int tree) { return (tree + i / 50) % 3 != 0; });
      Kinematics moved = s.data->kinematics;
      for (int b = 1; b < s.model.bodyCount(); ++b)
        if (!some.holds(s.model, b)) moved.X_WB[b].p.x() += 100.0;
      source->detectAmong(s.model, moved, some, among);
      const std::size_t of = all.contacts.size();
      std::erase_if(all.contacts,
                    [&](const Contact& c) { return !some.holds(s.model, c.bodyA, c.bodyB); });
      ASSERT_EQ(among.contacts.size(), all.contacts.size()) << i;
      for (std::size_t k = 0; k < all.contacts.size(); ++k) {
        ASSERT_EQ(among.contacts[k].p_WC, all.contacts[k].p_WC) << i;
        ASSERT_EQ(among.contacts[k].distance, all.contacts[k].distance) << i;
      }
      found += all.contacts.size() > 0, left += of > all.contacts.size();
    }
    EXPECT_GT(found, 100);
    EXPECT_GT(left, 100);
  }
}

}  // namespace
}  // namespace softgauss::test
