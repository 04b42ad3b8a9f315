// SPDX-License-Identifier: Apache-2.0
/// What no element calls for is neither called nor given memory, and what is idle makes no rows.

#include "softgauss/engine/model/plan.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// Four links on hinges, weightless, with nothing else: only Coriolis forces act.
ModelBuilder bareChain() {
  ModelBuilder builder = chain(4);
  builder.options.gravity.setZero();
  return builder;
}

struct EffectCase {
  Effect effect;
  std::function<void(ModelBuilder&)> call;  ///< adds what calls for the effect
  bool rows = false;                        ///< the effect makes rows, and does so at once
};

void onJoint(ModelBuilder& b, const std::function<void(JointSpec&)>& change) {
  change(*b.findJoint("joint2"));
}

void limit(JointSpec& joint, double lower) {
  joint.type = JointType::revolute;
  joint.lower = lower;
  joint.upper = 1.0;
}

const std::vector<EffectCase>& cases() {
  static const std::vector<EffectCase> all = {
      {Effect::gravity, [](ModelBuilder& b) { b.options.gravity = Vector3(0, 0, -9.81); }},
      {Effect::damping, [](ModelBuilder& b) { onJoint(b, [](JointSpec& j) { j.damping = 0.1; }); }},
      {Effect::spring,
       [](ModelBuilder& b) { onJoint(b, [](JointSpec& j) { j.stiffness = 3.0; }); }},
      {Effect::jointLimit, [](ModelBuilder& b) { onJoint(b, [](JointSpec& j) { limit(j, 0.4); }); },
       true},
      {Effect::dryFriction,
       [](ModelBuilder& b) { onJoint(b, [](JointSpec& j) { j.dryFriction = 0.2; }); }, true},
      {Effect::equality,
       [](ModelBuilder& b) {
         CouplingSpec coupling;
         coupling.follower = "joint1";
         coupling.leader = "joint3";
         b.couple(coupling);
       },
       true},
      {Effect::groundContact,
       [](ModelBuilder& b) {
         b.geometry(groundSpec(1.0));
         b.geometry(geometrySpec("link3", Shape::sphere(0.1)));
       },
       true},
  };
  return all;
}

Scene moving(const ModelBuilder& builder) {
  Scene s(builder.build(), std::make_shared<SampleContacts>());
  s.state.q << 0.3, -0.2, 0.1, 0.2;
  s.state.v << 0.5, 0.4, -0.6, 0.3;
  return s;
}

EffectUse useOf(const Scene& s, Effect effect) {
  return effectUse(s.model, *s.data)[static_cast<std::size_t>(effect)];
}

TEST(Plan, AbsentEffectHasNoRowsNoBytesAndNoCalls) {
  Scene bare = moving(bareChain());
  bare.steps(10);
  for (const EffectName& e : kEffectNames) {
    if (e.effect == Effect::coriolis) continue;
    const EffectUse use = useOf(bare, e.effect);
    EXPECT_EQ(use.calls, 0) << e.name;
    EXPECT_EQ(use.rows, 0) << e.name;
    EXPECT_EQ(use.bytes, 0u) << e.name;
  }
  EXPECT_EQ(useOf(bare, Effect::coriolis).calls, 10);  // once a step
  EXPECT_TRUE(bare.data->plan.rows.empty());
}

// The memory of collision is counted with contacts: it is there with pairs, and without any there
// is none.
TEST(Plan, CollisionWithoutPairsHoldsNothing) {
  ModelBuilder builder = bareChain();
  builder.geometry(groundSpec(1.0));
  for (const char* link : {"link1", "link2", "link3"})
    builder.geometry(geometrySpec(link, Shape::sphere(0.1)));
  for (const bool on : {false, true}) {
    if (!on) builder.options.effects.remove(Effect::groundContact);
    if (!on) builder.options.effects.remove(Effect::selfCollision);
    if (on) builder.options.effects = EffectSet::all();
    const Model model = builder.build();
    const collision::SceneContacts contacts(model);
    const Data data(model);
    EXPECT_EQ(contacts.bytes() > 0, on);
    EXPECT_EQ(contacts.mayTouch(), on);
    const EffectUse use =
        effectUse(model, data, &contacts)[static_cast<std::size_t>(Effect::groundContact)];
    EXPECT_EQ(use.bytes > 0, on);
  }
}

// Each alone is called once a step, the others stay at nothing; switched off it is nothing again,
// and the motion is that of the bare chain bit for bit.
TEST(Plan, CalledEffectAloneIsCalled) {
  Scene bare = moving(bareChain());
  bare.steps(10);
  for (const EffectCase& c : cases()) {
    ModelBuilder with = bareChain();
    c.call(with);
    Scene on = moving(with);
    on.steps(10);
    const std::string name(effectName(c.effect));
    EXPECT_GE(useOf(on, c.effect).calls, 10) << name;
    EXPECT_GT(useOf(on, c.effect).bytes, 0u) << name;
    if (c.rows) {
      EXPECT_GT(useOf(on, c.effect).rows, 0) << name;
    }
    for (const EffectCase& other : cases()) {
      if (other.effect == c.effect) continue;
      EXPECT_EQ(useOf(on, other.effect).calls, 0) << effectName(other.effect) << " by " << name;
      EXPECT_EQ(useOf(on, other.effect).bytes, 0u) << effectName(other.effect) << " by " << name;
    }
    EXPECT_NE(hash(on.state), hash(bare.state)) << name << " does nothing";

    with.options.effects.remove(c.effect);
    Scene off = moving(with);
    off.steps(10);
    EXPECT_EQ(useOf(off, c.effect).calls, 0) << name;
    EXPECT_EQ(useOf(off, c.effect).bytes, 0u) << name;
    EXPECT_EQ(hash(off.state), hash(bare.state)) << name;
  }
}

// A range that is not reached is looked at, and makes no row; the solve is that without ranges.
TEST(Plan, IdleLimitMakesNoRow) {
  ModelBuilder builder = bareChain();
  onJoint(builder, [](JointSpec& j) { limit(j, -1.0); });
  Scene idle = moving(builder), bare = moving(bareChain());
  idle.steps(10);
  bare.steps(10);
  EXPECT_EQ(useOf(idle, Effect::jointLimit).calls, 11);  // once when the data were made
  EXPECT_EQ(idle.data->stats.rows, 0);
  EXPECT_EQ(idle.data->stats.iterations, 0);
  EXPECT_EQ(hash(idle.state), hash(bare.state));
}

// A distance of exactly the margin makes no row: the test is strict.
TEST(Plan, RowsBeginBelowTheMargin) {
  ModelBuilder builder = bareChain();
  onJoint(builder, [](JointSpec& j) { limit(j, 0.125); });
  Scene s = moving(builder);
  s.state.v.setZero();
  s.state.q[2] = 0.125;
  s.stages();
  EXPECT_EQ(s.data->stats.rows, 0);
  s.state.q[2] = std::nextafter(0.125, 0.0);
  s.stages();
  EXPECT_EQ(s.data->stats.rows, 1);
}

TEST(Plan, ContactKindsFollowTheSurfaces) {
  const auto planned = [](double mu, int condim, Cone cone) {
    ModelBuilder builder = sphereOnPlane(0.1, 1.0, mu);
    builder.options.cone = cone;
    Model model = builder.build();
    for (Geometry& g : model.geometries) g.material.condim = condim;
    return Plan(model).rows;
  };
  const RowKinds pyramid = RowKinds::none().with(RowKind::pyramid);
  const RowKinds cone = RowKinds::none().with(RowKind::ellipticCone);
  EXPECT_EQ(planned(0.5, 3, Cone::pyramidal), pyramid);
  EXPECT_EQ(planned(0.5, 3, Cone::elliptic), cone);
  EXPECT_EQ(planned(0.0, 3, Cone::elliptic), pyramid);  // one row each, along the normal
  EXPECT_EQ(planned(0.5, 1, Cone::elliptic), pyramid);

  // Frictionless: one row, not four.
  for (const double mu : {0.0, 0.5}) {
    Scene s(sphereOnPlane(0.1, 1.0, mu).build(), std::make_shared<SampleContacts>());
    s.state.q[2] = 0.0999;
    s.stages();
    EXPECT_EQ(s.data->stats.contacts, 1);
    EXPECT_EQ(s.data->stats.rows, mu == 0.0 ? 1 : 4);
  }
}

// One surface with condim 3 and no coefficient against one with a coefficient and condim 1 rub:
// the mix takes the larger of both.
TEST(Plan, MixedSurfacesMayRubWhereNeitherDoesAlone) {
  ModelBuilder builder = sphereOnPlane(0.1, 1.0, 0.0);
  builder.options.cone = Cone::elliptic;
  Model model = builder.build();
  model.geometries[0].material.slidingFriction = 1.0;
  model.geometries[0].material.condim = 1;
  EXPECT_TRUE(Plan(model).rows.has(RowKind::ellipticCone));
}

// Without what may turn there are no Coriolis forces, and no pass for them.
TEST(Plan, SlidersHaveNoCoriolisForces) {
  ModelBuilder builder("slider");
  builder.link(emptyLink("world")).link(boxLink("cart", 1.0, {0.1, 0.1, 0.1}));
  builder.joint(jointSpec("rail", JointType::prismatic, "world", "cart", {}, Vector3::UnitX()));
  builder.options.gravity.setZero();
  Scene s(builder.build());
  s.state.v[0] = 1.0;
  s.steps(10);
  EXPECT_FALSE(s.data->plan.coriolis);
  EXPECT_EQ(useOf(s, Effect::coriolis).calls, 0);
  EXPECT_EQ(useOf(s, Effect::coriolis).bytes, 0u);
  EXPECT_SMALL(s.state.q[0] - 10 * 0.002, 1e-15);  // ten additions
}

// A free body about its centre and principal axes needs no factor; the result is that of the
// dense equations.
TEST(Plan, DiagonalMassMatrixIsDividedBy) {
  const auto box = [](const Vector3& com) {
    ModelBuilder builder = freeBody(boxLink("body", 2.0, {0.1, 0.2, 0.3}, com));
    Scene s(builder.build());
    s.state.v << 0.1, 0.2, 0.3, 3.0, -2.0, 1.0;
    return s;
  };
  EXPECT_FALSE(box({0.01, 0, 0}).data->plan.anyDiagonal);
  Scene s = box(Vector3::Zero());
  ASSERT_TRUE(s.data->plan.allDiagonal);
  s.stages();
  ASSERT_EQ(s.forward(), SolveStatus::converged);
  EXPECT_FALSE(s.data->bodies.massFactored);
  const VectorX a = s.data->inertia.M.dense().llt().solve(s.data->forces.net);
  // Off the diagonal M has rounding: a few units in the last place of the accelerations.
  EXPECT_APPROX(s.data->forward.a, a, 1e-13);
}

// Without a pair that may touch the source is never asked.
TEST(Plan, SourceWithoutPairsIsNotAsked) {
  class Silent final : public ContactSource {
   public:
    Silent() { mayTouch_ = false; }
    void detect(const Model&, const Kinematics&, ContactSet&) noexcept override { ++asked; }
    int asked = 0;
  };
  const auto source = std::make_shared<Silent>();
  Scene s(sphereOnPlane(0.1, 1.0, 1.0).build(), source);
  s.steps(3);
  EXPECT_EQ(source->asked, 0);
  EXPECT_EQ(s.data->contacts.detections, 0);
}

TEST(Plan, BuildsMayBeWithoutEffects) {
  constexpr EffectSet some = allEffectsBut("damping,joint_limit");
  for (const EffectName& e : kEffectNames)
    EXPECT_EQ(some.has(e.effect), e.effect != Effect::damping && e.effect != Effect::jointLimit);
  EXPECT_EQ(allEffectsBut(""), EffectSet::all());
  // This one has them all.
  EXPECT_EQ(kBuiltEffects, EffectSet::all());
  EXPECT_EQ(kBuiltRows, RowKinds::all());
}

TEST(Plan, KnowsWhenTheModelsOptionsHaveChanged) {
  Model model = bareChain().build();
  const Plan plan(model);
  EXPECT_TRUE(plan.fits(model));
  model.options.effects.remove(Effect::coriolis);
  EXPECT_FALSE(plan.fits(model));
}

TEST(Plan, ReadsNoClockUnlessAsked) {
  Scene s(bareChain().build());
  const auto spent = [&] {
    s.steps(10);
    const StepTimes& t = s.data->stats.times;
    return t.kinematics + t.collision + t.rows + t.solve + t.integrate;
  };
  EXPECT_EQ(spent(), 0.0);
  s.data->timed = true;
  EXPECT_GT(spent(), 0.0);
}

}  // namespace
}  // namespace softgauss::test
