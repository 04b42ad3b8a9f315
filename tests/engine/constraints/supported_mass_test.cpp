// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/supported_mass.hpp"

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// Free spheres of these masses [kg], body i + 1 in tree i, and a contact for each pair of bodies.
struct Island {
  Model model;
  InverseWeights weights;
  ContactSet contacts;
  SupportedMass load;

  Island(const std::vector<double>& masses, const std::vector<std::pair<int, int>>& touching)
      : model(spheres(masses)), weights(model) {
    for (const auto& [a, b] : touching) {
      Contact c;
      c.bodyA = a, c.bodyB = b;
      contacts.add(c);
    }
    load.assemble(model, Kinematics(model), contacts, weights);
  }
  static Model spheres(const std::vector<double>& masses) {
    ModelBuilder builder("spheres");
    builder.base = BaseKind::floating;
    for (std::size_t i = 0; i < masses.size(); ++i)
      builder.link(sphereLink("ball" + std::to_string(i), masses[i], 0.1));
    return builder.build();
  }
  double of(int contact) const {
    const Contact& c = contacts.contacts[contact];
    return load.mass(model, c.bodyA, c.bodyB);
  }
};

// 1 kg carries 10 kg, which carries 100 kg: each contact carries what stands upon it.
TEST(SupportedMass, IsWhatStandsUponIt) {
  const Island tower({1.0, 10.0, 100.0}, {{0, 1}, {1, 2}, {2, 3}});
  EXPECT_SMALL(tower.of(0) - 110.0, 1e-12);
  EXPECT_SMALL(tower.of(1) - 110.0, 1e-12);
  EXPECT_SMALL(tower.of(2) - 100.0, 1e-12);
}

// Two balls on three, one of them on one of the three alone: shares are equal.
TEST(SupportedMass, IsSharedByThoseThatBearIt) {
  const std::vector<std::pair<int, int>> touching = {{0, 1}, {0, 2}, {0, 3}, {4, 1},
                                                     {4, 2}, {4, 3}, {5, 4}, {5, 2}};
  const Island heavy({1.0, 1.0, 1.0, 6.0, 2.0}, touching);  // the heaviest counts everywhere
  for (const int contact : {0, 1, 2, 3, 4, 5}) EXPECT_SMALL(heavy.of(contact) - 6.0, 1e-12);
  const Island wide({1.0, 1.0, 1.0, 1.0, 3.0}, touching);
  EXPECT_SMALL(wide.of(0) - 3.0, 1e-12);                // the largest of the others
  EXPECT_SMALL(wide.of(1) - (1.0 / 3.0 + 3.0), 1e-12);  // a third of one, all of the other
}

// A layer that is wide carries no more for it.
TEST(SupportedMass, DoesNotGrowWithTheWidthOfAPile) {
  constexpr int kWidth = 30;
  std::vector<std::pair<int, int>> touching;
  for (int i = 1; i <= kWidth; ++i) {
    touching.emplace_back(0, i);
    touching.emplace_back(i, kWidth + i);
    if (i > 1) touching.emplace_back(i - 1, i);
    if (i > 1) touching.emplace_back(kWidth + i - 1, kWidth + i);
  }
  const Island pile(std::vector<double>(2 * kWidth, 1.0), touching);
  for (std::size_t i = 0; i < touching.size(); ++i)
    EXPECT_SMALL(pile.of(static_cast<int>(i)) -
                     (touching[i].second <= kWidth && touching[i].first > 0 ? 2.0 : 1.0),
                 1e-12)
        << i;
}

// What touches no world has nothing to stand upon: the heaviest counts.
TEST(SupportedMass, OfWhatFallsIsTheHeaviest) {
  const Island falling({1.0, 10.0, 100.0}, {{1, 2}, {2, 3}});
  EXPECT_SMALL(falling.of(0) - 100.0, 1e-12);
  EXPECT_SMALL(falling.of(1) - 100.0, 1e-12);
}

TEST(SupportedMass, EndsWhereTreesDoNotTouch) {
  // Two towers on the ground; the ground joins nothing.
  const Island towers({1.0, 10.0, 2.0, 5.0, 7.0}, {{0, 1}, {1, 2}, {0, 3}, {3, 4}, {0, 5}});
  EXPECT_SMALL(towers.of(0) - 10.0, 1e-12);
  EXPECT_SMALL(towers.of(2) - 5.0, 1e-12);
  EXPECT_EQ(towers.of(4), 0.0);
  EXPECT_EQ(Island({1.0, 10.0}, {{0, 1}, {0, 2}}).of(1), 0.0);
}

// L is symmetric in the order of contacts and of their bodies.
TEST(SupportedMass, DoesNotDependOnOrder) {
  Random random(3);
  for (int seed = 0; seed < 20; ++seed) {
    std::vector<double> masses;
    for (int i = 0; i < 8; ++i) masses.push_back(random.uniform(0.1, 10.0));
    std::vector<std::pair<int, int>> touching, turned;
    for (int i = 0; i < 9; ++i) {
      const int a = random.index(9), b = (a + 1 + random.index(8)) % 9;
      touching.emplace_back(a, b);
      turned.insert(turned.begin(), {b, a});
    }
    const Island one(masses, touching), other(masses, turned);
    for (int i = 0; i < 9; ++i) EXPECT_SMALL(one.of(i) - other.of(8 - i), 1e-12);
  }
}

/// Spheres of these masses, each tied to the one before, the first to the world, with the centres
/// 1 m apart along x; `weld` or connect.
struct Tied {
  Model model;
  InverseWeights weights;
  SupportedMass load;

  Tied(const std::vector<double>& masses, bool weld, const ContactSet& contacts = {})
      : model(row(masses, weld)), weights(model) {
    State state(model);
    for (int i = 0; i + 1 < model.bodyCount(); ++i) state.q[7 * i] = i;
    Kinematics kinematics(model);
    computeKinematics(model, state, kinematics);
    load.assemble(model, kinematics, contacts, weights);
  }
  static Model row(const std::vector<double>& masses, bool weld) {
    ModelBuilder builder("row");
    builder.base = BaseKind::floating;
    std::string last = "world";
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const std::string name = "ball" + std::to_string(i);
      builder.link(sphereLink(name, masses[i], 0.1));
      ConnectSpec connect;
      connect.linkA = name, connect.linkB = last;
      WeldSpec fixed;
      fixed.linkA = name, fixed.linkB = last;
      if (weld)
        builder.weld(fixed);
      else
        builder.connect(connect);
      last = name;
    }
    return builder.build();
  }
  double mass(int a, int b) const { return load.mass(model, a, b); }
};

// What hangs on an equality constraint is carried by all between it and the world, like what stands
// on a contact.
TEST(SupportedMass, OfTiesIsWhatHangsOnThem) {
  for (const bool weld : {false, true}) {
    const Tied row({1.0, 10.0, 100.0}, weld);
    EXPECT_SMALL(row.mass(1, 0) - 110.0, 1e-12);
    EXPECT_SMALL(row.mass(1, 2) - 110.0, 1e-12);
    EXPECT_SMALL(row.mass(2, 3) - 100.0, 1e-12);
  }
  EXPECT_EQ(Tied({5.0}, true).mass(1, 0), 0.0);
}

// Contacts and equality constraints are edges of one graph: what the last of the row lies on bears
// none of it, for the world holds its first; what lies on the last is passed to the world by both.
TEST(SupportedMass, JoinsContactsAndTies) {
  ContactSet contacts;
  Contact c;
  c.bodyA = 2, c.bodyB = 3;
  contacts.add(c);
  Model model = Tied::row({1.0, 2.0, 4.0}, false);
  model.connections.pop_back();  // the third lies on the second
  const InverseWeights weights(model);
  SupportedMass load;
  load.assemble(model, Kinematics(model), contacts, weights);
  EXPECT_SMALL(load.mass(model, 1, 0) - 6.0, 1e-12);
  EXPECT_SMALL(load.mass(model, 1, 2) - 6.0, 1e-12);
  EXPECT_SMALL(load.mass(model, 2, 3) - 4.0, 1e-12);
}

// A weld to the world bears the others' moment of inertia about its origin: that of their masses at
// their distances, and of each about its own centre, ⅖ m r².
TEST(SupportedMass, OfWeldsTurns) {
  const Tied row({1.0, 10.0, 100.0}, true);
  const auto own = [](double m) { return 0.4 * m * 0.01; };
  const Vector3 origin = Vector3::Zero(), second = Vector3::UnitX();
  EXPECT_SMALL(
      row.load.inertia(row.model, 1, 0, origin) - (own(10.0) + 10.0 + own(100.0) + 100.0 * 4.0),
      1e-9);
  EXPECT_SMALL(row.load.inertia(row.model, 3, 2, second) - (own(100.0) + 100.0), 1e-9);
  // Of the island's heaviest alone where that is more than what is passed down.
  const Tied light({100.0, 1.0}, true);
  EXPECT_SMALL(light.load.inertia(light.model, 2, 1, second) - (own(100.0) + 100.0), 1e-9);
}

// Equality constraints of at most half the critical damping are no edges, and no harder.
TEST(SupportedMass, LeavesTiesThatBounceAsTheyAre) {
  for (const double ratio : {0.05, 0.5, 0.51, 1.0}) {
    Scene scene(Tied::row({1.0, 99.0}, false));
    for (Connection& c : scene.model.connections) c.impedance.dampingRatio = ratio;
    scene.stages();
    const std::vector<double> with = scene.data->constraints.connection.D;
    scene.model.options.mechanisms.remove(Mechanism::supportedMass);
    scene.stages();
    const std::vector<double>& without = scene.data->constraints.connection.D;
    for (int i = 0; i < 6; ++i) EXPECT_EQ(with[i] > without[i], ratio > 0.5) << i << " " << ratio;
  }
}

// Loads make rows of equality constraints harder, A = 1/L, and nothing else of them.
TEST(SupportedMass, HardensTies) {
  Scene scene(Tied::row({1.0, 99.0}, false));
  scene.stages();
  const std::vector<double> with = scene.data->constraints.connection.D,
                            references = scene.data->constraints.connection.reference;
  scene.model.options.mechanisms.remove(Mechanism::supportedMass);
  scene.stages();
  const std::vector<double>& without = scene.data->constraints.connection.D;
  ASSERT_EQ(with.size(), 6u);
  for (int i = 0; i < 6; ++i) {
    const double weight = i < 3 ? 1.0 : 1.0 + 1.0 / 99.0;
    EXPECT_SMALL(with[i] / without[i] / (99.0 * weight) - 1.0, 1e-12);
  }
  EXPECT_EQ(references, scene.data->constraints.connection.reference);
}

/// D of all rows of contacts, with loads or without.
std::vector<double> stiffnesses(Scene& scene, bool carried) {
  scene.model.options.mechanisms = MechanismSet::all();
  if (!carried) scene.model.options.mechanisms.remove(Mechanism::supportedMass);
  scene.stages();
  return scene.data->constraints.contact.D;
}

// A robot that touches the world and itself is as it was, bit for bit.
TEST(SupportedMass, LeavesALoneRobotAsItIs) {
  Scene scene(humanoid().build(), std::make_shared<FixedContacts>());
  auto& points = static_cast<FixedContacts&>(*scene.contacts).points;
  Random random(5);
  computeKinematics(scene.model, scene.state, scene.data->kinematics);
  points = randomContacts(scene.model, scene.data->kinematics, random, 20).points;
  const std::vector<double> with = stiffnesses(scene, true);
  EXPECT_GT(with.size(), 20u);
  EXPECT_EQ(with, stiffnesses(scene, false));
}

/// A leg of 90 kg and at its end a foot of 10 kg on a hinge.
Model footed(BaseKind base) {
  ModelBuilder builder("footed");
  builder.base = base;
  if (base == BaseKind::fixed) builder.link(emptyLink("world"));
  builder.link(sphereLink("leg", 90.0, 0.1));
  builder.link(sphereLink("foot", 10.0, 0.1));
  if (base == BaseKind::fixed)
    builder.joint(jointSpec("slide", JointType::prismatic, "world", "leg"));
  builder.joint(jointSpec("ankle", JointType::continuous, "leg", "foot",
                          {Matrix3::Identity(), Vector3(0, 0, -1)}, Vector3::UnitY()));
  builder.link(sphereLink("ball", 1.0, 0.1));
  JointSpec free = jointSpec("free", JointType::floating, "world", "ball");
  if (base == BaseKind::fixed) builder.joint(free);
  return builder.build();
}

// The contacts of a foot share a fifth of the tree above it (5.3), on a base too.
TEST(SupportedMass, OfLightFeetIsAPartOfTheTree) {
  for (const BaseKind base : {BaseKind::floating, BaseKind::fixed}) {
    const Model model = footed(base);
    ASSERT_EQ(model.trees.size(), 2u);
    const InverseWeights weights(model);
    SupportedMass load;
    ContactSet contacts;
    for (int n = 1; n <= 20; ++n) {
      Contact c;
      c.bodyA = 0, c.bodyB = 2;
      contacts.add(c);
      load.assemble(model, Kinematics(model), contacts, weights);
      EXPECT_SMALL(load.contactShare(model, 0, 2) - 20.0 / n, 1e-12);
      EXPECT_SMALL(load.contactShare(model, 3, 2) - 20.0 / n, 1e-12);
      EXPECT_EQ(load.contactShare(model, 0, 3), 0.0);  // one body
      EXPECT_EQ(load.contactShare(model, 1, 2), 0.0);  // one tree
      EXPECT_EQ(load.mass(model, 0, 2), 0.0);
    }
  }
}

// Where a ball lies on the foot too, the island knows the tree by that part, and the ball, which
// stands on the world, is as hard as the foot wants.
TEST(SupportedMass, OfWhatLiesOnLightFeetIsAPartOfTheTree) {
  for (const BaseKind base : {BaseKind::floating, BaseKind::fixed}) {
    const Model model = footed(base);
    InverseWeights weights(model);
    weights.translation[2] = 10.0;  // a foot that feels as light as 0.1 kg
    ContactSet contacts;
    for (const auto& [a, b] : {std::pair(0, 2), std::pair(2, 3)}) {
      Contact c;
      c.bodyA = a, c.bodyB = b;
      contacts.add(c);
    }
    SupportedMass load;
    load.assemble(model, Kinematics(model), contacts, weights);
    EXPECT_SMALL(load.mass(model, 2, 3) - 10.0, 1e-12);  // 100 kg/(5·2), and the ball 1 kg
    EXPECT_SMALL(load.mass(model, 0, 2) - 1.0, 1e-12);   // the ball; the foot's own is the part
    EXPECT_SMALL(load.contactShare(model, 0, 2) - 10.0, 1e-12);
  }
}

// Between trees no row becomes softer, and some become harder.
TEST(SupportedMass, OnlyStiffens) {
  int harder = 0, rows = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Scene scene = randomScene(seed, 12);
    const std::vector<double> with = stiffnesses(scene, true), without = stiffnesses(scene, false);
    ASSERT_EQ(with.size(), without.size());
    for (std::size_t i = 0; i < with.size(); ++i) {
      EXPECT_GE(with[i], without[i] * (1.0 - 1e-12));
      harder += with[i] > 1.01 * without[i];
      ++rows;
    }
  }
  EXPECT_GT(harder, rows / 20);
  EXPECT_LT(harder, rows);
}

}  // namespace
}  // namespace softgauss::test
