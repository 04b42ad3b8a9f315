// SPDX-License-Identifier: Apache-2.0
/// Problems whose solution is a formula: no contacts, no limits, no boxes.

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// A fixed arm of seven hinges, every joint driven without a box, in a random state.
Scene armScene(Random& random) {
  Scene scene(chain(7).build());
  scene.state = randomState(scene.model, random);
  EXPECT_EQ(scene.stages(), SolveStatus::converged);
  return scene;
}

gdd::Reach randomReach(const Model& model, Random& random) {
  gdd::Reach reach(model, "link6", random.vector3(0.8), random.vector3(0.1));
  reach.weight = random.chance(0.5) ? 1.0 : random.uniform(0.1, 100.0);
  return reach;
}

/// The rows of `reach` from kinematics alone: J and a* − J̇ v.
void addDenseReach(GddScene& s, const gdd::Reach& reach) {
  const Kinematics& k = s.data().kinematics;
  const int body = s.model().frames[reach.frame].body;
  const Vector3 p = framePose(s.model(), k, reach.frame) * reach.p_FP;
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, s.dofs());
  pointJacobian(s.model(), k, body, p, J);
  const VectorX& v = s.scene.state.v;
  s.dense.A = J;
  s.dense.w = Vector3::Constant(reach.weight);
  s.dense.y = reach.stiffness * (reach.p_WTarget - p) - reach.damping * (J * v) -
              pointBiasAcceleration(s.model(), k, body, p);
}

// (12): a = (M + JᵀJ)⁻¹(Jᵀa* − c), here with the weight of the goal.
TEST(ClosedForm, FullyActuatedArmWithAReach) {
  double worst = 0.0;
  for (int seed = 0; seed < 100; ++seed) {
    Random random(seed);
    GddScene s(armScene(random));
    const gdd::Reach reach = randomReach(s.model(), random);
    reach.addCost({s.model(), s.scene.state, s.data()}, s.cost);
    addDenseReach(s, reach);
    const DenseGdd& d = s.dense;
    const MatrixX H = d.M + reach.weight * d.A.transpose() * d.A;
    const VectorX expected = H.llt().solve(reach.weight * d.A.transpose() * d.y - d.c);
    const VectorX& a = s.solve();
    EXPECT_EQ(s.report.status, gdd::GddStatus::converged);
    EXPECT_LE(s.report.iterations, 2);
    EXPECT_EQ(s.report.dualUpdates, 0);
    worst = std::max(worst, (a - expected).norm() / expected.norm());
  }
  EXPECT_SMALL(worst, 1e-12);
}

TEST(ClosedForm, FullyActuatedArmWithReachAndVirtualDamping) {
  double worst = 0.0;
  for (int seed = 0; seed < 100; ++seed) {
    Random random(seed + 1000);
    GddScene s(armScene(random));
    const gdd::Reach reach = randomReach(s.model(), random);
    gdd::VirtualDamping damping;
    damping.weight = random.uniform(0.01, 2.0);
    damping.rate = random.uniform(1.0, 20.0);
    const gdd::GoalContext context{s.model(), s.scene.state, s.data()};
    reach.addCost(context, s.cost);
    damping.addCost(context, s.cost);
    addDenseReach(s, reach);
    // (1 + α) M a + c + w Jᵀ(J a − y) + α β M v = 0
    const DenseGdd& d = s.dense;
    const MatrixX H = (1.0 + damping.weight) * d.M + reach.weight * d.A.transpose() * d.A;
    const VectorX expected = H.llt().solve(reach.weight * d.A.transpose() * d.y - d.c -
                                           damping.weight * damping.rate * (d.M * s.scene.state.v));
    worst = std::max(worst, (s.solve() - expected).norm() / expected.norm());
  }
  EXPECT_SMALL(worst, 1e-12);
}

/// min F(a) subject to (M a + c)_z = 0, by one linear system.
VectorX equalityConstrained(const DenseGdd& d, double& multiplierScale) {
  const int n = d.dofs();
  std::vector<int> z;
  for (int i = 0; i < n; ++i)
    if (d.lower[i] == d.upper[i]) z.push_back(i);
  const int m = static_cast<int>(z.size());
  MatrixX K = MatrixX::Zero(n + m, n + m);
  VectorX b(n + m);
  K.topLeftCorner(n, n) = d.M + d.goalHessian();
  b.head(n) = -d.c - d.goalGradient(VectorX::Zero(n));
  for (int i = 0; i < m; ++i) {
    K.row(n + i).head(n) = d.M.row(z[i]);
    K.col(n + i).head(n) = d.M.col(z[i]);
    b[n + i] = -d.c[z[i]];
  }
  const VectorX x = K.fullPivLu().solve(b);
  multiplierScale = m == 0 ? 0.0 : x.tail(m).cwiseAbs().maxCoeff();
  return x.head(n);
}

// An unactuated base and planar joints: g_z = 0 is a linear equality.
TEST(ClosedForm, UnderactuatedTreeSolvesItsKktSystem) {
  double worst = 0.0, worstForce = 0.0;
  int unfinished = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Random random(seed + 2000);
    ModelBuilder builder = randomFloatingTree(seed, true);
    builder.options.effects.remove(Effect::jointLimit);
    Scene scene(builder.build());
    scene.state = randomState(scene.model, random);
    ASSERT_EQ(scene.stages(), SolveStatus::converged);
    GddScene s(std::move(scene));
    ASSERT_EQ(s.dense.rows(), 0);
    s.addRandomGoals(random);
    s.solver->options.maxIterations = 50;  // what takes more meets its limits to 1e-8 alone
    double multiplierScale = 0.0;
    const VectorX expected = equalityConstrained(s.dense, multiplierScale);
    const VectorX& a = s.solve();
    unfinished += s.report.status != gdd::GddStatus::converged;
    if (s.report.status != gdd::GddStatus::converged) continue;
    worst = std::max(worst, (a - expected).norm() / expected.norm());
    worstForce = std::max(worstForce, s.dense.violation(a) / s.dense.c.cwiseAbs().maxCoeff());
  }
  // What the violation below comes to in a, through the smallest eigenvalue of M.
  EXPECT_SMALL(worst, 1e-7);
  // The solver's own tolerance on g_z, relative to the forces at work.
  EXPECT_SMALL(worstForce, 1e-9);
  // A goal of 1000 kg at a link of 0.4 kg outweighs the penalty: multipliers then converge slowly.
  EXPECT_LE(unfinished, 1);
}

}  // namespace
}  // namespace softgauss::test
