// SPDX-License-Identifier: Apache-2.0
/// Friction without creep: what Options::noSlip gains, what it keeps and what it costs.

#include "softgauss/engine/step/inverse.hpp"
#include "softgauss/engine/step/snapshot.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

/// A box of 2 kg at rest on a slope of `theta` with friction `mu`.
Scene boxOnSlope(double theta, double mu, Cone cone, bool noSlip) {
  const Matrix3 R = Eigen::AngleAxisd(theta, Vector3::UnitY()).toRotationMatrix();
  ModelBuilder builder = boxOnPlane({0.1, 0.1, 0.02}, 2.0, mu, R);
  builder.options.cone = cone;
  builder.options.noSlip = noSlip;
  builder.options.mechanisms.remove(Mechanism::nearRigid);  // noSlip goes without
  Scene s(builder.build(), std::make_shared<SampleContacts>());
  const Quaternion q(R);
  s.state.q.head<3>() = R.col(2) * 0.0199;
  s.state.q.tail<4>() << q.w(), q.x(), q.y(), q.z();
  return s;
}

double speedDownhill(const Scene& s, double theta) {
  return (Eigen::AngleAxisd(theta, Vector3::UnitY()).toRotationMatrix().col(0))
      .dot(s.state.v.head<3>());
}

double physicsViolation(Scene& s) {
  VectorX tau(s.model.nv);
  inverseDynamics(s.model, s.data->forward.a, *s.data, tau);
  return (tau - s.data->forces.tau).cwiseAbs().maxCoeff();
}

// The creep of a load f_t is R_t f_t/b, and R_t is 10⁴ times smaller.
TEST(NoSlip, BoundsTheCreepOfALoad) {
  // The load is this share of what friction can bear. Up to a half all edges of a pyramid share it.
  for (const double share : {0.3, 0.45, 0.9})
    for (const double mu : {0.05, 0.2, 0.8})
      for (const Cone cone : kCones) {
        const double theta = std::atan(share * mu);
        Scene soft = boxOnSlope(theta, mu, cone, false), stiff = boxOnSlope(theta, mu, cone, true);
        soft.steps(2000);
        stiff.steps(2000);
        const double creep = speedDownhill(soft, theta);
        EXPECT_GT(creep, 1e-5);
        const double ratio = speedDownhill(stiff, theta) * NoSlipFriction::kStiffer / creep;
        if (share < 0.5 || cone == Cone::elliptic) {
          EXPECT_SMALL(ratio - 1.0, 1e-2) << "friction " << mu << ", share " << share;
        } else {
          EXPECT_LE(ratio, 1.0) << "friction " << mu;
        }
      }
}

// Beyond the friction cone it slides, and there the second solve finds nothing to improve.
TEST(NoSlip, SlidesAsWithout) {
  const double theta = 0.6, mu = 0.3;
  for (const Cone cone : kCones) {
    Scene soft = boxOnSlope(theta, mu, cone, false), stiff = boxOnSlope(theta, mu, cone, true);
    soft.model.options.mechanisms.remove(Mechanism::slipCorrection);  // noSlip goes without
    int pressed = 0;
    for (int i = 0; i < 500; ++i) {
      soft.step();
      stiff.step();
      std::vector<Snapshot::ContactForce> contacts;
      contactForces(*stiff.data, contacts);
      for (const Snapshot::ContactForce& c : contacts) {
        const Vector3 friction = c.force - c.normalForce() * c.n_W;
        if (speedDownhill(stiff, theta) < 0.1 || c.normalForce() < 1e-3) continue;
        ++pressed;
        EXPECT_LE(friction.norm(), mu * c.normalForce() * (1.0 + 1e-9));
        // A pyramid that slides slowly leaves some of the load to edges that do not rub.
        EXPECT_GE(friction.norm(),
                  mu * c.normalForce() * (cone == Cone::elliptic ? 0.999999 : 0.4));
        EXPECT_GT(friction.dot(c.n_W.cross(Vector3::UnitY())), 0.0) << "against the motion";
      }
    }
    EXPECT_GT(pressed, 200);
    EXPECT_SMALL(speedDownhill(stiff, theta) / speedDownhill(soft, theta) - 1.0, 1e-6);
  }
}

/// Normal force that bounds the friction of contact i of the snapshot.
double boundOf(const Scene& s, int i) {
  // Pyramids are taken first; the snapshot has all in the order of the contacts.
  const PyramidalContact& pyramids = s.data->constraints.contact;
  const EllipticContact& cones = s.data->constraints.ellipticContact;
  std::vector<std::pair<int, int>> order;
  for (const ContactRows& made : pyramids.contactsWithRows())
    order.emplace_back(made.contact, static_cast<int>(order.size()));
  for (const ContactRows& made : cones.contactsWithRows())
    order.emplace_back(made.contact, static_cast<int>(order.size()));
  std::sort(order.begin(), order.end());
  return s.data->noSlipFriction.bound(order[static_cast<std::size_t>(i)].second);
}

TEST(NoSlip, ForcesStayInTheFrictionCone) {
  int patches = 0, creeping = 0;
  for (int seed = 0; seed < 100; ++seed)
    for (const Cone cone : kCones) {
      Scene s = lawScene(seed, 8);
      s.model.options.cone = cone;
      s.model.options.noSlip = true;
      s.stages();
      ASSERT_EQ(s.forward(), SolveStatus::converged) << "seed " << seed;
      std::vector<Snapshot::ContactForce> contacts;
      contactForces(*s.data, contacts);
      for (std::size_t i = 0; i < contacts.size(); ++i) {
        const Snapshot::ContactForce& c = contacts[i];
        const double mu = pairMaterial(s.model, c.geometryA, c.geometryB).slidingFriction;
        EXPECT_GE(c.normalForce(), -1e-12);
        if (s.data->noSlipFriction.rowCount() == 0) {
          ++creeping;
          break;
        }
        const double bound = mu * boundOf(s, static_cast<int>(i));
        const double tangential = (c.force - c.normalForce() * c.n_W).norm();
        // Rounding of −D U, which may be 10⁸ times what the bound leaves of it.
        EXPECT_LE(tangential, bound * (1.0 + 1e-6) + 1e-9) << "seed " << seed;
        patches += tangential > 0.0;
      }
    }
  EXPECT_GT(patches, 400);
  EXPECT_LE(creeping, 4);  // of 200: where the second solve does not converge, the first one stands
}

// Newton's equation holds with the forces that are reported: nothing is lost between the solves.
TEST(NoSlip, ForcesGiveTheAcceleration) {
  int solved = 0;
  for (int seed = 0; seed < 60; ++seed)
    for (const Cone cone : kCones) {
      Scene s = lawScene(seed, 6);
      s.model.options.cone = cone;
      s.model.options.noSlip = true;
      s.stages();
      s.forward();
      if (s.data->noSlipFriction.rowCount() == 0) continue;
      ++solved;
      const VectorX Ma = s.data->inertia.hat().dense() * s.data->forward.a;
      VectorX force = s.data->forces.net;
      s.data->constraints.visitAllButContacts([&](const auto& c) { c.addTransposed(c.f, force); });
      s.data->noSlipFriction.addForce(force);
      const VectorX unit = s.data->inertia.hat().dense().diagonal().cwiseSqrt();
      const double scale = 1.0 + Ma.cwiseQuotient(unit).cwiseAbs().maxCoeff();
      EXPECT_SMALL((Ma - force).cwiseQuotient(unit).cwiseAbs().maxCoeff() / scale, 1e-8)
          << "seed " << seed;
    }
  EXPECT_GT(solved, 110);
}

// The price: inverse dynamics miss the applied force by the change of the friction. At rest on the
// slope, where all of it creeps without, that is the load itself.
TEST(NoSlip, CostsTheConsistencyOfTheInverse) {
  const double theta = 0.2, mu = 0.8;
  for (const Cone cone : kCones) {
    Scene soft = boxOnSlope(theta, mu, cone, false), stiff = boxOnSlope(theta, mu, cone, true);
    soft.steps(500);
    stiff.steps(500);
    EXPECT_SMALL(physicsViolation(soft), 1e-9);
    const double load = 2.0 * 9.81 * std::sin(theta) * std::cos(theta);  // along world x
    EXPECT_SMALL(physicsViolation(stiff) / load - 1.0, 1e-2);
  }
}

TEST(NoSlip, WithoutFrictionNothingChanges) {
  ModelBuilder builder = sphereOnPlane(0.1, 1.0, 0.0);
  builder.options.mechanisms.remove(Mechanism::nearRigid);  // noSlip goes without
  Scene a(builder.build(), std::make_shared<SampleContacts>());
  builder.options.noSlip = true;
  Scene b(builder.build(), std::make_shared<SampleContacts>());
  a.state.v[0] = b.state.v[0] = 0.4;
  a.steps(200);
  b.steps(200);
  EXPECT_EQ(a.state.q, b.state.q);
  EXPECT_EQ(a.state.v, b.state.v);
}

}  // namespace
}  // namespace softgauss::test
