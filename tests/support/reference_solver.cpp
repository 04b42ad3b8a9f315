// SPDX-License-Identifier: Apache-2.0
#include "tests/support/reference_solver.hpp"

#include <Eigen/Cholesky>

namespace softgauss::test {

double ConvexProblem::cost(const VectorX& a) const {
  const VectorX overshoot = (J * a - aRef).cwiseMin(0.0);
  return 0.5 * a.dot(M * a) - a.dot(net) + 0.5 * overshoot.dot(D.cwiseProduct(overshoot));
}

VectorX ConvexProblem::gradient(const VectorX& a) const {
  const VectorX overshoot = (J * a - aRef).cwiseMin(0.0);
  return M * a - net + J.transpose() * D.cwiseProduct(overshoot);
}

ReferenceSolution solveByGaussSeidel(const ConvexProblem& p, double tolerance, int maxSweeps) {
  const Eigen::LLT<MatrixX> llt(p.M);
  const VectorX smooth = llt.solve(p.net);
  MatrixX A = p.J * llt.solve(p.J.transpose());
  A.diagonal() += p.D.cwiseInverse();
  const VectorX b = p.J * smooth - p.aRef;

  ReferenceSolution solution;
  VectorX& f = solution.f;
  f = VectorX::Zero(b.size());
  for (; solution.sweeps < maxSweeps; ++solution.sweeps) {
    double change = 0.0;
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      const double old = f[i];
      f[i] = std::max(0.0, old - (A.row(i).dot(f) + b[i]) / A(i, i));
      change = std::max(change, std::abs(f[i] - old));
    }
    if (f.size() == 0 || change <= tolerance * f.cwiseAbs().maxCoeff()) break;
  }
  solution.a = smooth + llt.solve(p.J.transpose() * f);
  return solution;
}

}  // namespace softgauss::test
