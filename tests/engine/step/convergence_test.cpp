// SPDX-License-Identifier: Apache-2.0
/// Integrators have the order that they are said to have, in position and in orientation.

#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/engine.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

/// Slope of log y over log x by least squares.
double fittedOrder(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// States after each quarter of the duration.
std::vector<State> run(ModelBuilder builder, const State& start, Integrator integrator,
                       double duration, int steps, StepStats* stats = nullptr) {
  builder.options.integrator = integrator;
  builder.options.timestep = duration / steps;
  const Model model = builder.build();
  Data data(model);
  State state = start;
  std::vector<State> quarters;
  for (int i = 0; i < steps; ++i) {
    EXPECT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
    if (stats) {
      stats->evaluations += data.stats.evaluations;
      stats->substeps += data.stats.substeps;
    }
    if (4 * (i + 1) % steps == 0) quarters.push_back(state);
  }
  return quarters;
}

/// A free body with a middle axis and two hinges that carry links: position, orientation and
/// joints, all coupled by Coriolis forces. In gravity.
ModelBuilder tumblingTree() {
  ModelBuilder builder = freeBody(boxLink("body", 1.0, {0.05, 0.1, 0.2}, {0.01, 0.02, 0.0}));
  builder.link(boxLink("arm", 0.5, {0.02, 0.02, 0.1}, {0, 0, -0.1}));
  builder.link(boxLink("hand", 0.3, {0.02, 0.03, 0.05}, {0, 0.02, -0.05}));
  builder.joint(jointSpec("shoulder", JointType::continuous, "body", "arm",
                          {Matrix3::Identity(), Vector3(0.05, 0, 0.1)}, Vector3::UnitY()));
  builder.joint(jointSpec("wrist", JointType::continuous, "arm", "hand",
                          {Matrix3::Identity(), Vector3(0, 0, -0.2)}, Vector3::UnitX()));
  return builder;
}

State tumblingStart(const Model& model) {
  State state(model);
  state.v << 0.3, -0.2, 0.5, 8.0, 12.0, 6.0, 9.0, -8.0;
  return state;
}

struct Difference {
  double position = 0.0, orientation = 0.0;
};

/// Root mean squares over the quarters, so that no error is small by chance of its sign.
Difference difference(const Model& model, const std::vector<State>& a,
                      const std::vector<State>& b) {
  Difference sum;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const VectorX d = positionDifference(model, a[i].q, b[i].q);
    sum.position += d.head<3>().squaredNorm() + d.tail<2>().squaredNorm();
    sum.orientation += d.segment<3>(3).squaredNorm();
  }
  return {std::sqrt(sum.position), std::sqrt(sum.orientation)};
}

/// Orders in position and orientation, fitted over the step sizes.
Difference orders(const ModelBuilder& builder, Integrator integrator,
                  const std::vector<int>& steps) {
  constexpr double kDuration = 0.5;
  const Model model = builder.build();
  const State start = tumblingStart(model);
  ModelBuilder ours = builder;
  ours.options.constraintModel = ConstraintModel::softgauss;
  const std::vector<State> exact = run(ours, start, Integrator::rungeKutta4, kDuration, 8192);
  std::vector<double> h, position, orientation;
  for (const int count : steps) {
    StepStats stats;
    const Difference d =
        difference(model, run(builder, start, integrator, kDuration, count, &stats), exact);
    if (integrator == Integrator::dormandPrince) {
      EXPECT_EQ(stats.substeps, count);
    }
    h.push_back(kDuration / count);
    position.push_back(d.position);
    orientation.push_back(d.orientation);
  }
  return {fittedOrder(h, position), fittedOrder(h, orientation)};
}

struct Case {
  Integrator integrator;
  double order;
  std::vector<int> steps;
  bool likeMujoco = false;
};

class Convergence : public testing::TestWithParam<Case> {};

// In 0.5 s the body turns by about 8 rad. 0.2: these step sizes are not yet the limit.
TEST_P(Convergence, OrderIsAsSaid) {
  const Case& c = GetParam();
  ModelBuilder builder = tumblingTree();
  builder.options.integrationTolerance = 1e3;  // no step is divided
  builder.options.substepAngle = kInfinity;
  builder.options.constraintModel =
      !c.likeMujoco ? ConstraintModel::softgauss : ConstraintModel::mujoco;
  const Difference order = orders(builder, c.integrator, c.steps);
  EXPECT_NEAR(order.position, c.order, 0.2);
  EXPECT_NEAR(order.orientation, c.order, 0.2);
}

INSTANTIATE_TEST_SUITE_P(
    Integrators, Convergence,
    testing::Values(Case{Integrator::semiImplicitEuler, 1.0, {1024, 2048, 4096, 8192}},
                    Case{Integrator::leapfrog, 2.0, {128, 256, 512, 1024}},
                    Case{Integrator::implicit, 1.0, {1024, 2048, 4096, 8192}},
                    Case{Integrator::implicitMidpoint, 2.0, {128, 256, 512, 1024}},
                    Case{Integrator::rungeKutta4, 4.0, {128, 256, 512, 1024}},
                    Case{Integrator::rungeKutta4, 2.0, {128, 256, 512, 1024}, true},
                    Case{Integrator::dormandPrince, 5.0, {128, 192, 256, 384, 512}}),
    [](const auto& instance) {
      std::string name(integratorName(instance.param.integrator));
      std::erase(name, '-');
      if (instance.param.likeMujoco) name += "LikeMujoco";
      return name;
    });

struct Smooth {
  std::string name;
  ModelBuilder builder;
  double torque = 0.0;
  int fewest = 32;  ///< steps in the second
};

/// Links of 0.2 m on hinges along y or, `crossed`, y and x in turn.
ModelBuilder hangingChain(int links, bool crossed, double damping) {
  ModelBuilder builder("chain");
  builder.link(emptyLink("world"));
  for (int i = 0; i < links; ++i) {
    const std::string name = "link" + std::to_string(i);
    builder.link(boxLink(name, 1.0, {0.02, 0.03, 0.1}, {0, 0, -0.1}));
    JointSpec hinge = jointSpec("joint" + std::to_string(i), JointType::continuous,
                                i == 0 ? "world" : "link" + std::to_string(i - 1), name,
                                {Matrix3::Identity(), Vector3(0, 0, i == 0 ? 0.0 : -0.2)},
                                crossed && i % 2 == 1 ? Vector3::UnitX() : Vector3::UnitY());
    hinge.damping = damping;
    builder.joint(hinge);
  }
  return builder;
}

// What a user gets by default: halving the step never makes the error larger, whoever follows the
// motion. 1e-12: rounding of what is followed in some hundred steps; 10 %: errors of unlike signs.
TEST(Leapfrog, ErrorFallsWithTheStep) {
  std::vector<Smooth> problems;
  for (const int links : {1, 2, 5, 20})
    problems.push_back({"chain of " + std::to_string(links), hangingChain(links, links > 5, 0.0)});
  problems.push_back({"tumbling tree", tumblingTree()});
  problems.push_back({"damped chain", hangingChain(5, true, 0.02)});
  problems.push_back({"driven chain", hangingChain(3, true, 0.02), 0.5, 128});
  for (Smooth& p : problems) {
    const Model model = p.builder.build();
    State start(model);
    const bool floats = model.bodies[1].joint == JointKind::floating;
    if (floats)
      start = tumblingStart(model);
    else
      for (int i = 0; i < model.nv; ++i) start.q[i] = i == 0 ? 1.2 : 0.1;
    Input input;
    input.tau = VectorX::Constant(model.nv, p.torque);
    const auto atEnd = [&](Integrator integrator, int steps) {
      p.builder.options.integrator = integrator;
      p.builder.options.timestep = 1.0 / steps;
      const Model m = p.builder.build();
      Data data(m);
      State state = start;
      for (int i = 0; i < steps; ++i)
        EXPECT_EQ(step(m, input, state, data, nullptr), SolveStatus::converged);
      return state;
    };
    const State exact = atEnd(Integrator::rungeKutta4, 16384);
    double before = kInfinity;
    for (int steps = p.fewest; steps <= 2048; steps *= 2) {
      const State end = atEnd(Integrator::leapfrog, steps);
      const double error = positionDifference(model, exact.q, end.q).norm();
      EXPECT_LE(error, 1.1 * before + 1e-11) << p.name << ", " << steps << " steps";
      before = error;
    }
    // Order 1 where damping is implicit in the solve, else what both leave of 1 s.
    EXPECT_LT(before, p.torque > 0.0 ? 1e-3 : 1e-9) << p.name;
  }
}

// Errors of the parts add up: at most the tolerance a step, and in this scene they stay below it.
TEST(RungeKutta, DormandPrinceKeepsItsTolerance) {
  ModelBuilder builder = tumblingTree();
  const Model model = builder.build();
  const State start = tumblingStart(model);
  const std::vector<State> exact = run(builder, start, Integrator::rungeKutta4, 0.5, 8192);
  int before = 0;
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    builder.options.integrationTolerance = tolerance;
    StepStats stats;
    const Difference d =
        difference(model, run(builder, start, Integrator::dormandPrince, 0.5, 4, &stats), exact);
    // Four steps, and Coriolis forces that spread an error by less than a factor of ten.
    EXPECT_LT(d.position, 50.0 * tolerance);
    EXPECT_LT(d.orientation, 50.0 * tolerance);
    EXPECT_GT(stats.substeps, before);
    before = stats.substeps;
  }
}

// A step that several stages make is still a function of the state alone.
TEST(Integrators, SameStateSameBits) {
  for (const IntegratorName& name : kIntegratorNames) {
    const Integrator integrator = name.integrator;
    const ModelBuilder builder = tumblingTree();
    const Model model = builder.build();
    const State start = tumblingStart(model);
    const State once = run(builder, start, integrator, 0.2, 40).back();
    const State half = run(builder, start, integrator, 0.1, 20).back();
    const State twice = run(builder, half, integrator, 0.1, 20).back();
    EXPECT_EQ(hash(once), hash(twice));
  }
}

// A state in which a later stage overflows is left as it was.
TEST(Integrators, AStepThatOverflowsLeavesTheState) {
  for (const IntegratorName& name : kIntegratorNames) {
    ModelBuilder builder = tumblingTree();
    builder.options.integrator = name.integrator;
    const Model model = builder.build();
    Data data(model);
    State state = tumblingStart(model);
    state.v[4] = 1e160;
    const std::uint64_t before = hash(state);
    EXPECT_EQ(step(model, {}, state, data, nullptr), SolveStatus::notFinite) << name.name;
    EXPECT_EQ(hash(state), before) << name.name;
  }
}

}  // namespace
}  // namespace softgauss::test
