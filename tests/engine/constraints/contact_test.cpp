// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/contact.hpp"

#include "softgauss/engine/constraints/impedance.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/reference_solver.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

TEST(MixMaterials, TakesMaximaMeansAndSums) {
  Material a, b;
  a.slidingFriction = 0.3, b.slidingFriction = 0.7;
  a.torsionalFriction = 0.02, b.torsionalFriction = 0.01;
  a.rollingFriction = 0.001, b.rollingFriction = 0.002;
  a.condim = 1, b.condim = 3;
  a.margin = 0.001, b.margin = 0.003;
  a.impedance = {0.01, 0.5, 0.8, 0.90, 0.001, 0.3, 1.0};
  b.impedance = {0.03, 1.5, 0.9, 0.96, 0.003, 0.5, 3.0};
  for (const Material& m : {mixMaterials(a, b), mixMaterials(b, a)}) {
    EXPECT_EQ(m.slidingFriction, 0.7);
    EXPECT_EQ(m.torsionalFriction, 0.02);
    EXPECT_EQ(m.rollingFriction, 0.002);
    EXPECT_EQ(m.condim, 3);
    EXPECT_SMALL(m.margin - 0.004, 1e-18);
    EXPECT_SMALL(m.impedance.timeConstant - 0.02, 1e-16);
    EXPECT_SMALL(m.impedance.dampingRatio - 1.0, 1e-16);
    EXPECT_SMALL(m.impedance.dMin - 0.85, 1e-15);
    EXPECT_SMALL(m.impedance.dMax - 0.93, 1e-15);
    EXPECT_SMALL(m.impedance.width - 0.002, 1e-16);
    EXPECT_SMALL(m.impedance.midpoint - 0.4, 1e-16);
    EXPECT_SMALL(m.impedance.power - 2.0, 1e-16);
  }
}

TEST(MixMaterials, WeighsTheImpedancesAndLeavesTheRest) {
  Material a, b;
  a.slidingFriction = 0.3, b.slidingFriction = 0.7;
  a.impedance.timeConstant = 0.01, b.impedance.timeConstant = 0.05;
  a.mixWeight = 3.0, b.mixWeight = 1.0;
  for (const Material& m : {mixMaterials(a, b), mixMaterials(b, a)}) {
    EXPECT_SMALL(m.impedance.timeConstant - 0.02, 1e-17);
    EXPECT_EQ(m.slidingFriction, 0.7);
  }
  b.mixWeight = 0.0;
  EXPECT_EQ(mixMaterials(a, b).impedance.timeConstant, 0.01);
  EXPECT_EQ(mixMaterials(b, a).impedance.timeConstant, 0.01);
  a.mixWeight = 0.0;
  EXPECT_SMALL(mixMaterials(a, b).impedance.timeConstant - 0.03, 1e-17);
}

TEST(MixMaterials, HigherPriorityDecidesOnAllButTheMargin) {
  Material a, b;
  a.slidingFriction = 0.3, b.slidingFriction = 0.7;
  a.condim = 1, b.condim = 6;
  a.margin = 0.001, b.margin = 0.003;
  a.impedance.timeConstant = 0.01, b.impedance.timeConstant = 0.05;
  b.spring = ContactSpring{1e4, 0.0, 10.0, 0.0};
  a.priority = 1;
  for (const Material& m : {mixMaterials(a, b), mixMaterials(b, a)}) {
    EXPECT_EQ(m.slidingFriction, 0.3);
    EXPECT_EQ(m.condim, 1);
    EXPECT_EQ(m.impedance, a.impedance);
    EXPECT_FALSE(m.spring);
    EXPECT_SMALL(m.margin - 0.004, 1e-18);
  }
}

/// A scene with one contact between two trees, its rows assembled.
Scene oneContact(std::uint64_t seed, const std::function<void(Model&, Contact&)>& change) {
  Random random(seed);
  Scene s(randomForest(seed).build());
  s.model.options.constraintModel = ConstraintModel::mujoco;  // that is of supported_mass_test.cpp
  s.model.ranges.clear();
  s.state = randomState(s.model, random);
  computeKinematics(s.model, s.state, s.data->kinematics);
  auto source =
      std::make_shared<FixedContacts>(randomContacts(s.model, s.data->kinematics, random, 1));
  Contact& c = source->points[0];
  c.distance = -0.0004;
  for (Geometry& g : s.model.geometries) {
    g.material.condim = 3;
    g.material.margin = 0.0;
    g.material.slidingFriction = 0.6;
  }
  change(s.model, c);
  s.contacts = source;
  s.stages();
  return s;
}

TEST(Contact, RowsAreTheEdgesOfThePyramid) {
  for (int seed = 0; seed < 20; ++seed) {
    Scene s = oneContact(seed, [](Model& m, Contact&) { m.options.impedanceRatio = 2.5; });
    const Contact& c = s.data->contacts.contacts[0];
    const PyramidalContact& rows = s.data->constraints.contact;
    ASSERT_EQ(rows.rowCount(), 4);
    Eigen::Matrix<double, 3, Eigen::Dynamic> Ja(3, s.model.nv), Jb(3, s.model.nv);
    pointJacobian(s.model, s.data->kinematics, c.bodyA, c.p_WC, Ja);
    pointJacobian(s.model, s.data->kinematics, c.bodyB, c.p_WC, Jb);
    const Matrix3 R_WC = rows.contactsWithRows()[0].R_WC;
    const MatrixX J = R_WC.transpose() * (Jb - Ja);
    EXPECT_EQ(R_WC.col(0), c.n_W);
    EXPECT_APPROX(R_WC.transpose() * R_WC, Matrix3::Identity(), 1e-14);
    EXPECT_SMALL(R_WC.determinant() - 1.0, 1e-14);

    const double mu = 0.6, r = c.distance;
    const auto& w = s.data->weights.translation;
    const Softness soft =
        softnessAt(Impedance{}, r, (w[c.bodyA] + w[c.bodyB]) * (1 + mu * mu), 0.002);
    const ConvexProblem p = denseProblem(*s.data);
    for (int row = 0; row < 4; ++row) {
      const double sign = row % 2 == 0 ? 1.0 : -1.0;
      const MatrixX edge = J.row(0) + sign * mu * J.row(1 + row / 2);
      EXPECT_APPROX(p.J.row(row), edge, 1e-14);
      const double velocity = (edge * s.state.v)(0);
      const double aRef = soft.referenceAcceleration(velocity, r);
      EXPECT_SMALL(p.aRef[row] / aRef - 1.0, 1e-12);
      EXPECT_SMALL(p.D[row] * 2 * mu * mu * soft.R / 2.5 - 1.0, 1e-14);
    }
  }
}

// condim 4 and 6: pairs of edges of the relative rotation too, all with one R.
TEST(Contact, RowsOfTorsionalAndRollingFrictionAreEdgesOfTheRotation) {
  for (const int condim : {4, 6}) {
    Scene s = oneContact(condim, [&](Model& m, Contact&) {
      for (Geometry& g : m.geometries) {
        g.material.condim = condim;
        g.material.torsionalFriction = 0.03;
        g.material.rollingFriction = 0.0;  // counts as 10⁻⁵
      }
    });
    const Contact& c = s.data->contacts.contacts[0];
    const PyramidalContact& rows = s.data->constraints.contact;
    ASSERT_EQ(rows.rowCount(), 2 * (condim - 1));
    Eigen::Matrix<double, 3, Eigen::Dynamic> Ja(3, s.model.nv), Jb(3, s.model.nv);
    const Matrix3 R_CW = rows.contactsWithRows()[0].R_WC.transpose();
    MatrixX J(6, s.model.nv);
    pointJacobian(s.model, s.data->kinematics, c.bodyA, c.p_WC, Ja);
    pointJacobian(s.model, s.data->kinematics, c.bodyB, c.p_WC, Jb);
    J.topRows(3) = R_CW * (Jb - Ja);
    rotationJacobian(s.model, s.data->kinematics, c.bodyA, Ja);
    rotationJacobian(s.model, s.data->kinematics, c.bodyB, Jb);
    J.bottomRows(3) = R_CW * (Jb - Ja);
    const double mu[5] = {0.6, 0.6, 0.03, 1e-5, 1e-5};
    const ConvexProblem p = denseProblem(*s.data);
    const auto& w = s.data->weights.translation;
    const Softness soft =
        softnessAt(Impedance{}, c.distance, (w[c.bodyA] + w[c.bodyB]) * 1.36, 0.002);
    for (int row = 0; row < p.J.rows(); ++row) {
      const double sign = row % 2 == 0 ? 1.0 : -1.0;
      const MatrixX edge = J.row(0) + sign * mu[row / 2] * J.row(1 + row / 2);
      EXPECT_APPROX(p.J.row(row), edge, 1e-14);
      const double aRef = soft.referenceAcceleration((edge * s.state.v)(0), c.distance);
      EXPECT_SMALL(p.aRef[row] / aRef - 1.0, 1e-12);
      EXPECT_SMALL(p.D[row] * 2 * 0.36 * soft.R - 1.0, 1e-14);
    }
  }
}

TEST(Contact, WithoutFrictionHasOneRow) {
  const auto frictionless = {std::function<void(Model&, Contact&)>([](Model& m, Contact&) {
                               for (Geometry& g : m.geometries) g.material.condim = 1;
                             }),
                             std::function<void(Model&, Contact&)>([](Model& m, Contact&) {
                               for (Geometry& g : m.geometries) g.material.slidingFriction = 0.0;
                             })};
  for (const auto& change : frictionless) {
    Scene s = oneContact(3, change);
    const Contact& c = s.data->contacts.contacts[0];
    const auto& w = s.data->weights.translation;
    const PyramidalContact& rows = s.data->constraints.contact;
    ASSERT_EQ(rows.rowCount(), 1);
    const Softness soft = softnessAt(Impedance{}, c.distance, w[c.bodyA] + w[c.bodyB], 0.002);
    EXPECT_SMALL(rows.D[0] * soft.R - 1.0, 1e-14);
    s.forward();
    const Vector3 f = rows.force(0);
    EXPECT_SMALL(f.cross(c.n_W).norm(), 1e-12 * (1.0 + f.norm()));
  }
}

TEST(Contact, OfAPairWithASurfaceOfItsOwnFollowsThat) {
  Material own;
  own.condim = 4;
  own.slidingFriction = 0.2;
  own.torsionalFriction = 0.07;
  own.margin = 0.002;
  own.impedance.timeConstant = 0.05;
  for (const bool swapped : {false, true}) {
    const Scene s = oneContact(7, [&](Model& m, Contact& c) {
      c.distance = 0.001;  // beyond the geometries' own margins
      if (swapped) {
        std::swap(c.bodyA, c.bodyB);
        std::swap(c.geometryA, c.geometryB);
      }
      const auto [a, b] = std::minmax(c.geometryA, c.geometryB);
      m.contactPairs = {{a, b, own}};
    });
    const PyramidalContact& rows = s.data->constraints.contact;
    ASSERT_EQ(rows.rowCount(), 6);
    EXPECT_EQ(rows.contactsWithRows()[0].friction[0], 0.2);
    EXPECT_EQ(rows.contactsWithRows()[0].friction[2], 0.07);
    const Contact& c = s.data->contacts.contacts[0];
    const auto& w = s.data->weights.translation;
    const Softness soft =
        softnessAt(own.impedance, -0.001, (w[c.bodyA] + w[c.bodyB]) * 1.04, 0.002);
    EXPECT_SMALL(rows.D[0] * 2 * 0.04 * soft.R - 1.0, 1e-12);
  }
}

TEST(Contact, DistanceCountsFromTheMargin) {
  const auto margin = [](double total, double distance) {
    return [=](Model& m, Contact& c) {
      for (Geometry& g : m.geometries) g.material.margin = 0.5 * total;
      c.distance = distance;
    };
  };
  // The same rows with a margin of 1 mm one millimetre further out.
  const Scene a = oneContact(4, margin(0.0, -0.0004)), b = oneContact(4, margin(0.001, 0.0006));
  ASSERT_EQ(a.data->stats.rows, 4);
  ASSERT_EQ(b.data->stats.rows, 4);
  for (int i = 0; i < 4; ++i)
    EXPECT_SMALL(
        b.data->constraints.contact.reference[i] / a.data->constraints.contact.reference[i] - 1.0,
        1e-12);
  // Touching is not yet a contact.
  EXPECT_EQ(oneContact(4, margin(0.0, 0.0)).data->stats.rows, 0);
  EXPECT_EQ(oneContact(4, margin(0.0, 0.001)).data->stats.rows, 0);
  EXPECT_EQ(oneContact(4, margin(0.001, 0.001)).data->stats.rows, 0);
}

TEST(Contact, BetweenBodiesThatCannotMoveMakesNoRows) {
  Scene s(boxOnPlane({0.1, 0.1, 0.1}, 1.0, 1.0).build());
  auto source = std::make_shared<FixedContacts>();
  Contact c;
  c.distance = -0.001;
  source->points = {c};
  s.contacts = source;
  s.stages();
  EXPECT_EQ(s.data->stats.contacts, 1);
  EXPECT_EQ(s.data->stats.rows, 0);
}

TEST(Contact, FollowsTheWishedTangent) {
  const Vector3 wish(0.3, -0.4, 0.7);
  const Scene s = oneContact(5, [&](Model&, Contact& c) { c.tangent_W = wish; });
  const Matrix3 R = s.data->constraints.contact.contactsWithRows()[0].R_WC;
  const Vector3 n = R.col(0);
  EXPECT_APPROX(R.col(1), (wish - n * n.dot(wish)).normalized(), 1e-14);
  EXPECT_APPROX(R.col(2), n.cross(R.col(1)), 1e-14);
  // A wish near the normal is followed too, as by a capsule that stands on its end.
  const Scene steep = oneContact(5, [&](Model&, Contact& c) { c.tangent_W = c.n_W + 1e-3 * wish; });
  EXPECT_APPROX(steep.data->constraints.contact.contactsWithRows()[0].R_WC.col(1), R.col(1), 1e-12);
  // A wish along the normal cannot be.
  const Scene along = oneContact(5, [&](Model&, Contact& c) { c.tangent_W = c.n_W; });
  EXPECT_EQ(along.data->constraints.contact.contactsWithRows()[0].R_WC,
            frameFromNormal(along.data->contacts.contacts[0].n_W));
}

TEST(Contact, SwapOfBodiesTurnsTheNormalAndChangesNothing) {
  const auto keepTangents = [](Model& m, Contact& c) {
    c.tangent_W = frameFromNormal(c.n_W).col(1);
    m.options.tolerance = 1e-14;
  };
  Scene a = oneContact(6, keepTangents);
  Scene b = oneContact(6, [&](Model& m, Contact& c) {
    keepTangents(m, c);
    std::swap(c.bodyA, c.bodyB);
    std::swap(c.geometryA, c.geometryB);
    c.n_W = -c.n_W;
  });
  a.forward();
  b.forward();
  EXPECT_APPROX(a.data->forward.a, b.data->forward.a, 1e-11);
}

}  // namespace
}  // namespace softgauss::test
