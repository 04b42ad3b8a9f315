// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/block_jacobian.hpp"

#include <algorithm>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/vector_clones.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"

namespace softgauss {
namespace {

/// The last dof that moves both, −1 if none does.
int commonDof(const Model& model, int i, int j) {
  while (i != j) {
    if (i > j)
      i = model.dofs[i].parent;
    else
      j = model.dofs[j].parent;
  }
  return i;
}

}  // namespace

void BlockJacobian::clear() {
  bodies_.clear();
  blocks_.clear();
  motions_.clear();
  segments_.clear();
  values_.clear();
}

void BlockJacobian::add(const Model& model, const Kinematics& k, const TreeSparsity& tree,
                        const RelativeMotion& m, Columns columns) {
  bodies_.add(model, k, m);
  JacobianBlock block;
  block.dim = m.linearDim + m.angularDim;
  block.segmentEnd = -1;
  if (columns == Columns::later) motions_.push_back(m);
  if (columns == Columns::now) addColumns(model, k, tree, m, block);
  blocks_.push_back(block);
}

void BlockJacobian::addColumns(const Model& model, const Kinematics& k, const TreeSparsity& tree,
                               int i) {
  if (blocks_[i].segmentEnd < 0 && idx(i) < motions_.size())
    addColumns(model, k, tree, motions_[i], blocks_[i]);
}

void BlockJacobian::addColumns(const Model& model, const Kinematics& k, const TreeSparsity& tree,
                               const RelativeMotion& m, JacobianBlock& block) {
  block.value = static_cast<int>(values_.size());
  block.segment = static_cast<int>(segments_.size());
  const int lastA = model.lastDof(m.bodyA), lastB = model.lastDof(m.bodyB);
  const int common = commonDof(model, lastA, lastB);
  block.couples = lastA > common && lastB > common;
  // Common ancestors turn one point about the other, if the two are apart.
  const bool apart = m.linearDim > 0 && m.p_WA != m.p_WB;

  // Depth-first numbering puts one whole branch before the other.
  const bool aFirst = lastA < lastB;
  const int last[2] = {aFirst ? lastA : lastB, aFirst ? lastB : lastA};
  int split = 0;  // columns of the first branch
  for (int side = 0; side < 2; ++side) {
    const int from = side == 0 && apart ? 0 : common + 1;
    if (last[side] >= from) {
      for (const Segment* s = tree.begin(last[side]); s != tree.end(last[side]); ++s) {
        if (s->end <= from) continue;
        const int begin = std::max(s->begin, from);
        if (block.columns > 0 && segments_.back().end == begin)
          segments_.back().end = s->end;
        else
          segments_.push_back({begin, s->end});
        block.columns += s->end - begin;
      }
    }
    if (side == 0) split = block.columns;
  }
  block.segmentEnd = static_cast<int>(segments_.size());

  values_.resize(values_.size() + static_cast<std::size_t>(block.dim * block.columns));
  double* J = values_.data() + block.value;
  Vector3 r[2];  // the point from O, in the tree of each branch
  double sign[2];
  for (int side = 0; side < 2; ++side) {
    const bool isB = (side == 0) != aFirst;
    const int body = isB ? m.bodyB : m.bodyA;
    sign[side] = isB ? 1.0 : -1.0;
    r[side] = body == 0 ? Vector3::Zero()
                        : Vector3((isB ? m.p_WB : m.p_WA) - k.p_WO[model.bodies[body].tree]);
  }
  int c = 0;
  for (int s = block.segment; s < block.segmentEnd; ++s) {
    for (int i = segments_[s].begin; i < segments_[s].end; ++i, ++c) {
      const int side = c < split ? 0 : 1;
      const bool both = i <= common;
      Vector3 u = sign[side] * dofPointVelocity(k.S[i], r[side]);
      if (both) u += sign[1] * dofPointVelocity(k.S[i], r[1]);
      for (int d = 0; d < m.linearDim; ++d) J[d * block.columns + c] = m.linear.col(d).dot(u);
      for (int d = 0; d < m.angularDim; ++d)
        J[(m.linearDim + d) * block.columns + c] =
            both ? 0.0 : sign[side] * m.angular.col(d).dot(k.S[i].angular);
    }
  }
  scratch_.resize(std::max(scratch_.size(), static_cast<std::size_t>(block.dim * block.columns)));
}

void BlockJacobian::multiply(int i, const VectorX& a, double* y) const {
  const JacobianBlock& block = blocks_[i];
  SOFTGAUSS_ASSERT(block.segmentEnd >= 0);
  if (block.dim == 3) {  // most contacts: three sums at a time wait less for one another
    const double *J0 = values_.data() + block.value, *J1 = J0 + block.columns,
                 *J2 = J1 + block.columns;
    double sum0 = 0.0, sum1 = 0.0, sum2 = 0.0;
    for (int s = block.segment; s < block.segmentEnd; ++s) {
      for (int j = segments_[s].begin; j < segments_[s].end; ++j) {
        sum0 += *J0++ * a[j];
        sum1 += *J1++ * a[j];
        sum2 += *J2++ * a[j];
      }
    }
    y[0] = sum0, y[1] = sum1, y[2] = sum2;
    return;
  }
  for (int d = 0; d < block.dim; ++d) {
    const double* J = values_.data() + block.value + d * block.columns;
    double sum = 0.0;
    for (int s = block.segment; s < block.segmentEnd; ++s)
      for (int j = segments_[s].begin; j < segments_[s].end; ++j) sum += *J++ * a[j];
    y[d] = sum;
  }
}

void BlockJacobian::addTransposed(int i, const double* f, VectorX& tau) const {
  const JacobianBlock& block = blocks_[i];
  SOFTGAUSS_ASSERT(block.segmentEnd >= 0);
  for (int d = 0; d < block.dim; ++d) {
    if (f[d] == 0.0) continue;
    const double* J = values_.data() + block.value + d * block.columns;
    for (int s = block.segment; s < block.segmentEnd; ++s)
      for (int j = segments_[s].begin; j < segments_[s].end; ++j) tau[j] += f[d] * *J++;
  }
}

namespace {

/// y ← y + Σ_d c_d x_d of n numbers, rows x_d `stride` apart.
template <int dim>
[[gnu::always_inline]] inline void addRowsOf(const double* c, const double* x, int stride, int n,
                                             double* y) {
  int j = 0;
  for (; j + 4 <= n; j += 4)
    addToTiles<1>(
        dim, [=](int d) { return c[d]; }, [=](int d) { return x + d * stride + j; }, y + j);
  for (; j < n; ++j) {
    double sum = y[j];
    for (int d = 0; d < dim; ++d) sum += c[d] * x[d * stride + j];
    y[j] = sum;
  }
}

/// Row by row of P, over the segments up to the diagonal. HJ: H J.
template <int dim>
[[gnu::always_inline]] inline void addProducts(const Segment* begin, const Segment* end,
                                               const double* J, const double* HJ, int n,
                                               TreeMatrix& P) {
  int ci = 0;
  for (const Segment* s = begin; s != end; ++s) {
    for (int row = s->begin; row < s->end; ++row, ++ci) {
      double c[dim];
      for (int d = 0; d < dim; ++d) c[d] = HJ[d * n + ci];
      double* p = P.row(row);
      const double* from = J;
      for (const Segment* t = begin; t <= s; ++t) {
        const int count = (t == s ? row + 1 : t->end) - t->begin;
        addRowsOf<dim>(c, from, n, count, p + t->begin);
        from += count;
      }
    }
  }
}

SOFTGAUSS_VECTOR_CLONES void addProductsOfThree(const Segment* begin, const Segment* end,
                                                const double* J, const double* HJ, int n,
                                                TreeMatrix& P) {
  addProducts<3>(begin, end, J, HJ, n, P);
}

}  // namespace

void BlockJacobian::addCurvature(int i, const double* H, TreeMatrix& P) {
  const JacobianBlock& block = blocks_[i];
  SOFTGAUSS_ASSERT(block.segmentEnd >= 0);
  const int n = block.columns, dim = block.dim;
  const double* J = values_.data() + block.value;
  double* HJ = scratch_.data();
  for (int d = 0; d < dim; ++d) {
    double* row = HJ + d * n;
    for (int c = 0; c < n; ++c) row[c] = H[d * dim] * J[c];
    for (int e = 1; e < dim; ++e)
      for (int c = 0; c < n; ++c) row[c] += H[d * dim + e] * J[e * n + c];
  }
  const Segment *begin = segments_.data() + block.segment,
                *end = segments_.data() + block.segmentEnd;
  if (dim == 3) return addProductsOfThree(begin, end, J, HJ, n, P);  // most contacts
  for (int d = 0; d < dim; ++d) addProducts<1>(begin, end, J + d * n, HJ + d * n, n, P);
}

void BlockJacobian::denseRow(int i, int row, Eigen::Ref<Eigen::RowVectorXd> J) const {
  const JacobianBlock& block = blocks_[i];
  const double* value = values_.data() + block.value + row * block.columns;
  J.setZero();
  for (int s = block.segment; s < block.segmentEnd; ++s)
    for (int j = segments_[s].begin; j < segments_[s].end; ++j) J[j] = *value++;
}

void BlockJacobian::appendCouplings(std::vector<Segment>& segments,
                                    std::vector<int>& setEnd) const {
  for (const JacobianBlock& block : blocks_) {
    if (!block.couples) continue;
    segments.insert(segments.end(), segments_.begin() + block.segment,
                    segments_.begin() + block.segmentEnd);
    setEnd.push_back(static_cast<int>(segments.size()));
  }
}

}  // namespace softgauss
