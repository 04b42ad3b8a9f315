// SPDX-License-Identifier: Apache-2.0
#include "tests/support/convex_qp.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <stdexcept>
#include <vector>

namespace softgauss::test {

VectorX nonNegativeLeastSquares(const MatrixX& columns, const VectorX& f) {
  // Columns of norm 1 give gains that can be compared.
  const VectorX norm = columns.colwise().norm().cwiseMax(1e-300);
  const MatrixX A = columns * norm.cwiseInverse().asDiagonal();
  const Eigen::Index n = A.cols();
  VectorX u = VectorX::Zero(n);
  std::vector<Eigen::Index> used;  // the columns whose u may be positive
  std::vector<bool> isUsed(n, false), refused(n, false);
  const double tolerance = 1e-12 * f.norm();
  double least = f.norm();

  const auto fit = [&] {
    MatrixX part(A.rows(), static_cast<Eigen::Index>(used.size()));
    for (std::size_t k = 0; k < used.size(); ++k) part.col(k) = A.col(used[k]);
    return VectorX(part.colPivHouseholderQr().solve(f));
  };
  for (int round = 0; round < 20 * static_cast<int>(n) + 100; ++round) {
    const VectorX gain = A.transpose() * (f - A * u);
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < n; ++i)
      if (!isUsed[i] && !refused[i] && gain[i] > tolerance && (best < 0 || gain[i] > gain[best]))
        best = i;
    if (best < 0) return u.cwiseQuotient(norm);
    used.push_back(best);
    isUsed[best] = true;
    VectorX fitted = fit();
    if (fitted[fitted.size() - 1] <= 0.0) {  // the gain was rounding
      used.pop_back();
      isUsed[best] = false;
      refused[best] = true;
      continue;
    }
    while (fitted.size() > 0 && fitted.minCoeff() <= 0.0) {
      double step = 1.0;
      for (std::size_t k = 0; k < used.size(); ++k)
        if (fitted[k] <= 0.0) step = std::min(step, u[used[k]] / (u[used[k]] - fitted[k]));
      std::vector<Eigen::Index> kept;
      for (std::size_t k = 0; k < used.size(); ++k) {
        double& x = u[used[k]];
        x += step * (fitted[k] - x);
        if (fitted[k] <= 0.0 && x <= 1e-15 * u.cwiseAbs().maxCoeff()) {
          x = 0.0;
          isUsed[used[k]] = false;
        } else {
          kept.push_back(used[k]);
        }
      }
      used = kept;
      fitted = fit();
    }
    for (std::size_t k = 0; k < used.size(); ++k) u[used[k]] = fitted[k];
    // Columns that are nearly the same would take turns: one that does not bring A u nearer to f is
    // not taken again until another does.
    const double away = (f - A * u).norm();
    if (away < least) {
      least = away;
      std::fill(refused.begin(), refused.end(), false);
    } else {
      refused[best] = true;
    }
  }
  throw std::runtime_error("non-negative least squares does not end");
}

namespace {

/// The y of least norm with G y ≥ h; rows of G have norm 1. Nothing where there is none.
std::optional<VectorX> leastDistance(const MatrixX& G, const VectorX& h) {
  const Eigen::Index m = G.cols();
  const double scale = h.size() == 0 ? 0.0 : h.maxCoeff();
  if (scale <= 0.0) return VectorX::Zero(m);
  MatrixX A(m + 1, G.rows());
  A << G.transpose(), h.transpose() / scale;
  const VectorX u = nonNegativeLeastSquares(A, VectorX::Unit(m + 1, m));
  const VectorX r = A * u - VectorX::Unit(m + 1, m);
  // |r|² = 1/(1 + |y/scale|²): no point within 10⁶ times the distance of the farthest plane.
  if (r.squaredNorm() < 1e-12) return std::nullopt;
  // The point from the rows that it lies on, which is more exact than −r/r_{m+1}.
  std::vector<Eigen::Index> on;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (u[i] > 0.0) on.push_back(i);
  MatrixX active(static_cast<Eigen::Index>(on.size()), m);
  VectorX distance(active.rows());
  for (std::size_t k = 0; k < on.size(); ++k) {
    active.row(k) = G.row(on[k]);
    distance[k] = h[on[k]];
  }
  return VectorX(active.completeOrthogonalDecomposition().solve(distance));
}

}  // namespace

std::optional<VectorX> ConvexQp::solve(double atMost) const {
  const Eigen::Index n = H.rows();
  VectorX x0 = VectorX::Zero(n);
  MatrixX Z = MatrixX::Identity(n, n);
  if (E.rows() > 0) {
    const Eigen::HouseholderQR<MatrixX> qr(E.transpose());
    const MatrixX Q = qr.householderQ();
    const MatrixX R = qr.matrixQR().topRows(E.rows()).triangularView<Eigen::Upper>();
    x0 = Q.leftCols(E.rows()) * R.transpose().triangularView<Eigen::Lower>().solve(e);
    Z = Q.rightCols(n - E.rows());
  }
  const Eigen::LLT<MatrixX> llt(Z.transpose() * H * Z);
  if (llt.info() != Eigen::Success) throw std::runtime_error("the program is not convex");
  const VectorX free = x0 - Z * llt.solve(Z.transpose() * (H * x0 + s));
  if (!(value(free) < atMost)) return std::nullopt;

  // x = free + Z L⁻ᵀ y:  the value is that at `free` plus ½ |y|².
  MatrixX G = llt.matrixL().solve((C * Z).transpose()).transpose();
  VectorX h = b - C * free;
  for (Eigen::Index i = 0; i < G.rows(); ++i) {
    const double norm = G.row(i).norm();
    const bool constant =
        norm <= 1e-14 * llt.matrixL().solve(Z.transpose()).norm() * C.row(i).norm();
    if (constant && h[i] > 1e-9 * (1.0 + std::abs(b[i]))) return std::nullopt;
    G.row(i) *= constant ? 0.0 : 1.0 / norm;
    h[i] *= constant ? 0.0 : 1.0 / norm;
  }
  const std::optional<VectorX> y = leastDistance(G, h);
  if (!y) return std::nullopt;
  return VectorX(free + Z * llt.matrixU().solve(*y));
}

}  // namespace softgauss::test
