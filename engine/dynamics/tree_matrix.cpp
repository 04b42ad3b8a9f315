// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_matrix.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <ranges>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/vector_clones.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"

namespace softgauss {
namespace {

/// The first bit in [from, end) that is `set`, `end` if there is none.
int nextBit(const std::uint64_t* bits, int from, int end, bool set) {
  for (int w = from / 64; 64 * w < end; ++w) {
    std::uint64_t word = set ? bits[w] : ~bits[w];
    if (w == from / 64) word &= ~std::uint64_t{0} << (from % 64);
    if (word) return std::min(end, 64 * w + std::countr_zero(word));
  }
  return end;
}

}  // namespace

TreeSparsity::TreeSparsity(const Model& model) {
  const int n = model.nv;
  rowBegin_.assign(1, 0);
  fourBegin_.assign(1, 0);
  std::vector<int> columns;
  for (int row = 0; row < n; ++row) {
    columns.clear();
    for (int j = row; j >= 0; j = model.dofs[j].parent) columns.push_back(j);
    std::reverse(columns.begin(), columns.end());
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c == 0 || columns[c] != columns[c - 1] + 1)
        segments_.push_back({columns[c], columns[c] + 1});
      else
        segments_.back().end = columns[c] + 1;
    }
    finishRow(row);
  }
  finish();
}

TreeSparsity TreeSparsity::dense(int size) {
  TreeSparsity pattern;
  pattern.rowBegin_.assign(1, 0);
  pattern.fourBegin_.assign(1, 0);
  for (int row = 0; row < size; ++row) {
    pattern.segments_.push_back({0, row + 1});
    pattern.finishRow(row);
  }
  pattern.finish();
  return pattern;
}

void TreeSparsity::finishRow(int row) {
  rowBegin_.push_back(static_cast<int>(segments_.size()));
  for (const Segment* s = begin(row); s != end(row); ++s) {
    const Segment four{s->begin & ~3, paddedSize(s->end)};
    if (s != begin(row) && four.begin <= fours_.back().end)
      fours_.back().end = four.end;
    else
      fours_.push_back(four);
  }
  fourBegin_.push_back(static_cast<int>(fours_.size()));
  const int from = foursBegin(row)->begin;
  offset_.push_back(static_cast<std::ptrdiff_t>(storage_) - from);
  storage_ += idx(paddedSize(row + 1) - from);
}

void TreeSparsity::finish() {
  // Transpose: for every column the rows below the diagonal, as ranges. Rows come one by one; a
  // column that the row before has too, from the same first column on, lengthens its last range.
  const int n = size();
  const auto visitEntries = [&](auto&& f) {
    for (int row = 1; row < n; ++row) {
      const bool joins = first(row - 1) == first(row);
      for (const Segment* s = begin(row); s != end(row); ++s)
        for (int column = s->begin; column < std::min(s->end, row); ++column) f(row, column, joins);
    }
  };
  columnBegin_.assign(static_cast<std::size_t>(n) + 1, 0);
  cursor_.assign(static_cast<std::size_t>(n), -1);  // the last row that has the column
  visitEntries([&](int row, int column, bool joins) {
    if (!joins || cursor_[column] != row - 1) ++columnBegin_[column + 1];
    cursor_[column] = row;
  });
  std::partial_sum(columnBegin_.begin(), columnBegin_.end(), columnBegin_.begin());
  columns_.resize(static_cast<std::size_t>(columnBegin_[n]));
  std::copy_n(columnBegin_.begin(), n, cursor_.begin());  // where its next range goes
  visitEntries([&](int row, int column, bool joins) {
    int& next = cursor_[column];
    if (joins && next > columnBegin_[column] && columns_[next - 1].end == row)
      columns_[next - 1].end = row + 1;
    else
      columns_[next++] = {row, row + 1};
  });
}

void TreeSparsity::couple(const TreeSparsity& tree, const std::vector<Segment>& couplings,
                          const std::vector<int>& setEnd) {
  constexpr std::size_t kSmall = 256;  // rows whose most segments are little memory
  const int n = tree.size();
  if (const std::size_t rows = static_cast<std::size_t>(n); rows <= kSmall)
    for (std::vector<Segment>* list : {&segments_, &fours_, &columns_})
      list->reserve(rows * (rows + 4) / 4);
  const std::size_t words = (static_cast<std::size_t>(n) + 63) / 64;
  bits_.assign(words * static_cast<std::size_t>(n), 0);
  const auto row = [&](int i) { return bits_.data() + words * static_cast<std::size_t>(i); };
  const auto insert = [&](std::uint64_t* bits, int begin, int end) {
    for (int j = begin; j < end; ++j) bits[j / 64] |= std::uint64_t{1} << (j % 64);
  };
  for (int i = 0; i < n; ++i)
    for (const Segment* s = tree.begin(i); s != tree.end(i); ++s) insert(row(i), s->begin, s->end);

  // A coupled set is a clique: its last dof sees all the others, elimination spreads the rest.
  int first = 0;
  for (const int last : setEnd) {
    const int top = couplings[last - 1].end - 1;
    for (int s = first; s < last; ++s) insert(row(top), couplings[s].begin, couplings[s].end);
    first = last;
  }

  // Closure: the next dof of row k (its parent in the elimination tree) inherits the rest.
  for (int k = n - 1; k > 0; --k) {
    std::uint64_t* bits = row(k);
    int parent = -1;
    for (int w = k / 64; w >= 0 && parent < 0; --w) {
      std::uint64_t word = bits[w];
      if (w == k / 64) word &= (std::uint64_t{1} << (k % 64)) - 1;
      if (word) parent = 64 * w + 63 - std::countl_zero(word);
    }
    if (parent < 0) continue;
    std::uint64_t* up = row(parent);
    for (int w = 0; w <= parent / 64; ++w) up[w] |= bits[w];
    const int w = parent / 64;
    if (parent % 64 != 63) up[w] &= (std::uint64_t{1} << (parent % 64 + 1)) - 1;
  }

  segments_.clear();
  rowBegin_.assign(1, 0);
  fours_.clear();
  fourBegin_.assign(1, 0);
  offset_.clear();
  storage_ = 0;
  for (int i = 0; i < n; ++i) {
    const std::uint64_t* bits = row(i);
    const int firstColumn = nextBit(bits, 0, i + 1, true);
    for (int from = firstColumn, to; from <= i; from = nextBit(bits, to, i + 1, true)) {
      to = nextBit(bits, from, i + 1, false);
      segments_.push_back({from, to});
    }
    finishRow(i);
  }
  finish();
}

void TreeMatrix::setZero() { std::fill(values_.begin(), values_.end(), 0.0); }

void TreeMatrix::assign(const TreeMatrix& other, Segments rows) {
  const bool samePattern = sparsity_ == other.sparsity_;
  for (const Segment part : rows) {
    const std::ptrdiff_t begin = sparsity_->storageBegin(part.begin);
    const std::ptrdiff_t end = sparsity_->storageBegin(part.end);
    if (samePattern) {
      std::copy(other.values_.data() + begin, other.values_.data() + end, values_.data() + begin);
      continue;
    }
    std::fill(values_.data() + begin, values_.data() + end, 0.0);
    for (int i = part.begin; i < part.end; ++i) {
      const double* from = other.row(i);
      double* to = row(i);
      for (const Segment* s = other.sparsity().begin(i); s != other.sparsity().end(i); ++s)
        std::copy(from + s->begin, from + s->end, to + s->begin);
    }
  }
}

void TreeMatrix::add(const TreeMatrix& other, double scale) {
  for (int i = 0; i < size(); ++i) {
    const double* from = other.row(i);
    double* to = row(i);
    for (const Segment* s = other.sparsity().begin(i); s != other.sparsity().end(i); ++s)
      for (int j = s->begin; j < s->end; ++j) to[j] += scale * from[j];
  }
}

void TreeMatrix::multiply(Segments dofs, const VectorX& x, VectorX& y) const {
  const Rows rows = this->rows();
  const double* from = x.data();
  double* to = y.data();
  for (const Segment part : dofs)
    for (int i = part.begin; i < part.end; ++i) {
      const double* a = rows(i);
      const double xi = from[i];
      double sum = 0.0;
      for (const Segment* s = sparsity_->begin(i); s != sparsity_->end(i); ++s) {
        const int end = std::min(s->end, i);
        for (int j = s->begin; j < end; ++j) {
          sum += a[j] * from[j];
          to[j] += a[j] * xi;
        }
      }
      to[i] = sum + a[i] * xi;
    }
}

MatrixX TreeMatrix::dense() const {
  MatrixX A = MatrixX::Zero(size(), size());
  for (int i = 0; i < size(); ++i)
    for (const Segment* s = sparsity_->begin(i); s != sparsity_->end(i); ++s)
      for (int j = s->begin; j < s->end; ++j) A(i, j) = A(j, i) = row(i)[j];
  return A;
}

SOFTGAUSS_VECTOR_CLONES bool TreeFactor::compute(const TreeMatrix& A, Segments dofs,
                                                 const double* diagonal) {
  const TreeSparsity& pattern = A.sparsity();
  LD_.resize(pattern);
  LD_.assign(A, dofs);
  dofs_.assign(dofs.begin(), dofs.end());
  const int n = A.size();
  pivot_.resize(static_cast<std::size_t>(n));
  inversePivot_.resize(static_cast<std::size_t>(n));
  failedRow_ = -1;
  if (diagonal)
    for (const Segment part : dofs_)
      for (int i = part.begin; i < part.end; ++i) LD_.row(i)[i] += diagonal[i];

  coefficient_.resize(idx(n));
  eliminated_.resize(idx(n));
  double *coefficient = coefficient_.data(), *pivots = pivot_.data();
  const double** eliminated = eliminated_.data();
  const TreeMatrix::Rows rows = LD_.rows();
  // Row i of D L from the rows below it that contain i:  A_ij − Σ_k (L_ki D_k) L_kj.
  for (const Segment part : dofs_ | std::views::reverse)
    for (int i = part.end - 1; i >= part.begin; --i) {
      double* Hi = LD_.row(i);
      for (const Segment* s = pattern.columnBegin(i); s != pattern.columnEnd(i); ++s) {
        const int from = pattern.foursBegin(s->begin)->begin, count = s->end - s->begin;
        for (int k = 0; k < count; ++k) {
          const double* L = rows(s->begin + k);
          eliminated[k] = L;
          coefficient[k] = -L[i] * pivots[s->begin + k];
        }
        for (const Segment* t = pattern.foursBegin(i); t != pattern.foursEnd(i); ++t) {
          const int begin = std::max(t->begin, from);
          if (begin >= t->end) continue;
          addSum(
              count, [=](int k) { return coefficient[k]; },
              [=](int k) { return eliminated[k] + begin; }, t->end - begin, Hi + begin);
        }
      }
      const double pivot = Hi[i];
      if (!(pivot > 0.0) || !std::isfinite(pivot)) {
        failedRow_ = i;
        return false;
      }
      pivots[i] = pivot;
      inversePivot_[i] = 1.0 / pivot;
      for (const Segment* t = pattern.foursBegin(i); t != pattern.foursEnd(i); ++t)
        for (int j = t->begin; j < t->end; ++j) Hi[j] *= inversePivot_[i];
      Hi[i] = pivot;
    }
  return true;
}

void TreeFactor::solveTransposed(VectorX& x) const {
  const TreeSparsity& pattern = LD_.sparsity();
  const TreeMatrix::Rows rows = LD_.rows();
  double* to = x.data();
  for (const Segment part : dofs_ | std::views::reverse)
    for (int k = part.end - 1; k >= part.begin; --k) {
      const double* L = rows(k);
      const double xk = to[k];
      if (xk == 0.0) continue;  // a row of a Jacobian has few entries
      for (const Segment* s = pattern.begin(k); s != pattern.end(k); ++s) {
        const int end = std::min(s->end, k);
        for (int j = s->begin; j < end; ++j) to[j] -= L[j] * xk;
      }
    }
}

void TreeFactor::solveLower(VectorX& x) const {
  const TreeSparsity& pattern = LD_.sparsity();
  const TreeMatrix::Rows rows = LD_.rows();
  double* to = x.data();
  for (const Segment part : dofs_)
    for (int k = part.begin; k < part.end; ++k) {
      const double* L = rows(k);
      double sum = to[k];
      for (const Segment* s = pattern.begin(k); s != pattern.end(k); ++s) {
        const int end = std::min(s->end, k);
        for (int j = s->begin; j < end; ++j) sum -= L[j] * to[j];
      }
      to[k] = sum;
    }
}

SOFTGAUSS_VECTOR_CLONES void TreeFactor::solveTransposed(RowMajorMatrixX& X,
                                                         std::vector<Segment>& range) const {
  SOFTGAUSS_ASSERT(X.cols() % 4 == 0);
  const TreeSparsity& pattern = LD_.sparsity();
  const int columns = static_cast<int>(X.cols());
  const TreeMatrix::Rows L = LD_.rows();
  for (const Segment part : dofs_)
    for (int k = part.begin; k < part.end; ++k) {
      Segment& r = range[idx(k)];
      r = {r.begin & ~3, paddedSize(r.end)};
    }
  // Row j from the rows below it that contain j, where these have entries.
  for (const Segment part : dofs_ | std::views::reverse)
    for (int j = part.end - 1; j >= part.begin; --j) {
      double* xj = X.data() + j * columns;
      for (const Segment* s = pattern.columnBegin(j); s != pattern.columnEnd(j); ++s) {
        for (int k = s->begin, end; k < s->end; k = end) {
          const Segment from = range[idx(k)];
          end = endOfRun(range, k, s->end);
          if (from.begin == from.end) continue;
          const double* xk = X.data() + k * columns + from.begin;
          addSum(
              end - k, [=](int i) { return -L(k + i)[j]; }, [=](int i) { return xk + i * columns; },
              from.end - from.begin, xj + from.begin);
          Segment& to = range[idx(j)];
          const bool empty = to.begin == to.end;
          to.begin = empty ? from.begin : std::min(to.begin, from.begin);
          to.end = std::max(to.end, from.end);
        }
      }
    }
}

SOFTGAUSS_VECTOR_CLONES void TreeFactor::solve(RowMajorMatrixX& X,
                                               std::vector<Segment>& range) const {
  solveTransposed(X, range);
  const TreeSparsity& pattern = LD_.sparsity();
  const int columns = static_cast<int>(X.cols());
  for (const Segment part : dofs_)
    for (int k = part.begin; k < part.end; ++k) {
      double* xk = X.data() + k * columns;
      const double inverse = inversePivot_[idx(k)];
      for (int c = range[k].begin; c < range[k].end; ++c) xk[c] *= inverse;
    }
  for (const Segment part : dofs_)
    for (int k = part.begin; k < part.end; ++k) {
      const double* L = LD_.row(k);
      for (const Segment* s = pattern.begin(k); s != pattern.end(k); ++s)
        addCombination(-1.0, L + s->begin, 1, X.data() + s->begin * columns, columns,
                       std::min(s->end, k) - s->begin, columns, X.data() + k * columns);
    }
}

SOFTGAUSS_VECTOR_CLONES void TreeFactor::multiplyRoot(const RowMajorMatrixX& X,
                                                      RowMajorMatrixX& Y) const {
  SOFTGAUSS_ASSERT(X.cols() % 4 == 0);
  const TreeSparsity& pattern = LD_.sparsity();
  const int columns = static_cast<int>(X.cols());
  for (const Segment part : dofs_)
    for (int k = part.begin; k < part.end; ++k) {
      const double* L = LD_.row(k);
      const double* x = X.data() + k * columns;
      double* y = Y.data() + k * columns;
      for (int c = 0; c < columns; ++c) y[c] = x[c];
      for (const Segment* s = pattern.begin(k); s != pattern.end(k); ++s)
        addCombination(1.0, L + s->begin, 1, X.data() + s->begin * columns, columns,
                       std::min(s->end, k) - s->begin, columns, y);
      const double root = std::sqrt(pivot_[k]);
      for (int c = 0; c < columns; ++c) y[c] *= root;
    }
}

void TreeFactor::solve(VectorX& x) const {
  solveTransposed(x);
  for (const Segment part : dofs_)
    for (int k = part.begin; k < part.end; ++k) x[k] *= inversePivot_[k];
  solveLower(x);
}

}  // namespace softgauss
