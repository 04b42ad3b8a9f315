// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Rows of single joints: each acts on one dof, up or down, J = ±eᵢ.

#include <vector>

#include "softgauss/engine/constraints/rows.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/articulated_factor.hpp"
#include "softgauss/engine/dynamics/body_motion.hpp"
#include "softgauss/engine/dynamics/tree_matrix.hpp"

namespace softgauss {

template <ScalarPenalty Penalty>
class JointRows : public ScalarRows<Penalty> {
 public:
  void multiply(const VectorX& a, std::vector<double>& y) const {
    this->selection.forEach([&](std::size_t i) { y[i] = sign_[i] * a[dof_[i]]; });
  }
  void addTransposed(const std::vector<double>& y, VectorX& tau) const {
    this->selection.forEach([&](std::size_t i) { tau[dof_[i]] += sign_[i] * y[i]; });
  }
  void multiply(const BodyMotion& a, std::vector<double>& y) const { multiply(a.joint, y); }
  void addTransposed(const std::vector<double>& y, BodyForce& tau) const {
    addTransposed(y, tau.joint);
  }
  void addCurvature(ArticulatedFactor& P) {
    this->selection.forEach([&](std::size_t i) { P.addJoint(dof_[i], this->h[i]); });
  }
  void addCurvature(TreeMatrix& P) {
    this->selection.forEach([&](std::size_t i) { P.row(dof_[i])[dof_[i]] += this->h[i]; });
  }
  /// y ← y + scale · (row i of J)ᵀ.
  void addRow(int i, double scale, VectorX& y) const { y[dof_[idx(i)]] += sign_[idx(i)] * scale; }
  std::size_t bytes() const { return ScalarRows<Penalty>::bytes() + bytesOfAll(dof_, sign_); }
  int dof(int row) const { return dof_[idx(row)]; }
  /// A body that the row moves.
  int bodyOf(const Model& model, int row) const { return model.dofs[idx(dof(row))].body; }
  /// +1: J = eᵢ, −1: J = −eᵢ.
  double sign(int row) const { return sign_[idx(row)]; }
  RowKey name(int row) const {
    return {.first = dof_[idx(row)], .second = sign_[idx(row)] > 0.0 ? 0 : 1};
  }

 protected:
  void clear() {
    dof_.clear();
    sign_.clear();
    this->clearRows();
  }
  void push(int dof, double sign, const Softness& soft, double aRef) {
    dof_.push_back(dof);
    sign_.push_back(sign);
    this->reference.push_back(aRef);
    this->pushSoftness(soft);
  }
  void finish() { this->resizeRows(dof_.size()); }

 private:
  std::vector<int> dof_;
  std::vector<double> sign_;
};

}  // namespace softgauss
