// SPDX-License-Identifier: Apache-2.0
/// Connections, welds and joint couplings: distances, their Jacobians and accelerations.

#include "softgauss/engine/constraints/impedance.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/reference_solver.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// A random scene with equalities alone.
Scene equalities(std::uint64_t seed) {
  RandomTreeOptions options;
  options.equalities = true;
  options.ranges = false;
  Scene s = randomScene(seed, 0, options);
  return s;
}

/// Whether the welded bodies can turn against each other: else the weld has three rows.
bool turns(const Scene& s) {
  const Weld& weld = s.model.welds[0];
  const std::vector<double>& w = s.data->weights.rotation;
  return w[weld.bodyA] + w[weld.bodyB] > 0.0;
}

TEST(Weld, OfBodiesThatCannotTurnHasNoRotationRows) {
  int sliding = 0;
  for (int seed = 0; seed < 100; ++seed) {
    const Scene s = equalities(seed);
    sliding += !turns(s);
    EXPECT_EQ(s.data->stats.rows, turns(s) ? 11 : 8);
  }
  EXPECT_GT(sliding, 0);
}

/// The distances of all rows in a configuration, written down once more.
VectorX distances(const Model& model, const VectorX& q) {
  State state(model);
  state.q = q;
  Kinematics k(model);
  computeKinematics(model, state, k);
  std::vector<double> r;
  const auto append = [&](const Vector3& x) { r.insert(r.end(), x.begin(), x.end()); };
  for (const Connection& c : model.connections)
    append(k.X_WB[c.bodyA] * c.p_AP - k.X_WB[c.bodyB] * c.p_BP);
  for (const Weld& w : model.welds) {
    const Transform A = k.X_WB[w.bodyA] * w.X_AF, B = k.X_WB[w.bodyB] * w.X_BF;
    append(A.p - B.p);
    // Quaternion of B → A: half the angle's sine along the axis.
    const Eigen::AngleAxisd turn(Matrix3(B.R.transpose() * A.R));
    append(w.torqueScale * std::sin(0.5 * turn.angle()) * turn.axis());
  }
  for (const JointCoupling& c : model.couplings) {
    const double x = c.leader == 0 ? 0.0 : q[model.bodies[c.leader].q];
    double p = 0.0;
    for (int i = c.leader == 0 ? 0 : 4; i >= 0; --i) p = p * x + c.polynomial[i];
    r.push_back(q[model.bodies[c.follower].q] - p);
  }
  return Eigen::Map<VectorX>(r.data(), static_cast<Eigen::Index>(r.size()));
}

/// q ⊕ δ.
VectorX moved(const Model& model, VectorX q, const VectorX& delta) {
  integratePosition(model, delta, 1.0, q);
  return q;
}

TEST(Equality, JacobianIsTheDerivativeOfTheDistance) {
  double worst = 0.0;
  for (int seed = 0; seed < 40; ++seed) {
    Scene s = equalities(seed);
    s.model.options.constraintModel =
        ConstraintModel::mujoco;  // at two places; at one it is that seen from between
    s.stages();
    const MatrixX J = denseProblem(*s.data).J;
    if (!turns(s)) continue;
    ASSERT_EQ(J.rows(), 3 + 6 + 2);
    const double h = 1e-6;
    for (int i = 0; i < s.model.nv; ++i) {
      const VectorX d = h * VectorX::Unit(s.model.nv, i);
      const VectorX difference = (distances(s.model, moved(s.model, s.state.q, d)) -
                                  distances(s.model, moved(s.model, s.state.q, -d))) /
                                 (2.0 * h);
      worst = std::max(worst, (J.col(i) - difference).cwiseAbs().maxCoeff());
    }
  }
  // Truncation h² and rounding 1e-16/h.
  EXPECT_SMALL(worst, 1e-9);
}

/// Of a row, less J̇ v, by (3.1) and (3.2); loads of (5.1) apart.
TEST(Equality, ReferenceIsASpringDamperOfTheDistance) {
  for (int seed = 0; seed < 40; ++seed) {
    Scene s = equalities(seed);
    if (!turns(s)) continue;
    s.model.options.constraintModel = ConstraintModel::mujoco;
    s.model.options.integrator = Integrator::semiImplicitEuler;
    s.stages();
    const Model& m = s.model;
    const InverseWeights& w = s.data->weights;
    const ConvexProblem p = denseProblem(*s.data);
    const VectorX r = distances(m, s.state.q), rate = p.J * s.state.v;
    const auto check = [&](int row, int count, double length, double weight, double tolerance) {
      const Softness soft = softnessAt({}, length, weight, 0.002);
      for (int i = row; i < row + count; ++i) {
        EXPECT_SMALL(p.D[i] * soft.R - 1.0, 1e-10);
        const double spring = -soft.damping * rate[i] - soft.stiffness * r[i];
        // What is left is J̇ v, of the size of |v|².
        EXPECT_SMALL(p.aRef[i] - spring, tolerance) << "row " << i;
      }
    };
    const double v2 = 100.0 * s.state.v.squaredNorm();
    const Connection& c = m.connections[0];
    check(0, 3, r.head<3>().norm(), w.translation[c.bodyA] + w.translation[c.bodyB], v2);
    const Weld& weld = m.welds[0];
    const double length = r.segment<6>(3).norm();
    check(3, 3, length, w.translation[weld.bodyA] + w.translation[weld.bodyB], v2);
    check(6, 3, length, w.rotation[weld.bodyA] + w.rotation[weld.bodyB], v2);
    for (int i = 0; i < 2; ++i) {
      const JointCoupling& k = m.couplings[i];
      const double leader = k.leader == 0 ? 0.0 : w.dof[m.bodies[k.leader].v];
      check(9 + i, 1, std::abs(r[9 + i]), w.dof[m.bodies[k.follower].v] + leader, 1e-9);
    }
  }
}

// Along any motion the second derivative of the distance is J a + J̇ v, and a_ref holds −J̇ v.
TEST(Equality, BiasIsTheAccelerationOfTheDistanceAtZeroAcceleration) {
  double worst = 0.0, largest = 0.0;
  for (int seed = 0; seed < 40; ++seed) {
    Scene s = equalities(seed);
    if (!turns(s)) continue;
    s.model.options.integrator = Integrator::semiImplicitEuler;  // rows of (3.1) as they are
    const bool places =
        seed % 2 ==
        0;  // MuJoCo's equality constraints act at two places, and its couplings are straight
    s.model.options.constraintModel =
        !places ? ConstraintModel::softgauss : ConstraintModel::mujoco;
    s.stages();
    const Model& m = s.model;
    const VectorX v = s.state.v;
    // A floating base's v is constant in its own mixed axes, as v̇ = 0 says.
    const auto at = [&](double t) {
      VectorX q = s.state.q;
      constexpr int kPieces = 64;  // rotation and translation of a base advance apart
      for (int i = 0; i < kPieces; ++i) integratePosition(m, v, t / kPieces, q);
      return distances(m, q);
    };
    const double h = 1e-3;
    const VectorX r0 = at(0.0);
    // Five points: truncation h⁴.
    const VectorX acceleration =
        (-at(2 * h) + 16.0 * at(h) - 30.0 * r0 + 16.0 * at(-h) - at(-2 * h)) / (12.0 * h * h);
    const ConvexProblem p = denseProblem(*s.data);
    const VectorX rate = p.J * v;
    const auto compare = [&](int row, int count, const Softness& soft) {
      for (int i = row; i < row + count; ++i) {
        const double bias = -p.aRef[i] - soft.damping * rate[i] - soft.stiffness * r0[i];
        worst = std::max(worst, std::abs(bias - acceleration[i]));
        largest = std::max(largest, std::abs(bias));
      }
    };
    const Softness weld = softnessAt({}, r0.segment<6>(3).norm(), 1.0, 0.002);
    if (places) compare(0, 3, softnessAt({}, r0.head<3>().norm(), 1.0, 0.002));
    if (places) compare(3, 3, weld);
    compare(6, 3, weld);
    for (const int i : {9, 10})
      if (!places) compare(i, 1, softnessAt({}, std::abs(r0[i]), 1.0, 0.002));
  }
  EXPECT_SMALL(worst, 1e-7);
  EXPECT_GT(largest, 1.0);
}

// However stretched and however turned, an equality constraint makes no moment: its force acts at
// one place. Two bodies in weightlessness keep their angular momentum, and their momentum.
TEST(Equality, KeepsMomentumHoweverStretched) {
  for (int seed = 0; seed < 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    ModelBuilder builder("pair");
    builder.base = BaseKind::floating;
    builder.link(boxLink("a", 1.0, {0.1, 0.2, 0.3})).link(boxLink("b", 5.0, {0.2, 0.1, 0.1}));
    if (seed % 2 == 0) {
      ConnectSpec tie;
      tie.linkA = "a", tie.linkB = "b";
      tie.p_LAP = random.vector3(0.2), tie.p_LBP = random.vector3(0.2);
      builder.connect(tie);
    } else {
      WeldSpec weld;
      weld.linkA = "a", weld.linkB = "b";
      weld.X_LAF.p = random.vector3(0.2);
      builder.weld(weld);
    }
    builder.options.gravity.setZero();
    Scene s(builder.build());
    s.state = randomState(s.model, random, 3.0);
    Kinematics k(s.model);
    computeKinematics(s.model, s.state, k);
    const Momentum before = computeMomentum(s.model, k);
    for (int i = 0; i < 100; ++i) ASSERT_NE(s.step(), SolveStatus::notFinite);
    computeKinematics(s.model, s.state, k);
    const Momentum after = computeMomentum(s.model, k);
    EXPECT_SMALL((after.linear - before.linear).norm() / before.linear.norm(), 1e-11) << seed;
    EXPECT_SMALL((after.angular - before.angular).norm() / before.angular.norm(), 1e-3) << seed;
  }
}

// (3.14): the force of an equality constraint is that of a spring and a damper in the state in
// which the step ends. K and B appear here as such, not as D and a_ref.
TEST(Equality, ForceIsThatOfTheStepsEnd) {
  for (const double h : {0.0005, 0.002, 0.01})
    for (const double speed : {-1.0, 0.0, 0.3}) {
      ModelBuilder builder("slider");
      builder.link(emptyLink("world")).link(boxLink("body", 3.0, {0.1, 0.1, 0.1}));
      builder.joint(jointSpec("rail", JointType::prismatic, "world", "body", {}, Vector3::UnitX()));
      CouplingSpec spec;
      spec.follower = "rail";
      builder.couple(spec);
      builder.options.timestep = h;
      Scene s(builder.build());
      s.state.q[0] = 0.004;
      s.state.v[0] = speed;
      const double before = s.state.q[0] + 0.5 * h * speed;  // where the step takes its rows
      s.step();
      const Softness soft = softnessAt({}, std::abs(before), s.data->weights.dof[0], h);
      const double K = soft.stiffness / soft.R, B = soft.damping / soft.R;
      const double end = -K * s.state.q[0] - B * s.state.v[0];
      EXPECT_SMALL(s.data->constraints.coupling.f[0] / end - 1.0, 1e-10) << h << ", " << speed;
    }
}

TEST(Coupling, BetweenBranchesEntersThePattern) {
  int coupled = 0, within = 0;
  for (int seed = 0; seed < 40; ++seed) {
    Scene s = equalities(seed);
    s.model.connections.clear();
    s.model.welds.clear();
    s.stages();
    s.forward();
    const bool own = &s.data->constraints.sparsity() == &s.data->inertia.sparsity;
    (own ? within : coupled) += 1;
    const ConvexProblem p = denseProblem(*s.data);
    const VectorX a = s.data->forward.a;
    // Couplings are as hard as gear teeth: D x is rounded as D |J| |a| is.
    const VectorX terms =
        p.J.cwiseAbs().transpose() * p.D.cwiseProduct(p.J.cwiseAbs() * a.cwiseAbs());
    EXPECT_SMALL(p.gradient(a).cwiseAbs().maxCoeff(), std::max(1e-8, 1e-14 * terms.maxCoeff()));
  }
  EXPECT_GT(coupled, 5);
  EXPECT_GT(within, 5);
}

TEST(Equality, SwitchedOffMakesNoRows) {
  Scene s = equalities(3);
  EXPECT_EQ(s.data->stats.rows, 11);
  s.model.options.effects.remove(Effect::equality);
  s.stages();
  EXPECT_EQ(s.data->stats.rows, 0);
}

// Exchanging the bodies turns the distance round and changes nothing else.
TEST(Equality, DoesNotDependOnWhichBodyIsFirst) {
  for (int seed = 0; seed < 20; ++seed) {
    Scene a = equalities(seed), b = equalities(seed);
    for (Connection& c : b.model.connections) {
      std::swap(c.bodyA, c.bodyB);
      std::swap(c.p_AP, c.p_BP);
    }
    for (Weld& w : b.model.welds) {
      std::swap(w.bodyA, w.bodyB);
      std::swap(w.X_AF, w.X_BF);
    }
    b.stages();
    a.forward();
    b.forward();
    EXPECT_APPROX(a.data->forward.a, b.data->forward.a, 1e-8) << "seed " << seed;
  }
}

}  // namespace
}  // namespace softgauss::test
