// SPDX-License-Identifier: Apache-2.0
/// Energy and momentum, whose laws know nothing of how the dynamics are computed.

#include "tests/laws/law_measures.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

constexpr int kSeeds = 40;

// Central differences with ε = 1e-6 of energies and momenta of O(100): rounding 1e-16·100/1e-6.
constexpr double kDifferenceTolerance = 1e-8;

/// Rate of f(kinematics, state) when the scene moves with acceleration a.
template <class F>
VectorX rateOf(const Scene& s, const VectorX& a, F&& f) {
  Kinematics k(s.model);
  return alongTrajectory(s.model, s.state, a, [&](const State& state) {
    computeKinematics(s.model, state, k);
    return VectorX(f(k, state));
  });
}

double energyRate(const Scene& s, const VectorX& a) {
  return rateOf(s, a, [&](const Kinematics& k, const State& state) {
    return VectorX::Constant(1, computeEnergy(s.model, k, state.q, state.v).total());
  })[0];
}

VectorX momentumRate(const Scene& s, const VectorX& a) {
  return rateOf(s, a, [&](const Kinematics& k, const State&) {
    const Momentum p = computeMomentum(s.model, k);
    return VectorX((VectorX(6) << p.linear, p.angular).finished());
  });
}

/// Σ force · velocity of all applied forces, wrenches at the velocity of their point.
double appliedPower(const Scene& s) {
  double power = s.input.tau.dot(s.state.v);
  const Kinematics& k = s.data->kinematics;
  for (const ExternalWrench& w : s.input.wrenches)
    power += w.F_Bo_W.force.dot(pointVelocity(s.model, k, w.body, k.X_WB[w.body].p)) +
             w.F_Bo_W.moment.dot(k.V[w.body].angular);
  for (int i = 0; i < s.model.nv; ++i)
    power -= s.model.dofs[i].damping * s.state.v[i] * s.state.v[i];
  return power;
}

TEST(Power, EqualsRateOfEnergy) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    RandomTreeOptions options;
    options.ranges = false;
    options.springs = seed % 2 == 1;
    Scene s = inContinuousTime(randomScene(seed, 0, options));
    s.forward();
    const double scale = 100.0 + std::abs(appliedPower(s));
    EXPECT_SMALL((energyRate(s, s.data->forward.a) - appliedPower(s)) / scale, kDifferenceTolerance)
        << "seed " << seed;
  }
}

TEST(Power, EqualsRateOfEnergyWithContactsAndLimits) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    Scene s = inContinuousTime(randomScene(seed, 6));
    s.forward();
    const Constraints& rows = s.data->constraints;
    const Kinematics& k = s.data->kinematics;
    // Contact forces act on both bodies, at the velocity with which their points approach.
    double power = appliedPower(s);
    const auto& made = rows.contact.contactsWithRows();
    for (int i = 0; i < static_cast<int>(made.size()); ++i) {
      const Contact& c = s.data->contacts.contacts[made[i].contact];
      power += rows.contact.force(i).dot(pointVelocity(s.model, k, c.bodyB, c.p_WC) -
                                         pointVelocity(s.model, k, c.bodyA, c.p_WC));
    }
    for (int i = 0; i < rows.jointLimit.rowCount(); ++i)
      power += rows.jointLimit.sign(i) * rows.jointLimit.f[i] * s.state.v[rows.jointLimit.dof(i)];
    const double scale = 100.0 + s.data->forward.a.cwiseAbs().maxCoeff();
    EXPECT_SMALL((energyRate(s, s.data->forward.a) - power) / scale, kDifferenceTolerance)
        << "seed " << seed;
  }
}

TEST(Energy, KineticIsHalfVtMv) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Scene s = inContinuousTime(randomScene(seed, 0));
    VectorX Mv = VectorX::Zero(s.model.nv);
    s.data->inertia.M.multiply(s.state.v, Mv);
    const double kinetic = computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).kinetic;
    EXPECT_SMALL(kinetic / (0.5 * s.state.v.dot(Mv)) - 1.0, 1e-13) << "seed " << seed;
  }
}

/// A floating tree with internal joint forces, and contacts between its own bodies.
Scene floatingScene(std::uint64_t seed, bool gravity) {
  Random random(seed);
  ModelBuilder builder = randomFloatingTree(seed);
  if (!gravity) builder.options.gravity.setZero();
  Scene s(builder.build());
  s.state = randomState(s.model, random);
  s.input.tau.tail(s.model.nv - 6) = random.vector(s.model.nv - 6, 10.0);
  computeKinematics(s.model, s.state, s.data->kinematics);
  FixedContacts all = randomContacts(s.model, s.data->kinematics, random, 20);
  std::erase_if(all.points, [](const Contact& c) { return c.bodyA == 0 || c.bodyB == 0; });
  s.contacts = std::make_shared<FixedContacts>(all);
  s.stages();
  s.forward();
  return s;
}

TEST(Momentum, ConservedWithoutExternalForce) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Scene s = floatingScene(seed, false);
    ASSERT_GT(s.data->constraints.contact.rowCount(), 0);
    const double scale = 10.0 + s.data->forward.a.cwiseAbs().maxCoeff();
    EXPECT_SMALL(momentumRate(s, s.data->forward.a).cwiseAbs().maxCoeff() / scale,
                 kDifferenceTolerance)
        << "seed " << seed;
  }
}

TEST(Momentum, ChangesByTheWeight) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Scene s = floatingScene(seed, true);
    const Vector3 weight = s.model.totalMass() * s.model.options.gravity;
    VectorX expected(6);
    expected << weight, centerOfMass(s.model, s.data->kinematics).cross(weight);
    const double scale = 10.0 + s.data->forward.a.cwiseAbs().maxCoeff();
    EXPECT_APPROX(momentumRate(s, s.data->forward.a) / scale, expected / scale,
                  kDifferenceTolerance)
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace softgauss::test
