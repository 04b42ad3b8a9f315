// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_lu.hpp"

#include <cmath>

namespace softgauss {

bool TreeLu::compute(const Model& model, TreePair& A) {
  constexpr double kLeast = 1e-3;
  const std::vector<Dof>& dofs = model.dofs;
  for (int k = model.nv - 1; k >= 0; --k) {
    double* lower = A.lower.row(k);
    const double* upper = A.upper.row(k);
    const double pivot = lower[k];
    // upper[k] is the entry as it was: elimination works on the one in `lower`.
    if (!(pivot > kLeast * std::abs(upper[k]))) return false;
    for (int i = dofs[k].parent; i >= 0; i = dofs[i].parent) {
      const double factor = upper[i] / pivot;
      if (factor == 0.0) continue;
      double* row = A.lower.row(i);
      for (int j = i; j >= 0; j = dofs[j].parent) row[j] -= factor * lower[j];
      for (int j = dofs[k].parent; j > i; j = dofs[j].parent)
        A.upper.row(j)[i] -= factor * lower[j];
    }
  }
  return true;
}

void TreeLu::solve(const Model& model, const TreePair& A, VectorX& x) const {
  const std::vector<Dof>& dofs = model.dofs;
  for (int k = model.nv - 1; k >= 0; --k) {
    const double scaled = x[k] / A.lower.row(k)[k];
    const double* upper = A.upper.row(k);
    for (int i = dofs[k].parent; i >= 0; i = dofs[i].parent) x[i] -= upper[i] * scaled;
  }
  for (int k = 0; k < model.nv; ++k) {
    const double* lower = A.lower.row(k);
    for (int j = dofs[k].parent; j >= 0; j = dofs[j].parent) x[k] -= lower[j] * x[j];
    x[k] /= lower[k];
  }
}

}  // namespace softgauss
