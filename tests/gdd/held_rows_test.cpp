// SPDX-License-Identifier: Apache-2.0
/// Rows held at their breakpoints (10.6), and the kinks at which the solver ends.

#include <Eigen/Cholesky>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

MatrixX jacobianOf(const gdd::HeldRows& held, int dofs) {
  MatrixX J(held.size(), dofs);
  for (int i = 0; i < held.size(); ++i) J.row(i) = held[i].J.transpose();
  return J;
}

/// The number of the pyramids among the kinds of rows.
constexpr int kPyramids = static_cast<int>(RowKind::pyramid);

/// The four edges of each of the first `contacts` frictional contacts.
void holdContacts(const Constraints& constraints, int contacts, gdd::HeldRows& held) {
  for (const ContactRows& made : constraints.contact.contactsWithRows()) {
    if (made.frictionDim == 0) continue;
    if (contacts-- == 0) return;
    for (int i = 0; i < 4; ++i) held.hold({{kPyramids, made.row + i}}, constraints);
  }
}

TEST(HeldRows, ProjectionStaysAtTheKnotsAlsoWhereRowsDepend) {
  double worst = 0.0, worstSystem = 0.0;
  int dependent = 0;
  for (int seed = 0; seed < 100; ++seed) {
    GddScene s = randomGddScene(seed, 4);
    Random random(seed);
    gdd::HeldRows held(s.dofs());
    holdContacts(s.data().constraints, 1 + random.index(2), held);
    if (held.empty()) continue;
    const VectorX a = random.vector(s.dofs(), 10.0);
    const Eigen::LLT<MatrixX> H(s.dense.gaussNewtonHessian(a));
    const VectorX gradient = s.dense.augmentedGradient(a);
    VectorX d = -H.solve(gradient);
    const double before = (jacobianOf(held, s.dofs()) * d).norm();
    held.project(d, [&](VectorX& x) { x = H.solve(x).eval(); });

    const MatrixX J = jacobianOf(held, s.dofs());
    worst = std::max(worst, (J * d).norm() / before);
    VectorX mu(held.size());
    for (int i = 0; i < held.size(); ++i) {
      mu[i] = held[i].multiplier;
      dependent += held[i].dependent;
      EXPECT_TRUE(!held[i].dependent || mu[i] == 0.0);
    }
    const VectorX system = s.dense.gaussNewtonHessian(a) * d + J.transpose() * mu + gradient;
    const double scale = gradient.norm() + (J.transpose() * mu).norm();
    worstSystem = std::max(worstSystem, system.norm() / scale);
  }
  // Rounding, times the condition of J H⁻¹ Jᵀ where stiff bounds leave the rows little room.
  EXPECT_SMALL(worst, 1e-7);
  EXPECT_SMALL(worstSystem, 1e-7);
  EXPECT_GE(dependent, 90) << "one edge of every pyramid depends on the others";
}

TEST(HeldRows, HoldingTwiceHoldsOnceAndReleaseForgets) {
  GddScene s = randomGddScene(3, 4);
  gdd::HeldRows held(s.dofs());
  const Constraints& constraints = s.data().constraints;
  ASSERT_GE(constraints.contact.rowCount(), 3);
  const int kind = kPyramids;
  for (const int row : {0, 1, 2, 1, 0}) held.hold({{kind, row}}, constraints);
  EXPECT_EQ(held.size(), 3);
  held.release(1);
  ASSERT_EQ(held.size(), 2);
  EXPECT_EQ(held[0].breakpoint.row, (RowId{kind, 0}));
  EXPECT_EQ(held[1].breakpoint.row, (RowId{kind, 2}));
  held.clear();
  EXPECT_TRUE(held.empty());
}

/// Scenes of which many end at a kink: heavy goals near contacts; dry friction in odd ones.
GddScene kinkScene(std::uint64_t seed) {
  GddScene s = lawGddScene(seed, 5, 0.3);
  Random random(seed + 31);
  const int body = 1 + random.index(s.model().bodyCount() - 1);
  s.addPoint(body, s.data().kinematics.X_WB[body].p, 3000.0, random.vector3(5.0));
  return s;
}

/// Slope of Φ at a towards d, rows within `width` of their breakpoints being at them.
double slopeTowards(const DenseGdd& s, const VectorX& a, const VectorX& d, double width) {
  const VectorX g = s.g(a), w = s.Minv * g + s.penaltySlope(g);
  const VectorX x = s.residual(a), dx = s.J * d;
  VectorX rate = s.Mhat * d;
  std::vector<bool> stiff;
  for (int i = 0; i < s.rows(); ++i) {
    stiff.push_back(s.stiff(i, x[i], dx[i], width));
    if (stiff[i]) rate += s.D[i] * dx[i] * s.J.row(i).transpose();
  }
  return w.dot(rate) + s.goalGradient(a, stiff).dot(d);
}

// Directional stationarity: Φ falls to no side, neither along random directions nor along those
// that move one held row alone.
TEST(GddKink, ObjectiveFallsInNoDirection) {
  int kinks = 0, smooth = 0, unfinished = 0, held = 0, heldBelow = 0, rounded = 0;
  for (int seed = 0; seed < 150; ++seed) {
    GddScene s = kinkScene(seed);
    const VectorX a = s.solve();
    unfinished += s.report.status == gdd::GddStatus::iterationLimit;
    smooth += s.report.status == gdd::GddStatus::converged;
    if (s.report.status != gdd::GddStatus::nonsmoothMinimum) continue;
    ++kinks;
    rounded += s.report.stationarity > 1e-3;
    const DenseGdd& d = s.dense;
    const VectorX x = d.residual(a);
    const double width = 1e-8 * (1.0 + d.aRef.cwiseAbs().maxCoeff());
    const Eigen::LLT<MatrixX> M(d.M);
    Random random(seed);
    std::vector<VectorX> directions;
    for (int i = 0; i < 200; ++i) directions.push_back(random.vector(s.dofs(), 1.0));
    for (int i = 0; i < d.rows(); ++i) {
      const double below = std::abs(x[i] - d.lowerKnot(i));
      if (below > width && std::abs(x[i] - d.upperKnot(i)) > width) continue;
      ++held;
      heldBelow += below <= width;
      directions.push_back(M.solve(d.J.row(i).transpose()));
    }
    // The jump of the slope at a breakpoint is what a wrong certificate would miss.
    const VectorX scale = d.M.diagonal().cwiseSqrt();
    const double wish = d.goalGradient(a).cwiseQuotient(scale).cwiseAbs().maxCoeff();
    for (const VectorX& direction : directions) {
      const double length = direction.cwiseProduct(scale).lpNorm<1>();
      for (const double sign : {1.0, -1.0}) {
        const double slope = slopeTowards(d, a, sign * direction, width);
        const double descent = -slope / (length * std::max(1.0, wish));
        EXPECT_LE(descent, std::max(1e-7, s.report.stationarity)) << "seed " << seed;
      }
    }
  }
  // The solver stops at a scaled gradient of 1e-8, or where rounding ends its progress, and says
  // so.
  EXPECT_EQ(rounded, 0);
  EXPECT_GT(kinks, 20);
  EXPECT_GT(held, kinks);
  EXPECT_GT(heldBelow, 5) << "rows at the lower breakpoint of their friction";
  EXPECT_LE(unfinished, 15);
  RecordProperty("kinks", kinks);
  RecordProperty("smooth", smooth);
}

// The same by values of Φ alone, a small step to every side.
TEST(GddKink, ObjectiveIsLowestNearby) {
  int kinks = 0;
  for (int seed = 0; seed < 80; ++seed) {
    GddScene s = kinkScene(seed);
    const VectorX a = s.solve();
    if (s.report.status != gdd::GddStatus::nonsmoothMinimum) continue;
    ++kinks;
    const double here = s.dense.augmented(a);
    Random random(seed + 77);
    for (int i = 0; i < 200; ++i) {
      const VectorX d = random.vector(s.dofs(), 1e-3 * (1.0 + a.cwiseAbs().maxCoeff()));
      EXPECT_GE(s.dense.augmented(a + d), here - 1e-12 * std::abs(here)) << "seed " << seed;
    }
  }
  EXPECT_GT(kinks, 10);
}

}  // namespace
}  // namespace softgauss::test
