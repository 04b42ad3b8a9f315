// SPDX-License-Identifier: Apache-2.0
/// Laws of contacts with elliptic cones, in random scenes with every other soft effect.

#include "tests/laws/law_measures.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

Scene ellipticScene(std::uint64_t seed, int contacts) {
  Scene s = lawScene(seed, contacts);
  s.model.options.cone = Cone::elliptic;
  s.model.options.impedanceRatio = seed % 3 == 0 ? 10.0 : 1.0;
  s.stages();
  return s;
}

/// The zones of the last evaluation.
std::vector<ConeZone> zonesOf(const Scene& s) {
  std::vector<ConeZone> zones;
  const EllipticContact& contact = s.data->constraints.ellipticContact;
  for (std::size_t i = 0; i < contact.contactsWithRows().size(); ++i)
    zones.push_back(contact.cone(static_cast<int>(i))
                        .point(contact.x.data() + contact.contactsWithRows()[i].row)
                        .zone());
  return zones;
}

TEST(EllipticInverse, RecoversForward) {
  int zones[3] = {};
  double worst = 0.0;
  for (int seed = 0; seed < 1000; ++seed) {
    Scene s = ellipticScene(seed, 6);
    ASSERT_EQ(s.forward(), SolveStatus::converged) << "seed " << seed;
    for (const ConeZone zone : zonesOf(s)) ++zones[static_cast<int>(zone)];
    worst = std::max(worst, inverseMiss(s));
  }
  EXPECT_SMALL(worst, 1e-10);
  for (const int count : zones) EXPECT_GT(count, 500);
}

TEST(EllipticForward, RecoversInverse) {
  double worst = 0.0;
  for (int seed = 0; seed < 200; ++seed) {
    Scene s = ellipticScene(seed, 6);
    Random random(seed);
    const VectorX a = random.vector(s.model.nv, 100.0);
    setAppliedForce(inverse(s, a), s.data->forces);
    ASSERT_EQ(s.forward(), SolveStatus::converged) << "seed " << seed;
    worst = std::max(worst, (s.data->forward.a - a).cwiseAbs().maxCoeff() / 100.0);
  }
  // The gradient's 1e-12 divided by eigenvalues of M down to 1e-3 of its diagonal.
  EXPECT_SMALL(worst, 1e-8);
}

TEST(EllipticInverseJacobian, MatchesFiniteDifferences) {
  int compared = 0, sliding = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Scene s = ellipticScene(seed, 6);
    s.forward();
    const VectorX a = s.data->forward.a;
    inverse(s, a);
    const std::vector<ConeZone> zones = zonesOf(s);
    TreeMatrix P;
    inverseDynamicsJacobian(*s.data, P);
    EXPECT_EQ(Eigen::LLT<MatrixX>(P.dense()).info(), Eigen::Success) << "seed " << seed;
    bool sameZones = true;
    const MatrixX difference = gradient(
        a,
        [&](const VectorX& x) {
          const VectorX tau = inverse(s, x);
          sameZones &= zonesOf(s) == zones;
          return tau;
        },
        1e-6);
    if (!sameZones) continue;
    ++compared;
    sliding += std::count(zones.begin(), zones.end(), ConeZone::middle) > 0;
    // Rounding of τ ~ 1e3 over a step of 1e-6, and what the middle zone bends within it.
    EXPECT_APPROX(P.dense(), difference, 1e-6) << "seed " << seed;
  }
  EXPECT_GT(compared, 40);
  EXPECT_GT(sliding, 15);
}

// What makes a force the solution, without the penalty: in every contact f is in the friction cone,
// y = x + R f is in its dual, and f·y = 0. With M a − Jᵀf = τ − c that is all there is to the
// convex problem of softened Coulomb friction.
TEST(EllipticForward, IsComplementary) {
  int zones[3] = {};
  double worst = 0.0, equation = 0.0;
  for (int seed = 0; seed < 200; ++seed) {
    Scene s = ellipticScene(seed, 6);
    s.forward();
    const EllipticContact& contact = s.data->constraints.ellipticContact;
    for (const ConeZone zone : zonesOf(s)) ++zones[static_cast<int>(zone)];
    for (std::size_t i = 0; i < contact.contactsWithRows().size(); ++i) {
      const ContactRows& made = contact.contactsWithRows()[i];
      const auto row = static_cast<std::size_t>(made.row);
      const double R = 1.0 / contact.cone(static_cast<int>(i)).D;
      const double mu = made.friction[0], ratio = s.model.options.impedanceRatio;
      double tangential = 0.0, dual = 0.0,
             product = contact.f[row] * (contact.x[row] + R * contact.f[row]);
      for (std::size_t k = 0; k < static_cast<std::size_t>(made.frictionDim); ++k) {
        // R_k μ_k² is one number for all directions, R₁ = R₀/impratio.
        const double Rk = R / ratio * mu * mu / (made.friction[k] * made.friction[k]);
        const double f = contact.f[row + 1 + k], y = contact.x[row + 1 + k] + Rk * f;
        tangential = std::hypot(tangential, f / made.friction[k]);
        dual = std::hypot(dual, made.friction[k] * y);
        product += f * y;
      }
      const double scale = 1.0 + contact.f[row] + std::abs(contact.x[row]) + dual;
      const double y0 = contact.x[row] + R * contact.f[row];
      worst = std::max({worst, (tangential - contact.f[row]) / scale, (dual - y0) / scale,
                        std::abs(product) / (scale * scale)});
    }
    equation = std::max(equation, relativeImbalance(s, s.data->forward.gradient));
  }
  EXPECT_SMALL(worst, 1e-12);
  EXPECT_SMALL(equation, 1e-10);
  for (const int count : zones) EXPECT_GT(count, 100);
}

// Third law and Jᵀ, of forces and moments.
TEST(EllipticContact, ForceActsAtItsPointOnBothBodies) {
  int moments = 0;
  for (int seed = 0; seed < 40; ++seed) {
    Scene s = ellipticScene(seed, 8);
    s.forward();
    const EllipticContact& contact = s.data->constraints.ellipticContact;
    VectorX actual = VectorX::Zero(s.model.nv);
    contact.addTransposed(contact.f, actual);
    for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i)
      moments += contact.moment(i).norm() > 0.0;
    EXPECT_APPROX(actual, forceOfContacts(s, contact), 1e-12) << "seed " << seed;
  }
  EXPECT_GT(moments, 20);
}

TEST(EllipticCost, DecreasesEveryIteration) {
  int iterations = 0, most = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Scene s = ellipticScene(seed, 10);
    const MatrixX M = s.data->inertia.hat().dense();
    double previous = kInfinity;
    for (int limit = 0; limit <= 100; ++limit) {
      s.model.options.maxIterations = limit;
      const SolveStatus status = s.forward();
      const VectorX& a = s.data->forward.a;
      bool changed = false;
      s.data->constraints.setResidual(a);
      const double cost =
          0.5 * a.dot(M * a) - a.dot(s.data->forces.net) + s.data->constraints.evaluate(changed);
      const double rounding = 1e-13 * (std::abs(cost) + 1.0) * toleranceScale();
      if (s.data->forward.report.iterations == limit) {
        EXPECT_LT(cost, previous + rounding);
      }
      previous = cost;
      if (status == SolveStatus::converged) break;
      EXPECT_EQ(status, SolveStatus::iterationLimit) << "seed " << seed;
      ++iterations;
      most = std::max(most, limit + 1);
    }
  }
  EXPECT_GT(iterations, 120);
  EXPECT_LE(most, 30);  // quadratic convergence at the end, few zones before it
}

// The crossings found on a ray are where contacts change their zones along it.
TEST(EllipticContact, CrossingsAreWhereZonesChangeAlongARay) {
  int found = 0;
  for (int seed = 0; seed < 100; ++seed) {
    Scene s = ellipticScene(seed, 4);
    s.forward();
    inverse(s, s.data->forward.a);
    Random random(seed);
    Constraints& constraints = s.data->constraints;
    constraints.setRay(random.vector(s.model.nv, 50.0));
    std::vector<Crossing> crossings;
    constraints.ellipticContact.findCrossings(7, crossings);
    double at = 0.0;
    const auto zoneAt = [&](double alpha, int row) {
      constraints.advance(alpha - at);
      at = alpha;
      const EllipticContact& contact = constraints.ellipticContact;
      for (std::size_t i = 0; i < contact.contactsWithRows().size(); ++i)
        if (contact.contactsWithRows()[i].row == row)
          return static_cast<int>(
              contact.cone(static_cast<int>(i)).point(contact.x.data() + row).zone());
      return -1;
    };
    for (const Crossing& c : crossings) {
      if (c.alpha > 5.0) continue;
      ++found;
      const double step = 1e-7 * (1.0 + c.alpha);
      const int before = zoneAt(c.alpha - step, c.breakpoint.row.row);
      const int after = zoneAt(c.alpha + step, c.breakpoint.row.row);
      EXPECT_EQ(std::min(before, after), c.breakpoint.index) << "seed " << seed;
      EXPECT_EQ(std::max(before, after), c.breakpoint.index + 1) << "seed " << seed;
      EXPECT_EQ(after > before, c.rate > 0.0);
      EXPECT_EQ(c.curvatureJump<0.0, c.rate> 0.0);
    }
  }
  EXPECT_GT(found, 60);
}

/// A humanoid that falls on the ground, all of it turned and moved by X_NW.
Scene fallingHumanoid(const Transform& X_NW) {
  ModelBuilder source = humanoid();
  source.options.gravity = X_NW.R * source.options.gravity;
  source.options.cone = Cone::elliptic;
  Model model = source.build();
  for (Geometry& g : model.geometries)
    if (g.body == 0) g.X_BG = X_NW * g.X_BG;
  return Scene(std::move(model), std::make_shared<SampleContacts>());
}

// No direction of the tangent plane is special: the tangents need not turn along.
TEST(EllipticContact, FrictionIsTheSameInEveryDirection) {
  Scene a = fallingHumanoid({});
  const Transform X_NW{Eigen::AngleAxisd(0.7, Vector3::UnitZ()).toRotationMatrix(),
                       Vector3(1.0, -2.0, 0.0)};
  Scene b = fallingHumanoid(X_NW);
  a.state.v = Random(6).vector(a.model.nv, 0.5);
  b.state = a.state;
  for (const Body& body : a.model.bodies) {
    if (body.joint != JointKind::floating) continue;
    const Quaternion turned =
        Quaternion(X_NW.R) * Quaternion(a.state.q[body.q + 3], a.state.q[body.q + 4],
                                        a.state.q[body.q + 5], a.state.q[body.q + 6]);
    b.state.q.segment<3>(body.q) = X_NW * Vector3(a.state.q.segment<3>(body.q));
    b.state.q.segment<4>(body.q + 3) << turned.w(), turned.x(), turned.y(), turned.z();
    b.state.v.segment<3>(body.v) = X_NW.R * a.state.v.segment<3>(body.v);
  }
  int contacts = 0;
  for (int i = 0; i < 150; ++i) {
    a.step();
    b.step();
    contacts += a.data->stats.contacts;
  }
  EXPECT_GT(contacts, 75);
  // Joints know nothing of the world's axes. Rounding grows over 150 steps.
  EXPECT_APPROX(b.state.q.tail(b.model.nq - 7), a.state.q.tail(a.model.nq - 7), 1e-9);
}

}  // namespace
}  // namespace softgauss::test
