// SPDX-License-Identifier: Apache-2.0
/// Torsional and rolling friction (condim 4 and 6) with physical answers: creep, rest, spin,
/// rolling.

#include "softgauss/engine/constraints/impedance.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

constexpr double kMass = 2.0;
constexpr double kInertia = 0.4 * kMass * kRadius * kRadius;

/// A ball on the ground at its penetration at rest; impedance that does not depend on depth.
Scene ball(int condim, double friction, double torsional, double rolling) {
  Model model = sphereOnPlane(kRadius, kMass, friction).build();
  for (Geometry& g : model.geometries) {
    g.material.condim = condim;
    g.material.torsionalFriction = torsional;
    g.material.rollingFriction = rolling;
    g.material.impedance.dMin = g.material.impedance.dMax = 0.9;
  }
  Scene s(std::move(model), std::make_shared<SampleContacts>());
  s.state.q[2] = kRadius - 1e-5;
  return s;
}

constexpr double kStep = 0.002;

/// An edge at the step's end (3.14), (3.17): of the spring K = k d/R and the damper b/R of the
/// impedance that is given, e each.
struct Edge {
  double K, D;
  Edge(double mu, int condim) {
    const double d = 0.9, tc = 0.02, R = (1 - d) / d / kMass;
    const double e = std::max(0.5 / (condim - 1), 0.5 / (mu * mu));
    K = e * d / std::pow(d * tc, 2) / R;
    D = kStep * (0.5 * kStep * K + e * 2 / (d * tc) / R);
  }
};

/// What pushes along a direction of friction, and how it moves there.
struct Creep {
  double load = 0.0;            ///< [N or N m]
  double mu = 0.0;              ///< [- or m]
  double inverseInertia = 0.0;  ///< over 1/kMass
  double speed = 0.0;           ///< [m/s or rad/s]
};

/// The speeds that loads keep: f_k = 2 μ_k² D_e (1 + s (γ − 1)) ẏ_k/h, with the share s and γ of
/// (5.11), (5.12).
void findSpeeds(std::vector<Creep>& all, double mu, int condim) {
  const double n = 2.0 * (condim - 1);
  double harder = 1.0;
  for (int i = 0; i < 500; ++i) {
    double square = 0.0, m = 0.0;
    for (Creep& c : all) {
      c.speed = c.load * kStep / (2.0 * c.mu * c.mu * Edge(mu, condim).D * harder);
      square += std::pow(c.mu * c.speed, 2.0);
      m += std::pow(c.mu * c.speed * c.mu / mu, 2.0) * c.inverseInertia;
    }
    m /= square;
    const double V = std::sqrt(square) / (m * mu * mu * kStep * kGravity);
    const double gamma = std::clamp(1.0 / m, 1.0, n);
    harder = 0.5 * (harder + 1.0 + std::min(1.0, 30.0 * V) * (gamma - 1.0));
  }
}

// All 2 (condim − 1) edges carry the weight alike.
TEST(RestDepth, FallsWithTheNumberOfEdges) {
  for (const int condim : {3, 4, 6}) {
    Scene s = ball(condim, 0.7, 0.02, 0.01);
    s.steps(2000);
    const double depth = kMass * kGravity / (2 * (condim - 1) * Edge(0.7, condim).K);
    EXPECT_SMALL((kRadius - s.state.q[2]) / depth - 1.0, 1e-8) << "condim " << condim;
    EXPECT_EQ(s.data->stats.rows, 2 * (condim - 1));
  }
}

// A small moment about the normal, or about a tangent with the ball held by its friction, is borne
// with creep.
TEST(TorsionalFriction, HoldsASmallMomentWithCreep) {
  Scene s = ball(4, 0.7, 0.02, 0.0);
  const double tau = 0.05 * 0.02 * kMass * kGravity;
  s.input.tau[5] = tau;
  s.steps(4000);
  std::vector<Creep> creep = {{tau, 0.02, kMass / kInertia}};
  findSpeeds(creep, 0.7, 4);
  EXPECT_SMALL(s.state.v[5] / creep[0].speed - 1.0, 1e-8);
  s.stages();
  s.forward();
  EXPECT_APPROX(s.data->constraints.contact.moment(0), Vector3(0, 0, -tau), 1e-8);
}

// Faster, the moment is μ_s m g, and the spin decays at the rate μ_s m g/I.
TEST(TorsionalFriction, StopsASpinningBall) {
  const double torsional = 0.004, rate = torsional * kMass * kGravity / kInertia;
  Scene s = ball(4, 0.5, torsional, 0.0);
  s.model.options.timestep = 5e-4;
  s.state.v[5] = 10.0;
  const double time = 5.0 / rate;  // to half the speed
  s.steps(static_cast<int>(time / s.model.options.timestep));
  EXPECT_SMALL(s.state.v[5] / 5.0 - 1.0, 0.01);
  EXPECT_SMALL(s.state.v.head<2>().norm(), 1e-6);
  // And it comes to rest: below the creep of the full moment the spin decays exponentially.
  s.steps(static_cast<int>(5.0 * time / s.model.options.timestep));
  EXPECT_SMALL(s.state.v[5], 1e-6);
  // Without torsional friction it spins on.
  Scene free = ball(3, 0.5, torsional, 0.0);
  free.state.v[5] = 10.0;
  free.steps(1000);
  EXPECT_SMALL(free.state.v[5] - 10.0, 1e-9);
}

// A ball that a small force F drives rolls with the creep of the moment F r, and slips with that of
// the force itself, F = 2 μ² D_e (v − ω r)/h.
TEST(RollingFriction, HoldsASmallForceWithCreep) {
  const double rolling = 0.02, mu = 0.8, force = 0.05 * rolling * kMass * kGravity / kRadius;
  Scene s = ball(6, mu, 0.01, rolling);
  s.input.tau[0] = force;
  s.steps(6000);
  const double arm = 0.5 * (s.state.q[2] + kRadius);  // the contact is midway of the overlap
  std::vector<Creep> creep = {{force * arm, rolling, kMass / kInertia}, {force, mu, 1.0}};
  findSpeeds(creep, mu, 6);
  EXPECT_SMALL(s.state.v[4] / creep[0].speed - 1.0, 1e-6);
  EXPECT_SMALL(s.state.v[0] / (creep[0].speed * arm + creep[1].speed) - 1.0, 1e-6);
  s.stages();
  s.forward();
  EXPECT_APPROX(s.data->constraints.contact.moment(0), Vector3(0, -force * arm, 0), 1e-6);
}

// A ball that rolls, faster than the creep of the full moment: the moment is μ_r f_n less the share
// that friction takes of the pyramid, which is f/μ at most; f = 5 τ/(7 r) keeps it rolling.
TEST(RollingFriction, SlowsARollingBall) {
  const double rolling = 0.02, mu = 1.0;
  Scene s = ball(6, mu, 1e-4, rolling);
  s.model.options.timestep = 5e-4;
  s.state.v[0] = 1.0;
  s.state.v[4] = 1.0 / kRadius;
  const double share = 5.0 * rolling / (7.0 * kRadius);
  s.steps(200);  // 0.1 s, after which it rolls steadily
  const double before = s.state.v[0];
  s.steps(400);
  const double slowdown = (before - s.state.v[0]) / 0.2;
  EXPECT_GT(slowdown, share * kGravity / (1.0 + share / mu));
  EXPECT_LT(slowdown, share * kGravity);
  s.steps(4000);
  EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-4);
}

TEST(RollingFriction, SwitchedOffIsTorsionalFrictionAlone) {
  Scene off = ball(6, 0.7, 0.02, 0.01), four = ball(4, 0.7, 0.02, 0.01);
  off.model.options.effects.remove(Effect::rollingFriction);
  Scene none = ball(6, 0.7, 0.02, 0.01), three = ball(3, 0.7, 0.02, 0.01);
  none.model.options.effects.remove(Effect::torsionalFriction);
  for (Scene* s : {&off, &four, &none, &three}) {
    s->state.v << 0.3, -0.2, 0.1, 1.0, 2.0, 3.0;
    s->steps(50);
  }
  EXPECT_EQ(hash(off.state), hash(four.state));
  EXPECT_EQ(hash(none.state), hash(three.state));
}

}  // namespace
}  // namespace softgauss::test
