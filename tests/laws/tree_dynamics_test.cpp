// SPDX-License-Identifier: Apache-2.0
/// Laws of a kinematic tree without constraints, on random forests of every joint kind.

#include <Eigen/Cholesky>

#include "softgauss/engine/dynamics/tree_acceleration.hpp"
#include "tests/laws/law_measures.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

constexpr int kForests = 40;

// Condition numbers of these mass matrices reach 1e5; an inverse loses that many of 16 digits.
constexpr double kTreeTolerance = 1e-11;

VectorX treeTorque(const Scene& s, const VectorX& vdot) {
  RneaWorkspace work(s.model);
  VectorX tau(s.model.nv);
  inverseDynamicsTree(s.model, s.data->kinematics, s.data->inertia, vdot, work, tau);
  return tau;
}

VectorX abaAcceleration(const Scene& s, const VectorX& tau) {
  TreeAcceleration aba(s.model);
  const EffectSet& effects = s.model.options.effects;
  VectorX angle = VectorX::Zero(s.model.nv), vdot(s.model.nv);
  for (const Body& body : s.model.bodies)
    if (body.dofs == 1) angle[body.v] = s.state.q[body.q];
  for (const Tree& tree : s.model.trees) {
    aba.take(s.model, tree);
    aba.compute(
        {s.data->kinematics.X_WB[tree.rootBody].R, angle.data(), s.state.v.data(), tau.data(),
         effects.has(Effect::gravity) ? s.model.options.gravity : Vector3::Zero(),
         effects.has(Effect::coriolis)},
        vdot.data());
  }
  return vdot;
}

TEST(Rnea, InvertsAba) {
  for (int seed = 0; seed < kForests; ++seed) {
    const Scene s = randomScene(seed, 0);
    const VectorX tau = s.input.tau;
    EXPECT_APPROX(treeTorque(s, abaAcceleration(s, tau)), tau, kTreeTolerance) << "seed " << seed;
  }
}

TEST(Aba, InvertsRnea) {
  for (int seed = 0; seed < kForests; ++seed) {
    const Scene s = randomScene(seed, 0);
    Random random(seed);
    const VectorX vdot = random.vector(s.model.nv, 10.0);
    EXPECT_APPROX(abaAcceleration(s, treeTorque(s, vdot)), vdot, kTreeTolerance) << "seed " << seed;
  }
}

TEST(Crba, ColumnIsRneaOfUnitAcceleration) {
  for (int seed = 0; seed < kForests; ++seed) {
    const Scene s = inContinuousTime(randomScene(seed, 0));
    const int n = s.model.nv;
    MatrixX M(n, n);
    const VectorX bias = treeTorque(s, VectorX::Zero(n));
    for (int i = 0; i < n; ++i) M.col(i) = treeTorque(s, VectorX::Unit(n, i)) - bias;
    // Differences of O(100) numbers: 1e-14 of them is rounding.
    EXPECT_APPROX(s.data->inertia.M.dense(), M, 1e-12) << "seed " << seed;
  }
}

TEST(Crba, MassMatrixIsPositiveDefinite) {
  for (int seed = 0; seed < kForests; ++seed) {
    const Scene s = randomScene(seed, 0);
    const Eigen::LLT<MatrixX> llt(s.data->inertia.M.dense());
    EXPECT_EQ(llt.info(), Eigen::Success) << "seed " << seed;
  }
}

TEST(Bias, IsRneaAtZeroAcceleration) {
  for (int seed = 0; seed < kForests; ++seed) {
    const Scene s = randomScene(seed, 0);
    EXPECT_APPROX(s.data->forces.bias, treeTorque(s, VectorX::Zero(s.model.nv)), 1e-13)
        << "seed " << seed;
  }
}

// M v̇ + b = τ is the rate of the generalised momentum p = M v less the gradient of the
// Lagrangian: d/dt (M v) − ∂T/∂q + ∂V/∂q = τ. It knows nothing of spatial algebra. In coordinates
// where v is not q̇ it needs extra terms, so trees without floating joints are used.
TEST(Rnea, IsLagrangesEquation) {
  for (int seed = 0; seed < kForests; ++seed) {
    RandomTreeOptions options;
    options.trees = 2;
    Random random(seed);
    Scene s = inContinuousTime(Scene(randomForest(seed, options).build()));
    s.state = randomState(s.model, random);
    const int first = s.model.trees[1].firstDof, n = s.model.nv - first;
    s.state.v.head(first).setZero();
    s.stages();
    VectorX a = random.vector(s.model.nv, 3.0);
    a.head(first).setZero();

    Scene probe(s.model);
    const auto momentum = [&](const State& state) {
      probe.state = state;
      probe.stages();
      VectorX p = VectorX::Zero(s.model.nv);
      probe.data->inertia.M.multiply(state.v, p);
      return p;
    };
    const auto lagrangian = [&](const VectorX& q) {
      probe.state = s.state;
      probe.state.q = q;
      computeKinematics(s.model, probe.state, probe.data->kinematics);
      const Energy e = computeEnergy(s.model, probe.data->kinematics, s.state.q, s.state.v);
      return VectorX(VectorX::Constant(1, e.kinetic - e.potential));
    };
    const VectorX tau = alongTrajectory(s.model, s.state, a, momentum) -
                        configurationGradient(s.model, s.state.q, lagrangian).transpose();
    // Central differences with ε = 1e-6 of energies of O(100): 1e-8.
    EXPECT_APPROX(treeTorque(s, a).tail(n), tau.tail(n), 3e-8) << "seed " << seed;
  }
}

TEST(Forward, EqualsAbaWithoutConstraints) {
  for (int seed = 0; seed < kForests; ++seed) {
    RandomTreeOptions options;
    options.ranges = false;
    Scene s = inContinuousTime(randomScene(seed, 0, options));
    ASSERT_EQ(s.data->stats.rows, 0);
    EXPECT_EQ(s.forward(), SolveStatus::converged);
    // τ − c without the bias, which the articulated-body algorithm adds itself.
    const VectorX tau = s.data->forces.net + s.data->forces.bias;
    EXPECT_APPROX(s.data->forward.a, abaAcceleration(s, tau), kTreeTolerance) << "seed " << seed;
  }
}

TEST(ExternalWrench, IsJacobianTransposeTimesForce) {
  for (int seed = 0; seed < kForests; ++seed) {
    Scene s = randomScene(seed, 0);
    VectorX expected = s.data->forces.bias;
    for (int i = 0; i < s.model.nv; ++i) expected[i] += s.model.dofs[i].damping * s.state.v[i];
    Eigen::Matrix<double, 3, Eigen::Dynamic> Jp(3, s.model.nv), Jr(3, s.model.nv);
    for (const ExternalWrench& w : s.input.wrenches) {
      const Kinematics& k = s.data->kinematics;
      pointJacobian(s.model, k, w.body, k.X_WB[w.body].p, Jp);
      rotationJacobian(s.model, k, w.body, Jr);
      expected -= Jp.transpose() * w.F_Bo_W.force + Jr.transpose() * w.F_Bo_W.moment;
    }
    EXPECT_APPROX(s.data->forces.c, expected, 1e-13) << "seed " << seed;
    EXPECT_APPROX(s.data->forces.net, s.input.tau - expected, 1e-13) << "seed " << seed;
  }
}

}  // namespace
}  // namespace softgauss::test
