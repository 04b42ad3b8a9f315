// SPDX-License-Identifier: Apache-2.0
#include "tests/gdd/convex_controller.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>

#include "tests/support/reference_solver.hpp"

namespace softgauss::test {

ConvexControl convexControl(const Data& data, const gdd::GoalCost& cost,
                            const gdd::ControlLimits& limits, bool stance) {
  // Small against M⁻¹, which is 0.02 1/kg and more: it picks one of many equivalent f.
  constexpr double kForcePrice = 1e-5;
  constexpr double kStance = 1e5;  // the weight of a goal that must not give way [kg]
  const ConvexProblem physics = denseProblem(data);
  const int n = static_cast<int>(physics.M.rows()), rows = static_cast<int>(physics.J.rows());
  for (int i = 0; i < rows; ++i)
    if (physics.lower[i] != 0.0 || std::isfinite(physics.upper[i]))
      throw std::logic_error("a row that is no limit and no contact");
  std::vector<int> actuated;
  for (int i = 0; i < n; ++i)
    if (limits.lower[i] < limits.upper[i]) actuated.push_back(i);
  const int m = static_cast<int>(actuated.size()), size = n + m + rows;
  const MatrixX M = data.inertia.M.dense(), Minv = physics.M.llt().solve(MatrixX::Identity(n, n));

  ConvexQp qp;
  qp.H = MatrixX::Zero(size, size);
  qp.s = VectorX::Zero(size);
  const auto slope = [&](const VectorX& a) {
    VectorX g(n);
    cost.gradient(a, M * a, g);
    return g;
  };
  const VectorX atZero = slope(VectorX::Zero(n));
  qp.s.head(n) = atZero;
  for (int i = 0; i < n; ++i) qp.H.col(i).head(n) = slope(VectorX::Unit(n, i)) - atZero;
  if (stance)
    for (const ContactRows& made : data.constraints.contact.contactsWithRows()) {
      // Twice the mean of opposite edges is the normal; their difference a tangent.
      const int first = rows - data.constraints.contact.rowCount() + made.row;
      const int edges = std::max(1, 2 * made.frictionDim);
      for (int e = 0; e < edges; ++e) {
        const VectorX J = physics.J.row(first + e);
        qp.H.topLeftCorner(n, n) += kStance / edges * J * J.transpose();
      }
    }
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) qp.H(n + i, n + j) = Minv(actuated[i], actuated[j]);
  qp.H.bottomRightCorner(rows, rows).diagonal().setConstant(kForcePrice);

  qp.E = MatrixX::Zero(n, size);
  qp.E.leftCols(n) = physics.M;
  for (int i = 0; i < m; ++i) qp.E(actuated[i], n + i) = -1.0;
  qp.E.rightCols(rows) = -physics.J.transpose();
  qp.e = -data.forces.c;

  qp.C = MatrixX::Zero(rows + 2 * m, size);
  qp.b = VectorX::Zero(rows + 2 * m);
  qp.C.topRightCorner(rows, rows).setIdentity();
  for (int i = 0; i < m; ++i) {
    qp.C(rows + 2 * i, n + i) = 1.0;
    qp.b[rows + 2 * i] = std::max(limits.lower[actuated[i]], -1e6);
    qp.C(rows + 2 * i + 1, n + i) = -1.0;
    qp.b[rows + 2 * i + 1] = -std::min(limits.upper[actuated[i]], 1e6);
  }
  const std::optional<VectorX> x = qp.solve();
  if (!x) throw std::logic_error("no forces and controls are feasible");
  ConvexControl control;
  control.a = x->head(n);
  control.u = VectorX::Zero(n);
  for (int i = 0; i < m; ++i) control.u[actuated[i]] = (*x)[n + i];
  control.f = x->tail(rows);
  return control;
}

}  // namespace softgauss::test
