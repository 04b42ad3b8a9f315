// SPDX-License-Identifier: Apache-2.0
/// Motions with closed forms, and the order at which the step converges to them.

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// error(h) ~ hᵖ: p from the errors at h and h/2.
template <class Error>
double observedOrder(Error&& error, double h) {
  return std::log2(error(h) / error(0.5 * h));
}

// ---- Free fall
// -----------------------------------------------------------------------------------

// Under a constant force the leapfrog is exact, to rounding.
TEST(FreeFall, IsExact) {
  Scene s(freeBody(boxLink("body", 2.0, {0.1, 0.2, 0.3})).build());
  s.state.v << 1.0, -2.0, 3.0, 0, 0, 0;
  const double h = s.model.options.timestep;
  const int n = 500;
  s.steps(n);
  EXPECT_APPROX(s.state.v.head(3), Vector3(1, -2, 3 - 9.81 * n * h), 1e-13);
  EXPECT_APPROX(s.state.q.head(3), Vector3(n * h, -2 * n * h, 3 * n * h - 9.81 * h * h * n * n / 2),
                1e-13);
  EXPECT_SMALL(s.state.time - n * h, 1e-12);
}

// The centre of mass of a tree falls like a stone, whatever its joints do.
TEST(FreeFall, OfATreeMovesItsCenterOfMassLikeAStone) {
  Scene s(randomFloatingTree(3).build());
  s.model.options.effects.remove(Effect::jointLimit);  // their blows are of order 1 in h
  s.model.options.effects.remove(Effect::dryFriction);
  Random random(3);
  s.state = randomState(s.model, random, 0.5);
  s.stages();
  const double mass = s.model.totalMass();
  const Vector3 p0 = centerOfMass(s.model, s.data->kinematics);
  const Vector3 v0 = computeMomentum(s.model, s.data->kinematics).linear / mass;
  const auto error = [&](double h) {
    Scene copy(s.model);
    copy.model.options.timestep = h;
    copy.model.options.substepAngle = kInfinity;
    copy.state = s.state;
    const int n = static_cast<int>(std::lround(0.2 / h));
    copy.steps(n);
    copy.stages();
    const double t = n * h;
    const Vector3 exact = p0 + v0 * t + 0.5 * t * t * s.model.options.gravity;
    return (centerOfMass(copy.model, copy.data->kinematics) - exact).norm();
  };
  const double order = observedOrder(error, 1e-3);
  EXPECT_GT(order, 1.8);
  EXPECT_LT(order, 2.2);
}

// ---- Pendulum
// ------------------------------------------------------------------------------------

/// Complete elliptic integral of the first kind K(sin ½θ₀) by the arithmetic–geometric mean.
double ellipticK(double k) {
  double a = 1.0, b = std::sqrt(1.0 - k * k);
  while (std::abs(a - b) > 1e-15) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return M_PI / (2.0 * a);
}

/// By the leapfrog alone, which would else have it followed.
Scene swinging(double amplitude, double h) {
  ModelBuilder builder = pendulum(0.5, 1.3, 0.05);
  builder.options.mechanisms.remove(Mechanism::treeSubstepping);
  builder.options.timestep = h;
  Scene s(builder.build());
  s.state.q[0] = amplitude;
  return s;
}

/// Time between the first and the third passage of zero, interpolated by the velocity.
double periodOf(Scene& s) {
  double first = 0.0;
  int passages = 0;
  for (int i = 0; i < 1000000; ++i) {
    const double before = s.state.q[0];
    s.step();
    if (before * s.state.q[0] > 0.0) continue;
    const double t = s.state.time - s.state.q[0] / s.state.v[0];
    if (++passages == 1) first = t;
    if (passages == 3) return t - first;
  }
  return kNaN;
}

// T = 4 √(J/(m g l)) K(sin ½θ₀) with J = m l² + ⅖ m r².
TEST(Pendulum, PeriodIsTheEllipticIntegral) {
  const double amplitude = 1.5, l = 0.5, r = 0.05;
  const double omega = std::sqrt(9.81 * l / (l * l + 0.4 * r * r));
  const double exact = 4.0 / omega * ellipticK(std::sin(0.5 * amplitude));
  const auto error = [&](double h) {
    Scene s = swinging(amplitude, h);
    return std::abs(periodOf(s) / exact - 1.0);
  };
  // (ω h)²/24 at h = 2 ms.
  EXPECT_SMALL(error(0.002), 5e-6);
  const double order = observedOrder(error, 0.004);
  EXPECT_GT(order, 1.9);
  EXPECT_LT(order, 2.1);
}

TEST(Pendulum, PositionConvergesWithOrderTwo) {
  // After a time that is no multiple of the half period, from a reference with a tiny step.
  const auto at = [&](double h) {
    Scene s = swinging(1.5, h);
    s.steps(static_cast<int>(std::lround(1.28 / h)));
    return s.state.q[0];
  };
  const double reference = (4.0 * at(1e-4) - at(2e-4)) / 3.0;  // order 4
  const auto error = [&](double h) { return std::abs(at(h) - reference); };
  const double order = observedOrder(error, 0.008);
  EXPECT_GT(order, 1.9);
  EXPECT_LT(order, 2.1);
}

TEST(Pendulum, EnergyStaysBounded) {
  Scene s = swinging(1.5, 0.002);
  s.stages();
  const double start = computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).total();
  double worst = 0.0;
  for (int i = 0; i < 20000; ++i) {  // 40 s: some 25 swings
    s.step();
    computeKinematics(s.model, s.state, s.data->kinematics);
    worst = std::max(
        worst,
        std::abs(computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).total() - start));
  }
  // Symplectic: the energy error oscillates with (h ω)²/6 of the energy's size and does not grow.
  EXPECT_SMALL(worst / (1.3 * 9.81 * 0.5), std::pow(0.002, 2.0) * 9.81 / 0.5 / 6.0);
}

// ---- Free rotation
// -------------------------------------------------------------------------------

// A body that spins about a principal axis keeps doing so.
TEST(FreeRotation, AboutAPrincipalAxisIsSteady) {
  ModelBuilder builder = freeBody(boxLink("body", 2.0, {0.1, 0.2, 0.3}));
  builder.options.gravity.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    Scene s(builder.build());
    s.state.v[3 + axis] = 20.0;
    s.steps(1000);
    VectorX expected = VectorX::Zero(6);
    expected[3 + axis] = 20.0;
    EXPECT_APPROX(s.state.v, expected, 1e-12);
    const Vector3 turned = positionDifference(s.model, s.model.q0, s.state.q).tail(3);
    Vector3 angle = Vector3::Zero();
    angle[axis] = std::remainder(20.0 * 1000 * s.model.options.timestep, 2 * M_PI);
    EXPECT_APPROX(turned, angle, 1e-11);
  }
}

/// Relative drift of energy and of angular momentum of a tumbling box over 1 s.
struct Drift {
  double energy, momentum;
};
Drift tumblingDrift(double h, Integrator integrator) {
  ModelBuilder builder = freeBody(boxLink("body", 2.0, {0.1, 0.2, 0.3}));
  builder.options.gravity.setZero();
  builder.options.timestep = h;
  builder.options.integrator = integrator;
  builder.options.substepAngle = kInfinity;
  Scene s(builder.build());
  s.state.v << 0, 0, 0, 4.0, 7.0, 5.0;
  s.stages();
  const double E0 = computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).kinetic;
  const Vector3 L0 = computeMomentum(s.model, s.data->kinematics).angular;
  s.steps(static_cast<int>(std::lround(1.0 / h)));
  s.stages();
  const double E = computeEnergy(s.model, s.data->kinematics, s.state.q, s.state.v).kinetic;
  const Vector3 L = computeMomentum(s.model, s.data->kinematics).angular;
  return {std::abs(E / E0 - 1.0), (L - L0).norm() / L0.norm()};
}

// With the gyroscopic term of the step's start a tumbling body gains energy, with order 1.
TEST(FreeRotation, TumblingByPlainEulerConvergesWithOrderOne) {
  const auto energy = [](double h) {
    return tumblingDrift(h, Integrator::semiImplicitEuler).energy;
  };
  const auto momentum = [](double h) {
    return tumblingDrift(h, Integrator::semiImplicitEuler).momentum;
  };
  for (const double order : {observedOrder(energy, 0.001), observedOrder(momentum, 0.001)}) {
    EXPECT_GT(order, 0.9);
    EXPECT_LT(order, 1.1);
  }
}

// Taken at a predicted velocity of mid-step it makes all of it second order.
TEST(FreeRotation, TumblingByTheLeapfrogConvergesWithOrderTwo) {
  const auto energy = [](double h) { return tumblingDrift(h, Integrator::leapfrog).energy; };
  const auto momentum = [](double h) { return tumblingDrift(h, Integrator::leapfrog).momentum; };
  EXPECT_GT(observedOrder(energy, 0.001), 1.9);
  EXPECT_GT(observedOrder(momentum, 0.001), 1.9);
  EXPECT_LT(energy(0.002), 1e-2 * tumblingDrift(0.002, Integrator::semiImplicitEuler).energy);
}

// ---- Springs and dampers
// -------------------------------------------------------------------------

/// A slider of mass m along x without gravity.
Model slider(double mass, double damping, double h) {
  ModelBuilder builder("slider");
  builder.link(emptyLink("world")).link(boxLink("body", mass, {0.1, 0.1, 0.1}));
  JointSpec joint = jointSpec("rail", JointType::prismatic, "world", "body", {}, Vector3::UnitX());
  joint.damping = damping;
  builder.joint(joint);
  builder.options.timestep = h;
  builder.options.gravity.setZero();
  return builder.build();
}

// (m + h d) v⁺ = m v: v_n = v₀ (1 + h d/m)⁻ⁿ, stable and positive for any damping.
TEST(JointDamping, DecaysByTheImplicitRecurrence) {
  for (const double damping : {0.5, 3.0, 1e4}) {
    Scene s(slider(2.0, damping, 0.002));
    s.state.v[0] = 1.0;
    s.steps(40);
    const double expected = std::pow(1.0 + 0.002 * damping / 2.0, -40);
    EXPECT_GT(s.state.v[0], 0.0);
    EXPECT_SMALL(s.state.v[0] / expected - 1.0, 1e-12);
  }
}

TEST(JointDamping, ConvergesToTheExponentialWithOrderOne) {
  const auto error = [](double h) {
    Scene s(slider(2.0, 3.0, h));
    s.state.v[0] = 1.0;
    s.steps(static_cast<int>(std::lround(1.0 / h)));
    return std::abs(s.state.v[0] - std::exp(-1.5));
  };
  const double order = observedOrder(error, 0.001);
  EXPECT_GT(order, 0.95);
  EXPECT_LT(order, 1.05);
}

// Among other joints too, and where rows act: M (v⁺ − v)/h = τ + Jᵀf − (c − D v) − D v⁺, with M
// that of the bodies and D v⁺ of the velocity that the step ends with.
TEST(JointDamping, IsImplicitInEveryTree) {
  int damped = 0;
  for (int seed = 0; seed < 60; ++seed)
    for (const Integrator integrator : {Integrator::leapfrog, Integrator::semiImplicitEuler}) {
      Scene s = randomScene(seed, seed % 2 == 0 ? 0 : 4);
      s.model.options.integrator = integrator;
      s.model.options.substepAngle = kInfinity;
      const double h = s.model.options.timestep;
      const VectorX before = s.state.v;
      s.step();
      VectorX D(s.model.nv);
      for (int i = 0; i < s.model.nv; ++i) D[i] = s.model.dofs[i].damping;
      damped += (D.array() > 0.0).any();
      MassMatrix inertia(s.model);
      computeMassMatrix(s.model, s.data->kinematics, inertia);
      const MatrixX M = inertia.M.dense();
      EXPECT_SMALL((h * D - s.data->inertia.added).cwiseAbs().maxCoeff(), 1e-13);
      const VectorX a = (s.state.v - before) / h;
      VectorX force = s.data->forces.net - D.cwiseProduct(s.state.v - before);
      std::vector<Force> onBodies(s.model.bodies.size());
      BodyForce all{force, onBodies};
      s.data->constraints.addForce(all);
      addBodyForces(s.model, s.data->kinematics, onBodies, force);
      EXPECT_SMALL((M * a - force).cwiseAbs().maxCoeff() / (M * a).cwiseAbs().maxCoeff(), 1e-9)
          << "seed " << seed;
      EXPECT_APPROX(s.data->acceleration, a, 1e-9);
    }
  EXPECT_GT(damped, 60);
}

// A limit on one mass is a spring and a damper at the step's end that never pull, and half damped
// it bounces: K = k and B = b − t K of its reference on its mass (3.11), t = ½ h, so that m a =
// max(0, −D (a + v/h + K/D r)) with D = h (t K + B). Flat impedance: d does not change.
TEST(JointLimit, OnOneMassIsASpringDamper) {
  Model model = slider(2.0, 0.0, 0.001);
  JointRange range;
  range.body = 1;
  range.lower = 0.0;
  range.upper = 1.0;
  range.impedance.timeConstant = 0.1;
  range.impedance.dampingRatio = 0.5;
  range.impedance.dMin = range.impedance.dMax = 0.9;
  model.ranges.push_back(range);
  Scene s(std::move(model));
  s.state.q[0] = -0.01;
  s.state.v[0] = -0.2;

  const double h = 0.001, k = 1 / std::pow(0.1 * 0.5, 2), b = 2 / 0.1;
  const double D = h * b;  // per mass
  double q = -0.01, v = -0.2;
  int steps = 0;
  while (q < 0.0) {
    s.step();
    q += 0.5 * h * v;
    v += h * std::max(0.0, -b * v - k * q) / (1.0 + D);
    q += 0.5 * h * v;
    ++steps;
    ASSERT_SMALL(s.state.q[0] - q, 1e-14);
    ASSERT_LT(steps, 1000);
  }
  EXPECT_GT(steps, 50);
  const double left = s.state.v[0];
  s.step();  // beyond the limit nothing acts
  EXPECT_EQ(s.state.v[0], left);
}

// A limit in its range's middle carries a weight at a depth r with f = D k d r.
TEST(JointLimit, CarriesALoadAtThePredictedDepth) {
  Model model = slider(2.0, 0.0, 0.002);
  JointRange range;
  range.body = 1;
  range.lower = 0.0;
  range.impedance.dMin = range.impedance.dMax = 0.9;
  model.ranges.push_back(range);
  Scene s(std::move(model));
  s.input.tau[0] = -5.0;
  s.steps(2000);
  // r = f R/(k d), R = (1 − d)/(d m), k = 1/(d tc)².
  const double d = 0.9, R = (1 - d) / d / 2.0, k = 1 / std::pow(d * 0.02, 2);
  EXPECT_SMALL(s.state.q[0] / (-5.0 * R / (k * d)) - 1.0, 1e-9);
  EXPECT_SMALL(s.state.v[0], 1e-12);
}

}  // namespace
}  // namespace softgauss::test
