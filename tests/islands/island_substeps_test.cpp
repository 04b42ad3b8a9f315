// SPDX-License-Identifier: Apache-2.0

/// Into how many parts a step goes is each island's own: what turns fast beside others changes no
/// bit of theirs, nor do they of its.

#include <map>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

/// Some of these, each far from the others.
enum Piece { kRest, kTumbler, kTop, kPair, kWelded, kSlider, kCreature, kPieces };

void addPiece(ModelBuilder& builder, Piece piece) {
  const Vector3 at(20.0 * static_cast<int>(piece), 0.0, 0.0);
  const auto tie = [&](const std::string& a, const std::string& b, Vector3 onA, Vector3 onB) {
    ConnectSpec spec;
    spec.linkA = a, spec.linkB = b;
    spec.p_LAP = onA, spec.p_LBP = onB;
    builder.connect(spec);
  };
  switch (piece) {
    case kRest:
      addCube(builder, "rest lower", at + Vector3(0.0, 0.0, 0.1));
      return addCube(builder, "rest upper", at + Vector3(0.05, 0.0, 0.3));
    case kTumbler:
      return addCube(builder, "tumbler", at + Vector3(0.0, 0.0, 0.2));
    case kTop:  // hangs from the world by a corner
      addCube(builder, "top", at + Vector3(0.0, 0.0, 3.0));
      return tie("top", "world", Vector3::Constant(0.1), at + Vector3(0.1, 0.1, 3.1));
    case kPair:  // on a string
      addCube(builder, "pair left", at + Vector3(-0.5, 0.0, 5.0));
      addCube(builder, "pair right", at + Vector3(0.5, 0.0, 5.0));
      return tie("pair left", "pair right", Vector3(0.5, 0.0, 0.0), Vector3(-0.5, 0.0, 0.0));
    case kWelded: {
      addCube(builder, "welded lower", at + Vector3(0.0, 0.0, 5.0));
      addCube(builder, "welded upper", at + Vector3(0.0, 0.0, 5.3));
      WeldSpec spec;
      spec.linkA = "welded lower", spec.linkB = "welded upper";
      spec.X_LAF.p.z() = 0.3;
      builder.weld(spec);
      return;
    }
    case kSlider: {
      ModelBuilder one("slider");
      one.base = BaseKind::fixed;
      one.X_WRoot.p = at + Vector3(0.0, 0.0, 3.0);
      one.link(emptyLink("rail"));
      one.link(boxLink("carriage", 1.3, Vector3::Constant(0.1)));
      one.joint(jointSpec("slide", JointType::prismatic, "rail", "carriage"));
      builder.add(one, "");
      return;
    }
    case kCreature:
      return addCreature(builder, "creature", at + Vector3(0.0, 0.0, 0.1));
    case kPieces:
      return;
  }
}

struct Whole {
  explicit Whole(const std::vector<Piece>& pieces, Cone cone = Cone::pyramidal)
      : model(build(pieces, cone)), contacts(model), state(model), data(model) {
    for (const Tree& tree : model.trees) spin(tree);
  }
  static Model build(const std::vector<Piece>& pieces, Cone cone) {
    ModelBuilder builder = ground();
    builder.options.cone = cone;
    for (const Piece piece : pieces) addPiece(builder, piece);
    return builder.build();
  }
  /// All but what rests.
  void spin(const Tree& tree) {
    const std::string& name = model.bodyNames[idx(tree.rootBody)];
    if (name.starts_with("rest")) return;
    for (int i = tree.firstDof + 3; i < tree.dofEnd; ++i)
      state.v[i] = 12.0 + 5.0 * (i - tree.firstDof);
  }
  void step() {
    ASSERT_EQ(softgauss::step(model, {}, state, data, &contacts), SolveStatus::converged);
  }

  /// q, v and the last acceleration of trees, by the names of their roots.
  std::map<std::string, std::vector<double>> all() const {
    std::map<std::string, std::vector<double>> of;
    for (const Tree& tree : model.trees) {
      std::vector<double>& x = of[model.bodyNames[idx(tree.rootBody)]];
      const int n = tree.dofEnd - tree.firstDof;
      const Segment q = coordinatesOf(model, tree);
      const auto add = [&](const VectorX& from, int first, int count) {
        x.insert(x.end(), from.data() + first, from.data() + first + count);
      };
      add(state.q, q.begin, q.end - q.begin);
      for (const VectorX* y : {&state.v, &state.a, &data.acceleration, &data.forward.a})
        add(*y, tree.firstDof, n);
    }
    return of;
  }
  /// Forces of contacts, by the names of the bodies that the ground carries.
  std::multimap<std::string, std::vector<double>> forces() const {
    std::vector<Snapshot::ContactForce> list;
    contactForces(data, list);
    std::multimap<std::string, std::vector<double>> of;
    for (const auto& c : list) {
      const int body = model.geometries[idx(c.geometryB)].body;
      of.emplace(
          model.bodyNames[idx(body)],
          std::vector<double>{c.p_WC.x(), c.p_WC.y(), c.force.x(), c.force.y(), c.force.z()});
    }
    return of;
  }

  const Model model;
  collision::SceneContacts contacts;
  State state;
  Data data;
};

/// Where a solve is repeated for one, forces of others are found again, of the same acceleration.
void expectSame(const std::multimap<std::string, std::vector<double>>& a,
                const std::multimap<std::string, std::vector<double>>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (auto x = a.begin(), y = b.begin(); x != a.end(); ++x, ++y) {
    ASSERT_EQ(x->first, y->first);
    for (std::size_t i = 0; i < x->second.size(); ++i)
      EXPECT_SMALL(x->second[i] - y->second[i], 1e-10 * (1.0 + std::abs(y->second[i]))) << x->first;
  }
}

TEST(IslandSubsteps, AreAnIslandsOwn) {
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
    std::vector<Piece> every;
    std::vector<std::unique_ptr<Whole>> alone;
    for (int piece = 0; piece < kPieces; ++piece) {
      every.push_back(static_cast<Piece>(piece));
      alone.push_back(std::make_unique<Whole>(std::vector{every.back()}, cone));
    }
    Whole together(every, cone);
    int divided = 0, differ = 0;
    for (int i = 0; i < 300; ++i) {
      together.step();
      const auto all = together.all();
      int most = 1, least = 1 << 20;
      std::multimap<std::string, std::vector<double>> forces;
      for (const auto& piece : alone) {
        piece->step();
        for (const auto& [name, x] : piece->all()) ASSERT_EQ(x, all.at(name)) << name << ", " << i;
        for (const auto& contact : piece->forces()) forces.insert(contact);
        most = std::max(most, piece->data.stats.parts);
        least = std::min(least, piece->data.stats.parts);
      }
      ASSERT_EQ(together.data.stats.parts, most) << i;
      expectSame(together.forces(), forces);
      divided += most > 1;
      differ += most != least;
    }
    EXPECT_GT(divided, 250);
    EXPECT_GT(differ, 250);
    EXPECT_EQ(alone[kRest]->data.stats.parts, 1);
  }
}

// Who has no part in it takes one step, and is counted once.
TEST(IslandSubsteps, CountWhatEachHasDone) {
  Whole rest({kRest}), top({kTop}), both({kRest, kTop});
  for (int i = 0; i < 20; ++i)
    for (Whole* scene : {&rest, &top, &both}) scene->step();
  const StepStats &r = rest.data.stats, &t = top.data.stats, &b = both.data.stats;
  ASSERT_GT(t.parts, 1);
  EXPECT_EQ(b.substeps, t.substeps);
  EXPECT_EQ(b.acted[Mechanism::substepping], t.parts);
  EXPECT_EQ(b.contacts, r.contacts);
  EXPECT_EQ(b.rows, r.rows + 3);  // of what ties the top
  EXPECT_SMALL(b.realised, 1e-12);
}

// What is not finite in one leaves all as they were, and goes no further than that.
TEST(IslandSubsteps, AreRefusedWithTheStep) {
  Whole both({kRest, kTop}), other({kRest, kTop});
  both.step(), other.step();
  const State before = both.state;
  both.state.v[both.model.nv - 1] = 1e160;
  const State given = both.state;
  EXPECT_EQ(step(both.model, {}, both.state, both.data, &both.contacts), SolveStatus::notFinite);
  EXPECT_EQ(hash(both.state), hash(given));
  both.state = before;
  both.step(), other.step();
  EXPECT_EQ(hash(both.state), hash(other.state));
}

/// Counts how often it is asked.
struct Counted final : StepControl {
  gdd::GoalDirectedController& controller;
  int asked = 0;
  explicit Counted(gdd::GoalDirectedController& c) : controller(c) {}
  bool acts() const noexcept override { return controller.acts(); }
  const VectorX* apply(const Model& model, const State& state, Data& data) noexcept override {
    ++asked;
    return controller.apply(model, state, data);
  }
  void keep(WarmStart& warm, const TreeSelection& trees) noexcept override {
    controller.keep(warm, trees);
  }
};

// A robot with goals takes the step whole, however fast something turns that it does not touch.
TEST(IslandSubsteps, LeaveGoalsToAWholeStep) {
  Whole top({kTop}), both({kTop, kCreature}), robot({kCreature});
  const auto controlled = [](Whole& scene) {
    auto controller = std::make_unique<gdd::GoalDirectedController>(scene.model);
    controller->goals.push_back(std::make_unique<gdd::Posture>(scene.model.q0));
    controller->goals.push_back(std::make_unique<gdd::VirtualDamping>());
    scene.state.v.tail(9).setZero();  // the creature stands still
    return controller;
  };
  const auto ofBoth = controlled(both), ofRobot = controlled(robot);
  Counted control(*ofBoth);
  int divided = 0;
  for (int i = 0; i < 200; ++i) {
    top.step();
    const auto take = [](Whole& scene, StepControl& by) {
      ASSERT_EQ(step(scene.model, {}, scene.state, scene.data, &scene.contacts, &by),
                SolveStatus::converged);
    };
    control.asked = 0;
    take(both, control);
    take(robot, *ofRobot);
    ASSERT_EQ(control.asked, 1 + both.data.stats.repeats) << i;
    ASSERT_EQ(both.all().at("top"), top.all().at("top")) << i;
    divided += both.data.stats.parts > 1;
  }
  EXPECT_GT(divided, 150);
  // Goals are solved for all trees at once: their rounding is shared.
  const std::vector<double> x = both.all().at("creature_0"), y = robot.all().at("creature_0");
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_SMALL(x[i] - y[i], 1e-9) << i;
}

}  // namespace
}  // namespace softgauss::test
