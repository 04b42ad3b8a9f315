// SPDX-License-Identifier: Apache-2.0
/// Input that does not fit the model is refused with what it is; the state stays as it was.
#include "softgauss/engine/step/bad_input.hpp"

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

Scene humanoidWith(Integrator integrator) {
  ModelBuilder builder = humanoid();
  builder.options.integrator = integrator;
  return Scene(builder.build());
}

/// A step, and the stages alone, refuse what `spoil` has done to a scene, and go on without it.
template <class Spoil>
void expectRefused(BadInputKind kind, double found, double expected, const std::string& said,
                   Spoil&& spoil) {
  using enum Integrator;
  for (const Integrator integrator :
       {leapfrog, semiImplicitEuler, implicit, implicitMidpoint, rungeKutta4, dormandPrince}) {
    Scene s = humanoidWith(integrator), untouched = humanoidWith(integrator);
    s.steps(3);
    untouched.steps(3);
    const State good = s.state;
    const Input input = s.input;
    spoil(s);
    const State bad = s.state;
    for (const SolveStatus status : {s.step(), s.stages()}) {
      EXPECT_EQ(status, SolveStatus::badInput) << said;
      const StepStats& stats = s.data->stats;
      EXPECT_EQ(stats.status, SolveStatus::badInput);
      EXPECT_EQ(stats.badInput.kind, kind);
      EXPECT_EQ(stats.badInput.found, found);
      EXPECT_EQ(stats.badInput.expected, expected);
      EXPECT_EQ(describe(s.model, stats.badInput), said);
      EXPECT_EQ(hash(s.state), hash(bad));
    }
    s.state = good;
    s.input = input;
    s.step();
    untouched.step();
    EXPECT_FALSE(s.data->stats.badInput) << "it goes on after a refusal";
    EXPECT_EQ(hash(s.state), hash(untouched.state));
  }
}

const Model& sample() {
  static const Model model = humanoid().build();
  return model;
}

std::string sizeText(const std::string& name, int found, int expected) {
  return name + ": found " + std::to_string(found) + " numbers, expected " +
         std::to_string(expected);
}

TEST(BadInput, OfAnotherSizeIsRefused) {
  const int nq = sample().nq, nv = sample().nv;
  expectRefused(BadInputKind::q, 3, nq, sizeText("State::q", 3, nq),
                [](Scene& s) { s.state.q.setZero(3); });
  expectRefused(BadInputKind::q, nq + 1, nq, sizeText("State::q", nq + 1, nq),
                [&](Scene& s) { s.state.q.setZero(nq + 1); });
  expectRefused(BadInputKind::v, nq, nv, sizeText("State::v", nq, nv),
                [&](Scene& s) { s.state.v.setZero(nq); });
  expectRefused(BadInputKind::v, 0, nv, sizeText("State::v", 0, nv),
                [](Scene& s) { s.state.v.resize(0); });
  expectRefused(BadInputKind::tau, nv - 6, nv, sizeText("Input::tau", nv - 6, nv),
                [&](Scene& s) { s.input.tau.setZero(nv - 6); });
  const int trees = static_cast<int>(sample().trees.size());
  expectRefused(BadInputKind::controlled, trees + 1, trees,
                sizeText("Input::controlled", trees + 1, trees),
                [&](Scene& s) { s.input.controlled.resize(static_cast<std::size_t>(trees) + 1); });
  expectRefused(BadInputKind::warmStart, 2, nv, sizeText("the warm start", 2, nv),
                [](Scene& s) { s.state.warmstart.a.setZero(2); });
  const int forces = 9 * static_cast<int>(sample().connections.size());
  expectRefused(BadInputKind::connectionForces, forces + 9, forces,
                sizeText("State::connectionForces", forces + 9, forces),
                [&](Scene& s) { s.state.connectionForces.setZero(forces + 9); });
  expectRefused(BadInputKind::a, 2, nv, sizeText("the acceleration a", 2, nv), [](Scene& s) {
    s.state.a.setZero(2);
    s.state.hasAcceleration = true;
  });
}

TEST(BadInput, ForceOnNoBodyIsRefused) {
  const int bodies = sample().bodyCount();
  for (const int body : {-1, bodies}) {
    const std::string said = "Input::wrenches[1]: found body " + std::to_string(body) +
                             ", expected 0 to " + std::to_string(bodies - 1);
    expectRefused(BadInputKind::wrench, body, bodies, said, [&](Scene& s) {
      s.input.wrenches = {{1, {}}, {body, {}}};
      for (ExternalWrench& w : s.input.wrenches) w.F_Bo_W = {Vector3::Zero(), Vector3::Zero()};
    });
  }
}

TEST(BadInput, QuaternionThatIsNoneIsRefused) {
  const std::string joint = " at joint '" + sample().jointNames[1] + "', expected length 1";
  expectRefused(BadInputKind::quaternion, 0.0, 1.0,
                "State::q: found the quaternion (0, 0, 0, 0)" + joint,
                [](Scene& s) { s.state.q.segment<4>(3).setZero(); });
  for (const double length : {0.0625, 16.0})  // powers of two: the length is exact
    expectRefused(
        BadInputKind::quaternion, length, 1.0,
        "State::q: found a quaternion of length " + std::string(length > 1 ? "16" : "0.0625") +
            joint,
        [&](Scene& s) { s.state.q.segment<4>(3) = Eigen::Vector4d(0.0, 0.0, length, 0.0); });
}

TEST(BadInput, QuaternionToldNamesItsDof) {
  Scene s = humanoidWith(Integrator::leapfrog);
  s.state.q.segment<4>(3).setZero();
  EXPECT_EQ(s.step(), SolveStatus::badInput);
  EXPECT_EQ(s.data->stats.badDof, 0);
}

// Rounding to two digits, or another length, leaves a rotation.
TEST(BadInput, QuaternionOfAnotherLengthIsARotation) {
  for (const double length : {0.125, 0.99, 1.01, 8.0}) {
    Scene s = humanoidWith(Integrator::leapfrog);
    s.state.q.segment<4>(3) *= length;
    EXPECT_EQ(s.step(), SolveStatus::converged) << length;
  }
}

// What is no number is told as before, also in a quaternion.
TEST(BadInput, NaNIsNotFinite) {
  Scene s = humanoidWith(Integrator::leapfrog);
  s.state.q[4] = kNaN;
  EXPECT_EQ(s.step(), SolveStatus::notFinite);
  EXPECT_FALSE(s.data->stats.badInput);
}

TEST(BadInput, OfForwardAndInverseDynamicsIsRefused) {
  Scene s = humanoidWith(Integrator::semiImplicitEuler);
  ASSERT_EQ(s.stages(), SolveStatus::converged);
  const VectorX three = VectorX::Zero(3);
  EXPECT_EQ(forwardDynamics(s.model, &three, *s.data), SolveStatus::badInput);
  EXPECT_EQ(s.data->stats.badInput.kind, BadInputKind::warmStart);
  EXPECT_EQ(s.data->stats.badInput.found, 3);
  ASSERT_EQ(s.stages(), SolveStatus::converged);
  VectorX tau = VectorX::Constant(s.model.nv, 7.0);
  EXPECT_EQ(inverseDynamics(s.model, three, *s.data, tau), SolveStatus::badInput);
  EXPECT_EQ(s.data->stats.badInput.kind, BadInputKind::a);
  EXPECT_EQ(s.data->stats.badInput.expected, s.model.nv);
  EXPECT_EQ(inverseDynamics(s.model, VectorX::Constant(s.model.nv, kNaN), *s.data, tau),
            SolveStatus::notFinite);
  EXPECT_TRUE((tau.array() == 7.0).all());
  EXPECT_EQ(inverseDynamics(s.model, VectorX::Zero(s.model.nv), *s.data, tau),
            SolveStatus::converged);
}

}  // namespace
}  // namespace softgauss::test
