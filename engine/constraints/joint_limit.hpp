// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joint limits  q_min ≤ q ≤ q_max, one row per end whose distance r < margin.
///
/// Distance r = q − q_min (lower) or q_max − q (upper), so J = ±eᵢ and a force ≥ 0 pushes inward:
///   x = ±aᵢ − a_ref,   a_ref = −b ṙ − k d (r − margin),   s(x) = ½ D min(x, 0)²           (4.1)
/// b, k, D: of the joint's Impedance, A of (5.4). Contract: f ≥ 0, f·max(x, 0) = 0.

#include <vector>

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/rows.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/articulated_factor.hpp"
#include "softgauss/engine/dynamics/body_motion.hpp"

namespace softgauss {

class JointLimit : public ScalarRows<HalfQuadratic> {
 public:
  void assemble(const Assembly& in);
  void multiply(const VectorX& a, std::vector<double>& y) const {
    for (std::size_t i = 0; i < dof_.size(); ++i) y[i] = sign_[i] * a[dof_[i]];
  }
  void addTransposed(const std::vector<double>& y, VectorX& tau) const {
    for (std::size_t i = 0; i < dof_.size(); ++i) tau[dof_[i]] += sign_[i] * y[i];
  }
  void multiply(const BodyMotion& a, std::vector<double>& y) const { multiply(a.joint, y); }
  void addTransposed(const std::vector<double>& y, BodyForce& tau) const {
    addTransposed(y, tau.joint);
  }
  void addCurvature(ArticulatedFactor& P) {
    for (std::size_t i = 0; i < dof_.size(); ++i) P.addJoint(dof_[i], h[i]);
  }
  void addCurvature(TreeMatrix& P) {
    for (std::size_t i = 0; i < dof_.size(); ++i) P.row(dof_[i])[dof_[i]] += h[i];
  }
  /// y ← y + scale · (row i of J)ᵀ.
  void addRow(int i, double scale, VectorX& y) const { y[dof_[idx(i)]] += sign_[idx(i)] * scale; }
  std::size_t bytes() const { return ScalarRows::bytes() + bytesOfAll(dof_, sign_); }
  int dof(int row) const { return dof_[idx(row)]; }
  RowKey name(int row) const {
    return {.first = dof_[idx(row)], .second = sign_[idx(row)] > 0.0 ? 0 : 1};
  }
  double sign(int row) const { return sign_[idx(row)]; }

 private:
  std::vector<int> dof_;
  std::vector<double> sign_;  ///< +1 lower, −1 upper
};

}  // namespace softgauss
