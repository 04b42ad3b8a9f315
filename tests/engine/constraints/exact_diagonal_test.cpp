// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/exact_diagonal.hpp"

#include <Eigen/Cholesky>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// The scene with constant inverse weights, and the same with the exact diagonal.
struct Both {
  Scene constant, exact;
  MatrixX A;  ///< J M⁻¹ Jᵀ, rows as Constraints::visit() has them

  Both(std::uint64_t seed, Cone cone) : constant(lawScene(seed, 6)), exact(lawScene(seed, 6)) {
    constant.model.options.cone = exact.model.options.cone = cone;
    exact.model.options.exactDiagonal = true;
    constant.stages();
    exact.stages();
    const MatrixX J = exact.data->constraints.denseJacobian();
    A = J * exact.data->inertia.M.dense().llt().solve(J.transpose());
  }
};

// R is perInertia times the diagonal of J M⁻¹ Jᵀ, for each row of what is no contact.
TEST(ExactDiagonal, IsThatOfTheDenseMatrix) {
  int compared = 0;
  for (int seed = 0; seed < 40; ++seed) {
    Both both(seed, Cone::pyramidal);
    int row = 0;
    both.exact.data->constraints.visitAllButContacts([&](const auto& c) {
      for (int i = 0; i < c.rowCount(); ++i, ++row, ++compared)
        EXPECT_SMALL(1.0 / (c.D[i] * c.perInertia[i] * both.A(row, row)) - 1.0, 1e-9) << seed;
    });
  }
  EXPECT_GT(compared, 300);
}

// A contact has one R: from its first edge, or from its normal.
TEST(ExactDiagonal, OfAContactIsThatOfItsFirstRow) {
  int compared = 0;
  for (int seed = 0; seed < 40; ++seed)
    for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
      Both both(seed, cone);
      const Constraints& constraints = both.exact.data->constraints;
      int first = 0;
      constraints.visitAllButContacts([&](const auto& c) { first += c.rowCount(); });
      for (const ContactRows& made : constraints.contact.contactsWithRows()) {
        const double A = both.A(first + made.row, first + made.row);
        for (int i = 0; i < std::max(1, 2 * made.frictionDim); ++i, ++compared) {
          const int row = made.row + i;
          EXPECT_SMALL(
              1.0 / (constraints.contact.D[row] * constraints.contact.perInertia[row] * A) - 1.0,
              1e-9);
        }
      }
      first += constraints.contact.rowCount();
      const EllipticContact& cones = constraints.ellipticContact;
      for (int i = 0; i < static_cast<int>(cones.contactsWithRows().size()); ++i, ++compared) {
        const int row = first + cones.contactsWithRows()[i].row;
        EXPECT_SMALL(1.0 / (cones.cone(i).D * cones.perInertia(i) * both.A(row, row)) - 1.0, 1e-9);
      }
    }
  EXPECT_GT(compared, 500);
}

// Nothing else changes: what a row wants is the same.
TEST(ExactDiagonal, LeavesTheReferences) {
  Both both(3, Cone::pyramidal);
  std::vector<std::vector<double>> references;
  both.constant.data->constraints.visit([&](const auto& c) { references.push_back(c.reference); });
  std::size_t kind = 0;
  both.exact.data->constraints.visit(
      [&](const auto& c) { EXPECT_EQ(c.reference, references[kind++]); });
}

// With all joints at zero the constants of scalar joints are the exact diagonal.
TEST(ExactDiagonal, IsTheConstantOfAJointAtZero) {
  Both both(1, Cone::pyramidal);
  both.constant.state.q = both.constant.model.q0;
  both.exact.state.q = both.exact.model.q0;
  both.constant.stages();
  both.exact.stages();
  const DryFriction &a = both.constant.data->constraints.dryFriction,
                    &b = both.exact.data->constraints.dryFriction;
  ASSERT_EQ(a.rowCount(), b.rowCount());
  int compared = 0;
  for (int i = 0; i < a.rowCount(); ++i) {
    const Body& body = both.exact.model.bodies[both.exact.model.dofs[a.dof(i)].body];
    if (body.joint == JointKind::floating) continue;  // the mean of three
    ++compared;
    EXPECT_SMALL(a.D[i] / b.D[i] - 1.0, 1e-10);
  }
  EXPECT_GT(compared, 3);
}

// A pendulum whose loop is closed 1 mm off its plane: nothing can move that way. Its rounding
// must not become a force.
TEST(ExactDiagonal, DoesNotHardenWhatCannotMove) {
  ModelBuilder builder = chain(1);
  ConnectSpec spec;
  spec.linkA = "link0";
  spec.linkB = "world";
  spec.p_LAP = Vector3(0, 0, -0.2);
  spec.p_LBP = Vector3(0.0, 1e-3, -0.2);
  builder.connect(spec);
  builder.options.exactDiagonal = true;
  Scene s(builder.build());
  ASSERT_EQ(s.stages(), SolveStatus::converged);
  ASSERT_EQ(s.forward(), SolveStatus::converged);
  const ConnectionRows& rows = s.data->constraints.connection;
  VectorX across = VectorX::Zero(s.model.nv);
  rows.addRow(1, rows.f[1], across);
  EXPECT_SMALL(across.cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace softgauss::test
