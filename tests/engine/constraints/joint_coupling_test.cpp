// SPDX-License-Identifier: Apache-2.0
/// Couplings: screws, gears, fingers and chains of them, against statics and against a model in
/// which the follower is substituted.

#include "softgauss/engine/constraints/joint_coupling.hpp"

#include <cmath>
#include <sstream>

#include "softgauss/engine/constraints/impedance.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

constexpr double kSteps[] = {0.0005, 0.002, 0.005, 0.01};
constexpr Integrator kIntegrators[] = {Integrator::semiImplicitEuler, Integrator::leapfrog};

template <class F>
void forEachSetting(F&& f) {
  for (const Integrator integrator : kIntegrators)
    for (const double timestep : kSteps) {
      std::ostringstream name;
      name << integratorName(integrator) << ", " << timestep << " s";
      const testing::ScopedTrace trace(__FILE__, __LINE__, name.str());
      f(integrator, timestep);
    }
}

/// A joint on the world that moves a ball of this mass and central inertia.
void addJoint(ModelBuilder& builder, const std::string& name, JointType type, double mass,
              double inertia, const Vector3& axis = Vector3::UnitZ()) {
  LinkSpec link = sphereLink(name + "_link", mass, 0.1);
  link.I_Lcm = inertia * Matrix3::Identity();
  builder.link(link);
  builder.joint(jointSpec(name, type, "world", name + "_link", {}, axis));
}

void couple(ModelBuilder& builder, const std::string& follower, const std::string& leader,
            double multiplier, double offset = 0.0) {
  CouplingSpec spec;
  spec.follower = follower;
  spec.leader = leader;
  spec.polynomial = {offset, multiplier, 0.0, 0.0, 0.0};
  builder.couple(spec);
}

ModelBuilder empty(Integrator integrator, double timestep) {
  ModelBuilder builder("coupled");
  builder.options.integrator = integrator;
  builder.options.timestep = timestep;
  builder.link(emptyLink("world"));
  return builder;
}

double q(const Scene& s, const std::string& joint) {
  return s.state.q[s.model.bodies[s.model.findJoint(joint)].q];
}
int dof(const Model& model, const std::string& joint) {
  return model.bodies[model.findJoint(joint)].v;
}

/// |r| at which a row of the default impedance and of this A holds the force f: D k d |r| = f.
double givesWay(double force, double A, double timestep) {
  double low = 0.0, high = 1e3;
  for (int i = 0; i < 200; ++i) {
    const double r = 0.5 * (low + high);
    const Softness s = softnessAt({}, r, A, timestep);
    (s.stiffness * r / s.R < force ? low : high) = r;
  }
  return high;
}

/// A nut of 1 kg on a screw of this lead [m/rad] in its own statics: the torque m g × lead. Off by
/// what the row gives way under the weight; the two move as one meanwhile.
void screw(double lead, double inertia, Integrator integrator, double timestep) {
  ModelBuilder builder = empty(integrator, timestep);
  addJoint(builder, "turn", JointType::continuous, 0.2, inertia);
  addJoint(builder, "lift", JointType::prismatic, 1.0, 0.01);
  couple(builder, "lift", "turn", lead);
  Scene s(builder.build());
  s.input.tau[dof(s.model, "turn")] = 9.81 * lead;
  s.steps(static_cast<int>(1.0 / timestep));
  const double feels = 1.0 + lead * lead / inertia;  // diagonal: W is what the two sides feel
  const double carries = std::max(3e3 / feels, 1.0);
  const double off = givesWay(9.81, std::min(feels, 1.0 / carries), timestep);
  EXPECT_LT(off, 0.4e-3);  // m
  // What the integrator has left of the way down is less than a tenth of that, or a nanometre.
  EXPECT_SMALL(q(s, "lift") - lead * q(s, "turn") + off, 0.1 * off + 1e-9);
  EXPECT_SMALL(q(s, "lift"), 0.5e-3);
}

TEST(Coupling, ScrewHoldsItsNutByItsStatics) {
  for (const double lead : {1e-3, 1e-2, 0.1, 1.0, 10.0, 1e3, -0.01})
    for (const double inertia : {1e-6, 1e-4, 1e-2}) {
      std::ostringstream name;
      name << lead << " m/rad, " << inertia << " kg m²";
      SCOPED_TRACE(name.str());
      forEachSetting([&](Integrator integrator, double timestep) {
        screw(lead, inertia, integrator, timestep);
      });
    }
}

// Fingers that turn against each other, pressed together by twice what one of them takes.
TEST(Coupling, LightFingersStayAlike) {
  for (const double inertia : {1e-6, 1e-5, 1e-4, 1e-2})
    for (const double torque : {0.5, 5.0})
      forEachSetting([&](Integrator integrator, double timestep) {
        ModelBuilder builder = empty(integrator, timestep);
        addJoint(builder, "left", JointType::continuous, 0.05, inertia);
        addJoint(builder, "right", JointType::continuous, 0.05, inertia);
        couple(builder, "right", "left", -1.0);
        Scene s(builder.build());
        s.input.tau << torque, torque;  // the motor's 2 T, less T on each
        s.steps(static_cast<int>(1.0 / timestep));
        // 3000 times W = 2/I, (1 − d)/d = 1/9 and t_c² = 4 h² at least.
        const double tc = std::max(0.02, 2.0 * timestep);
        EXPECT_LT(std::abs(q(s, "left") + q(s, "right")),
                  torque * 2.0 / 3e3 / inertia * tc * tc / 9.0 * 1.01);
      });
}

/// Random couplings of a tree, and A of their rows by its definition.
TEST(Coupling, SoftnessIsThatOfWhatItsRowFeels) {
  for (int seed = 0; seed < 40; ++seed) {
    RandomTreeOptions options;
    options.equalities = true;  // one coupling with a leader, one without
    Scene s = randomScene(seed, 0, options);
    s.stages();
    const CouplingRows& rows = s.data->constraints.coupling;
    const MatrixX M = s.data->inertia.M.dense();
    const std::vector<double>& w = s.data->weights.dof;
    const JointCoupling &led = s.model.couplings[0], &alone = s.model.couplings[1];
    ASSERT_EQ(alone.leader, 0);
    const auto dofOf = [&](int body) { return s.model.bodies[body].v; };
    const int f = dofOf(led.follower), l = dofOf(led.leader), g = dofOf(alone.follower);
    const double slope = led.slope(s.state.q[s.model.bodies[led.leader].q]);
    const double m_f = M(f, f), m_l = M(l, l) / (slope * slope);
    const auto A = [](double feels, double load) { return std::min(feels, 1.0 / load); };
    const double expected[] = {
        A(w[f] + slope * slope * w[l], std::max(3e3 / (1.0 / m_f + 1.0 / m_l), m_f)),
        A(w[g], M(g, g))};
    for (int i = 0; i < 2; ++i)
      EXPECT_SMALL(1.0 / (rows.D[i] * rows.perInertia[i]) / expected[i] - 1.0, 1e-8);
  }
}

// A shaft and a heavy wheel by a gear are one joint with the wheel's inertia over the gear: the
// model with the coupling substituted. Both swing on a spring.
TEST(Coupling, GearedWheelSwingsAsTheModelWithTheWheelSubstituted) {
  for (const double gear : {1e-3, 0.1, -3.0, 100.0, 1e3})
    forEachSetting([&](Integrator integrator, double timestep) {
      const double inertia = 0.02, wheel = 0.3 / (gear * gear);
      const auto spring = [&](ModelBuilder& builder) {
        builder.findJoint("shaft")->stiffness = 5.0;
        builder.findJoint("shaft")->springReference = 1.0;
      };
      ModelBuilder geared = empty(integrator, timestep), alone = geared;
      addJoint(geared, "shaft", JointType::continuous, 1.0, inertia);
      addJoint(geared, "wheel", JointType::continuous, 1.0, wheel);
      couple(geared, "wheel", "shaft", gear);
      addJoint(alone, "shaft", JointType::continuous, 1.0, inertia + wheel * gear * gear);
      spring(geared), spring(alone);
      Scene s(geared.build()), t(alone.build());
      double worst = 0.0;
      for (int i = 0; i < static_cast<int>(3.0 / timestep); ++i) {
        s.step(), t.step();
        worst = std::max(worst, std::abs(q(s, "shaft") - q(t, "shaft")));
        worst = std::max(worst, std::abs(q(s, "wheel") / gear - q(t, "shaft")));
      }
      // The spring's 5 N m part them by 1/27000 t_c² of what they would make of either alone.
      EXPECT_SMALL(worst, 1e-3);
    });
}

// Each joint follows the one before, by ±½, ±2 and so on; a torque at one end holds one at the
// other, by the product of all.
TEST(Coupling, ChainHandsTorqueOn) {
  forEachSetting([&](Integrator integrator, double timestep) {
    ModelBuilder builder = empty(integrator, timestep);
    const std::vector<double> multipliers = {2.0, -0.5, 3.0, 0.1, -4.0};
    addJoint(builder, "joint0", JointType::continuous, 1.0, 1e-3);
    double product = 1.0;
    for (std::size_t i = 0; i < multipliers.size(); ++i) {
      const std::string name = "joint" + std::to_string(i + 1);
      addJoint(builder, name, JointType::continuous, 1.0, 1e-3);
      couple(builder, name, "joint" + std::to_string(i), multipliers[i], 0.1);
      product *= multipliers[i];
    }
    Scene s(builder.build());
    s.input.tau[0] = -product * 0.2;
    s.input.tau[5] = 0.2;
    s.steps(static_cast<int>(1.0 / timestep));
    for (std::size_t i = 0; i < multipliers.size(); ++i)
      EXPECT_SMALL(q(s, "joint" + std::to_string(i + 1)) - 0.1 -
                       multipliers[i] * q(s, "joint" + std::to_string(i)),
                   1e-4);
    EXPECT_SMALL(q(s, "joint0"), 1e-3);
  });
}

// A light leader at its stop bears the heavy one that follows it.
TEST(Coupling, LightLeaderAtItsStopBearsWhatFollows) {
  for (const double leader : {1.0, 0.01})
    forEachSetting([&](Integrator integrator, double timestep) {
      ModelBuilder builder = empty(integrator, timestep);
      addJoint(builder, "leader", JointType::prismatic, leader, 0.01);
      addJoint(builder, "follower", JointType::prismatic, 100.0, 0.01);
      couple(builder, "follower", "leader", 1.0);
      builder.findJoint("leader")->lower = 0.0;
      builder.findJoint("leader")->upper = 1.0;
      Scene s(builder.build());
      s.steps(static_cast<int>(1.0 / timestep));
      EXPECT_SMALL(q(s, "follower") - q(s, "leader"), 0.4e-3);
      EXPECT_SMALL(q(s, "leader"), 5.0 * 0.4e-3);
    });
}

}  // namespace
}  // namespace softgauss::test
