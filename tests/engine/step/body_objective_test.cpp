// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/body_objective.hpp"

#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/inverse.hpp"
#include "softgauss/engine/step/step.hpp"
#include "tests/support/gauss_objective.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// lawScene(), couplings of joints included.
Scene bodyScene(std::uint64_t seed, Cone cone) {
  Scene s = lawScene(seed, 1 + static_cast<int>(seed % 12));
  s.model.options.cone = cone;
  s.data = std::make_unique<Data>(s.model);
  EXPECT_EQ(s.stages(), SolveStatus::converged);
  return s;
}

/// Forces of all rows.
VectorX rowForces(const Constraints& rows) {
  VectorX f(rows.rowCount());
  Eigen::Index row = 0;
  rows.visit([&](const auto& c) {
    for (const double force : c.f) f[row++] = force;
  });
  return f;
}

struct Solve {
  VectorX a, forces;
  int iterations = 0;
};

/// By matrices and on bodies.
std::pair<Solve, Solve> solveBoth(Cone cone, std::uint64_t seed,
                                  double tolerance = Options{}.tolerance) {
  Scene s = bodyScene(seed, cone);
  s.model.options.tolerance = tolerance;
  Solve matrices, bodies;
  const NewtonReport report = minimizeGauss(s.model, *s.data, matrices.a);
  EXPECT_EQ(report.status, SolveStatus::converged) << "seed " << seed;
  matrices.iterations = report.iterations;
  matrices.forces = rowForces(s.data->constraints);
  EXPECT_EQ(forwardDynamics(s.model, nullptr, *s.data), SolveStatus::converged) << "seed " << seed;
  bodies.a = s.data->forward.a;
  bodies.iterations = s.data->forward.report.iterations;
  bodies.forces = rowForces(s.data->constraints);
  return {matrices, bodies};
}

/// Both solves end where the scaled gradient is 10⁻¹²: forces of stiff rows agree as closely as
/// that says. Rounding decides whether the last step is within the tolerance, so single scenes may
/// take a step more or less; together they take as many.
void compareAll(Cone cone) {
  int iterations = 0, onBodies = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto [matrices, bodies] = solveBoth(cone, seed);
    EXPECT_APPROX(bodies.a, matrices.a, 1e-12) << "seed " << seed;
    EXPECT_APPROX(bodies.forces, matrices.forces, 1e-11) << "seed " << seed;
    iterations += matrices.iterations, onBodies += bodies.iterations;
  }
  EXPECT_SMALL(onBodies - iterations, 0.02 * iterations);
}

TEST(BodyObjective, SolvesAsMatricesDo) { compareAll(Cone::pyramidal); }

TEST(BodyObjective, SolvesEllipticConesAsMatricesDo) { compareAll(Cone::elliptic); }

// Both end closer to the minimum than by default, whose tolerance leaves 12 of these scenes
// further apart, by up to 1.7e-11.
TEST(BodyObjectiveLong, HasTheMinimumOfMatricesInTenThousandScenes) {
  for (std::uint64_t seed = 0; seed < 10000; ++seed) {
    const auto [matrices, bodies] =
        solveBoth(seed % 2 == 0 ? Cone::pyramidal : Cone::elliptic, seed, 1e-14);
    EXPECT_APPROX(bodies.a, matrices.a, 1e-12) << "seed " << seed;
    EXPECT_APPROX(bodies.forces, matrices.forces, 1e-11) << "seed " << seed;
  }
}

TEST(BodyObjective, HasTheGradientOfMatrices) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Scene s = bodyScene(seed, Cone::pyramidal);
    Random random(seed);
    const VectorX a = random.vector(s.model.nv, 10.0);
    s.data->bodies.divide(s.model, s.data->inertia, s.data->active, s.data->constraints);
    VectorX g(s.model.nv);
    for (int i = 0; i < s.data->bodies.islands.size(); ++i) {
      BodyObjective objective(s.model, *s.data, i);
      objective.moveTo(a);
      objective.gradient(g);
    }
    s.data->constraints.selectAll();
    VectorX expected = s.data->inertia.hat().dense() * a - s.data->forces.net;
    bool changed = false;
    s.data->constraints.setResidual(a);
    s.data->constraints.evaluate(changed);
    VectorX force = VectorX::Zero(s.model.nv);
    s.data->constraints.addForce(force);
    EXPECT_APPROX(g, expected - force, 1e-12) << "seed " << seed;
    VectorX tau;
    inverseDynamics(s.model, a, *s.data, tau);
    EXPECT_APPROX(tau, g + s.data->forces.net + s.data->forces.c, 1e-12) << "seed " << seed;
  }
}

// Forward and inverse dynamics need neither M nor J.
TEST(BodyStages, HaveWhatForwardAndInverseDynamicsNeed) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Scene s = bodyScene(seed, seed % 2 == 0 ? Cone::pyramidal : Cone::elliptic);
    ASSERT_EQ(forwardDynamics(s.model, nullptr, *s.data), SolveStatus::converged);
    const VectorX a = s.data->forward.a;
    Random random(seed);
    const VectorX wished = a + random.vector(s.model.nv, 10.0);
    VectorX tau, onBodies;
    inverseDynamics(s.model, wished, *s.data, tau);
    TreeMatrix P;
    EXPECT_TRUE(inverseDynamicsJacobian(*s.data, P));
    ASSERT_EQ(computeBodyStages(s.model, s.input, s.state, *s.data, s.contacts.get()),
              SolveStatus::converged);
    inverseDynamics(s.model, wished, *s.data, onBodies);
    EXPECT_APPROX(onBodies, tau, 1e-12) << "seed " << seed;
    EXPECT_FALSE(inverseDynamicsJacobian(*s.data, P));
    ASSERT_EQ(forwardDynamics(s.model, nullptr, *s.data), SolveStatus::converged);
    EXPECT_APPROX(s.data->forward.a, a, 1e-12) << "seed " << seed;
  }
}

}  // namespace
}  // namespace softgauss::test
