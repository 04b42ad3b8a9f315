// SPDX-License-Identifier: Apache-2.0
/// Constraint rows are passive: nothing moves faster than what it had and what springs were given.
/// The spring and the damper of a row change at random from step to step, and rows begin and end.
/// What a harder spring is given is booked by its closed form, ½ K r², with K of the parameters and
/// of the inertia that the row moves; springs give back no more.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <string>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "tests/support/random.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

/// A row's law, as it is asked for.
struct Law {
  double stiffness, damping, impedance;  ///< [1/s²], [1/s], [-]

  Impedance asked() const {
    Impedance p;
    p.dMin = p.dMax = impedance;
    p.direct = ReferenceSpring{stiffness, damping};
    return p;
  }
  /// K of a row that moves an inverse inertia of 1/I. `rebounds`: kinds that give back what they
  /// took where their reference is less than half critically damped.
  /// `edges`: how much harder the edges of a friction pyramid are together than one row.
  double spring(double inertia, bool rebounds, double edges) const {
    const bool bounces = rebounds && damping * damping <= stiffness;
    return inertia * stiffness * (bounces ? 1.0 : edges / (1.0 - impedance));
  }
};

/// What is slow enough for the step: K up to 1/(4 h²), B up to 1/h. A step bounds what is faster.
Law randomLaw(Random& random, double h) {
  return {std::pow(10.0, random.uniform(-3.0, 0.0)) * 0.25 / (h * h),
          std::pow(10.0, random.uniform(-4.0, 0.0)) / h, random.uniform(0.05, 0.99)};
}

/// One row, or the rows of one constraint, and what it stores.
struct Kind {
  std::string name;
  std::function<Model(double timestep)> make;
  std::function<void(Model&, const Law&)> set;
  double inertia = 1.0;                         ///< of what the row moves [kg or kg m²]
  bool rebounds = false;                        ///< Law::spring()
  double edges = 1.0;                           ///< likewise
  bool begins = true;                           ///< and ends by itself
  std::function<double(const State&)> squares;  ///< r², 0 where the row is not
  std::function<void(State&, Random&)> push;    ///< a state in which it is
  double farthest = kInfinity;                  ///< r up to which that holds
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

class Passivity : public testing::TestWithParam<Kind> {};

Model finished(ModelBuilder builder, double timestep) {
  builder.options.gravity.setZero();
  builder.options.timestep = timestep;
  builder.options.integrator = Integrator::leapfrog;
  builder.options.substepAngle = kInfinity;  // parts of a step keep the rows' law of the start
  return builder.build();
}

double largestForce(const Data& data) {
  double largest = 0.0;
  data.constraints.visit([&](const auto& c) {
    for (const double f : c.f) largest = std::max(largest, std::abs(f));
  });
  return largest;
}

// 400 sequences of 200 steps each. 1e-9 is above the rounding of 200 sums.
TEST_P(Passivity, NothingComesInByARow) {
  const Kind& kind = GetParam();
  for (const double h : {0.0005, 0.002, 0.01}) {
    Random random(7);
    Model model = kind.make(h);
    Model without = model;
    without.options.effects.remove(Effect::equality);
    Data with(model), free(without);
    Kinematics kinematics(model);
    collision::SceneContacts contacts(model);
    double worst = 0.0;
    int held = 0;
    for (int run = 0; run < 400; ++run) {
      State state(model);
      kind.push(state, random);
      const auto motion = [&] {
        computeKinematics(model, state, kinematics);
        return computeEnergy(model, kinematics, state.q, state.v).kinetic;
      };
      bool on = true;
      double stored = 0.0, given = motion();
      for (int i = 0; i < 200 && kind.squares(state) < kind.farthest * kind.farthest; ++i) {
        if (!kind.begins && random.chance(0.1)) on = !on;
        const Law law = randomLaw(random, h);
        kind.set(model, law);
        const double K = on ? law.spring(kind.inertia, kind.rebounds, kind.edges) : 0.0;
        const auto spring = [&] { return 0.5 * K * kind.squares(state); };
        given += std::max(0.0, spring() - stored);
        const SolveStatus status = on ? step(model, {}, state, with, &contacts)
                                      : step(without, {}, state, free, &contacts);
        // Runs that are given much reach 10⁴ m/s: what is left is then rounding of their forces.
        ASSERT_TRUE(status == SolveStatus::converged ||
                    (on && with.stats.residual <= 1e-15 * largestForce(with)))
            << statusName(status) << ", residual " << with.stats.residual;
        held += on && with.stats.rows > 0;
        stored = spring();
        worst = std::max(worst, (motion() - given) / given);
      }
    }
    EXPECT_GT(held, 1000);
    EXPECT_LE(worst, 1e-9) << "more motion than was given, relative, with steps of " << h << " s";
  }
}

Kind limit() {
  Kind kind;
  kind.name = "Limit";
  kind.make = [](double h) {
    ModelBuilder builder = pendulum(0.5, 1.0, 0.05);
    JointSpec& joint = *builder.findJoint("hinge");
    joint.type = JointType::revolute;
    joint.lower = -0.1, joint.upper = 1e3;
    return finished(builder, h);
  };
  kind.set = [](Model& m, const Law& law) {
    for (JointRange& range : m.ranges) range.impedance = law.asked();
  };
  kind.inertia = 0.25 + 0.4 * 0.05 * 0.05;
  kind.squares = [](const State& s) { return std::pow(std::min(0.0, s.q[0] + 0.1), 2.0); };
  kind.push = [](State& s, Random& random) {
    s.q[0] = random.uniform(-0.2, -0.05), s.v[0] = random.uniform(-2.0, 2.0);
  };
  return kind;
}

Kind contact(Cone cone, double friction) {
  Kind kind;
  kind.name = std::string(cone == Cone::elliptic ? "Elliptic" : "Pyramidal") +
              (friction > 0.0 ? "Friction" : "Contact");
  kind.make = [=](double h) {
    ModelBuilder builder = sphereOnPlane(0.1, 2.0, friction);
    builder.options.cone = cone;
    return finished(builder, h);
  };
  kind.set = [](Model& m, const Law& law) {
    for (Geometry& g : m.geometries) g.material.impedance = law.asked();
  };
  kind.inertia = 2.0;
  kind.rebounds = true;
  // Four edges with R = 2 μ² (1 + μ²) of one row's.
  if (cone == Cone::pyramidal && friction > 0.0)
    kind.edges = 2.0 / (friction * friction * (1.0 + friction * friction));
  kind.squares = [](const State& s) { return std::pow(std::min(0.0, s.q[2] - 0.1), 2.0); };
  kind.push = [](State& s, Random& random) {
    s.q[2] = 0.1 + random.uniform(-0.01, 0.001);
    for (int i = 0; i < 6; ++i) s.v[i] = random.uniform(-2.0, 2.0);
  };
  return kind;
}

Kind connection() {
  Kind kind;
  kind.name = "Connection";
  kind.make = [](double h) {
    ModelBuilder builder = freeBody(sphereLink("body", 2.0, 0.1));
    ConnectSpec tie;
    tie.linkA = "body", tie.linkB = "world";
    builder.connect(tie);
    return finished(builder, h);
  };
  kind.set = [](Model& m, const Law& law) { m.connections[0].impedance = law.asked(); };
  kind.inertia = 2.0;
  kind.rebounds = true;
  kind.begins = false;
  kind.squares = [](const State& s) { return s.q.head<3>().squaredNorm(); };
  kind.push = [](State& s, Random& random) {
    s.q.head<3>() = random.vector3(0.1);
    s.v.head<3>() = random.vector3(2.0);
  };
  return kind;
}

/// Turned by θ, its rotational rows stretch by θ at most, and push back up to half a turn.
Kind weld() {
  constexpr double kSquareOfGyration = 0.4 * 0.1 * 0.1;
  Kind kind;
  kind.name = "Weld";
  kind.make = [](double h) {
    ModelBuilder builder = freeBody(sphereLink("body", 2.0, 0.1));
    WeldSpec tie;
    tie.linkA = "body", tie.linkB = "world";
    builder.weld(tie);
    return finished(builder, h);
  };
  kind.set = [](Model& m, const Law& law) { m.welds[0].impedance = law.asked(); };
  kind.inertia = 2.0;
  kind.rebounds = true;
  kind.begins = false;
  kind.squares = [](const State& s) {
    const double angle = 2.0 * std::atan2(s.q.segment<3>(4).norm(), std::abs(s.q[3]));
    return s.q.head<3>().squaredNorm() + kSquareOfGyration * angle * angle;
  };
  kind.push = [](State& s, Random& random) {
    s.q.head<3>() = random.vector3(0.05);
    s.v = random.vector(6, 2.0);
  };
  kind.farthest = 0.5 * M_PI * std::sqrt(kSquareOfGyration);
  return kind;
}

Kind coupling() {
  Kind kind;
  kind.name = "Coupling";
  kind.make = [](double h) {
    ModelBuilder builder("two wheels");
    builder.base = BaseKind::fixed;
    builder.link(emptyLink("stand"));
    builder.link(sphereLink("a", 1.0, 0.1)).link(sphereLink("b", 1.0, 0.2));
    for (const char* wheel : {"a", "b"})
      builder.joint(jointSpec(wheel, JointType::continuous, "stand", wheel));
    CouplingSpec mimic;
    mimic.follower = "b", mimic.leader = "a", mimic.polynomial = {0, 2, 0, 0, 0};
    builder.couple(mimic);
    return finished(builder, h);
  };
  kind.set = [](Model& m, const Law& law) { m.couplings[0].impedance = law.asked(); };
  kind.inertia = 1.0 / (4.0 / 0.004 + 1.0 / 0.016);  // J M⁻¹ Jᵀ of J = (−2, 1)
  kind.rebounds = true;
  kind.begins = false;
  kind.squares = [](const State& s) { return std::pow(s.q[1] - 2.0 * s.q[0], 2.0); };
  kind.push = [](State& s, Random& random) {
    s.q = random.vector(2, 0.1), s.v = random.vector(2, 2.0);
  };
  return kind;
}

/// Stores nothing.
Kind dryFriction() {
  Kind kind;
  kind.name = "DryFriction";
  kind.make = [](double h) {
    ModelBuilder builder = pendulum(0.5, 1.0, 0.05);
    builder.findJoint("hinge")->dryFriction = 0.5;
    return finished(builder, h);
  };
  kind.set = [](Model& m, const Law& law) { m.dofs[0].frictionImpedance = law.asked(); };
  kind.squares = [](const State&) { return 0.0; };
  kind.push = [](State& s, Random& random) { s.v[0] = random.uniform(-2.0, 2.0); };
  return kind;
}

INSTANTIATE_TEST_SUITE_P(OfRows, Passivity,
                         testing::Values(limit(), contact(Cone::pyramidal, 0.0),
                                         contact(Cone::pyramidal, 0.7),
                                         contact(Cone::elliptic, 0.0), contact(Cone::elliptic, 0.7),
                                         connection(), weld(), coupling(), dryFriction()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace softgauss::test
