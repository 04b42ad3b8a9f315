// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Dry (Coulomb) friction of joints, one row for each dof that has it.
///
/// The row wants the joint to come to rest, with a force of at most f_max = Dof::dryFriction:
///   x = aᵢ − a_ref,   a_ref = −b vᵢ,   f = −D x clamped to ± f_max                         (4.2)
/// There is no distance: b, D come from the dof's Impedance at r = 0. While the joint slides, the
/// force is f_max against the motion. While it sticks under a load f, it would creep at R f/b, but
/// slower than 2 R f_max/b its row hardens (5.6), unless friction is asked
/// to stay soft (Options::constraintModel, Input::controlled). Contract: |f| ≤ f_max.

#include <vector>

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/rows.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/articulated_factor.hpp"
#include "softgauss/engine/dynamics/body_motion.hpp"

namespace softgauss {

class DryFriction : public ScalarRows<Huber> {
 public:
  void assemble(const Assembly& in);
  void multiply(const VectorX& a, std::vector<double>& y) const {
    for (std::size_t i = 0; i < dof_.size(); ++i) y[i] = a[dof_[i]];
  }
  void addTransposed(const std::vector<double>& y, VectorX& tau) const {
    for (std::size_t i = 0; i < dof_.size(); ++i) tau[dof_[i]] += y[i];
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
  void addRow(int i, double scale, VectorX& y) const { y[dof_[idx(i)]] += scale; }
  std::size_t bytes() const { return ScalarRows::bytes() + bytesOf(dof_); }
  int dof(int row) const { return dof_[idx(row)]; }
  RowKey name(int row) const { return {.first = dof_[idx(row)]}; }

 private:
  std::vector<int> dof_;
};

}  // namespace softgauss
