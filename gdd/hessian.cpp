// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/hessian.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::gdd {
namespace {

/// y ← y + Σ_k B(k, i) B(k, 0..count) for one i: a row of the Gram matrix Bᵀ B. B is row-major
/// (rows × stride). Four rows at a time, so that y is loaded and stored once for four products.
void addGramRow(const double* B, int rows, int stride, int i, int count, double* y) {
  int k = 0;
  for (; k + 4 <= rows; k += 4) {
    const double *b0 = B + k * stride, *b1 = b0 + stride, *b2 = b1 + stride, *b3 = b2 + stride;
    const double s0 = b0[i], s1 = b1[i], s2 = b2[i], s3 = b3[i];
    for (int j = 0; j < count; ++j) y[j] += s0 * b0[j] + s1 * b1[j] + s2 * b2[j] + s3 * b3[j];
  }
  for (; k < rows; ++k) {
    const double* b = B + k * stride;
    const double s = b[i];
    for (int j = 0; j < count; ++j) y[j] += s * b[j];
  }
}

}  // namespace

GaussNewtonHessian::GaussNewtonHessian(const Model& model)
    : dense_(TreeSparsity::dense(model.nv)),
      compact_(model.dofs.size(), -1),
      force_(VectorX::Zero(model.nv)),
      row_(VectorX::Zero(model.nv)) {
  H_.resize(dense_);
}

void GaussNewtonHessian::setCell(Data& data) {
  const TreeSparsity& pattern = data.constraints.sparsity();
  G_.resize(pattern);
  G_.setZero();
  data.constraints.addCurvature(G_);
  P_.resize(pattern);
  P_.assign(G_);
  P_.add(data.inertia.hat());
}

bool GaussNewtonHessian::factorize(const Data& data, const TreeFactor& massFactor,
                                   const VectorX& boundCurvature, const ControlLimits& limits,
                                   GoalCost& cost, ContactForceTerms& forces) {
  const int n = H_.size();
  H_.setZero();
  if (cost.controlCost().hasInverseMass()) {
    // M̂ + 2 G + G M̂⁻¹G
    H_.add(data.inertia.hat());
    H_.add(G_, 2.0);
    addReflectedContacts(data, massFactor);
  }
  H_.add(data.inertia.M, cost.metricWeight());
  addForceTerms(boundCurvature, limits, cost.controlCost());
  cost.addRowCurvature(H_);
  if (forces.active()) {
    forces.setJacobian(data.constraints, n);
    forces.addCurvature(H_);
  }
  return factorizeRounded();
}

/// P M̂⁻¹ P squares the stiffness of contacts over the inertia: beyond 10¹⁶ rounding takes the
/// smallest pivots. A share of the diagonal, as small as serves, gives them back; the direction
/// stays one of descent.
bool GaussNewtonHessian::factorizeRounded() {
  constexpr double kLeast = 1e-15, kMost = 1e-9;
  const int n = H_.size();
  if (n == 0 || factor_.compute(H_)) return true;
  for (double share = kLeast; share < kMost; share *= 10.0) {
    for (int i = 0; i < n; ++i) row_[i] = share * H_.row(i)[i];
    if (factor_.compute(H_, row_.data())) return true;
  }
  return false;
}

void GaussNewtonHessian::addReflectedContacts(const Data& data, const TreeFactor& massFactor) {
  // Dofs with a row of G, and their ancestors, to which L⁻ᵀ carries.
  const int n = G_.size();
  std::fill(compact_.begin(), compact_.end(), -1);
  const TreeSparsity& tree = data.inertia.sparsity;
  for (int i = 0; i < n; ++i) {
    if (G_.row(i)[i] == 0.0) continue;
    for (const Segment* s = tree.begin(i); s != tree.end(i); ++s)
      std::fill(compact_.begin() + s->begin, compact_.begin() + s->end, 0);
  }
  touched_.clear();
  for (int i = 0; i < n; ++i) {
    if (compact_[i] < 0) continue;
    compact_[i] = static_cast<int>(touched_.size());
    touched_.push_back(i);
  }
  const int m = static_cast<int>(touched_.size());
  if (m == 0) return;

  // C ← G on these dofs, both triangles.
  C_.assign(static_cast<std::size_t>(m * m), 0.0);
  for (int ci = 0; ci < m; ++ci) {
    const int i = touched_[ci];
    const double* row = G_.row(i);
    for (const Segment* s = G_.sparsity().begin(i); s != G_.sparsity().end(i); ++s) {
      for (int j = s->begin; j < s->end; ++j) {
        const int cj = compact_[j];
        if (cj >= 0) C_[ci * m + cj] = C_[cj * m + ci] = row[j];
      }
    }
  }
  // C ← D^−½ L⁻ᵀ C, then H gains Cᵀ C.
  for (int ck = m - 1; ck >= 0; --ck) {
    const int k = touched_[ck];
    const double* L = massFactor.lowerRow(k);
    double* from = C_.data() + ck * m;
    for (const Segment* s = tree.begin(k); s != tree.end(k); ++s) {
      const int end = std::min(s->end, k);
      for (int j = s->begin; j < end; ++j) {
        double* to = C_.data() + compact_[j] * m;
        const double l = L[j];
        for (int c = 0; c < m; ++c) to[c] -= l * from[c];
      }
    }
    const double root = std::sqrt(massFactor.inversePivot(k));
    for (int c = 0; c < m; ++c) from[c] *= root;
  }
  gram_.resize(static_cast<std::size_t>(m));
  for (int ci = 0; ci < m; ++ci) {
    std::fill(gram_.begin(), gram_.begin() + ci + 1, 0.0);
    addGramRow(C_.data(), m, m, ci, ci + 1, gram_.data());
    double* h = H_.row(touched_[ci]);
    for (int cj = 0; cj <= ci; ++cj) h[touched_[cj]] += gram_[cj];
  }
}

/// H gains one rank √c P x for each force x that costs ½ c (x·g)².
void GaussNewtonHessian::addForceTerms(const VectorX& boundCurvature, const ControlLimits& limits,
                                       const ControlCostTerm& controlCost) {
  const int n = P_.size();
  forceRows_.clear();
  for (int i = 0; i < n; ++i) {
    const bool plain = limits.isPlain(i);
    const double curvature = controlCost.diagonal()[i] + (plain ? boundCurvature[i] : 0.0);
    if (curvature != 0.0) addForceRow(i, curvature);
    if (plain || boundCurvature[i] == 0.0) continue;
    force_ = limits.transmission->C().row(i).transpose();
    addForceRow(force_, boundCurvature[i]);
  }
  for (int k = 0; k < controlCost.directionCount(); ++k) addForceRow(controlCost.direction(k), 1.0);
  if (forceRows_.empty()) return;
  const int rows = static_cast<int>(forceRows_.size()) / n;
  for (int i = 0; i < n; ++i) addGramRow(forceRows_.data(), rows, n, i, i + 1, H_.row(i));
}

void GaussNewtonHessian::addForceRow(int dof, double curvature) {
  const int n = P_.size();
  const std::size_t first = forceRows_.size();
  forceRows_.resize(first + static_cast<std::size_t>(n), 0.0);
  double* b = forceRows_.data() + first;
  const double root = std::sqrt(curvature);
  for (const Segment* s = P_.sparsity().begin(dof); s != P_.sparsity().end(dof); ++s)
    for (int j = s->begin; j < s->end; ++j) b[j] = root * P_.row(dof)[j];
  for (int k = dof + 1; k < n; ++k)
    for (const Segment* s = P_.sparsity().begin(k); s != P_.sparsity().end(k); ++s)
      if (s->begin <= dof && dof < s->end) b[k] = root * P_.row(k)[dof];
}

void GaussNewtonHessian::addForceRow(const Eigen::Ref<const VectorX>& force, double curvature) {
  force_ = std::sqrt(curvature) * force;
  P_.multiply(force_, row_);
  forceRows_.insert(forceRows_.end(), row_.begin(), row_.end());
}

}  // namespace softgauss::gdd
