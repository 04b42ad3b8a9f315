// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Dense products and Cholesky's algorithm on rows that are padded to whole vectors, the same bits
/// on every processor. `columns` and strides of rows are multiples of four.

#include <vector>

#include "softgauss/engine/core/vector_kernels.hpp"

namespace softgauss::planning {

/// A matrix by rows.
class DenseRows {
 public:
  DenseRows(int rows, int columns)
      : stride_(paddedSize(columns)),
        data_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride_)) {}
  double* operator[](int row) { return data_.data() + row * stride_; }
  const double* operator[](int row) const { return data_.data() + row * stride_; }
  int stride() const { return stride_; }
  void setZero() { data_.assign(data_.size(), 0.0); }

 private:
  int stride_;
  std::vector<double> data_;
};

/// A block that begins at an entry of a matrix.
struct Block {
  const double* data;
  int stride;
  Block(const double* first, int rowStride) : data(first), stride(rowStride) {}
  Block(const DenseRows& A, int column = 0) : data(A[0] + column), stride(A.stride()) {}
};

/// C ← C + AᵀB of `sum` rows each; C has `rows` rows. A need not be padded.
void addProduct(const Block& A, const Block& B, int sum, int rows, int columns, double* C,
                int strideC);
/// The same by ± on and right of the diagonal of C alone, of which up to three entries left of it
/// change too.
void addUpperProduct(double scale, const Block& A, const Block& B, int sum, int rows, int columns,
                     double* C, int strideC);

/// (U Y) ← L⁻¹(H X) in place, U = Lᵀ, L Lᵀ = H, of which the first n columns are H by what is on
/// and right of its diagonal. False where H is not positive definite.
bool factorRows(DenseRows& rows, int n);
/// X ← U⁻¹Y for Y in `factored` from column `first` on, a multiple of four; X has the same columns.
void solveRows(const DenseRows& factored, int n, int first, DenseRows& X);

}  // namespace softgauss::planning
