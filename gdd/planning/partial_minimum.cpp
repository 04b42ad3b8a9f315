// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/partial_minimum.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::planning {

PartialMinimum::PartialMinimum(int n, int m)
    : n_(n),
      m_(m),
      first_(paddedSize(n)),
      Q_(first_ + paddedSize(m + 1), first_ + m + 1),
      rows_(n, first_ + m + 1) {}

void PartialMinimum::setX(const MatrixX& Qxx, const VectorX& Qx) {
  for (int i = 0; i < m_; ++i) {
    std::copy_n(Qxx.col(i).data() + i, m_ - i, rowOfX(i) + i);
    rowOfX(i)[m_] = Qx[i];
  }
}

void PartialMinimum::addSquares(const VectorX& W, const MatrixX& P, const MatrixX& G) {
  int count = 0;
  for (int r = 0; r < n_; ++r) {
    if (W[r] == 0.0) continue;
    const double root = std::sqrt(W[r]);
    double* row = rows_[count++];
    std::fill(row, row + stride(), 0.0);
    for (int i = 0; i < n_; ++i) row[i] = root * P(i, r);
    for (int i = 0; i < m_; ++i) row[first_ + i] = root * G(r, i);
  }
  addUpperProduct(1.0, rows_, rows_, count, n_, stride(), Q_[0], stride());
  const Block ofX(rows_, first_);
  addUpperProduct(1.0, ofX, ofX, count, m_, columnsOfX(), rowOfX(0), stride());
}

void PartialMinimum::gain(MatrixX& K, VectorX& k) {
  solveRows(Q_, n_, first_, rows_);
  for (int i = 0; i < n_; ++i) {
    const double* row = rows_[i] + first_;
    for (int j = 0; j < m_; ++j) K(i, j) = -row[j];
    k[i] = -row[m_];
  }
}

void PartialMinimum::value(const VectorX* E, MatrixX& curvature, VectorX& slope) {
  const auto subtract = [&](const DenseRows& rows) {
    const Block ofX(rows, first_);
    addUpperProduct(-1.0, ofX, ofX, n_, m_, columnsOfX(), rowOfX(0), stride());
  };
  subtract(Q_);
  if (E) {
    for (int i = 0; i < n_; ++i) {
      const double root = std::sqrt((*E)[i]);
      for (int j = first_; j < stride(); ++j) rows_[i][j] *= root;
    }
    subtract(rows_);
  }
  for (int j = 0; j < m_; ++j) {
    const double* row = rowOfX(j);
    std::copy_n(row + j, m_ - j, curvature.col(j).data() + j);
    slope[j] = row[m_];
  }
}

}  // namespace softgauss::planning
