// SPDX-License-Identifier: Apache-2.0
/// Forward dynamics (13), its inverse (14) and the Jacobian of that (15), with contacts and limits.

#include <Eigen/Cholesky>

#include "tests/laws/law_measures.hpp"
#include "tests/support/finite_difference.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/reference_solver.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// Pieces that the rows of s are in: curvature zero or not.
std::vector<double> cellOf(const Scene& s) {
  std::vector<double> h;
  s.data->constraints.visit([&](const auto& c) {
    if constexpr (requires { c.h; }) h.insert(h.end(), c.h.begin(), c.h.end());
  });
  return h;
}

int activeRows(const Scene& s) {
  int active = 0;
  for (const double h : cellOf(s)) active += h != 0.0;
  return active;
}

TEST(Inverse, RecoversForward) {
  int limits = 0, contacts = 0;
  double worst = 0.0;
  for (int seed = 0; seed < 1000; ++seed) {
    Scene s = lawScene(seed, 6);
    ASSERT_EQ(s.forward(), SolveStatus::converged) << "seed " << seed;
    limits += s.data->constraints.jointLimit.rowCount() > 0 && activeRows(s) > 0;
    contacts += s.data->constraints.contact.rowCount() > 0;
    const double relative = inverseMiss(s);
    worst = std::max(worst, relative);
    EXPECT_LE(relative, 1e-10) << "seed " << seed;
  }
  EXPECT_SMALL(worst, 1e-10);
  // Most of the scenes do have contacts and limits at work.
  EXPECT_GT(limits, 500);
  EXPECT_GT(contacts, 900);
}

// Also where a is no solution: the other way round, forward dynamics undo inverse dynamics.
TEST(Forward, RecoversInverse) {
  double worst = 0.0;
  for (int seed = 0; seed < 200; ++seed) {
    Scene s = lawScene(seed, 6);
    Random random(seed);
    const VectorX a = random.vector(s.model.nv, 100.0);
    setAppliedForce(inverse(s, a), s.data->forces);
    ASSERT_EQ(s.forward(), SolveStatus::converged) << "seed " << seed;
    worst = std::max(worst, (s.data->forward.a - a).cwiseAbs().maxCoeff() / 100.0);
  }
  // The gradient's 1e-12 divided by eigenvalues of M down to 1e-3 of its diagonal.
  EXPECT_SMALL(worst, 1e-8);
}

TEST(Inverse, IsTheGradientOfTheCost) {
  for (int seed = 0; seed < 40; ++seed) {
    Scene s = lawScene(seed, 6);
    Random random(seed);
    const VectorX a = random.vector(s.model.nv, 30.0);
    const ConvexProblem p = denseProblem(*s.data);
    EXPECT_APPROX(inverse(s, a) - s.input.tau, p.gradient(a), 1e-13) << "seed " << seed;
    const auto cost = [&](const VectorX& x) { return VectorX(VectorX::Constant(1, p.cost(x))); };
    // The cost is a quadratic of O(1e4) in each cell: a step of 1e-4 leaves 1e-8 of rounding.
    EXPECT_APPROX(p.gradient(a).transpose(), gradient(a, cost, 1e-4), 1e-6) << "seed " << seed;
  }
}

TEST(InverseJacobian, MatchesFiniteDifferencesInsideACell) {
  int compared = 0, coupled = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Scene s = lawScene(seed, 6);
    s.forward();
    const VectorX a = s.data->forward.a;
    inverse(s, a);
    const std::vector<double> cell = cellOf(s);
    if (activeRows(s) == 0) continue;
    TreeMatrix P;
    inverseDynamicsJacobian(*s.data, P);

    bool sameCell = true;
    const MatrixX difference = gradient(
        a,
        [&](const VectorX& x) {
          const VectorX tau = inverse(s, x);
          sameCell &= cellOf(s) == cell;
          return tau;
        },
        1e-4);
    if (!sameCell) continue;
    ++compared;
    coupled += &P.sparsity() != &s.data->inertia.sparsity;
    // τ(a) is linear in a cell: only rounding of τ ~ 1e3 over a step of 1e-4 remains.
    EXPECT_APPROX(P.dense(), difference, 1e-8) << "seed " << seed;
    EXPECT_FALSE(P.dense() == difference) << "a thing compared with itself, seed " << seed;
  }
  EXPECT_GT(compared, 40);
  EXPECT_GT(coupled, 30);
}

TEST(InverseJacobian, IsMassMatrixPlusCurvatureAndPositiveDefinite) {
  for (int seed = 0; seed < 60; ++seed) {
    Scene s = lawScene(seed, 6);
    s.forward();
    inverse(s, s.data->forward.a);
    TreeMatrix P;
    inverseDynamicsJacobian(*s.data, P);
    const ConvexProblem p = denseProblem(*s.data);
    const std::vector<double> h = cellOf(s);
    const VectorX H = Eigen::Map<const VectorX>(h.data(), static_cast<Eigen::Index>(h.size()));
    EXPECT_APPROX(P.dense(), p.M + p.J.transpose() * H.asDiagonal() * p.J, 1e-12);
    EXPECT_EQ(Eigen::LLT<MatrixX>(P.dense()).info(), Eigen::Success) << "seed " << seed;
  }
}

TEST(Forward, MatchesReferenceSolver) {
  double worst = 0.0;
  int active = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Scene s = lawScene(seed, 4);
    s.forward();
    active += activeRows(s);
    const ReferenceSolution reference = solveByGaussSeidel(denseProblem(*s.data));
    const double scale = 1.0 + reference.a.cwiseAbs().maxCoeff();
    worst = std::max(worst, (s.data->forward.a - reference.a).cwiseAbs().maxCoeff() / scale);
  }
  // Gauss–Seidel stops where a sweep changes 1e-14; it converges linearly, so the rest is more.
  EXPECT_SMALL(worst, 1e-10);
  EXPECT_GT(active, 300);
}

TEST(Cost, DecreasesEveryIteration) {
  int iterations = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Scene s = lawScene(seed, 10);
    const ConvexProblem p = denseProblem(*s.data);
    double previous = kInfinity;
    for (int limit = 0; limit <= 100; ++limit) {
      s.model.options.maxIterations = limit;
      const SolveStatus status = s.forward();
      const double cost = p.cost(s.data->forward.a);
      // Rounding of the cost is 1e-16 of its terms.
      const double rounding = 1e-13 * (std::abs(cost) + 1.0) * toleranceScale();
      if (s.data->forward.report.iterations == limit) {
        EXPECT_LT(cost, previous + rounding);
      }
      previous = cost;
      if (status == SolveStatus::converged) break;
      EXPECT_EQ(status, SolveStatus::iterationLimit) << "seed " << seed;
      ++iterations;
    }
  }
  EXPECT_GT(iterations, 120);  // solves do take several iterations
}

TEST(Solver, WarmStartIsNeverWorse) {
  int cold = 0, warm = 0;
  for (int seed = 0; seed < 60; ++seed) {
    Scene s = lawScene(seed, 10);
    s.forward();
    const VectorX a = s.data->forward.a;
    cold += s.data->forward.report.iterations;
    s.state.warmstart.a = a;
    s.state.warmstart.valid = true;
    ASSERT_EQ(s.forward(), SolveStatus::converged);
    warm += s.data->forward.report.iterations;
    EXPECT_APPROX(s.data->forward.a, a, 1e-9);
    // A warm start that costs more than the unconstrained acceleration is not used.
    s.state.warmstart.a = VectorX::Constant(s.model.nv, 1e6);
    s.forward();
    EXPECT_APPROX(s.data->forward.a, a, 1e-9);
  }
  EXPECT_LE(warm, 60);
  EXPECT_GT(cold, 120);
}

TEST(Friction, StaysInPyramid) {
  int checked = 0;
  for (int seed = 0; seed < 100; ++seed) {
    Scene s = lawScene(seed, 8);
    s.forward();
    const PyramidalContact& contact = s.data->constraints.contact;
    for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i) {
      const ContactRows& made = contact.contactsWithRows()[i];
      const Vector3 f = made.R_WC.transpose() * contact.force(i);
      const Vector3 m = made.R_WC.transpose() * contact.moment(i);
      EXPECT_GE(f[0], 0.0);
      // The sum of non-negative edge forces, up to rounding.
      const double each[5] = {f[1], f[2], m[0], m[1], m[2]};
      double shares = 0.0;
      for (int k = 0; k < made.frictionDim; ++k) shares += std::abs(each[k]) / made.friction[k];
      for (int k = made.frictionDim; k < 5; ++k) EXPECT_SMALL(each[k], 1e-12 * (1.0 + f[0]));
      EXPECT_LE(shares, f[0] + 1e-12 * (1.0 + f[0]));
      checked += f[0] > 0.0;
    }
  }
  EXPECT_GT(checked, 200);
}

TEST(Contact, ForceIsNonNegativeAndVanishesOnTheFreeSide) {
  for (int seed = 0; seed < 100; ++seed) {
    Scene s = randomScene(seed, 8);
    s.forward();
    s.data->constraints.visit([&](const auto& rows) {
      for (int i = 0; i < rows.rowCount(); ++i) {
        EXPECT_GE(rows.f[i], 0.0);
        EXPECT_EQ(rows.f[i] * std::max(rows.x[i], 0.0), 0.0);
      }
    });
  }
}

// Newton's third law and Jᵀ: the constraint force on the dofs is the sum of the contacts' forces
// at their points, and of their moments, on both bodies.
TEST(Contact, ForceActsAtItsPointOnBothBodies) {
  int moments = 0;
  for (int seed = 0; seed < 40; ++seed) {
    Scene s = lawScene(seed, 8);
    s.forward();
    const PyramidalContact& contact = s.data->constraints.contact;
    VectorX actual = VectorX::Zero(s.model.nv);
    contact.addTransposed(contact.f, actual);
    for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i)
      moments += contact.moment(i).norm() > 0.0;
    EXPECT_APPROX(actual, forceOfContacts(s, contact), 1e-12) << "seed " << seed;
  }
  EXPECT_GT(moments, 20);
}

}  // namespace
}  // namespace softgauss::test
