// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/forward_derivative.hpp"

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/step.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

TEST(RightJacobian, IsTheDerivativeOfTheExponential) {
  Random random(1);
  for (const double angle : {0.0, 1e-3, 0.015, 0.025, 0.5, 2.0, 3.0}) {
    const Vector3 phi = angle * random.direction();
    const Quaternion back = quaternionExp(phi).conjugate();
    const MatrixX expected = gradient(
        phi, [&](const VectorX& x) { return VectorX(quaternionLog(back * quaternionExp(x))); });
    EXPECT_APPROX(rightJacobian(phi), expected, 1e-9) << angle;
  }
}

/// Trees on springs, soft and stiff, with smooth forces alone: no kinks.
Scene smoothScene(int seed) {
  RandomTreeOptions options;
  options.springs = true;
  options.ranges = options.geometries = false;
  Scene s = randomScene(seed, 0, options);
  s.model.options = StepDerivative::bareStep(s.model.options);
  s.model.options.timestep = 0.02;
  if (seed % 2 == 1)
    for (Dof& dof : s.model.dofs) dof.stiffness *= 1e5;
  s.data = std::make_unique<Data>(s.model);
  return s;
}

TEST(ForwardDerivative, IsThatOfForwardDynamics) {
  for (int seed = 0; seed < 20; ++seed) {
    Scene s = smoothScene(seed);
    const State state = s.state;
    const auto acceleration = [&](const VectorX& q, const VectorX& v, const VectorX& tau) {
      s.state.q = q, s.state.v = v, s.input.tau = tau;
      s.stages();
      s.forward();
      return VectorX(s.data->forward.a);
    };
    const VectorX tau = s.input.tau;
    const MatrixX q = configurationGradient(
        s.model, state.q, [&](const VectorX& x) { return acceleration(x, state.v, tau); });
    const MatrixX v =
        gradient(state.v, [&](const VectorX& x) { return acceleration(state.q, x, tau); });
    const MatrixX u =
        gradient(tau, [&](const VectorX& x) { return acceleration(state.q, state.v, x); });
    acceleration(state.q, state.v, tau);
    ForwardDerivative derivative(s.model);
    ASSERT_EQ(derivative.compute(s.model, s.input, s.state, nullptr, *s.data),
              SolveStatus::converged);
    // Accelerations of up to 1e5 m/s², with condition numbers of as much.
    EXPECT_APPROX(derivative.q(), q, 1e-6) << seed;
    EXPECT_APPROX(derivative.v(), v, 1e-6) << seed;
    EXPECT_APPROX(derivative.tau(), u, 1e-6) << seed;
  }
}

TEST(StepDerivative, IsThatOfTheStep) {
  for (int seed = 0; seed < 20; ++seed) {
    Scene s = smoothScene(seed);
    const State begin = s.state;
    const int n = s.model.nv;
    State end = begin;
    softgauss::step(s.model, s.input, end, *s.data, nullptr);
    const auto after = [&](const VectorX& q, const VectorX& v, const VectorX& tau) {
      State state = begin;
      state.q = q, state.v = v;
      Input input = s.input;
      input.tau = tau;
      softgauss::step(s.model, input, state, *s.data, nullptr);
      VectorX x(2 * n);
      x << positionDifference(s.model, end.q, state.q), state.v;
      return x;
    };
    const VectorX& tau = s.input.tau;
    MatrixX x(2 * n, 2 * n);
    x.leftCols(n) = configurationGradient(s.model, begin.q,
                                          [&](const VectorX& q) { return after(q, begin.v, tau); });
    x.rightCols(n) = gradient(begin.v, [&](const VectorX& v) { return after(begin.q, v, tau); });
    const MatrixX u = gradient(tau, [&](const VectorX& t) { return after(begin.q, begin.v, t); });
    StepDerivative derivative(s.model);
    ASSERT_EQ(derivative.compute(s.model, s.input, begin, nullptr, *s.data),
              SolveStatus::converged);
    EXPECT_APPROX(derivative.state(), x, 1e-6) << seed;
    EXPECT_APPROX(derivative.tau(), u, 1e-6) << seed;
    EXPECT_APPROX(derivative.acceleration(), (end.v - begin.v) / s.model.options.timestep, 1e-9);
  }
}

TEST(StepDerivative, RefusesAStepWithMoreStateThanItsOwn) {
  Scene s = randomScene(1, 0);
  StepDerivative derivative(s.model);
  EXPECT_THROW(derivative.compute(s.model, s.input, s.state, nullptr, *s.data), ModelError);
}

}  // namespace
}  // namespace softgauss::test
