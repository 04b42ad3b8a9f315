// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Symmetric matrices with the sparsity of kinematic trees, and their factorisation  A = LᵀDL.
///
/// Row i of the lower triangle is non-zero only at dofs that move together with dof i: its
/// ancestors, and dofs that a constraint couples to it (2.6). In depth-first order these are a few
/// contiguous ranges of columns (segments), so all inner loops run over contiguous memory.
/// Eliminating from the leaves to the root fills nothing in beyond the pattern
/// (Featherstone 2008, section 6.5; George and Liu for the coupled case).

#include <cstddef>
#include <cstdint>
#include <vector>

#include "softgauss/engine/core/segment.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// Where the run of equal segments ends that begins at `from`, at `end` at the latest.
inline int endOfRun(const std::vector<Segment>& segments, int from, int end) {
  int i = from + 1;
  while (i < end && segments[idx(i)] == segments[idx(from)]) ++i;
  return i;
}

/// Which columns of each row of the lower triangle (diagonal included) may be non-zero. Closed
/// under elimination: if j < i are both in row k then j is in row i.
class TreeSparsity {
 public:
  TreeSparsity() = default;
  /// Ancestor dofs of every dof: the pattern of the mass matrix.
  explicit TreeSparsity(const Model& model);

  /// Every dof coupled to every other.
  static TreeSparsity dense(int size);

  int size() const { return static_cast<int>(rowBegin_.size()) - 1; }
  const Segment* begin(int row) const { return segments_.data() + rowBegin_[idx(row)]; }
  const Segment* end(int row) const { return segments_.data() + rowBegin_[idx(row + 1)]; }
  /// Rows below `column` that have it in their pattern (in a tree its descendants), as ranges of
  /// rows that begin at the same column.
  const Segment* columnBegin(int column) const {
    return columns_.data() + columnBegin_[idx(column)];
  }
  const Segment* columnEnd(int column) const {
    return columns_.data() + columnBegin_[idx(column + 1)];
  }
  int first(int row) const { return begin(row)->begin; }
  /// The segments of a row in whole fours of columns, those that meet as one: what runs over them
  /// has no tails. The last one ends beyond the diagonal.
  const Segment* foursBegin(int row) const { return fours_.data() + fourBegin_[idx(row)]; }
  const Segment* foursEnd(int row) const { return fours_.data() + fourBegin_[idx(row + 1)]; }
  /// Position of entry (row, 0) in the value array; entries exist for columns in the segments.
  std::ptrdiff_t offset(int row) const { return offset_[idx(row)]; }
  const std::ptrdiff_t* offsets() const { return offset_.data(); }
  std::size_t storage() const { return storage_; }
  /// Where in the value array these rows are.
  std::ptrdiff_t storageBegin(int row) const {
    return row == size() ? static_cast<std::ptrdiff_t>(storage_)
                         : offset(row) + foursBegin(row)->begin;
  }

  /// This pattern plus all products of the given dof sets, closed under elimination. `couplings`
  /// lists sets of dofs, each as segments ascending; sets are separated by `setEnd`.
  void couple(const TreeSparsity& tree, const std::vector<Segment>& couplings,
              const std::vector<int>& setEnd);

 private:
  void finishRow(int row);
  void finish();

  std::vector<Segment> segments_;
  std::vector<int> rowBegin_;
  std::vector<Segment> fours_;
  std::vector<int> fourBegin_;
  std::vector<std::ptrdiff_t> offset_;
  std::vector<Segment> columns_;  ///< the pattern by columns, diagonal excluded
  std::vector<int> columnBegin_;
  std::size_t storage_ = 0;
  std::vector<std::uint64_t> bits_;  ///< scratch of couple(): one bitset per row
  std::vector<int> cursor_;          ///< scratch of finish(): a place per column
};

/// A symmetric matrix on a TreeSparsity; row() points at column 0 of a row. From the four of
/// columns in which a row begins to the four of its diagonal all is stored, and zero outside its
/// segments: algorithms may run over it.
class TreeMatrix {
 public:
  void resize(const TreeSparsity& sparsity) {
    sparsity_ = &sparsity;
    if (values_.size() < sparsity.storage()) values_.resize(sparsity.storage());
  }
  const TreeSparsity& sparsity() const { return *sparsity_; }
  int size() const { return sparsity_->size(); }
  /// Where rows begin, for inner loops: a value, which stores to the matrix cannot change.
  struct Rows {
    const double* values;
    const std::ptrdiff_t* offset;
    const double* operator()(int i) const { return values + offset[i]; }
  };
  Rows rows() const { return {values_.data(), sparsity_->offsets()}; }
  double* row(int i) { return values_.data() + sparsity_->offset(i); }
  const double* row(int i) const { return values_.data() + sparsity_->offset(i); }
  void setZero();
  /// This ← other; the pattern of other is contained in this one.
  void assign(const TreeMatrix& other) {
    const Segment all{0, size()};
    assign(other, {&all, 1});
  }
  /// The same of these rows.
  void assign(const TreeMatrix& other, Segments rows);
  /// This ← this + scale · other; the pattern of other is contained in this one.
  void add(const TreeMatrix& other, double scale = 1.0);
  /// y ← A x.
  void multiply(const VectorX& x, VectorX& y) const {
    const Segment all{0, size()};
    multiply({&all, 1}, x, y);
  }
  /// The same of these dofs, which nothing couples with others.
  void multiply(Segments dofs, const VectorX& x, VectorX& y) const;
  MatrixX dense() const;

 private:
  const TreeSparsity* sparsity_ = nullptr;
  std::vector<double> values_;
};

/// A = LᵀDL with unit lower triangular L, in the place of A. Returns false when a pivot is not
/// positive (A is not positive definite up to rounding, or not finite). It may be of some dofs
/// alone, which nothing couples with others: entries of others are then neither read nor written.
class TreeFactor {
 public:
  /// Factors a copy of A, with `diagonal` added (may be null).
  bool compute(const TreeMatrix& A, const double* diagonal = nullptr) {
    const Segment all{0, A.size()};
    return compute(A, Segments(&all, 1), diagonal);
  }
  /// The same of these dofs, ascending.
  bool compute(const TreeMatrix& A, Segments dofs, const double* diagonal = nullptr);
  /// x ← A⁻¹ x.
  void solve(VectorX& x) const;
  /// X ← A⁻¹ X for many columns at once; rows of X are contiguous. `range` of a row k holds the
  /// columns in which it is not zero, before the call and, of L⁻ᵀX, after it.
  void solve(RowMajorMatrixX& X, std::vector<Segment>& range) const;
  /// X ← L⁻ᵀ X, the first half.
  void solveTransposed(RowMajorMatrixX& X, std::vector<Segment>& range) const;
  /// Y ← D^½ L X, so that YᵀY = XᵀA X.
  void multiplyRoot(const RowMajorMatrixX& X, RowMajorMatrixX& Y) const;
  /// x ← L⁻ᵀ x, the first half of solve(): xᵀ A⁻¹ x = Σ x_k²/D_k afterwards.
  void solveTransposed(VectorX& x) const;
  /// x ← L⁻¹ x, the last half.
  void solveLower(VectorX& x) const;
  double inversePivot(int k) const { return inversePivot_[idx(k)]; }
  const double* inversePivots() const { return inversePivot_.data(); }
  /// Row k of L, entries left of the diagonal, on the sparsity of A.
  const double* lowerRow(int k) const { return LD_.row(k); }
  const TreeSparsity& sparsity() const { return LD_.sparsity(); }
  int size() const { return LD_.size(); }
  /// What it is of.
  Segments dofs() const { return dofs_; }
  /// The row whose pivot was not positive, −1 after success.
  int failedRow() const { return failedRow_; }

 private:
  TreeMatrix LD_;  ///< L below the diagonal, D on it, anything beyond
  int failedRow_ = -1;
  std::vector<Segment> dofs_;
  std::vector<double> pivot_, inversePivot_;
  std::vector<double> coefficient_;        ///< scratch of compute()
  std::vector<const double*> eliminated_;  ///< scratch of compute()
};

}  // namespace softgauss
