// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/program_face.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/vector_clones.hpp"
#include "softgauss/gdd/weighted_rows.hpp"

namespace softgauss::gdd {
namespace {

/// Of |p|, |q|: what rounding may violate.
constexpr double kRounding = 1e-13;
/// A constraint of which less than this share (squared) is new depends on the others.
constexpr double kDependentFace = 1e-12;

SOFTGAUSS_VECTOR_CLONES double dotPadded(const double* x, const double* y, int n) {
  return dot(x, y, n);
}

/// g_k ← w·w_k for `count` rows of W.
SOFTGAUSS_VECTOR_CLONES void multiplyRows(const double* W, int count, int stride, const double* w,
                                          double* g) {
  for (int k = 0; k < count; ++k) g[k] = dot(W + k * stride, w, stride);
}

double largest(const double* x, int n) {
  double most = 0.0;
  for (int i = 0; i < n; ++i) most = std::max(most, std::abs(x[i]));
  return most;
}

}  // namespace

void ProgramFace::reserve(int unknowns, int rows) {
  const std::size_t most = static_cast<std::size_t>(2 * unknowns + rows);
  for (std::vector<int>* list : {&active_, &from_}) list->reserve(most);
  for (std::vector<double>* list : {&rest_, &size_, &products_}) list->reserve(most);
  isActive_.reserve(most);
  nu_.reserve(most + 4);  // padded
  W_.resize(std::max(W_.size(), most * static_cast<std::size_t>(paddedSize(unknowns))));
  gram_.reserve(unknowns);
}

/// Takes in a constraint: its w.
void ProgramFace::addNormal(const PaddedCholesky& factor, const ProgramData& program,
                            int constraint) {
  const int n = factor.size(), stride = factor.stride();
  const std::size_t used = active_.size() * static_cast<std::size_t>(stride);
  if (W_.size() < used + stride) W_.resize(used + stride);
  double* w = W_.data() + used;
  std::fill(w, w + stride, 0.0);
  double size = 1.0;
  int first = 0;
  if (constraint < n) {
    w[first = constraint] = 1.0;
    rest_.push_back((*program.lower)[constraint]);
  } else if (constraint < 2 * n) {
    w[first = constraint - n] = -1.0;
    rest_.push_back(-(*program.upper)[constraint - n]);
  } else {
    const int row = constraint - 2 * n;
    std::copy_n(&(*program.N)(row, 0), n, w);
    size = std::sqrt(dotPadded(w, w, stride));
    rest_.push_back(-(*program.distance)[row]);
  }
  factor.solveLower(w, first);
  active_.push_back(constraint);
  size_.push_back(size);
  isActive_[constraint] = 1;
}

/// G and the right sides of constraints that have come since the last time.
void ProgramFace::growGram(const PaddedCholesky& factor) {
  const int n = factor.size(), stride = factor.stride();
  const int m = static_cast<int>(active_.size());
  if (G_.cols() < n) G_.resize(n, n);
  products_.resize(static_cast<std::size_t>(m));
  for (; known_ < m; ++known_) {
    const double* w = W_.data() + known_ * stride;
    multiplyRows(W_.data(), known_ + 1, stride, w, products_.data());
    for (int b = 0; b <= known_; ++b) G_(known_, b) = products_[b];
    rest_[known_] -= dotPadded(w, y_.data(), stride);
  }
}

/// ν ← G⁻¹(b + W L⁻¹q); false where constraints depend on one another.
bool ProgramFace::solveMultipliers() {
  const int m = static_cast<int>(active_.size());
  if (!gram_.compute(G_.topLeftCorner(m, m))) return false;
  for (int a = 0; a < m; ++a) {
    const double inverse = gram_.inverse()[a];
    if (!(1.0 > kDependentFace * G_(a, a) * inverse * inverse)) return false;
  }
  nu_.assign(static_cast<std::size_t>(gram_.stride()), 0.0);
  std::copy_n(rest_.begin(), m, nu_.begin());
  gram_.solveLower(nu_.data());
  gram_.solveTransposed(nu_.data());
  nu_.resize(static_cast<std::size_t>(m));
  return true;
}

/// p and ν on the present face.
bool ProgramFace::solveFace(const PaddedCholesky& factor, const ProgramData& program) {
  const int n = factor.size(), stride = factor.stride();
  const int m = static_cast<int>(active_.size());
  if (m > n) return false;
  growGram(factor);
  if (!solveMultipliers()) return false;
  p_ = y_;
  addWeightedRows(nu_.data(), W_.data(), m, stride, p_.data());
  factor.solveTransposed(p_.data());
  for (const int c : active_) {
    if (c < n)
      p_[c] = (*program.lower)[c];
    else if (c < 2 * n)
      p_[c - n] = (*program.upper)[c - n];
  }
  return true;
}

/// Drops what pulls and takes in what is violated; whether anything has changed.
bool ProgramFace::changeFace(const PaddedCholesky& factor, const ProgramData& program) {
  const int n = factor.size(), stride = factor.stride();
  const double size = kRounding * largest(p_.data(), n);
  int kept = 0;
  const int before = static_cast<int>(active_.size());
  from_.resize(static_cast<std::size_t>(before));
  for (int a = 0; a < before; ++a) {
    if (nu_[a] * size_[a] < -kRounding * force_) {
      isActive_[active_[a]] = 0;
      continue;
    }
    if (kept != a) {
      std::copy_n(W_.data() + a * stride, stride, W_.data() + kept * stride);
      active_[kept] = active_[a], rest_[kept] = rest_[a], size_[kept] = size_[a];
    }
    from_[kept++] = a;
  }
  active_.resize(kept), rest_.resize(kept), size_.resize(kept);
  if (kept != before)
    for (int b = 0; b < kept; ++b)
      for (int a = b; a < kept; ++a) G_(a, b) = G_(from_[a], from_[b]);
  known_ = kept;
  bool changed = kept != before;
  // What was dropped is on its bound, and violates nothing.
  const auto take = [&](int constraint) {
    if (isActive_[constraint]) return;
    addNormal(factor, program, constraint);
    changed = true;
  };
  for (int i = 0; i < n; ++i) {
    if (p_[i] < (*program.lower)[i] - size) take(i);
    if (p_[i] > (*program.upper)[i] + size) take(n + i);
  }
  for (int k = 0; k < program.rows; ++k) {
    if (isActive_[2 * n + k]) continue;
    const auto N = program.N->row(k);
    double sum = (*program.distance)[k], square = 0.0;
    for (int i = 0; i < n; ++i) sum += N[i] * p_[i], square += N[i] * N[i];
    if (sum < -size * std::sqrt(n * square)) take(2 * n + k);
  }
  return changed;
}

bool ProgramFace::minimize(const PaddedCholesky& factor, const ProgramData& program) {
  constexpr int kMaxRounds = 8;
  const int n = factor.size(), stride = factor.stride();
  y_.assign(static_cast<std::size_t>(stride), 0.0);
  for (int i = 0; i < n; ++i) y_[i] = -(*program.q)[i];
  force_ = largest(y_.data(), n);
  factor.solveLower(y_.data());
  isActive_.assign(static_cast<std::size_t>(program.count()), 0);
  active_.clear(), rest_.clear(), size_.clear();
  known_ = 0;
  for (int i = 0; i < n; ++i) {
    if ((*program.lower)[i] == 0.0) addNormal(factor, program, i);
    if ((*program.upper)[i] == 0.0) addNormal(factor, program, n + i);
  }
  for (int k = 0; k < program.rows; ++k) addNormal(factor, program, 2 * n + k);
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!solveFace(factor, program)) return false;
    if (changeFace(factor, program)) continue;
    for (double& nu : nu_) nu = std::max(0.0, nu);
    return true;
  }
  return false;
}

}  // namespace softgauss::gdd
