// SPDX-License-Identifier: Apache-2.0
#include "tests/support/reference_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace softgauss::test {

VectorX ConvexProblem::residual(const VectorX& a) const {
  const VectorX Ja = J * a;
  return Ja - aRef;
}

VectorX ConvexProblem::force(const VectorX& x) const {
  return (-D.cwiseProduct(x)).cwiseMax(lower).cwiseMin(upper);
}

double ConvexProblem::cost(const VectorX& a) const {
  // Where a bound holds, s goes on as a line: −f x − ½ R f².
  const VectorX x = residual(a), f = force(x);
  double rows = 0.0;
  for (Eigen::Index i = 0; i < f.size(); ++i)
    rows +=
        f[i] == -D[i] * x[i] ? 0.5 * D[i] * x[i] * x[i] : -f[i] * x[i] - 0.5 * f[i] * f[i] / D[i];
  return 0.5 * a.dot(M * a) - a.dot(net) + rows;
}

VectorX ConvexProblem::gradient(const VectorX& a) const {
  return M * a - net - J.transpose() * force(residual(a));
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
      f[i] = std::clamp(old - (A.row(i).dot(f) + b[i]) / A(i, i), p.lower[i], p.upper[i]);
      change = std::max(change, std::abs(f[i] - old));
    }
    if (f.size() == 0 || change <= tolerance * f.cwiseAbs().maxCoeff()) break;
  }
  solution.a = smooth + llt.solve(p.J.transpose() * f);
  return solution;
}

}  // namespace softgauss::test
